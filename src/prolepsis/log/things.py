"""One record for each thing: its name, class, shape and quantities, from the scene to the query.

A ``Thing`` is made when the scene is composed and travels inside the log, so that recognition,
containment, rendering and logs of other origin share it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from prolepsis.geometry.shape import IDENTITY, Quaternion, Shape, Triple

DEFAULT_FRICTION = 0.5
"""Sliding friction of a thing of which nothing is known [1]."""


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
    whole: str | None = None
    """The thing this is a part of, if any."""
    roles: frozenset[str] = frozenset()
    """Classes that recognition and phenomena go by: ``Gripper``, ``Container``, ``Breakable``, ``Stuff``,
    ``Piece`` (appears when its whole breaks), ``Floor`` ..."""
    fixed: bool = False
    """True for what never moves (floor, table, wall)."""
    quantities: Mapping[str, float] = field(default_factory=dict[str, float])
    """Named quantities in SI units: friction, breakingForce, ..."""


def friction_of(thing: Thing) -> float:
    """Return the sliding friction of a thing's surface [1]."""
    return float(thing.quantities.get("friction", DEFAULT_FRICTION))
