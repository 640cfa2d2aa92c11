"""Cavities by spill height: what could not run out of a shape at rest, whichever way it is turned.

The free space around a shape's matter is a grid. The spill level of a free node is the least height over which
every way to the outside must rise - found for all nodes at once, as water finds it. Below its spill level a
node is in a depression; the free corner of an L, the space under an upturned cup, or a ring without a bottom
has none.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray

NODE_COUNT = 30_000
"""Nodes of a grid: 31 along the edge of a cube, 3 mm for a cup of 10 cm."""
BLOCKED = 0.501
"""A node nearer to matter than this share of a step is blocked. Any step through a wall, however thin, then
has a blocked end, so that walls thinner than a step do not leak."""
LEAST_DEPTH = 1.2
"""Depth of a depression [grid steps] below which it is an artefact of the grid's steps on a slanted surface."""
CLEARANCE = 0.7
"""Share of its least half-width [1] that a body needs around its inner points to pass a gap: it does not slip
through a grate. Its samples lie within a quarter of its half-width, so it may touch a wall."""
CLEARANCE_STEPS = 5
"""Greatest clearance that is told apart [grid steps]."""
LEAST_STEP = 0.002
"""Shortest step [m]: no finer than what is handled in a household asks for."""
ORIENTATIONS = 10
"""Gravity's direction in the shape's frame is rounded to this fraction of one: it is at most 3 degrees off, which
tilts the rim of a cup by less than a step."""
_NEAR = 1.75
"""Distance to matter [grid steps] beyond which the nearest node is surely on the same side of every wall."""


class Matter(Protocol):
    """What takes up space: one of the convex solids of a shape, or the exact field of a whole one."""

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Return the least and greatest coordinates in the shape's frame [m], each of shape (3,)."""
        ...

    def distance(self, points: FloatArray, /) -> FloatArray:
        """Return the signed distance of points in the shape's frame [m], negative inside, (N, 3) to (N,)."""
        ...


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Cavity:
    """The free space around one rigid shape."""

    matter: tuple[Matter, ...]
    """What the space is free of, in the shape's frame."""
    origin: FloatArray
    """Position of the first node [m], shape (3,)."""
    step: float
    """Distance between nodes [m]."""
    distance: FloatArray
    """Distance of each node to the nearest matter [m], cut off at a few steps, shape (nx, ny, nz)."""
    _levels: dict[tuple[int, int, int, int], FloatArray] = field(
        default_factory=dict[tuple[int, int, int, int], FloatArray]
    )

    def depth(self, points: FloatArray, up: FloatArray, half_width: float) -> FloatArray:
        """Return how far below its spill level each point is [m], 0 where it is in no depression, shape (N,).

        Args:
            points: In the shape's frame [m], shape (N, 3).
            up: Unit vector against gravity in the shape's frame, shape (3,), or one for each point, shape (N, 3),
                that agree as far as directions are told apart.
            half_width: Least half-width of the body that the points are well inside of [m].
        """
        width = int(min(CLEARANCE * half_width / self.step, CLEARANCE_STEPS))
        clearance = self.step * max(width, BLOCKED)
        direction = _direction(np.atleast_2d(up)[0])
        levels = self._spill_levels(direction, width)
        places, inside = self._nodes(points)
        doubtful = np.flatnonzero(inside & (self.distance[tuple(places.T)] < max(clearance, _NEAR * self.step)))
        low = np.ones(len(points), dtype=np.bool_)
        if len(doubtful):
            places[doubtful], inside[doubtful] = self._nodes(self._cleared(points[doubtful], clearance + self.step))
            low[doubtful] = self._is_low(places[doubtful], levels, direction)
            # The node is as high as a low rim, or there is no rim at all: look at one that is nearer.
            high = doubtful[~low[doubtful]]
            places[high], low[high] = self._nearer(points[high], places[high], clearance)
            low[high] &= self._is_low(places[high], levels, direction)
        found = levels[tuple(places.T)]
        # The way out passes an edge at the clearance above it.
        rise = found - clearance - (points * up).sum(axis=1)
        # An infinite level is a closed hollow; a blocked node says nothing.
        free = self.distance[tuple(places.T)] >= clearance
        in_depression = inside & free & low & (rise > LEAST_DEPTH * self.step)
        return np.where(in_depression, np.minimum(rise, float(np.max(self.step * np.array(self.distance.shape)))), 0.0)

    def _is_low(self, places: IntArray, levels: FloatArray, direction: IntArray) -> BoolArray:
        """Return whether nodes lie below their spill level: what is moved away from flat ground does not."""
        heights = (self.origin + self.step * places) @ (direction / np.linalg.norm(direction))
        return levels[tuple(places.T)] > heights + 1e-3 * self.step

    def _nearer(self, points: FloatArray, places: IntArray, clearance: float) -> tuple[IntArray, BoolArray]:
        """Return a node nearer to each point than ``places`` that is surely on its side of all matter, and if it is."""
        moved = self._cleared(points, clearance)
        nodes, inside = self._nodes(moved)
        apart = np.linalg.norm(self.origin + self.step * nodes - moved, axis=1)
        # Two balls without matter that meet: nothing is between their middles.
        sure = inside & (apart <= self.distance[tuple(nodes.T)] + clearance)
        return np.where(sure[:, None], nodes, places), sure

    def _nodes(self, points: FloatArray) -> tuple[IntArray, BoolArray]:
        """Return the nearest node of each point, and whether the point is within the grid."""
        place = np.rint((points - self.origin) / self.step).astype(np.int64)
        shape = np.array(self.distance.shape)
        inside: BoolArray = np.all((place >= 0) & (place < shape), axis=1, keepdims=False)
        return np.clip(place, 0, shape - 1), inside

    def _cleared(self, points: FloatArray, clearance: float) -> FloatArray:
        """Return the points moved away from the nearest walls, on their own side, until they are clear."""
        moved, small = points.copy(), 1e-3 * self.step
        for _ in range(3):
            distance = _union_distance(self.matter, moved)
            near = distance < clearance
            if not near.any():
                break
            here = moved[near]
            slope = np.stack(
                [_union_distance(self.matter, here + small * axis) - distance[near] for axis in np.eye(3)], axis=1
            )
            slope /= np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-300)
            moved[near] = here + slope * (clearance - distance[near])[:, None]
        return moved

    def _spill_levels(self, direction: IntArray, width: int) -> FloatArray:
        key = (int(direction[0]), int(direction[1]), int(direction[2]), width)
        if key not in self._levels:
            blocked = self.distance < self.step * max(width, BLOCKED)
            self._levels[key] = spill_levels(self._heights(direction / np.linalg.norm(direction)), blocked)
        return self._levels[key]

    def _heights(self, up: FloatArray) -> FloatArray:
        nodes = np.moveaxis(np.indices(self.distance.shape, dtype=np.float64), 0, -1)
        heights: FloatArray = (self.origin + self.step * nodes) @ up
        return heights


