"""Hollows: where something at rest in or on rigid solids could not leave them, whichever way they are turned.

The free space round the solids is a grid. The *spill level* of a place is the least height over which every way to
the outside must rise. What lies below its spill level is in a *pool*: the free corner of an L, the space under an
upturned cup, or a ring without a bottom has none. A liquid takes every way, a body only those that are wide enough.
Filling and recognition both ask here, so that they agree on what a vessel holds.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from prolepsis.geometry.distances import nearest_faces, node_distances
from prolepsis.geometry.faces import Solids
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.geometry.spilling import level_at, pool_levels
from prolepsis.geometry.spreading import regions, spread

NODE_COUNT = 80_000
"""Nodes in the box round the solids: 1.9 mm apart for a cup of 10 cm. docs/grounding.md says what was measured."""
LEAST_STEP = 0.0008
"""Shortest step [m]: that of a thimble."""
BLOCKED = 0.501
"""A node nearer to matter than this share of a step is blocked. Any step through a wall, however thin, then
has a blocked end, so that walls thinner than a step do not leak."""
BESIDE = 1.5
"""Free nodes count as next to matter if they are no more than this further from it than they may be [steps]."""
BEYOND = 3
"""Nodes beyond the box round the solids up to which ways over their rims are followed."""
CLEARINGS = 4
"""Times that a point is looked at on its way off the walls: out of a wedge, one wall after the other."""
LEAST_DEPTH = 0.5
"""Depth of a pool's lowest node below which it may be an artefact of the grid [steps]: on convex solids they are up to
0.02 deep, between two balls 0.2."""
ORIENTATIONS = 30
"""Directions that are the same when rounded to this fraction of one are taken as their mean, at most 1.4 degrees off.
Heights are taken along the same direction, so that near the lip, where it matters, nothing is lost."""
_AXES: FloatArray = np.concatenate((np.eye(3), -np.eye(3)))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Basin:
    """One pool, in layers along the direction up."""

    origin: FloatArray
    """Position of the first node [m], shape (3,)."""
    step: float
    """Distance between nodes, and thickness of a layer [m]."""
    nodes: BoolArray
    """Nodes in the pool, or between it and the walls, shape (nx, ny, nz)."""
    brim: float
    """Height above which it spills [m]; its top if it is closed all round."""
    bottom: float
    """Height of the middle of the lowest layer [m]."""
    areas: FloatArray
    """Free area of each layer [m^2], the lowest first, shape (L,)."""

    @property
    def capacity(self) -> float:
        """Volume up to the brim [m^3]."""
        return self._below(self.brim)

    def level(self, volume: float) -> float:
        """Return the height up to which ``volume`` [m^3] fills it [m], the brim at most."""
        low, high = self.bottom - self.step, self.brim
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if self._below(middle) < volume else (low, middle)
        return (low + high) / 2

    def within(self, points: FloatArray) -> BoolArray:
        """Return whether points, shape (N, 3), that are in no matter are in the basin, shape (N,)."""
        return _at(self.nodes, np.rint((points - self.origin) / self.step), outside=False)

    def _below(self, height: float) -> float:
        """Return the volume below a height [m^3]."""
        floors = self.bottom + self.step * (np.arange(len(self.areas)) - 0.5)
        return float(self.areas @ np.clip(height - floors, 0.0, self.step))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Space:
    """The free space in and round rigid solids."""

    solids: Solids
    """What the space is free of."""
    origin: FloatArray
    """Position of the first node [m], shape (3,)."""
    step: float
    """Distance between nodes [m]."""
    distance: FloatArray
    """Signed distance of each node to the solids [m], shape (nx, ny, nz)."""
    box: IntArray
    """First node and the one after the last, along each axis, of the box round the solids, shape (2, 3)."""
    _free_by_clearance: dict[float, tuple[BoolArray, IntArray, FloatArray]] = field(
        default_factory=dict[float, tuple[BoolArray, IntArray, FloatArray]]
    )

    def pools(self, up: FloatArray, clearance: float = 0.0) -> FloatArray:
        """Return the spill level of each node in a pool [m], minus infinity at the others, shape (nx, ny, nz).

        In a closed hollow it is infinite.

        Args:
            up: Unit vector against gravity, shape (3,).
            clearance: Distance to all matter [m] that a way out needs. Rims are as high as they are, though.
        """
        free, near, foot = self._free_nodes(max(clearance, BLOCKED * self.step))
        followed, across = self._box(BEYOND), self.step * up
        base = float(self.origin @ up) + float(across @ [each.start for each in followed])
        found = np.full(self.distance.shape, -np.inf)
        found[followed] = pool_levels(free, near, foot @ up, base, across, LEAST_DEPTH * self.step)
        return found

    def stopped(self, up: FloatArray, clearance: float) -> FloatArray:
        """Return the same where gaps that leave no more than a clearance [m] on either side are stopped."""
        pool = self.pools(up, clearance)
        highest = float(pool.max())
        if clearance <= 0 or highest == -np.inf:
            return pool
        # Nodes near the wall are blocked then, yet a liquid reaches the wall.
        free = self.distance >= BLOCKED * self.step
        grown = spread(pool > -np.inf, free, max(1, round(clearance / self.step)))
        return np.where(grown & (self.heights(up) <= highest), highest, -np.inf)

    def hollow(self, clearance: float = 0.0) -> BoolArray:
        """Return the nodes in a pool when the solids stand on any of six sides, gaps stopped, shape (nx, ny, nz)."""
        found = np.zeros(self.distance.shape, dtype=np.bool_)
        for up in _AXES:
            found |= self.pools(up) > -np.inf
            if clearance > 0:
                found |= self.stopped(up, clearance) > -np.inf
        return found

    def basin(self, up: FloatArray, clearance: float = 0.0) -> Basin | None:
        """Return the largest pool, gaps stopped, or None if there is none."""
        pool = self.stopped(up, clearance)
        numbers = regions(pool > -np.inf)
        if not numbers.any():
            return None
        chosen = numbers == int(np.argmax(np.bincount(numbers.ravel())[1:])) + 1
        nodes = self._with_shore(chosen, pool)
        heights = self.heights(up)[nodes]
        brim, bottom = float(pool[chosen].max()), float(heights.min())
        layers = np.rint((heights - bottom) / self.step).astype(np.int64)
        # A node stands for a cube, which a wall may cut.
        share = np.clip(0.5 + self.distance[nodes] / self.step, 0.0, 1.0)
        areas: FloatArray = np.bincount(layers, weights=share).astype(np.float64) * self.step**2
        return Basin(
            origin=self.origin,
            step=self.step,
            nodes=nodes,
            brim=min(brim, float(heights.max())),
            bottom=bottom,
            areas=areas,
        )

    def depth(self, points: FloatArray, up: FloatArray, pools: FloatArray, clearance: float) -> FloatArray:
        """Return how far below its spill level each point is [m], 0 where it is in no pool, shape (N,).

        Args:
            points: Well inside of a body [m], shape (N, 3).
            up: Unit vector against gravity at each of them, shape (N, 3).
            pools: What ``pools`` says of that direction and the clearance.
            clearance: What the body needs [m].
        """
        moved, apart = self._cleared(points, max(clearance, BLOCKED * self.step) + 0.5 * self.step)
        level = level_at(moved - self.origin, apart, self.step, self.distance, pools)
        most = self.step * max(self.distance.shape)
        return np.clip(level - (points * up).sum(axis=1), 0.0, most)

    def on_same_grid(self, solids: Solids) -> Space:
        """Return the space in and round other solids within the same bounds."""
        shape: IntArray = np.array(self.distance.shape)
        distance = node_distances(solids, self.origin, self.step, shape)
        return replace(self, solids=solids, distance=distance, _free_by_clearance={})

    def heights(self, up: FloatArray) -> FloatArray:
        """Return the height of each node [m], shape (nx, ny, nz)."""
        x, y, z = np.ogrid[tuple(slice(count) for count in self.distance.shape)]
        heights: FloatArray = float(self.origin @ up) + self.step * (up[0] * x + up[1] * y + up[2] * z)
        return heights

    def _box(self, beyond: int) -> tuple[slice, slice, slice]:
        """Return the box round the solids, and so many nodes beyond it, as a slice of the grid."""
        (a, b, c), (d, e, f) = (self.box + [[-beyond], [beyond]]).tolist()
        return slice(a, d), slice(b, e), slice(c, f)

    def _free_nodes(self, clearance: float) -> tuple[BoolArray, IntArray, FloatArray]:
        """Return the nodes that are clear of matter, those next to it, and how they lie from its nearest point."""
        if clearance not in self._free_by_clearance:
            followed, reach = self._box(BEYOND), clearance + BESIDE * self.step
            distance = self.distance[followed]
            # What is beyond the solids' box is outside, however near to them.
            inner = (slice(BEYOND, -BEYOND),) * 3
            free: BoolArray = np.ones(distance.shape, dtype=np.bool_)
            free[inner] = distance[inner] >= clearance
            near = np.argwhere(free & (distance < reach))
            first = self.origin + self.step * (self.box[0] - BEYOND)
            faces = nearest_faces(self.solids, first + self.step * near, reach + self.step)
            foot = np.where(np.isfinite(faces[:, :1]), faces[:, :1], 0.0) * faces[:, 1:]
            self._free_by_clearance[clearance] = free, np.array(np.ravel_multi_index(tuple(near.T), free.shape)), foot
        return self._free_by_clearance[clearance]

    def _with_shore(self, chosen: BoolArray, pool: FloatArray) -> BoolArray:
        """Return the nodes of a pool and those between it and the walls, but none behind a thin wall."""
        nodes = _dilated(chosen) & (chosen | (pool == -np.inf))
        shore = np.argwhere(nodes & ~chosen)
        points = self.origin + self.step * shore
        faces = nearest_faces(self.solids, points, BESIDE * self.step)
        near = np.isfinite(faces[:, 0])
        ahead = points[near] + faces[near, 1:] * (BESIDE * self.step - faces[near, :1])
        behind = ~_at(nodes, np.rint((ahead - self.origin) / self.step), outside=False)
        nodes[tuple(shore[near][behind].T)] = False
        return nodes

    def _cleared(self, points: FloatArray, clearance: float) -> tuple[FloatArray, FloatArray]:
        """Return points moved away from the nearest walls, on their own side, until they are clear; and how clear."""
        moved = points.copy()
        # At least so far are they from matter by what is known of the nearest node.
        nodes = np.rint((points - self.origin) / self.step)
        apart = _at(self.distance, nodes, outside=np.inf)
        apart = apart - np.linalg.norm(self.origin + self.step * nodes - points, axis=1)
        doubtful = np.flatnonzero(apart < clearance)
        for _ in range(CLEARINGS):
            faces = nearest_faces(self.solids, moved[doubtful], clearance + 2 * self.step)
            apart[doubtful] = faces[:, 0]
            short = faces[:, 0] < clearance
            if not short.any():
                break
            moved[doubtful] += faces[:, 1:] * np.maximum(clearance - faces[:, :1], 0.0)
        return moved, apart


def space_of(solids: Solids, low: FloatArray, high: FloatArray, reach: float = 0.0) -> Space:
    """Return the free space in and round solids.

    Args:
        solids: The solids.
        low: Their least coordinates [m], shape (3,).
        high: Their greatest coordinates [m], shape (3,).
        reach: How far round them it must go at least [m].
    """
    step = max(float(np.prod(np.maximum(high - low, 1e-4)) / NODE_COUNT) ** (1 / 3), LEAST_STEP)
    margin = max(BEYOND * step, reach + 2 * step)
    origin = low - margin
    shape: IntArray = np.ceil((high + margin - origin) / step).astype(np.int64) + 1
    box = np.stack((np.ceil((low - origin) / step - BLOCKED), np.floor((high - origin) / step + BLOCKED) + 1))
    distance = node_distances(solids, origin, step, shape)
    return Space(solids=solids, origin=origin, step=step, distance=distance, box=box.astype(np.int64))


def alike(up: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return the directions that are told apart among many, (N, 3) to (K, 3), and which each of them is, shape (N,)."""
    digits = np.rint(up * ORIENTATIONS).astype(np.int64) + ORIENTATIONS
    side = 2 * ORIENTATIONS + 1
    _, which = np.unique((digits[:, 0] * side + digits[:, 1]) * side + digits[:, 2], return_inverse=True)
    which = which.ravel()
    sums = np.column_stack([np.bincount(which, weights=up[:, axis]) for axis in range(3)])
    return sums / np.linalg.norm(sums, axis=1, keepdims=True), which


def _at(values: npt.NDArray[Any], nodes: FloatArray, *, outside: float) -> npt.NDArray[Any]:
    """Return values at nodes, shape (N, 3), and another outside of the grid, shape (N,)."""
    shape = np.array(values.shape)
    within = np.all((nodes >= 0) & (nodes < shape), axis=1)
    index = np.where(within[:, None], nodes, 0).astype(np.int64)
    return np.where(within, values[tuple(index.T)], outside)


def _dilated(mask: BoolArray) -> BoolArray:
    """Return nodes and all those beside them, also across corners."""
    return spread(mask, np.ones_like(mask), 1)
