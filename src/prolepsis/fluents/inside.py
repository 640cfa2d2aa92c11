"""When one rigid shape lies in a depression of another: seen every few ticks, and sharpened at the ends."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from prolepsis.fluents.hollows import hollows_of
from prolepsis.fluents.intervals import mask_of, runs, ticks_of
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.shapes_in_time import RigidShape
from prolepsis.geometry.rotations import rotate, rotate_back
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.geometry.solids import samples

INSIDE_SHARE = 0.5
"""Share of x's volume [1] below the spill level from which x is inside: an apple on a plate is not, a ball that
just looks out of a cup is."""
CLEARANCE = 0.7
"""Share of its least half-width [1] that a body needs around its inner points to pass a gap: it does not slip
through a grate. Its samples lie within a quarter of its half-width, so it may touch a wall."""
LOOK_STEP = 0.02
"""Time between two looks [s]; what goes in or out is followed tick by tick."""
REST_SPEED = 0.01
"""Speed relative to the container below which x rests in it [m/s]."""
REST_WINDOW = 0.2
"""Time over which it must do so [s], longer than a hand that passes through would pause."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Depths:
    """How deep one body lay in the depressions of another."""

    tick: IntArray
    """Ticks that were looked at, ascending, shape (K,)."""
    share: FloatArray
    """Share of the body's volume below the spill level [1], shape (K,)."""
    depth: FloatArray
    """How far its middle is below the spill level [m], shape (K,)."""
    stretches: IntArray
    """When it was inside, be it that only the holes, stopped, would keep it there."""
    surely: IntArray
    """When it was so, holes or not."""
    at_rest: IntArray
    """When it was at rest relative to the container."""

    def at(self, start: int, end: int) -> tuple[float, float] | None:
        """Return the greatest share and depth seen over ticks ``start`` to ``end``, if any was."""
        seen = (self.tick >= start) & (self.tick < end)
        return (float(self.share[seen].max()), float(self.depth[seen].max())) if seen.any() else None


def depths_within(observation: Observation, hollow: RigidShape, shape: RigidShape, borne: BoolArray) -> Depths | None:
    """Return how deep ``shape`` lay in ``hollow``, or None if it never was inside while it may count as contained.

    Args:
        observation: The log.
        hollow: The shape that may have depressions.
        shape: The shape that may be in one.
        borne: When something that may be the container or in it bears the body, shape (T,). Before it is
            borne or at rest in the hollow, nothing is looked at; before it is both, no hole is stopped.
    """
    both = hollow.during & shape.during
    step = ticks_of(LOOK_STEP, observation.dt)
    looked = np.arange(0, observation.tick_count, step)
    looked = looked[both[looked]]
    if not len(looked):
        return None
    known = observation.of(sampled)
    if id(shape) not in known:
        known[id(shape)] = samples(shape.solids)
    points, weights = known[id(shape)]
    middle = weights @ points
    near = _between_bounds(observation, hollow, shape, middle, looked)
    at_rest = _at_rest(observation, hollow.body, shape, middle, both) if near.any() else runs(near)
    rests = mask_of(at_rest, observation.tick_count)
    near = _since_anchored(near, looked, rests | borne)
    if not near.any():
        return None
    viewer = _Viewer(observation=observation, hollow=hollow, shape=shape, points=points, weights=weights)
    share, depth = np.zeros(len(looked)), np.zeros(len(looked))
    share[near], depth[near] = viewer.look(looked[near])
    surely = viewer.stretches(looked, near, share >= INSIDE_SHARE)
    seen = surely
    stays = near & (share < INSIDE_SHARE) & (rests & borne)[looked]
    if stays.any() and viewer.has_holes:
        viewer = replace(viewer, stopped=True)
        share[near], depth[near] = viewer.look(looked[near])
        seen = surely | viewer.stretches(looked, near, share >= INSIDE_SHARE)
    if not seen.any():
        return None
    return Depths(
        tick=looked[near],
        share=share[near],
        depth=depth[near],
        stretches=runs(seen & both),
        surely=runs(surely & both),
        at_rest=at_rest,
    )


def sampled(observation: Observation) -> dict[int, tuple[FloatArray, FloatArray]]:
    """Return points well inside shapes and their weights, by identity, filled when first needed."""
    return {}


def extents(observation: Observation) -> dict[int, tuple[FloatArray, FloatArray]]:
    """Return the bounds of shapes, by identity, filled when first needed."""
    return {}


