"""What is said of a "no" where the same is told otherwise: the other way round, by another number or other evidence."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence

from prolepsis.log.evidence_names import EVIDENCE_UNITS
from prolepsis.log.fact_types import SYMMETRIC
from prolepsis.log.lookup import lookup
from prolepsis.log.timeline import Timeline
from prolepsis.logic.refusals import shown
from prolepsis.terms.errors import InputError, brief, brief_list
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import Term, Value, Variable, format_atom, format_value

MOST = 3
"""So much is told."""
EITHER_WAY = frozenset({"holds", "holds_at", "occurs", "evidence", "ongoing"})
"""Predicates that find the two things of a symmetric type in either order; of an answer they have one."""
OTHER_UNIT = 10.0
"""A number that is so many times another may be in another unit [1]."""


def otherwise_note(timeline: Timeline, goal: str) -> str:
    """Return the note on a goal without answers, empty if it needs none.

    Args:
        timeline: What was asked.
        goal: The goal as it was asked; what it says of two things, numbers and evidence is looked up otherwise.
    """
    try:
        asked = [each for each in subterms(parse_term(goal)) if isinstance(each, Term)]
    except (InputError, RecursionError):
        return ""
    words = {*re.findall(r"\w+", goal)}
    either_way = [part for each in asked if each.functor in EITHER_WAY for part in each.args]
    told = [
        told
        for each in asked
        for told in (
            *_other_way_round(timeline, each, each in either_way),
            *_other_number(timeline, each),
            *_other_evidence(timeline, each, words),
            *_of_parts(timeline, each),
        )
    ]
    told = list(dict.fromkeys(told))
    return f"no, but {'; '.join(told[:MOST])}{' ...' if len(told) > MOST else ''}: {shown(goal)}" if told else ""


def subterms(value: Value) -> Iterator[Value]:
    """Yield a value and all that is in it."""
    yield value
    for each in value.args if isinstance(value, Term) else value if isinstance(value, tuple) else ():
        yield from subterms(each)


def _other_way_round(timeline: Timeline, asked: Term, either_way: bool) -> Iterator[str]:
    """Yield what is so with the two arguments in the other order, unless it is of a type that was found either way."""
    if len(asked.args) != 2 or not all(isinstance(each, str) for each in asked.args):
        return
    if either_way and asked.functor in SYMMETRIC:
        return
    parts = [("has_part", row) for row in timeline.domain.parts] if asked.functor == "has_part" else []
    facts = {*parts, *((fact.type, fact.args) for fact in lookup(timeline).of(asked.functor))}
    if (asked.functor, asked.args[::-1]) in facts and (asked.functor, asked.args) not in facts:
        yield f"{brief(format_value(Term(asked.functor, asked.args[::-1])))} is so, the other way round"


def _of_parts(timeline: Timeline, asked: Term) -> Iterator[str]:
    """Yield what is told of the parts of a thing, where it is told of nothing that fits the thing itself."""
    facts = lookup(timeline).of(asked.functor)
    orders = [asked.args, asked.args[::-1]] if asked.functor in SYMMETRIC else [asked.args]
    if not facts or any(_fits(fact.args, order) for fact in facts for order in orders):
        return
    for thing in asked.args:
        parts = _below(timeline.domain.parts, thing) if isinstance(thing, str) else set[str]()
        wholes = [tuple(thing if each in parts else each for each in fact.args) for fact in facts] if parts else []
        told = [
            brief(format_value(fact.term))
            for fact, whole in zip(facts, wholes, strict=False)
            if any(_fits(whole, order) for order in orders)
        ]
        if told:
            more = f" and {len(told) - MOST} more" if len(told) > MOST else ""
            whole = brief(format_atom(str(thing)))
            yield f"{asked.functor} is told of parts of {whole}: {', '.join(told[:MOST])}{more}"


def _below(parts: Collection[tuple[str, str]], whole: str) -> set[str]:
    """Return the parts of a whole, and theirs."""
    direct: dict[str, list[str]] = {}
    for above, part in parts:
        direct.setdefault(above, []).append(part)
    found, left = set[str](), [whole]
    while left:
        new = [part for part in direct.get(left.pop(), ()) if part not in found]
        found.update(new)
        left += new
    return found


def _fits(given: Sequence[Value], asked: Sequence[Value]) -> bool:
    """Return whether arguments are those that are asked for, where no variable stands."""
    pairs = zip(given, asked, strict=False)
    return len(given) == len(asked) and all(isinstance(each, Variable) or each == of for of, each in pairs)


def _other_number(timeline: Timeline, asked: Term) -> Iterator[str]:
    if any(isinstance(each, int | float) for each in asked.args):
        alike = lookup(timeline).of(asked.functor)
        same = [fact.term for fact in alike if _but_for_numbers(fact.term) == _but_for_numbers(asked)]
        yield from (f"{brief(format_value(each))} is so" for each in same if each != asked)
    match asked:
        case Term(functor="value", args=(str(thing), str(name), int() | float() as given)):
            numbers = [value for of, its, value in timeline.domain.values if (of, its) == (thing, name)]
        case Term(functor="evidence", args=(thing, _, str(name), int() | float() as given)):
            type_ = thing.functor if isinstance(thing, Term) else thing
            alike = lookup(timeline).of(type_) if isinstance(type_, str) else ()
            numbers = [fact.evidence.get(name) for fact in alike if fact.term == thing]
        case _:
            return
    unit = {**EVIDENCE_UNITS, **dict(timeline.domain.units)}.get(name, "")
    for number in numbers:
        if isinstance(number, int | float) and _meant(given, number):
            of_unit = f" {unit}" if unit not in ("", "1") else ""
            yield f"{format_atom(name)} of {brief(format_value(thing))} is {number:.6g}{of_unit}"


def _other_evidence(timeline: Timeline, asked: Term, words: Collection[str]) -> Iterator[str]:
    """Yield what the facts of a type have, asked for here or elsewhere in the goal, where none has such evidence."""
    match asked:
        case Term(functor="evidence", args=(Term(functor=type_), _, str(name), _)):
            types = {type_}
        case Term(functor="evidence", args=(str(type_), _, str(name), _)):
            types = {type_}
        case Term(functor="evidence", args=(_, _, str(name), _)):
            types = {*words}
        case _:
            return
    for type_ in sorted(types & lookup(timeline).by_type.keys()):
        known = {each for fact in lookup(timeline).of(type_) for each in fact.evidence}
        if name not in known:
            yield f"{type_} has no {format_atom(name)} here; {_evidence_told(name, known)}"


def _evidence_told(name: str, known: set[str]) -> str:
    if not known:
        return "nothing was measured of it"
    # What is called alike comes first.
    ranked = sorted(known, key=lambda each: (name not in each and each not in name, each))
    return f"its evidence is {brief_list(ranked)}"


def _but_for_numbers(value: Value) -> Value:
    if isinstance(value, Term) and value.functor not in ("value", "evidence"):
        return Term(value.functor, tuple("" if isinstance(each, int | float) else each for each in value.args))
    return value


def _meant(given: float, number: float) -> bool:
    """Return whether a number was meant by one that is given: rounded, or in another unit."""
    decimals = len(repr(given).partition(".")[2])
    ratio = abs(number / given) if given else 1.0
    return round(number, decimals) == given or not 1 / OTHER_UNIT < ratio < OTHER_UNIT
