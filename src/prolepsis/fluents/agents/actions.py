"""What the control program did, as events: ``grasp(hand1, egg1, force7)`` becomes ``grasping`` with its arguments."""

from __future__ import annotations

from collections.abc import Iterator

from prolepsis.fluents.observation import Observation
from prolepsis.log.fact_types import EVENTS, event_of
from prolepsis.log.timeline import Argument, Fact
from prolepsis.terms.decimals import decimal_of
from prolepsis.terms.terms import Term, Value, format_value


def action_facts(observation: Observation) -> Iterator[Fact]:
    """Yield the events of the log's actions, but for those that have a grounding of their own."""
    elsewhere = {known.action for known in EVENTS.values()}
    for done in observation.log.actions:
        if done.term.functor in elsewhere:
            continue
        args = tuple(argument_of(value) for value in done.term.args)
        stretch = done.start, max(done.end, done.start + 1)
        evidence: dict[str, float | str] = {"outcome": done.outcome, **done.evidence}
        yield observation.fact("event", event_of(done.term.functor), args, stretch, evidence)


def argument_of(value: Value) -> Argument:
    """Return an argument of an action as one of a fact: numbers and atoms stay, anything else is written out."""
    return value if isinstance(value, (str, int, float)) else format_value(_in_decimals(value))


def _in_decimals(value: Value) -> Value:
    match value:
        case int() | float():
            return decimal_of(value)
        case tuple():
            return tuple(map(_in_decimals, value))
        case Term(functor=name, args=args):
            return Term(name, tuple(map(_in_decimals, args)))
        case _:
            return value
