"""Whether an action has crushed what it holds: the force of the hand, or with which it presses, was what broke it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from prolepsis.log.things import Thing
from prolepsis.robots.commands import Sense

MOST = 0.5
"""What makes at least this part of all that presses on a thing has broken it [1]: a blow on what is only held makes the
rest."""


class Crushing:
    """What becomes of the whole things that an action holds or presses."""

    def __init__(self, arguments: Mapping[str, Any], hands: Iterable[str], held: Iterable[str], sense: Sense) -> None:
        """Look after what is held or named as an action with such arguments begins."""
        named = [value for value in arguments.values() if isinstance(value, Thing) and value.name not in sense.hands]
        self._hands = tuple(hands)
        self._whole = {
            name for name in (*(thing.name for thing in named), *held) if not sense.attribute(name, "broken")
        }
        self._push = arguments.get("force", 0.0)
        """Force that the action commands, if it does [N]."""
        pushes = self._push and len(named) > 1
        self._pressed = [thing.name for thing in named if pushes and "Breakable" in thing.roles]
        self._against = [thing.name for thing in named]
        self._felt: dict[str, tuple[float, float]] = {}
        """Force in each hand, and the one that it should have [N], the tick before."""
        self._between: dict[str, set[str]] = {}
        """What was between the pads of each hand then."""
        self._bore: dict[str, float] = {}
        """What pressed on each thing in all then [N]."""
        self._borne: dict[str, float] = {}
        """Force with which each of what is pressed is pressed on something named, the tick before [N]."""

    def look(self, sense: Sense) -> dict[str, float | str]:
        """Return the force at which something broke under it, and the reason; nothing if nothing has."""
        found: dict[str, float | str] = {}
        for name in [each for each in self._whole if sense.attribute(each, "broken")]:
            self._whole.remove(name)
            grips = [self._felt[each] for each in self._felt if name in self._between.get(each, ())]
            gripped, borne = 2 * sum(felt for felt, _ in grips), self._borne.get(name, 0.0)
            force, wanted = max(grips) if gripped > borne else (borne, self._push)
            pressed = max(sense.attribute(name, "force"), self._bore.get(name, 0.0))
            if gripped + borne > MOST * pressed:
                found = {"force": force, "reason": f"{name} broke at {force:.3g} of {wanted:.4g} N"}
        if self._whole:
            self._felt = {each: (sense.hands[each].pad_force, sense.hands[each].grip) for each in self._hands}
            felt = {each: sense.hands[each] for each in self._hands if sense.hands[each].pad_force > 0}
            self._between = {each: {*hand.between(), *hand.held()} for each, hand in felt.items()}
            self._bore = {each: sense.attribute(each, "force") for each in self._whole}
            for name in self._pressed:
                self._borne[name] = sum(sense.pressing(name, other) for other in self._against if other != name)
        return found
