"""The surface of a sponge: places just outside it where liquid comes out, and places inside where it is kept."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray, Shape
from prolepsis.geometry.signed_distance import Field, field_of
from prolepsis.geometry.solids import bounded
from prolepsis.terms.errors import KnowledgeError

CLEARANCE = 0.55
"""Distance of a particle that comes out from the surface [spacings]: at rest on it, it is a half."""
APART = 0.9
"""Least distance of two places outside [spacings]."""
SMALL = 1e-3
"""Step of finite differences [spacings]."""
MOST_POINTS = 10_000_000
"""Most points that are looked at to find the surface; more would take gigabytes."""
GOLDEN = 1.2207440846057596
"""The number g with g^4 = g + 1: multiples of its powers fill a box evenly.

Source: Roberts, The unreasonable effectiveness of quasirandom sequences (2018)."""


class SpongeSurface:
    """Inside and outside of one shape, in its own frame, for liquids of one spacing."""

    def __init__(self, shape: Shape, spacing: float) -> None:
        """Find the places of a shape for particles ``spacing`` [m] apart.

        Raises:
            KnowledgeError: If they are too many.
        """
        self._field: Field = field_of(shape)
        corners = np.array([solid.bounds() for solid in bounded(shape)])
        self.low: FloatArray = corners[:, 0].min(axis=0)
        """Least coordinates [m], shape (3,)."""
        self.high: FloatArray = corners[:, 1].max(axis=0)
        """Greatest coordinates [m], shape (3,)."""
        self.exits, self.outward = self._outside(spacing)
        """Positions of particles that come out [m], and the normals there, shape (k, 3) each."""

    def _outside(self, spacing: float) -> tuple[FloatArray, FloatArray]:
        size = self.high - self.low
        steps = np.ceil(size / spacing) + 2
        if steps.prod() > MOST_POINTS:
            shown = " x ".join(f"{1e3 * float(side):.4g}" for side in size)
            raise KnowledgeError(
                f"a sponge of {shown} mm is too large for particles {1e3 * spacing:.2g} mm apart: at most "
                f"{MOST_POINTS:,} places are looked at; allowed: a smaller sponge, or fewer particles"
            )
        axes = [(np.arange(int(n)) - (float(n) - 1) / 2) * spacing for n in steps]
        grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3) + (self.low + self.high) / 2
        distance = self._field.distance(grid)
        near = (distance > 0) & (distance <= spacing)
        points, distance = grid[near], distance[near]
        outward = self._slope(points, SMALL * spacing)
        points += outward * (CLEARANCE * spacing - distance)[:, None]
        kept = np.ones(len(points), dtype=np.bool_)
        pairs: IntArray = _tree(points).query_pairs(APART * spacing, output_type="ndarray")
        for a, b in sorted(pairs.tolist()):
            kept[b] &= not kept[a]
        return points[kept], outward[kept]

    def _slope(self, points: FloatArray, step: float) -> FloatArray:
        ahead = [self._field.distance(points + step * axis) for axis in np.eye(3)]
        behind = [self._field.distance(points - step * axis) for axis in np.eye(3)]
        slope = np.stack([a - b for a, b in zip(ahead, behind, strict=True)], axis=1)
        return slope / np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-300)

    def touched_by(self, points: FloatArray, reach: float) -> BoolArray:
        """Return which points, shape (n, 3), are within ``reach`` [m] of it or inside, shape (n,)."""
        found: BoolArray = np.all((points > self.low - reach) & (points < self.high + reach), axis=1)
        found[found] = self._field.distance(points[found]) < reach
        return found

    def distance(self, points: FloatArray) -> FloatArray:
        """Return the signed distance of points, shape (n, 3), to it [m], shape (n,)."""
        return self._field.distance(points)

    def is_below(self, points: FloatArray, up: FloatArray) -> BoolArray:
        """Return which points, shape (n, 3), are in front of a part of it that looks down, shape (n,)."""
        _, nearest = nearest_of(self.exits, points)
        return self.outward[nearest] @ up < -0.5

    def inside(self, count: int) -> FloatArray:
        """Return ``count`` points inside, of which any first ones are spread evenly too, shape (count, 3) [m]."""
        found = np.zeros((0, 3))
        number = 2 * count
        while len(found) < count:
            steps = np.arange(1, number + 1)[:, None] / GOLDEN ** np.arange(1, 4)
            points = self.low + (0.5 + steps) % 1.0 * (self.high - self.low)
            found = points[self._field.distance(points) < 0]
            number *= 2
        return found[:count]


def nearest_of(targets: FloatArray, points: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return the distance of points, shape (n, 3), to the nearest target, and which it is, shape (n,) each."""
    found: tuple[FloatArray, IntArray] = _tree(targets).query(points)
    return found


def _tree(points: FloatArray) -> Any:
    # Imported here: the import takes longer than a scene without sponges.
    from scipy import spatial  # pyright: ignore[reportMissingTypeStubs]

    library: Any = spatial
    return library.cKDTree(points)
