"""What is said of a "no" to what never comes about here of a thing: it is told only of what is of a class."""

from __future__ import annotations

import re
from collections.abc import Iterator

from prolepsis.log.domain import Domain
from prolepsis.log.fact_types import BY_ITSELF, NEEDS, ONLY_OF, TOLD_INSTEAD
from prolepsis.log.lookup import lookup
from prolepsis.log.timeline import Fact, Timeline
from prolepsis.logic.otherwise import subterms
from prolepsis.logic.refusals import shown
from prolepsis.terms.errors import InputError, brief
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import Term, format_atom, format_value

MOST = 3
"""So many things are told of."""


def only_of_note(timeline: Timeline, goal: str) -> str:
    """Return the note on a goal without answers, empty if it needs none.

    Args:
        timeline: What was asked.
        goal: The goal as it was asked; it bears on a thing that it names in a fact of such a type, on all that it names
            if it names the type apart, and on whatever is told of instead if it names no thing.
    """
    asked = {*_asked(goal, {name for name, _ in timeline.domain.instances})}
    told = [each for type_, roles, thing in sorted(asked) if (each := _told(timeline, type_, roles, thing))]
    told = list(dict.fromkeys(told))
    return f"no, but {'; '.join(told[:MOST])}{' ...' if len(told) > MOST else ''}: {shown(goal)}" if told else ""


def _asked(goal: str, known: set[str]) -> Iterator[tuple[str, tuple[str, ...], str]]:
    """Yield each type, the classes of one of which something must be, and the thing of which it is asked, or ""."""
    try:
        terms = [*subterms(parse_term(goal))]
    except (InputError, RecursionError):
        terms = []
    of = {**ONLY_OF, **NEEDS}
    named = [each for each in terms if isinstance(each, Term) and each.functor in of]
    for term in named:
        for roles, thing in zip(ONLY_OF.get(term.functor, ()), term.args, strict=False):
            if roles:
                yield term.functor, roles, thing if isinstance(thing, str) else ""
        if term.functor in NEEDS:
            yield term.functor, NEEDS[term.functor], ""
    words = {*re.findall(r"\w+", goal)}
    for type_ in words & {*of} - {term.functor for term in named}:
        roles = ONLY_OF.get(type_, (NEEDS.get(type_, ()),))
        # Which of several things it would be is not told.
        if all(roles):
            any_role = tuple(dict.fromkeys(role for each in roles for role in each))
            yield from ((type_, any_role, thing) for thing in words & known or {""})


def _told(timeline: Timeline, type_: str, roles: tuple[str, ...], thing: str) -> str:
    domain = timeline.domain
    told_instead = {TOLD_INSTEAD[role] for role in roles if role in TOLD_INSTEAD}
    found = [each for type_instead in sorted(told_instead) for each in lookup(timeline).of(type_instead)]
    instead = [each for each in found if thing in ("", *each.args[:1])]
    if instead:
        return f"{_facts(instead)} occurred, and {type_} is told of nothing but what is {' or '.join(roles)}"
    classes = {kind for name, kind in domain.instances if name == thing}
    if {*roles} <= {role for (role,) in domain.untold} and not lookup(timeline).of(type_):
        return f"the log tells of nothing that is {' or '.join(roles)}, and does not decide {type_}"
    if classes and not classes & {*roles} and _told_of(domain, roles):
        return f"{brief(format_atom(thing))} is not {' or '.join(roles)}, and {type_} is told of nothing else"
    whole = next((whole for whole, part in domain.parts if part == thing), None)
    if whole is not None and not classes & BY_ITSELF and any(whole in each.args for each in lookup(timeline).of(type_)):
        return f"{brief(format_value(Term(type_, (whole,))))} tells of it: {brief(format_atom(thing))} is a part"
    return ""


def _told_of(domain: Domain, roles: tuple[str, ...]) -> bool:
    """Return whether one of some classes is known where a domain comes from, and all classes of what is in it are."""
    if not domain.subclasses:  # What a log alone says of things is some of their classes.
        return False
    return not {*roles}.isdisjoint(
        name for row in (*domain.subclasses, *domain.definitions, *domain.instances) for name in row
    )


def _facts(facts: list[Fact]) -> str:
    return ", ".join(brief(format_value(each.term)) for each in facts[:MOST]) + (" ..." if len(facts) > MOST else "")
