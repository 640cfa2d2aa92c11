"""Packing: n particles of a spacing into a region, as evenly as it allows."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray

DENSEST = 0.7
"""Least distance of lattice points over the spacing [1]; a region that needs them closer is too narrow for so few."""
FINER = 0.99
"""Step by which the lattice is made finer [1]."""
RELAXATIONS = 120
"""Steps in which particles that are too close push each other apart: neighbours then differ by some 2 % from it."""
STRENGTH = 0.35
"""Share of an overlap that one step removes [1]."""
CLEARINGS = 4
"""Last steps in which only walls push: out of a wedge, one wall after the other."""
SETTLED = 0.03
"""Greatest overlap over the spacing [1] with which it ends early."""
KEPT_STEPS = 12
"""Steps for which a list of neighbours is kept."""
REACH = 1.25
"""Reach of that list over the spacing [1]."""

Admits = Callable[[FloatArray], BoolArray]
"""Whether world points, shape (n, 3), are in the region, shape (n,)."""


def lowest(admits: Admits, low: FloatArray, high: FloatArray, count: int, spacing: float) -> FloatArray | None:
    """Return ``count`` lattice points in a region, the lowest there are, shape (count, 3); None if it is too narrow.

    Args:
        admits: The region.
        low: Least coordinates of a box around it [m], shape (3,).
        high: Greatest coordinates of that box [m], shape (3,).
        count: Number of points.
        spacing: Distance of points [m]; they are put closer where the walls leave no room.
    """
    step = spacing
    while step > DENSEST * spacing:
        points = lattice(low, high, step)
        points = points[admits(points)]
        if len(points) >= count:
            return points[np.argsort(points[:, 2], kind="stable")[:count]]
        step *= FINER
    return None


def lattice(low: FloatArray, high: FloatArray, step: float) -> FloatArray:
    """Return a cubic lattice from the bottom of a box upwards, in its middle otherwise, shape (n, 3)."""
    middle, half = (low + high) / 2, (high - low) / 2
    counts: IntArray = np.floor(half / step).astype(np.int64)
    layers = int(np.floor((high[2] - low[2] + 1e-9) / step)) + 1
    shape = (max(layers, 0), 2 * int(counts[0]) + 1, 2 * int(counts[1]) + 1)
    z, x, y = np.indices(shape, dtype=np.float64).reshape(3, -1)
    return np.column_stack((middle[0] + step * (x - counts[0]), middle[1] + step * (y - counts[1]), low[2] + step * z))


def relaxed(points: FloatArray, spacing: float, confine: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Return points that have pushed each other apart to nearly the spacing, shape (n, 3).

    Args:
        points: Where they start, shape (n, 3).
        spacing: Distance of neighbours in the liquid at rest [m].
        confine: Moves points that have left the region back into it.
    """
    pairs = np.zeros((0, 2), dtype=np.int64)
    for step in range(RELAXATIONS):
        if step % KEPT_STEPS == 0:
            pairs = _pairs(points, REACH * spacing)
        apart = points[pairs[:, 0]] - points[pairs[:, 1]]
        distance = np.maximum(np.sqrt(np.einsum("nc,nc->n", apart, apart)), 1e-9)
        overlap = np.maximum(spacing - distance, 0.0)
        if overlap.max(initial=0.0) < SETTLED * spacing:
            break
        push = apart * (STRENGTH * overlap / distance)[:, None]
        moved = points.copy()
        for axis in range(3):
            moved[:, axis] += np.bincount(pairs[:, 0], push[:, axis], len(points))
            moved[:, axis] -= np.bincount(pairs[:, 1], push[:, axis], len(points))
        points = confine(moved)
    for _ in range(CLEARINGS):
        points = confine(points)
    return points


def _pairs(points: FloatArray, reach: float) -> IntArray:
    """Return the pairs of points nearer than ``reach`` [m], shape (m, 2)."""
    # Imported here: the import takes longer than an egg, which needs no more than a lattice.
    from scipy import spatial  # pyright: ignore[reportMissingTypeStubs]

    library: Any = spatial
    found: IntArray = library.cKDTree(points).query_pairs(reach, output_type="ndarray")
    return found
