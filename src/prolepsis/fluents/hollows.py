"""The hollows of rigid shapes over a log: in which directions they stood, and what they kept in each of them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

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
    whole: Space
    """The same with the holes stopped that are drilled through it."""
    plug: float
    """Gaps that leave no more than this on either side count as holes, too [m]; none if the outline is exact."""
    up: FloatArray
    """Directions up that are told apart, in that frame, shape (K, 3)."""
    which: IntArray
    """The direction at each tick, shape (T,)."""
    _pools: dict[tuple[int, float], FloatArray] = field(default_factory=dict[tuple[int, float], FloatArray])
    _stopped: dict[tuple[int, float], FloatArray] = field(default_factory=dict[tuple[int, float], FloatArray])

    @property
    def has_holes(self) -> bool:
        """Whether there may be more in it with its holes stopped."""
        return self.whole is not self.space or self.plug > 0.0

    def pools(self, direction: int, clearance: float) -> FloatArray:
        """Return the spill levels along a direction for a body that needs a clearance [m], kept for the next time."""
        if (direction, clearance) not in self._pools:
            self._pools[direction, clearance] = self.space.pools(self.up[direction], clearance)
        return self._pools[direction, clearance]

    def stopped(self, direction: int, plug: float) -> FloatArray:
        """Return the spill levels along a direction with the holes stopped, kept for the next time."""
        if (direction, plug) not in self._stopped:
            self._stopped[direction, plug] = stopped_levels(self, self.up[direction], plug)
        return self._stopped[direction, plug]


def stopped_levels(hollows: Hollows, up: FloatArray, plug: float) -> FloatArray:
    """Return the spill level of each node with the holes stopped [m], those within drilled holes included.

    Args:
        hollows: The hollows of a shape.
        up: Unit vector against gravity, shape (3,).
        plug: Gaps that leave no more than this on either side are stopped, too [m].
    """
    levels = covered(hollows.whole, up, hollows.whole.stopped(up, plug))
    highest = float(levels.max())
    drilled = (hollows.whole.distance < 0.0) & (hollows.space.distance >= 0.0)
    return np.where(drilled & (hollows.space.heights(up) <= highest), highest, levels)


def covered(space: Space, up: FloatArray, levels: FloatArray) -> FloatArray:
    """Return spill levels with those of closed hollows, which are infinite, at their highest place [m]."""
    closed = np.isposinf(levels)
    return np.where(closed, space.heights(up)[closed].max(), levels) if closed.any() else levels


def hollows_of(observation: Observation, shape: RigidShape) -> Hollows:
    """Return the hollows of a shape, found when it is first asked for them."""
    known = observation.of(_known)
    if id(shape) not in known:
        up, which = alike(rotate_back(observation.log.poses[:, shape.body, 3:], observation.up))
        particles = observation.log.particles
        reach = max(NEAR * particles.spacing, PLUG) if len(particles.stuff) else 0.0
        space = space_of(assembled(shape.parts), *shape.bounds(), reach)
        drilled = any(part.shape.holes for part in shape.parts)
        whole = space.on_same_grid(assembled(shape.parts, plugged=True)) if drilled else space
        plug = 0.0 if all(part.shape.profile for part in shape.parts) else PLUG
        known[id(shape)] = Hollows(space=space, whole=whole, plug=plug, up=up, which=which)
    return known[id(shape)]


def _known(observation: Observation) -> dict[int, Hollows]:
    """Return the hollows of shapes, by identity, filled when first needed."""
    return {}
