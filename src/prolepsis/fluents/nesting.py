"""Which vessel dips into which, by shape, and whether what it holds is in the other, too."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from prolepsis.fluents.hollows import hollows_of
from prolepsis.fluents.inside import INSIDE_SHARE, LOOK_STEP
from prolepsis.fluents.intervals import ticks_of
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.shapes_in_time import RigidShape, rigid_shapes
from prolepsis.geometry.hollows import BLOCKED
from prolepsis.geometry.rotations import rotate, rotate_back
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray

POINTS = 400
"""In so many points of a vessel's matter, evenly chosen, it is looked how much of it is in another."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Nesting:
    """How one vessel is in another."""

    dips: BoolArray
    """When some of it is below the rim of the other, and more than of the other below its own, shape (T,)."""
    within: BoolArray
    """When that is half of it, or its own rim is below that of the other: what it holds is in both then, shape (T,)."""

    @property
    def keeps(self) -> BoolArray:
        """When what it holds is in it alone: what goes over its rim is not kept by the other, shape (T,)."""
        return self.dips & ~self.within


def nesting(observation: Observation, inner: int, outer: int) -> Nesting:
    """Return how one unit is in another, kept for the next time."""
    known = observation.of(_known)
    if (inner, outer) not in known:
        known[inner, outer] = _nesting(observation, inner, outer)
    return known[inner, outer]


def _known(observation: Observation) -> dict[tuple[int, int], Nesting]:
    """Return how units are in one another, filled when first needed."""
    return {}


def _nesting(observation: Observation, inner: int, outer: int) -> Nesting:
    dips, within = np.zeros((2, observation.tick_count), dtype=np.bool_)
    for shape in _hollow_shapes(observation, inner):
        for other in _hollow_shapes(observation, outer):
            both = shape.during & other.during
            ticks = np.flatnonzero(both)[:: ticks_of(LOOK_STEP, observation.dt)]
            if not len(ticks):
                continue
            share = _share(observation, shape, other, ticks)
            deep = share > 0
            below = np.zeros(len(ticks), dtype=np.bool_)
            if deep.any():
                deep[deep] = share[deep] > _share(observation, other, shape, ticks[deep])
                below = _brim(observation, shape, ticks) <= _brim(observation, other, ticks)
            at = np.maximum(np.searchsorted(ticks, np.arange(observation.tick_count), side="right") - 1, 0)
            dips |= both & deep[at]
            within |= both & ((share >= INSIDE_SHARE) | below)[at]
    return Nesting(dips=dips, within=within)


def _hollow_shapes(observation: Observation, unit: int) -> list[RigidShape]:
    shapes = observation.of(rigid_shapes)
    return [shape for shape in shapes if shape.is_hollow and observation.unit[shape.body] == unit]


def _share(observation: Observation, shape: RigidShape, other: RigidShape, ticks: IntArray) -> FloatArray:
    """Return the share of one shape's matter below where the other would spill, its holes stopped [1], shape (K,)."""
    points, hollows = _matter(observation, shape), hollows_of(observation, other)
    pose, host = observation.log.poses[ticks, shape.body], observation.log.poses[ticks, other.body]
    position = rotate(pose[:, None, 3:], points) + (pose[:, :3] - host[:, :3])[:, None]
    local, which = rotate_back(host[:, None, 3:], position), hollows.which[ticks]
    share = np.zeros(len(ticks))
    for direction in np.unique(which).tolist():
        here = which == direction
        where = local[here].reshape(-1, 3)
        up = np.repeat(hollows.up[direction][None], len(where), axis=0)
        levels = hollows.stopped(direction, hollows.plug) if hollows.has_holes else hollows.pools(direction, 0.0)
        deep = hollows.space.depth(where, up, levels, 0.0) > 0
        share[here] = deep.reshape(-1, len(points)).mean(axis=1)
    return share


def _matter(observation: Observation, shape: RigidShape) -> FloatArray:
    """Return points spread through the matter of a shape, in its frame, shape (n, 3)."""
    space = hollows_of(observation, shape).space
    nodes = np.argwhere(space.distance < BLOCKED * space.step)
    return space.origin + space.step * nodes[:: -(-len(nodes) // POINTS)]


def _brim(observation: Observation, shape: RigidShape, ticks: IntArray) -> FloatArray:
    """Return the height up to which a shape would keep a liquid, its holes stopped [m], world frame, shape (K,)."""
    hollows = hollows_of(observation, shape)
    which = hollows.which[ticks]
    levels = {k: float(hollows.whole.pools(hollows.up[k], hollows.plug).max()) for k in np.unique(which).tolist()}
    base: FloatArray = observation.log.poses[ticks, shape.body, :3] @ observation.up
    return base + np.array([levels[k] for k in which.tolist()])
