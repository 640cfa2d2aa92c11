"""What the control program did, as events: ``grasp(hand1, egg1, force7)`` becomes ``grasping`` with its arguments."""

from __future__ import annotations

import re
from collections.abc import Iterator

from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import Grounding, event
from prolepsis.log.timeline import Argument, Fact
from prolepsis.terms.terms import Value, format_value

_VOWELS = "aeiou"
ACTIONS = (
    "bring",
    "carry",
    "close",
    "drive",
    "grasp",
    "hit",
    "hold",
    "lift",
    "look_at",
    "pour",
    "press",
    "raise_torso",
    "reach",
    "release",
    "replay",
    "squeeze",
    "tilt",
    "wait",
)
"""Actions that are listed with their events; any other action in a log becomes an event in the same way."""
ELSEWHERE = frozenset({"wipe"})
"""Actions whose events have other arguments and a grounding of their own: ``wiping(sponge1, table1)``."""


def _listed(action: str) -> Grounding:
    def grounding(observation: Observation) -> Iterator[Fact]:
        return action_facts(observation, action)

    grounding.__qualname__ = f"{action}_facts"
    grounding.__doc__ = f"The control program runs the action {action}; the arguments are the action's."
    return grounding


def ing(verb: str) -> str:
    """Return the event type of an action: ``grasping``, ``releasing``, ``hitting``, ``pouringTo``."""
    word, rest = re.fullmatch(r"([a-z]*)(.*)", verb, re.DOTALL).groups()  # type: ignore[union-attr]
    if word.endswith("ie"):
        word = word[:-2] + "y"
    elif word.endswith("e") and not word.endswith(("ee", "oe", "ye")):
        word = word[:-1]
    elif _doubles(word):
        word += word[-1]
    # Types are lower camel case: looking_at becomes lookingAt.
    return f"{word}ing{re.sub('_([a-z])', lambda found: found[1].upper(), rest)}"


def _doubles(word: str) -> bool:
    """Return whether the last letter doubles: one syllable that ends in a single vowel and a single consonant."""
    return (
        len(word) >= 3
        and word[-1] not in _VOWELS + "wxy"
        and word[-2] in _VOWELS
        and sum(1 for k, c in enumerate(word) if c in _VOWELS and (k == 0 or word[k - 1] not in _VOWELS)) == 1
        and word[-3] not in _VOWELS
    )


for _action in ACTIONS:
    event(ing(_action), "hand", "...")(_listed(_action))


def action_facts(observation: Observation, action: str | None = None) -> Iterator[Fact]:
    """Yield the events of the log's actions called ``action``, or of those that are not listed."""
    for done in observation.log.actions:
        if done.term.functor != action and (action is not None or done.term.functor in ELSEWHERE.union(ACTIONS)):
            continue
        args = tuple(argument_of(value) for value in done.term.args)
        stretch = done.start, max(done.end, done.start + 1)
        evidence: dict[str, float | str] = {"outcome": done.outcome, **done.evidence}
        yield observation.fact("event", ing(done.term.functor), args, stretch, evidence)


def argument_of(value: Value) -> Argument:
    """Return an argument of an action as one of a fact: numbers and atoms stay, anything else is written out."""
    return value if isinstance(value, (str, int, float)) else format_value(value)
