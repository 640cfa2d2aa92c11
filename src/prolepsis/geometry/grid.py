"""A closed surface of triangles as signed distances on a grid: built once, kept by content."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any, cast

import numpy as np

from prolepsis.geometry.kept import kept_array
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray, Surface
from prolepsis.system.kernels import njit

NODE_COUNT = 250_000
"""Nodes of a grid: about 1.5 mm apart for a cup of 10 cm; between them distances are interpolated."""
BAND = 3
"""Within so many steps of the surface distances are exact, beyond them counted in nodes."""
MARGIN = 4
"""Nodes round the surface on every side."""


@lru_cache(maxsize=64)
def grid_of(surface: Surface) -> FloatArray:
    """Return origin (3), step, shape (3) and values (nx ny nz), one after the other, as ``faces.Solids`` has them."""
    vertices = np.array(surface.vertices, dtype=np.float64)
    triangles = np.array(surface.triangles, dtype=np.int64)
    return kept_array(
        "grid", (vertices, triangles, np.array([NODE_COUNT, BAND, MARGIN])), lambda: _grid(vertices, triangles)
    )


def _grid(vertices: FloatArray, triangles: IntArray) -> FloatArray:
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    extents = np.maximum(high - low, 1e-4)
    step = math.pow(extents[0] * extents[1] * extents[2] / NODE_COUNT, 1 / 3)
    # Rays through nodes must not run along edges, which meshes have at round numbers.
    origin = low - MARGIN * step - step * np.array([0.137, 0.291, 0.213])
    shape: IntArray = np.ceil((high - origin) / step).astype(np.int64) + MARGIN
    extent = (int(shape[0]), int(shape[1]), int(shape[2]))
    inside = np.zeros(extent, dtype=np.bool_)
    near = np.full(extent, np.inf)
    _scan(vertices, triangles, origin, step, near, inside)
    # Imported here: few scenes have meshes.
    from scipy import ndimage  # pyright: ignore[reportMissingTypeStubs]

    transform = cast("Callable[[BoolArray], FloatArray]", cast(Any, ndimage).distance_transform_edt)
    far = np.where(inside, transform(inside), transform(~inside)) * step
    distance = np.where(near <= BAND * step, near, np.maximum(far, BAND * step))
    signed = np.where(inside, -distance, distance)
    return np.concatenate([origin, [step], shape.astype(np.float64), signed.ravel()])


@njit(cache=True)
def _scan(
    vertices: FloatArray, triangles: IntArray, origin: FloatArray, step: float, near: FloatArray, inside: BoolArray
) -> None:
    """Fill in distances of the nodes near each triangle, and which nodes an upward ray says are inside."""
    shape = near.shape
    for t in range(len(triangles)):
        a, b, c = vertices[triangles[t, 0]], vertices[triangles[t, 1]], vertices[triangles[t, 2]]
        first, last = np.zeros(3, dtype=np.int64), np.zeros(3, dtype=np.int64)
        for axis in range(3):
            least = min(a[axis], min(b[axis], c[axis]))
            greatest = max(a[axis], max(b[axis], c[axis]))
            first[axis] = max(math.floor((least - origin[axis]) / step) - BAND, 0)
            last[axis] = min(math.ceil((greatest - origin[axis]) / step) + BAND, shape[axis] - 1)
        for i in range(first[0], last[0] + 1):
            for j in range(first[1], last[1] + 1):
                for k in range(first[2], last[2] + 1):
                    p = origin + step * np.array([float(i), float(j), float(k)])
                    near[i, j, k] = min(near[i, j, k], _to_triangle(p, a, b, c))
        area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
        if abs(area) < 1e-18:
            continue
        for i in range(first[0], last[0] + 1):
            for j in range(first[1], last[1] + 1):
                x, y = origin[0] + step * i, origin[1] + step * j
                v = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / area
                w = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / area
                if v < 0.0 or w < 0.0 or v + w >= 1.0:
                    continue
                z = a[2] + v * (b[2] - a[2]) + w * (c[2] - a[2])
                below = min(math.ceil((z - origin[2]) / step), shape[2])
                for k in range(below):
                    inside[i, j, k] = not inside[i, j, k]


@njit(cache=True)
def _to_triangle(p: FloatArray, a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    """Return the distance from a point to a triangle."""
    ab, ac, ap = b - a, c - a, p - a
    normal = np.cross(ab, ac)
    square = np.dot(normal, normal)
    if square > 0.0:
        w = np.dot(np.cross(ab, ap), normal) / square
        v = np.dot(np.cross(ap, ac), normal) / square
        if v >= 0.0 and w >= 0.0 and v + w <= 1.0:
            return abs(np.dot(ap, normal)) / math.sqrt(square)
    return min(_to_edge(p, a, b), min(_to_edge(p, b, c), _to_edge(p, c, a)))


@njit(cache=True)
def _to_edge(p: FloatArray, a: FloatArray, b: FloatArray) -> float:
    ab = b - a
    t = np.dot(p - a, ab) / max(np.dot(ab, ab), 1e-300)
    apart = p - a - min(max(t, 0.0), 1.0) * ab
    return math.sqrt(np.dot(apart, apart))