@dataclass(frozen=True, kw_only=True, slots=True)
class _Viewer:
    observation: Observation
    hollow: RigidShape
    shape: RigidShape
    points: FloatArray
    weights: FloatArray
    stopped: bool = False
    """Whether the holes of the hollow are stopped."""

    @property
    def has_holes(self) -> bool:
        """Whether there may be more in the hollow with its holes stopped; the cracks of a fragment are none."""
        observation = self.observation
        return hollows_of(observation, self.hollow).has_holes and not observation.has_role(self.hollow.body, "Piece")

    def stretches(self, looked: IntArray, near: BoolArray, inside: BoolArray) -> BoolArray:
        """Return when it was inside, shape (T,), given whether it was at the ticks that were looked at."""
        count = self.observation.tick_count
        seen = np.zeros(count, dtype=np.bool_)
        for first, last in runs(inside):
            before = int(looked[first - 1]) + 1 if first and near[first - 1] else int(looked[first])
            begin = self.first_inside(before, int(looked[first]))
            limit = int(looked[last]) if last < len(looked) else count
            seen[begin : self.first_outside(int(looked[last - 1]) + 1, limit)] = True
        return seen

    def look(self, ticks: IntArray) -> tuple[FloatArray, FloatArray]:
        """Return the share inside [1] and the depth of the middle [m] at ticks, each of their shape."""
        observation = self.observation
        hollows = hollows_of(observation, self.hollow)
        pose, host = observation.log.poses[ticks, self.shape.body], observation.log.poses[ticks, self.hollow.body]
        up = rotate_back(host[:, 3:], observation.up)
        position = rotate(pose[:, None, 3:], self.points) + (pose[:, :3] - host[:, :3])[:, None]
        local = rotate_back(host[:, None, 3:], position)
        step = hollows.space.step
        # Whole steps, so that bodies that are alike share what is found.
        half_width = min(solid.half_width for solid in self.shape.solids)
        clearance = step * int(CLEARANCE * half_width / step)
        plug = max(hollows.plug, step * math.ceil(half_width / step)) if hollows.plug else 0.0
        share, depth = np.zeros(len(ticks)), np.zeros(len(ticks))
        for direction, first, which, here in _distinct(hollows.which[ticks], local, step):
            pools = hollows.pools(direction, clearance)
            where, upward = local[first].reshape(-1, 3), np.repeat(up[first], len(self.points), axis=0)
            deep = hollows.space.depth(where, upward, pools, clearance)
            if self.stopped:
                stopped = hollows.stopped(direction, plug)
                deep = np.maximum(deep, hollows.space.depth(where, upward, stopped, 0.0))
            deep = deep.reshape(len(first), -1)
            share[here] = ((deep > 0) @ self.weights)[which]
            depth[here] = (deep @ self.weights)[which]
        return share, depth

    def first_inside(self, first: int, last: int) -> int:
        """Return the first tick from ``first`` on at which it is inside, knowing that it is at ``last``."""
        ticks = np.arange(first, last + 1)
        return int(ticks[np.argmax(self.look(ticks)[0] >= INSIDE_SHARE)])

    def first_outside(self, first: int, last: int) -> int:
        """Return the first tick from ``first`` on at which it is not inside, at most ``last``."""
        ticks = np.arange(first, last)
        outside = self.look(ticks)[0] < INSIDE_SHARE if len(ticks) else np.zeros(0, dtype=np.bool_)
        return int(ticks[np.argmax(outside)]) if outside.any() else last


def _distinct(
    directions: IntArray, local: FloatArray, step: float
) -> Iterator[tuple[int, IntArray, IntArray, IntArray]]:
    """Yield, for each direction of up in the container, the ticks at which the body lies there in distinct ways.

    A twentieth of a grid step makes no difference, and what rests, rests for thousands of ticks.

    Yields:
        The direction; one tick for each way of lying; for each tick of the direction, which of them it is; its ticks.
    """
    key = np.rint(local[:, [0, -1]].reshape(len(local), -1) / (0.05 * step)).astype(np.int64)
    for direction in np.unique(directions).tolist():
        ticks = np.flatnonzero(directions == direction)
        _, first, which = np.unique(key[ticks], axis=0, return_index=True, return_inverse=True)
        yield direction, ticks[first], which.ravel(), ticks


def _between_bounds(
    observation: Observation, hollow: RigidShape, shape: RigidShape, middle: FloatArray, ticks: IntArray
) -> BoolArray:
    """Return whether the body's middle is within the box around the container, at each of some ticks."""
    known = observation.of(extents)
    if id(hollow) not in known:
        known[id(hollow)] = hollow.bounds()
    low, high = known[id(hollow)]
    position = _relative(observation, hollow.body, shape, middle, ticks)
    inside: BoolArray = np.all((position > low) & (position < high), axis=1, keepdims=False)
    return inside


def _relative(
    observation: Observation, host: int, shape: RigidShape, middle: FloatArray, ticks: IntArray
) -> FloatArray:
    pose, frame = observation.log.poses[ticks, shape.body], observation.log.poses[ticks, host]
    return rotate_back(frame[:, 3:], rotate(pose[:, 3:], middle) + pose[:, :3] - frame[:, :3])


def _since_anchored(near: BoolArray, looked: IntArray, anchored: BoolArray) -> BoolArray:
    """Return ``near`` without what comes before the first anchored tick of each of its runs."""
    count = np.concatenate(([0], np.cumsum(anchored)))
    ends = np.append(looked[1:], len(anchored))
    here = count[ends] > count[looked]
    found = np.zeros_like(near)
    for first, last in runs(near).tolist():
        if here[first:last].any():
            found[first + int(np.argmax(here[first:last])) : last] = True
    return found


def _at_rest(observation: Observation, host: int, shape: RigidShape, middle: FloatArray, both: BoolArray) -> IntArray:
    step = ticks_of(LOOK_STEP, observation.dt)
    ticks = np.arange(0, observation.tick_count, step)
    position = _relative(observation, host, shape, middle, ticks)
    speed = np.linalg.norm(np.diff(position, axis=0), axis=1) / (step * observation.dt)
    still = runs(np.append(speed < REST_SPEED, False))
    still = still[(still[:, 1] - still[:, 0]) * step * observation.dt >= REST_WINDOW]
    return runs(mask_of(still * step, observation.tick_count) & both)
