"""What is said of a "no" to what never comes about here of a thing: most things are rigid, whatever strikes them."""

from __future__ import annotations

import re
from collections.abc import Iterator

from prolepsis.log.fact_types import ONLY_OF, TOLD_INSTEAD
from prolepsis.log.timeline import Fact, Timeline
from prolepsis.logic.otherwise import subterms
from prolepsis.logic.refusals import shown
from prolepsis.terms.errors import InputError, brief
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import Term, format_atom, format_value

TEARS = "Stuff"
"""What flows may be held by a membrane of its own, which breaks by itself: the yolk of an egg."""
MOST = 3
"""So many things are told of."""


def unbreakable_note(timeline: Timeline, goal: str) -> str:
    """Return the note on a goal without answers, empty if it needs none.

    Args:
        timeline: What was asked.
        goal: The goal as it was asked; it bears on a thing that it names in a fact of such a type, on all that it names
            if it names the type apart, and on whatever is told of instead if it names no thing.
    """
    asked = {*_asked(goal, {name for name, _ in timeline.domain.instances})}
    told = [each for type_, thing in sorted(asked) if (each := _told(timeline, type_, thing))]
    told = list(dict.fromkeys(told))
    return f"no, but {'; '.join(told[:MOST])}{' ...' if len(told) > MOST else ''}: {shown(goal)}" if told else ""


def _asked(goal: str, known: set[str]) -> Iterator[tuple[str, str]]:
    """Yield each type and the thing of which it is asked, empty if none is named."""
    try:
        terms = [*subterms(parse_term(goal))]
    except (InputError, RecursionError):
        terms = []
    named = [each for each in terms if isinstance(each, Term) and each.functor in ONLY_OF and len(each.args) == 1]
    for term in named:
        thing = term.args[0]
        yield term.functor, thing if isinstance(thing, str) else ""
    words = {*re.findall(r"\w+", goal)}
    for type_ in words & {*ONLY_OF} - {term.functor for term in named}:
        yield from ((type_, thing) for thing in words & known or {""})


def _told(timeline: Timeline, type_: str, thing: str) -> str:
    role, domain = ONLY_OF[type_], timeline.domain
    instead = [each for each in timeline.facts if each.type == TOLD_INSTEAD.get(role) and thing in ("", *each.args[:1])]
    if instead:
        return f"{_facts(instead)} occurred, and {type_} is told of nothing but what is {role}"
    classes = {kind for name, kind in domain.instances if name == thing}
    if TEARS in classes:
        return ""
    whole = next((whole for whole, part in domain.parts if part == thing), None)
    if whole is not None and any(whole in each.args for each in timeline.select(type=type_)):
        return f"{brief(format_value(Term(type_, (whole,))))} tells of it: {brief(format_atom(thing))} is a part"
    told_of = role in {name for row in (*domain.subclasses, *domain.definitions, *domain.instances) for name in row}
    if classes and role not in classes and told_of:
        return f"{brief(format_atom(thing))} is not {role}, and {type_} is told of nothing else"
    return ""


def _facts(facts: list[Fact]) -> str:
    return ", ".join(brief(format_value(each.term)) for each in facts[:MOST]) + (" ..." if len(facts) > MOST else "")
