"""Writing a timeline as the flat facts that Prolog reads: one term a line."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache
from pathlib import Path

from prolepsis.log.asserted import with_asserted
from prolepsis.log.fact_types import SYMMETRIC, fact_types
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import NUMBERS, Argument, Fact, Timeline
from prolepsis.logic.unknown_names import OTHERWISE
from prolepsis.terms.decimals import decimal_of
from prolepsis.terms.terms import format_atom, format_value
from prolepsis.terms.ticks import ticks_of

_atom = lru_cache(maxsize=65536)(format_atom)


def write_run(timeline: Timeline, file: Path) -> None:
    """Write the facts and the domain knowledge of ``timeline`` to ``file``."""
    with file.open("w", encoding="utf-8") as out:
        ticks = ticks_of(timeline.dt)
        out.write(f"tick({format_value(ticks.numerator)},{ticks.denominator}).\n")
        out.writelines(f"symmetric({_atom(type_)}).\n" for type_ in sorted(SYMMETRIC))
        out.write(f"lasts({format_value(float(timeline.duration))}).\n")
        facts = with_asserted(timeline) if timeline.domain.relations else timeline.facts
        out.writelines(_type_rows(facts))
        out.writelines(_declared_rows())
        out.writelines(_domain_rows(timeline))
        out.write("".join(_fact_rows(facts)))
        for each in timeline.near_misses:
            times = format_value(float(each.start)), format_value(float(each.end))
            margin = format_value(each.evidence.get(MARGIN, 1.0))
            out.write(f"near({_term(each)},{','.join(times)},{margin}).\n")


def _term(fact: Fact) -> str:
    return f"{_atom(fact.type)}({','.join(map(_text, fact.args))})" if fact.args else _atom(fact.type)


def _text(value: Argument) -> str:
    if isinstance(value, str):
        # A displacement of an action is a list in a goal, as it is in the plan.
        return value if NUMBERS.fullmatch(value) else _atom(value)
    return format_value(decimal_of(value))


def _type_rows(facts: Iterable[Fact]) -> Iterable[str]:
    for type_, kind, arity in sorted({(fact.type, fact.kind, len(fact.args)) for fact in facts}):
        yield f"type({_atom(type_)},{kind},{arity}).\n"


def _declared_rows() -> Iterable[str]:
    """Yield the types that this program has been told of, some by its user: the others are known to Prolog already."""
    for known in fact_types().values():
        for arity in known.arities:
            yield f"declared({known.kind},{_atom(known.name)},{arity}).\n"


def _fact_rows(facts: Iterable[Fact]) -> Iterator[str]:
    # Most of the work is making texts, and most terms come back: those of names alone are kept.
    # Numbers are not, since 1, 1.0 and True are one key.
    known: dict[tuple[str, tuple[Argument, ...]], str] = {}
    for fact in facts:
        key = (fact.type, fact.args)
        term = known.get(key)
        if term is None:
            term = _term(fact)
            if all(isinstance(argument, str) for argument in fact.args):
                known[key] = term
        start, end = repr(float(fact.start)), repr(float(fact.end))
        if "e" in start or "e" in end:  # Prolog reads no 1e-05, only 1.0e-5
            start, end = format_value(float(fact.start)), format_value(float(fact.end))
        yield f"{fact.kind}({term},{start},{end}).\n"
        for name, value in fact.evidence.items():
            yield f"proof({_atom(name)},{_text(value)}).\n"


def _domain_rows(timeline: Timeline) -> Iterable[str]:
    domain = timeline.domain
    for individual, kind in domain.instances:
        yield f"instance({_atom(individual)},{_atom(kind)}).\n"
    for whole, part in domain.parts:
        yield f"part({_atom(whole)},{_atom(part)}).\n"
    for individual, name, value in domain.values:
        yield f"value({_atom(individual)},{_atom(name)},{_text(value)}).\n"
    for name, above in domain.subclasses:
        yield f"subclass({_atom(name)},{_atom(above)}).\n"
    for row in domain.definitions:
        yield f"definition({','.join(map(_atom, row))}).\n"
    for name, above in domain.subproperties:
        yield f"subproperty({_atom(name)},{_atom(above)}).\n"
    for row in domain.inverses:
        yield f"inverse({','.join(map(_atom, row))}).\n"
    for kind, name in domain.declared:
        yield f"named({kind if kind in ('class', 'relation') else 'property'},{_atom(name)}).\n"
        if kind == "relation" and name not in OTHERWISE:
            yield f"declared(fluent,{_atom(name)},2).\n"
    for name, unit in domain.units:
        yield f"unit({_atom(name)},{_atom(unit)}).\n"
