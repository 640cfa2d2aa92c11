"""How actions end: every outcome by name, with what it says; one is evidence of each action's event."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

Outcome = Literal[
    "done",
    "dropped",
    "crushed",
    "missed",
    "not_held",
    "not_reached",
    "not_graspable",
    "in_collision",
    "unreachable",
    "timed_out",
    "unfinished",
]
"""How an action ended."""

OUTCOMES: Mapping[Outcome, str] = {
    "done": "what the action aims at was reached, within the tolerance that docs/actions.md states beside it",
    "dropped": "the hand no longer holds what it held when the action began",
    "crushed": "the force of the hand, or the one with which it pressed, broke what it held",
    "missed": "the pads closed on something else than they should, or on nothing; or a blow met nothing",
    "not_held": "the hand does not hold what the action is done with",
    "not_reached": "the action went on to its end, but fell short of its force, place, angle or speed",
    "not_graspable": "the object is too wide or too thin for the hand as it lies",
    "in_collision": "something is in the way, or the hand or its arm is pressed against it",
    "unreachable": "the arm or the joint cannot get there",
    "timed_out": "what the action waits for has not come in the time that it has",
    "unfinished": "the run ended before the action did",
}
"""All outcomes."""

GOES_ON = frozenset[Outcome]({"done", "dropped", "crushed", "not_reached"})
"""After these, what follows in a sequence is done: the action has gone its way to the end. The others end it."""
CARRYING = frozenset({"lift", "carry", "tilt", "bring", "hold"})
"""These move whatever the hand holds: by one that grips nothing they are ``not_held``, but go their way to the end."""
CLOSING = frozenset({"close"})
"""These close on whatever is there: on nothing they have ``missed``, but what follows is done."""