def cavity_of(matter: Sequence[Matter]) -> Cavity:
    """Return the free space around one rigid shape, the union of all ``matter``."""
    bounds = [each.bounds() for each in matter]
    low: FloatArray = np.min([b[0] for b in bounds], axis=0)
    high: FloatArray = np.max([b[1] for b in bounds], axis=0)
    step = max(float(np.prod(np.maximum(high - low, 1e-4)) / NODE_COUNT) ** (1 / 3), LEAST_STEP)
    # Two free nodes on every side: all that is outside is one region.
    margin = 2.0 * step
    origin = low - margin
    shape: IntArray = np.ceil((high + margin - origin) / step).astype(np.int64) + 1
    cut = step * (CLEARANCE_STEPS + 1)
    distance: FloatArray = np.full(tuple(shape.tolist()), cut)
    for each, (least, greatest) in zip(matter, bounds, strict=True):
        first = np.maximum(np.floor((least - cut - origin) / step).astype(np.int64), 0)
        last = np.minimum(np.ceil((greatest + cut - origin) / step).astype(np.int64) + 1, shape)
        block = tuple(slice(int(a), int(b)) for a, b in zip(first, last, strict=True))
        extent = tuple((last - first).tolist())
        nodes = np.moveaxis(np.indices(extent, dtype=np.float64), 0, -1) + first
        here = each.distance((origin + step * nodes).reshape(-1, 3)).reshape(extent)
        distance[block] = np.minimum(distance[block], here)
    return Cavity(matter=tuple(matter), origin=origin, step=step, distance=distance)


def spill_levels(heights: FloatArray, blocked: BoolArray) -> FloatArray:
    """Return, for each node, the least possible greatest height on a way to the edge of the grid.

    Blocked nodes, and free ones without a way out, are at infinity. Each sweep carries levels along one axis;
    sweeps go on until nothing changes.

    Args:
        heights: Height of each node [m], shape (nx, ny, nz).
        blocked: Nodes that no way may use.
    """
    floor = np.where(blocked, np.inf, heights)
    levels = np.full_like(heights, np.inf)
    for axis in range(3):
        ends, bottom = np.moveaxis(levels, axis, 0), np.moveaxis(floor, axis, 0)
        ends[0], ends[-1] = bottom[0], bottom[-1]
    # Slices along the first axis of a copy are contiguous, which is several times faster than strided ones.
    bottoms = [np.ascontiguousarray(np.moveaxis(floor, axis, 0)) for axis in range(3)]
    while True:
        before = levels
        for axis in (2, 0, 1):
            lines = np.moveaxis(levels, axis, 0).copy()
            _sweep(lines, bottoms[axis], range(1, len(lines)), 1)
            _sweep(lines, bottoms[axis], range(len(lines) - 2, -1, -1), -1)
            levels = np.moveaxis(lines, 0, axis)
        if np.array_equal(before, levels):
            return levels


def _sweep(lines: FloatArray, bottom: FloatArray, order: range, back: int) -> None:
    minimum, maximum = np.minimum, np.maximum
    for i in order:
        line = lines[i]
        minimum(line, lines[i - back], out=line)
        maximum(line, bottom[i], out=line)


def _direction(up: FloatArray) -> IntArray:
    """Return the direction that a unit vector is told apart as, in whole numbers, shape (3,)."""
    return np.rint(up * ORIENTATIONS).astype(np.int64)


def _union_distance(matter: Sequence[Matter], points: FloatArray) -> FloatArray:
    found = matter[0].distance(points)
    for each in matter[1:]:
        found = np.minimum(found, each.distance(points))
    return found
