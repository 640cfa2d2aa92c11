"""The planes of a convex hull, from its vertices."""

from __future__ import annotations

import numpy as np

from prolepsis.things import FloatArray, IntArray

_FLAT = 1e-7
"""Share of the extent [1] below which a point counts as lying in a plane."""


def hull_planes(vertices: FloatArray) -> FloatArray:
    """Return the outward planes (normal, offset) of the convex hull of points, shape (F, 4).

    A point p is inside when ``normal @ p <= offset`` for all planes. Points in one plane get a box around
    them, since a sheet has no inside.

    Args:
        vertices: Points [m], shape (V, 3).
    """
    points = np.unique(np.asarray(vertices, dtype=np.float64), axis=0)
    extent = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    start = _first_tetrahedron(points, _FLAT * extent)
    if start is None:
        return _box_planes(points)
    middle = points[start].mean(axis=0)
    faces = np.array([np.delete(start, k) for k in range(4)])
    faces, planes = _outward(points, faces, middle)
    for index in range(len(points)):
        seen = planes[:, :3] @ points[index] - planes[:, 3] > _FLAT * extent
        if not seen.any():
            continue
        edges = np.concatenate([faces[seen][:, pair] for pair in ((0, 1), (1, 2), (2, 0))])
        edges.sort(axis=1)
        # An edge between a seen and an unseen face is on the horizon: it occurs once.
        distinct, count = np.unique(edges, axis=0, return_counts=True)
        horizon = distinct[count == 1]
        added = np.column_stack((horizon, np.full(len(horizon), index)))
        new_faces, new_planes = _outward(points, added, middle)
        faces = np.concatenate((faces[~seen], new_faces))
        planes = np.concatenate((planes[~seen], new_planes))
    scale = np.array([1.0, 1.0, 1.0, 1.0 / extent])
    _, chosen = np.unique(np.round(planes * scale, 6), axis=0, return_index=True)
    return planes[np.sort(chosen)]


def _first_tetrahedron(points: FloatArray, flat: float) -> IntArray | None:
    if len(points) < 4:
        return None
    first = 0
    second = int(np.argmax(np.linalg.norm(points - points[first], axis=1)))
    line = points[second] - points[first]
    aside = np.linalg.norm(np.cross(points - points[first], line), axis=1) / max(float(np.linalg.norm(line)), 1e-300)
    third = int(np.argmax(aside))
    normal = np.cross(line, points[third] - points[first])
    height = np.abs((points - points[first]) @ normal) / max(float(np.linalg.norm(normal)), 1e-300)
    fourth = int(np.argmax(height))
    if aside[third] <= flat or height[fourth] <= flat:
        return None
    return np.array([first, second, third, fourth])


def _outward(points: FloatArray, faces: IntArray, middle: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the faces that have an area, and their planes with normals away from ``middle``."""
    corner = points[faces[:, 0]]
    normals = np.cross(points[faces[:, 1]] - corner, points[faces[:, 2]] - corner)
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = normals / np.maximum(size, 1e-300)
    offsets = np.einsum("fc,fc->f", normals, corner)
    sign = np.where(normals @ middle > offsets, -1.0, 1.0)
    return faces, np.column_stack((normals * sign[:, None], offsets * sign))


def _box_planes(points: FloatArray) -> FloatArray:
    low = points.min(axis=0) if len(points) else np.zeros(3)
    high = points.max(axis=0) if len(points) else np.zeros(3)
    axes = np.eye(3)
    return np.concatenate((np.column_stack((axes, high)), np.column_stack((-axes, -low))))
