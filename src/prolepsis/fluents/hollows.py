"""The hollows of rigid shapes over a log: in which directions they stood, and what they kept in each of them."""

from __future__ import annotations

from dataclasses import dataclass, field

from prolepsis.fluents.kernels.matter import assembled
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.shapes_in_time import RigidShape
from prolepsis.geometry.hollows import Space, alike, space_of
from prolepsis.geometry.rotations import rotate_back
from prolepsis.geometry.shape import FloatArray, IntArray

NEAR = 1.5
"""A particle within this many spacings of a hollow, round the rim, has not left it yet [1]."""
PLUG = 0.008
"""Holes of a mesh are not known as such: gaps narrower than twice this [m] count as holes."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Hollows:
    """The free space in and round one rigid shape, and how it was turned."""

    space: Space
    """In the frame of its body."""
    up: FloatArray
    """Directions up that are told apart, in that frame, shape (K, 3)."""
    which: IntArray
    """The direction at each tick, shape (T,)."""
    _pools: dict[tuple[int, float], FloatArray] = field(default_factory=dict[tuple[int, float], FloatArray])

    def pools(self, direction: int, clearance: float) -> FloatArray:
        """Return the spill levels along a direction for a body that needs a clearance [m], kept for the next time."""
        if (direction, clearance) not in self._pools:
            self._pools[direction, clearance] = self.space.pools(self.up[direction], clearance)
        return self._pools[direction, clearance]


def hollows_of(observation: Observation, shape: RigidShape) -> Hollows:
    """Return the hollows of a shape, found when it is first asked for them."""
    known = observation.of(_known)
    if id(shape) not in known:
        up, which = alike(rotate_back(observation.log.poses[:, shape.body, 3:], observation.up))
        particles = observation.log.particles
        reach = max(NEAR * particles.spacing, PLUG) if len(particles.stuff) else 0.0
        space = space_of(assembled(shape.parts), *shape.bounds(), reach)
        known[id(shape)] = Hollows(space=space, up=up, which=which)
    return known[id(shape)]


def _known(observation: Observation) -> dict[int, Hollows]:
    """Return the hollows of shapes, by identity, filled when first needed."""
    return {}
