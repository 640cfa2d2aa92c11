"""What is said of a "no" when an action that it depends on did not do what it aimed at."""

from __future__ import annotations

import re

from prolepsis.log.outcomes import OUTCOMES
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
ASK_LOG = frozenset(
    {"holds", "holds_at", "occurs", "ongoing", "near_miss", "evidence", "fact"}
    | {"fluent", "fluentT", "event", "eventT", "argsOf", "objOf"}
)
"""Predicates that a plan that goes on may make true."""
MOST = 3
"""So many actions are told of."""


def undone_note(timeline: Timeline, goal: str) -> str:
    """Return the note on a goal without answers, empty if it needs none: what was not done proves nothing.

    Args:
        timeline: What was asked.
        goal: The goal as it was asked; an action bears on it if it names one of the action's things, and one that
            ended the plan on whatever it asks of the time from then on.
    """
    ended = plan_end(timeline)
    is_about = ended is not None and _asks_after(goal, ended[0])
    named = {*re.findall(r"\w+", goal)}
    found = [plan_end_told(timeline)] if is_about else []
    for fact in timeline.facts:
        outcome = fact.evidence.get("outcome")
        if (
            outcome in OUTCOMES
            and outcome not in FINE
            and not (outcome == "not_held" and fact.type in CARRYING_EVENTS)
            and not (is_about and ended and fact in ended[1])
            and named & {each for each in fact.args if isinstance(each, str)}
        ):
            found.append(told(fact))
    return f"no, but {'; '.join(found[:MOST])}{' ...' if len(found) > MOST else ''}: {shown(goal)}" if found else ""


def _asks_after(goal: str, time: float) -> bool:
    """Return whether a goal asks the log of what was, or may have been, after a time [s]."""
    try:
        parts = [*subterms(parse_term(goal))]
    except (InputError, RecursionError):
        return any(name in ASK_LOG for name in re.findall(r"\w+(?=\()", goal))
    return any(_is_after(each, time) for each in parts if isinstance(each, Term) and each.functor in ASK_LOG)


def _is_after(asked: Term, time: float) -> bool:
    when: Value | None = asked.args[1] if len(asked.args) > 1 else None
    return not isinstance(when, int | float) or when >= time
