"""One record for each thing: its name, class, shape and quantities, from the scene to the query.

A ``Thing`` is made when the scene is composed and travels inside the log, so that recognition,
containment, rendering and logs of other origin share it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

from prolepsis.geometry.shape import IDENTITY, Geom, Quaternion, Shape, Triple

DEFAULT_FRICTION = 0.5
"""Sliding friction of a thing of which nothing is known [1]."""


@dataclass(frozen=True, slots=True)
class Mount:
    """How a thing is held in the world at the start."""

    by: Literal["nothing", "world", "joints", "whole"]
    """``nothing``: it moves freely; ``world``: it never moves; ``joints``: it hangs on another body; ``whole``: it
    is no body of its own, but moves with what it is a part of, until that falls apart."""
    to: str | None = None
    """What it hangs on by joints; None for the world."""


FREE, FIXED, WITHIN = Mount("nothing"), Mount("world"), Mount("whole")


def jointed(to: str | None = None) -> Mount:
    """Return the mount of what hangs by joints on the thing called ``to``, or on the world."""
    return Mount("joints", to)


@dataclass(frozen=True, kw_only=True, slots=True)
class Thing:
    """What is known of one thing when the run starts."""

    name: str
    """``egg1``, ``hand1/left_finger``, ``eggshell1/piece3``."""
    kind: str
    """Most specific class, ``Egg``."""
    shape: Shape = Shape()
    """Geometry in the thing's own frame."""
    position: Triple = (0.0, 0.0, 0.0)
    """Initial origin of the thing's frame in the world [m]."""
    orientation: Quaternion = IDENTITY
    """Initial unit quaternion (w, x, y, z) in the world."""
    mass: float = 0.0
    """Mass with all parts [kg]; of a fixed thing it has no effect and may be 0."""
    centre: Triple | None = None
    """Centre of mass of the rigid body that it is, in the thing's frame [m], where that is told; of what is of one
    material its shape tells it."""
    whole: str | None = None
    """The thing this is a part of, if any."""
    roles: frozenset[str] = frozenset()
    """Classes that recognition and kinds of matter go by: ``Gripper``, ``Container``, ``Breakable``, ``Stuff``,
    ``Piece`` (appears when its whole breaks), ``Floor`` ..."""
    mount: Mount = FREE
    """How it is held: a floor, a table or a wall is ``FIXED``."""
    quantities: Mapping[str, float] = field(default_factory=dict[str, float])
    """Named quantities in SI units: friction, breakingForce, ..."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Thing({self.name}, {self.kind})"

    @property
    def fixed(self) -> bool:
        """Whether it never moves."""
        return self.mount.by == "world"

    @property
    def is_body(self) -> bool:
        """Whether it is a rigid body of its own at the start."""
        return self.mount.by == "joints" or (self.mount.by != "whole" and bool(self.shape.geoms))

    @property
    def emerges(self) -> bool:
        """Whether it becomes a body when its whole falls apart: a shard, a kernel."""
        return self.mount.by == "whole" and bool(self.shape.geoms)


def own_solids(things: Sequence[Thing]) -> dict[str, tuple[int, ...]]:
    """Return which solids of each thing are its own: others stand again in a part on joints, which moves for itself."""
    wholes = {thing.name: thing for thing in things}
    moved: dict[str, list[Geom]] = {}
    for part in things:
        whole = wholes.get(part.whole or "")
        if whole is not None and part.mount.by == "joints" and _frame(part) == _frame(whole):
            moved.setdefault(whole.name, []).extend(part.shape.geoms)
    return {
        thing.name: tuple(k for k, geom in enumerate(thing.shape.geoms) if geom not in moved.get(thing.name, ()))
        for thing in things
    }


def falling_apart(things: Sequence[Thing]) -> frozenset[str]:
    """Return the names of what may fall apart: the wholes of what emerges."""
    wholes = {thing.name: thing.whole for thing in things}
    found: set[str] = set()
    for part in things:
        above = part.whole if part.emerges else None
        while above is not None and above not in found:
            found.add(above)
            above = wholes.get(above)
    return frozenset(found)


def pressed_in(things: Sequence[Thing]) -> frozenset[frozenset[int]]:
    """Return which pairs of things, by number, may go into each other: something soft, and what falls apart or has."""
    brittle = falling_apart(things)
    soft = [i for i, thing in enumerate(things) if "densificationStrain" in thing.quantities]
    hard = [i for i, thing in enumerate(things) if thing.emerges or thing.name in brittle]
    return frozenset(frozenset({i, j}) for i in soft for j in hard if i != j)


def _frame(thing: Thing) -> tuple[Triple, Quaternion]:
    return thing.position, thing.orientation


def friction_of(thing: Thing) -> float:
    """Return the sliding friction of a thing's surface [1]."""
    return float(thing.quantities.get("friction", DEFAULT_FRICTION))
