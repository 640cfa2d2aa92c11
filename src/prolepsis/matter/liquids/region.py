"""The region that a liquid may take up: clear of all matter, in a basin, below a level."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.hollows import Basin
from prolepsis.geometry.shape import BoolArray, FloatArray
from prolepsis.scene.posed import Posed, nearest

SMALL = 1e-4
"""Step of finite differences over the clearance [1]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Region:
    """Where the centres of particles may be."""

    matter: tuple[Posed, ...]
    """What takes up space."""
    clearance: float
    """Least distance of a centre to it [m]."""
    level: float
    """Greatest height of a centre in the world [m]."""
    basin: Basin | None = None
    """What it is the inside of, if anything."""

    @classmethod
    def of(cls, container: Posed, basin: Basin, others: tuple[Posed, ...], spacing: float, level: float) -> Region:
        """Return the region in the basin of a container up to a level [m], clear of what else is near."""
        low, high = container.low - spacing, container.high + spacing
        near = [each for each in others if each.name != container.name]
        near = [each for each in near if (each.low < high).all() and (each.high > low).all()]
        matter = (container, *near)
        return cls(matter=matter, clearance=0.5 * spacing, level=level - 0.5 * spacing, basin=basin)

    def admits(self, points: FloatArray) -> BoolArray:
        """Return whether world points, shape (n, 3), are in the region, shape (n,)."""
        inside = points[:, 2] <= self.level + 1e-9
        if self.basin is not None:
            inside &= self.basin.within(points)
        inside[inside] = nearest(self.matter, points[inside]) >= self.clearance - 1e-9
        return inside

    def confine(self, points: FloatArray) -> FloatArray:
        """Return points that are too near to matter, or above the level, moved out of it, shape (n, 3)."""
        distance = nearest(self.matter, points)
        near = distance < self.clearance
        if near.any():
            here, small = points[near], SMALL * self.clearance
            slope = np.stack([nearest(self.matter, here + small * axis) - distance[near] for axis in np.eye(3)], axis=1)
            slope /= np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-300)
            points[near] = here + slope * (self.clearance - distance[near])[:, None]
        points[:, 2] = np.minimum(points[:, 2], self.level)
        return points


def box_of(region: Region, basin: Basin) -> tuple[FloatArray, FloatArray]:
    """Return the least and greatest coordinates that centres can have in a basin [m], each of shape (3,)."""
    across = [np.flatnonzero(basin.nodes.any(axis=axes)) for axes in ((1, 2), (0, 2))]
    low = basin.origin + basin.step * np.array([across[0][0], across[1][0], 0])
    high = basin.origin + basin.step * np.array([across[0][-1], across[1][-1], 0])
    low[2] = basin.bottom + basin.step * int(np.flatnonzero(basin.areas > 0)[0])
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
        distance = nearest(region.matter, points)
        if distance.max(initial=0.0) > 0:
            return float(height - distance.max())
    return basin.brim
