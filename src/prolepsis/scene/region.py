"""The region that a liquid may take up: clear of all matter, in a basin, below a level."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from prolepsis.fields.solids import bounded, matrix
from prolepsis.scene.basin import Basin, distance_to
from prolepsis.things import BoolArray, FloatArray, Thing

SMALL = 1e-4
"""Step of finite differences over the clearance [1]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Region:
    """Where the centres of particles may be."""

    bodies: tuple[Thing, ...]
    """What takes up space."""
    clearance: float
    """Least distance of a centre to it [m]."""
    level: float
    """Greatest height of a centre in the world [m]."""
    basin: Basin | None = None
    """What it is the inside of, if anything."""

    @classmethod
    def of(cls, basin: Basin, bodies: tuple[Thing, ...], spacing: float, level: float) -> Region:
        """Return the region in a basin up to a level [m], clear of what else is near."""
        low, high = bounds_of(basin.container)
        near = [
            body
            for body in bodies
            if body.name != basin.container.name
            and body.shape.geoms
            and (bounds_of(body)[0] < high + spacing).all()
            and (bounds_of(body)[1] > low - spacing).all()
        ]
        return cls(bodies=(basin.container, *near), clearance=0.5 * spacing, level=level - 0.5 * spacing, basin=basin)

    def distance(self, points: FloatArray) -> FloatArray:
        """Return the distance of world points, shape (n, 3), to the nearest matter [m], shape (n,)."""
        found = np.full(len(points), np.inf)
        for body in self.bodies:
            if body.shape.geoms:
                found = np.minimum(found, distance_to(body, points))
        return found

    def admits(self, points: FloatArray) -> BoolArray:
        """Return whether world points, shape (n, 3), are in the region, shape (n,)."""
        inside = points[:, 2] <= self.level + 1e-9
        if self.basin is not None:
            inside &= self.basin.within(points)
        inside[inside] = self.distance(points[inside]) >= self.clearance - 1e-9
        return inside

    def confine(self, points: FloatArray) -> FloatArray:
        """Return points that are too near to matter, or above the level, moved out of it, shape (n, 3)."""
        distance = self.distance(points)
        near = distance < self.clearance
        if near.any():
            here, small = points[near], SMALL * self.clearance
            slope = np.stack(
                [self.distance(here + small * axis) - self.distance(here - small * axis) for axis in np.eye(3)], axis=1
            )
            slope /= np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-300)
            points[near] = here + slope * (self.clearance - distance[near])[:, None]
        points[:, 2] = np.minimum(points[:, 2], self.level)
        return points


def box_of(region: Region, basin: Basin) -> tuple[FloatArray, FloatArray]:
    """Return the least and greatest coordinates that centres can have in a basin [m], each of shape (3,)."""
    across = [np.flatnonzero(basin.nodes.any(axis=axes)) for axes in ((1, 2), (0, 2))]
    first = int(np.flatnonzero(basin.areas > 0)[0])
    low = basin.origin + basin.step * np.array([across[0][0], across[1][0], first])
    high = basin.origin + basin.step * np.array([across[0][-1], across[1][-1], first])
    # The lowest layer of particles lies on the deepest floor.
    low[2] = _floor(region, basin, low, high) + region.clearance
    high[2] = region.level
    return low, high


def _floor(region: Region, basin: Basin, low: FloatArray, high: FloatArray) -> float:
    """Return the height of the deepest place in a basin [m]."""
    step = region.clearance / 4
    counts = np.ceil((high - low)[:2] / step).astype(np.int64) + 1
    x, y = np.indices((int(counts[0]), int(counts[1])), dtype=np.float64).reshape(2, -1)
    for height in np.arange(low[2], basin.brim, basin.step).tolist():
        points = np.column_stack((low[0] + step * x, low[1] + step * y, np.full(len(x), height)))
        points = points[basin.within(points)]
        distance = region.distance(points)
        if distance.max(initial=0.0) > 0:
            return float(height - distance.max())
    return basin.brim


def bounds_of(thing: Thing) -> tuple[FloatArray, FloatArray]:
    """Return the least and greatest world coordinates of a thing's solids [m], each of shape (3,); planes left out."""
    turn = matrix(np.array(thing.orientation))
    corners = [np.zeros((0, 3))]
    for solid in bounded(thing.shape):
        low, high = solid.bounds()
        grid = np.stack(np.meshgrid(*zip(low, high, strict=True), indexing="ij"), axis=-1).reshape(-1, 3)
        corners.append(grid @ turn.T + np.array(thing.position))
    found = np.concatenate(corners)
    if not len(found):
        return np.full(3, np.inf), np.full(3, -np.inf)
    return found.min(axis=0), found.max(axis=0)
