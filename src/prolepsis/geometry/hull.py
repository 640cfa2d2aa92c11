"""The planes of a convex hull, from its vertices."""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray, IntArray

_FLAT = 1e-7
"""Share of the extent [1] below which a point counts as lying in a plane."""
_FEW = 56
"""Up to so many points, trying all planes is quicker than importing the library that does it well."""


def hull_planes(vertices: FloatArray) -> FloatArray:
    """Return the outward planes (normal, offset) of the convex hull of points, shape (F, 4).

    A point p is inside when ``normal @ p <= offset`` for all planes. Points in one plane get a box around
    them, since a sheet has no inside.

    Args:
        vertices: Points [m], shape (V, 3).
    """
    points = np.unique(np.asarray(vertices, dtype=np.float64).reshape(-1, 3), axis=0)
    extent = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False) if len(points) >= 4 else np.zeros(3)
    if spread[-1] <= _FLAT * extent:
        return _box_planes(points)
    planes = _tried_planes(points, _FLAT * extent) if len(points) <= _FEW else _qhull_planes(points)
    scale = np.array([1.0, 1.0, 1.0, 1.0 / extent])
    _, chosen = np.unique(np.round(planes * scale, 6), axis=0, return_index=True)
    return planes[np.sort(chosen)]


@lru_cache(maxsize=64)
def _triples(count: int) -> IntArray:
    return np.array(list(combinations(range(count), 3))).T


def _tried_planes(points: FloatArray, flat: float) -> FloatArray:
    """Return the planes through three points that have all others on one side, shape (F, 4)."""
    i, j, k = _triples(len(points))
    normals = np.cross(points[j] - points[i], points[k] - points[i])
    size = np.linalg.norm(normals, axis=1)
    good = size > flat * flat
    normals = normals[good] / size[good, None]
    offsets = np.einsum("fc,fc->f", normals, points[i[good]])
    beyond = normals @ points.T - offsets[:, None]
    below, above = (beyond <= flat).all(axis=1), (beyond >= -flat).all(axis=1)
    kept = np.column_stack((normals, offsets))
    return np.concatenate((kept[below], -kept[above & ~below]))


def _qhull_planes(points: FloatArray) -> FloatArray:
    """Return the planes of the hull of many points, shape (F, 4)."""
    # Imported here: the import takes longer than recognizing an egg, whose pieces have few vertices.
    from scipy.spatial import ConvexHull  # pyright: ignore[reportMissingTypeStubs]

    hull: Any = ConvexHull(points)
    equations = np.asarray(hull.equations, dtype=np.float64)
    return np.column_stack((equations[:, :3], -equations[:, 3]))


def _box_planes(points: FloatArray) -> FloatArray:
    low = points.min(axis=0) if len(points) else np.zeros(3)
    high = points.max(axis=0) if len(points) else np.zeros(3)
    axes = np.eye(3)
    return np.concatenate((np.column_stack((axes, high)), np.column_stack((-axes, -low))))
