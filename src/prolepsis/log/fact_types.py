"""What may be on a timeline: every fluent and event by name, declared by those who find it or do it.

``fluents/`` declares what is found in a log, ``programs/`` what actions are as events; each is here once its room has
been imported.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from prolepsis.log.timeline import Argument, Fact, Kind


@dataclass(frozen=True, kw_only=True, slots=True)
class FactType:
    """One kind of fact."""

    name: str
    """Lower camel case, ``closingGripper``."""
    kind: Kind
    """``fluent`` for a condition, ``event`` for what happens."""
    arguments: tuple[str, ...]
    """Names of the arguments; of an action's event, the last ones may be left out."""
    doc: str
    """One line that says when it holds."""
    action: str | None = None
    """Name of the action whose event it is, if it is one."""
    optional: int = 0
    """How many of the last arguments may be left out."""

    @property
    def arities(self) -> range:
        """How many arguments a fact of this type may have."""
        return range(len(self.arguments) - self.optional, len(self.arguments) + 1)


SYMMETRIC = frozenset({"contacts", "colliding"})
"""Types of which both things are alike: a goal finds them with the two in either order."""
_FLUID = ("Liquid", "Stuff")
ONLY_OF: Mapping[str, tuple[tuple[str, ...], ...]] = {
    **dict.fromkeys(("breaking", "broken"), (("Breakable", "Membraned"),)),
    **dict.fromkeys(("cracked", "open", "crushed"), (("Breakable",),)),
    "dented": (("DentingBowl",),),
    "buckled": (("BucklingBowl",),),
    **dict.fromkeys(("absorbing", "absorbs", "dripping"), (("Absorbent",), _FLUID)),
    **dict.fromkeys(("spilled", "spilling", "inFlight"), (_FLUID,)),
    **dict.fromkeys(("flowingOut", "overflowing", "leaking"), ((), _FLUID)),
    "flowingOnto": (_FLUID, ()),
    "pouringTo": ((), _FLUID, ()),
    **dict.fromkeys(("floats", "immersed"), ((), _FLUID)),
    **dict.fromkeys(("closingGripper", "openingGripper"), (("Gripper",),)),
}
"""Types that are found of nothing but what is of one of some classes, argument by argument; none are any. Everything
else is rigid and dry: a "no" says so."""
BY_ITSELF = frozenset({"Stuff", "Membraned"})
"""What breaks of these is told by itself, also where it is a part: recognition takes a stuff for a whole of its own."""
NEEDS: Mapping[str, tuple[str, ...]] = dict.fromkeys(("wet", "dirty"), _FLUID)
"""Types that come about only where something is of one of some classes, be it of what it may."""
TOLD_INSTEAD: Mapping[str, str] = {"Breakable": "overloading"}
"""What is found of a thing that is of no such class, where one of the class would come to what is found of it only."""
FLUENTS: dict[str, FactType] = {}
"""Conditions that are found in a log, by name."""
EVENTS: dict[str, FactType] = {}
"""What happens and is found in a log, by name."""
ACTION_EVENTS: dict[str, FactType] = {}
"""Events that actions are, by name."""


def fact_types() -> Mapping[str, FactType]:
    """Return all by name. An event of an action that is found in a log (``wiping``) is as it is found."""
    return dict(sorted({**ACTION_EVENTS, **FLUENTS, **EVENTS}.items()))


def declare_action(name: str, arguments: tuple[str, ...], *, optional: int = 0) -> None:
    """Declare the event that an action is, of which the last arguments may be left out."""
    doc = f"The control program runs the action {name}; the arguments are the action's."
    event = event_of(name)
    ACTION_EVENTS[event] = FactType(
        name=event, kind="event", arguments=arguments, doc=doc, action=name, optional=optional
    )


def arguments_of(fact: Fact) -> dict[str, Argument]:
    """Return the arguments of a fact by name; none of a type that nobody has declared."""
    known = fact_types().get(fact.type)
    return {} if known is None else dict(zip(known.arguments, fact.args, strict=False))


_VOWELS = "aeiou"


def event_of(action: str) -> str:
    """Return the type of an action's event: ``grasping``, ``releasing``, ``hitting``, ``pouringTo``."""
    word, rest = re.fullmatch(r"([a-z]*)(.*)", action, re.DOTALL).groups()  # type: ignore[union-attr]
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
