"""What is said of a "no" when an action that it depends on did not do what it aimed at."""

from __future__ import annotations

import re
from collections.abc import Set

from prolepsis.log.lookup import lookup
from prolepsis.log.plan_end import CARRYING_EVENTS, plan_end, plan_end_told, told
from prolepsis.log.timeline import Timeline
from prolepsis.logic.otherwise import subterms
from prolepsis.logic.refusals import shown
from prolepsis.terms.errors import InputError
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import Term, Value

FINE = ("done", "dropped", "unfinished")
"""Outcomes of which nothing need be said here: what was let fall was done until then, what a log cuts off is told as an
open end."""
PLAN_MAKES = frozenset(
    {"holds", "holds_at", "occurs", "ongoing", "near_miss", "evidence", "fact"}
    | {"fluent", "fluentT", "event", "eventT", "argsOf", "objOf"}
)
"""Predicates that a plan that goes on may make true."""
ASK_LOG = PLAN_MAKES | {"instance_of"}
"""Predicates that an action may make true: not what is known of a thing from the start, as its parts are."""
MOST = 3
"""So many actions are told of."""


def undone_note(timeline: Timeline, goal: str) -> str:
    """Return the note on a goal without answers, empty if it needs none: what was not done proves nothing.

    Args:
        timeline: What was asked.
        goal: The goal as it was asked; an action bears on it if it names one of the action's things, and one that
            ended the plan on whatever it asks of the time from then on.
    """
    if not _asks_log(goal, 0.0):
        return ""
    ended = plan_end(timeline)
    is_about = ended is not None and _asks_log(goal, ended[0], PLAN_MAKES)
    named = {*re.findall(r"\w+", goal)}
    found = [plan_end_told(timeline)] if is_about else []
    for fact in lookup(timeline).actions:
        outcome = fact.evidence.get("outcome")
        if (
            outcome not in FINE
            and not (outcome == "not_held" and fact.type in CARRYING_EVENTS)
            and not (is_about and ended and fact in ended[1])
            and named & {each for each in fact.args if isinstance(each, str)}
        ):
            found.append(told(fact))
    return f"no, but {'; '.join(found[:MOST])}{' ...' if len(found) > MOST else ''}: {shown(goal)}" if found else ""


def _asks_log(goal: str, time: float, predicates: Set[str] = ASK_LOG) -> bool:
    """Return whether a goal asks, by one of some predicates, what was, or may have been, from a time [s] on."""
    try:
        parts = [*subterms(parse_term(goal))]
    except (InputError, RecursionError):
        return any(name in predicates for name in re.findall(r"\w+(?=\()", goal))
    return any(_is_from(each, time) for each in parts if isinstance(each, Term) and each.functor in predicates)


def _is_from(asked: Term, time: float) -> bool:
    when: Value | None = asked.args[1] if len(asked.args) > 1 else None
    return not isinstance(when, int | float) or when >= time
