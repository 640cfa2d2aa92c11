"""Writing a timeline as the flat facts that Prolog reads: one term a line."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from pathlib import Path

from prolepsis.terms import format_atom, format_value
from prolepsis.timeline import Argument, Fact, Timeline

_atom = lru_cache(maxsize=65536)(format_atom)


def write_run(timeline: Timeline, file: Path) -> None:
    """Write the facts and the domain knowledge of ``timeline`` to ``file``."""
    with file.open("w", encoding="utf-8") as out:
        out.write(f"tick({format_value(float(timeline.dt))}).\n")
        out.writelines(_domain_rows(timeline))
        for fact in timeline.facts:
            out.write(_fact_row(fact))


def _text(value: Argument) -> str:
    return _atom(value) if isinstance(value, str) else format_value(value)


def _time(value: float) -> str:
    text = repr(float(value))
    return text if "e" not in text else format_value(float(value))


def _fact_row(fact: Fact) -> str:
    name = _atom(fact.type)
    term = f"{name}({','.join(map(_text, fact.args))})" if fact.args else name
    row = f"{fact.kind}({term},{_time(fact.start)},{_time(fact.end)}).\n"
    return row + "".join(f"proof({_atom(key)},{_text(value)}).\n" for key, value in fact.evidence.items())


def _domain_rows(timeline: Timeline) -> Iterable[str]:
    domain = timeline.domain
    for individual, kind in domain.instances:
        yield f"instance({_atom(individual)},{_atom(kind)}).\n"
    for whole, part in domain.parts:
        yield f"part({_atom(whole)},{_atom(part)}).\n"
    for individual, name, value in domain.values:
        yield f"value({_atom(individual)},{_atom(name)},{_text(value)}).\n"
    for relation, subject, object_ in domain.relations:
        yield f"relation({_atom(relation)}({_atom(subject)},{_atom(object_)})).\n"
