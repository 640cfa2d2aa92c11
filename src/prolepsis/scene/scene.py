"""A scene: the things of one situation as frozen values, before any physics."""

from __future__ import annotations

from dataclasses import dataclass

from prolepsis.domain import Domain
from prolepsis.errors import UnknownNameError
from prolepsis.things import Thing, Triple


@dataclass(frozen=True, kw_only=True, slots=True)
class Scene:
    """What there is at the start."""

    things: tuple[Thing, ...]
    """Wholes, parts, pieces and blobs."""
    domain: Domain = Domain()
    """What is known of the individuals."""
    gravity: Triple = (0.0, 0.0, -9.81)
    """[m/s^2]"""

    def thing(self, name: str) -> Thing:
        """Return the thing called ``name``.

        Raises:
            UnknownNameError: If there is none.
        """
        for thing in self.things:
            if thing.name == name:
                return thing
        raise UnknownNameError.of("object", name, (t.name for t in self.things if t.whole is None))

    def index(self, name: str) -> int:
        """Return the position of the thing called ``name`` among ``things``."""
        return self.things.index(self.thing(name))

    def parts(self, name: str) -> tuple[Thing, ...]:
        """Return the direct parts of a thing."""
        return tuple(thing for thing in self.things if thing.whole == name)

    def number(self, individual: str, prop: str) -> float | None:
        """Return a number that is known of an individual, in SI units, or None."""
        for subject, name, value in self.domain.values:
            if subject == individual and name == prop and not isinstance(value, str):
                return float(value)
        return None
