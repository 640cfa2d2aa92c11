"""How a plan ended: an action that fails ends its sequence, and what follows is not done."""

from __future__ import annotations

from collections.abc import Sequence

from prolepsis.log.fact_types import event_of
from prolepsis.log.lookup import lookup
from prolepsis.log.outcomes import CARRYING, CLOSING, GOES_ON
from prolepsis.log.timeline import Fact, Timeline
from prolepsis.terms.errors import brief
from prolepsis.terms.terms import format_value

CARRYING_EVENTS = frozenset(event_of(verb) for verb in CARRYING)
"""What these are ``not_held`` in goes its way to the end."""
CLOSING_EVENTS = frozenset(event_of(verb) for verb in CLOSING)
REASON = 160
"""Characters of a reason that are told."""


def plan_end(timeline: Timeline) -> tuple[float, tuple[Fact, ...]] | None:
    """Return when the plan ended [s], and the failed actions that ended it; None if it went through."""
    actions = lookup(timeline).actions
    failed = [fact for fact in actions if _ends_sequence(fact) and not _followed(fact, actions)]
    return (max(fact.end for fact in actions), tuple(failed)) if failed else None


def plan_outcome(timeline: Timeline) -> str:
    """Return the outcome of a plan: of the action that ended it, else of the last that fell short, else ``done``."""
    ended = plan_end(timeline)
    short = _wholes(ended[1]) if ended else [f for f in lookup(timeline).actions if f.evidence["outcome"] != "done"]
    return str(max(short, key=lambda fact: (fact.end, -fact.start)).evidence["outcome"]) if short else "done"


def _ends_sequence(fact: Fact) -> bool:
    outcome = fact.evidence["outcome"]
    goes_on = outcome in GOES_ON or (outcome == "not_held" and fact.type in CARRYING_EVENTS)
    goes_on = goes_on or (outcome == "missed" and fact.type in CLOSING_EVENTS)
    return not goes_on and outcome != "unfinished"


def _followed(failed: Fact, actions: Sequence[Fact]) -> bool:
    """Return whether something was done after it that was not done beside it."""
    beside = any(each.start < failed.end < each.end for each in actions)
    return not beside and any(each.start >= failed.end for each in actions)


def told(fact: Fact) -> str:
    """Return what became of an action: ``grasping(hand1,egg1,5) was missed (between the pads is nothing)``."""
    reason = fact.evidence.get("reason")
    why = f" ({brief(reason, REASON)})" if reason else ""
    return f"{brief(format_value(fact.term), REASON)} was {fact.evidence['outcome']}{why}"


def plan_end_told(timeline: Timeline) -> str:
    """Return that and why a plan did not go through, empty if it did."""
    ended = plan_end(timeline)
    if ended is None:
        return ""
    time, failed = ended
    return f"the plan ended at {time:.4g} s: {'; '.join(map(told, _wholes(failed)))}"


def _wholes(failed: Sequence[Fact]) -> list[Fact]:
    """Return the failed actions but those that failed as a part of another one."""
    return [fact for fact in failed if not any(_is_part(fact, each) for each in failed)]


def _is_part(fact: Fact, whole: Fact) -> bool:
    """Return whether an action failed as what it is a part of: ``reaching`` in ``grasping``."""
    within = whole.start <= fact.start and fact.end <= whole.end and (fact.start, fact.end) != (whole.start, whole.end)
    return within and all(fact.evidence.get(name) == whole.evidence.get(name) for name in ("outcome", "reason"))
