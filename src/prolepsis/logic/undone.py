"""What is said of a "no" when an action that it depends on did not do what it aimed at."""

from __future__ import annotations

import re

from prolepsis.log.fact_types import event_of
from prolepsis.log.outcomes import CARRYING, OUTCOMES
from prolepsis.log.timeline import Timeline
from prolepsis.logic.refusals import shown
from prolepsis.terms.errors import brief
from prolepsis.terms.terms import format_value

FINE = ("done", "dropped", "unfinished")
"""Outcomes of which nothing need be said here: what was let fall was done until then, what a log cuts off is told as an
open end."""
CARRYING_EVENTS = frozenset(event_of(verb) for verb in CARRYING)
"""What a hand lost before it carried it is like what it let fall then."""

REASON, MOST = 160, 3
"""Characters of a reason that are told, and how many actions."""


def undone_note(timeline: Timeline, goal: str) -> str:
    """Return the note on a goal without answers, empty if it needs none: what was not done proves nothing.

    Args:
        timeline: What was asked.
        goal: The goal as it was asked; an action bears on it if it names one of the action's things.
    """
    named = {*re.findall(r"\w+", goal)}
    told: list[str] = []
    for fact in timeline.facts:
        outcome = fact.evidence.get("outcome")
        if (
            outcome in OUTCOMES
            and outcome not in FINE
            and not (outcome == "not_held" and fact.type in CARRYING_EVENTS)
            and named & {each for each in fact.args if isinstance(each, str)}
        ):
            reason = fact.evidence.get("reason")
            why = f" ({brief(reason, REASON)})" if reason else ""
            told.append(f"{brief(format_value(fact.term), REASON)} was {outcome}{why}")
    return f"no, but {'; '.join(told[:MOST])}{' ...' if len(told) > MOST else ''}: {shown(goal)}" if told else ""
