"""A vessel as it looks: its profile turned to one seamless surface, with its holes left open."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from prolepsis.geometry.shape import FloatArray, Hole, Shape

SEGMENTS = 72
"""Facets round a vessel."""
FINE_SEGMENTS, FINE_STEP = 180, 1.2e-3
"""Facets round a vessel with holes, and their height [m]: a hole's edge is ragged by about half of that."""


def turned_surface(shape: Shape) -> tuple[FloatArray, npt.NDArray[np.int32]]:
    """Return vertices (n, 3) [m] and triangles (m, 3), counter-clockwise from outside, of a shape with a profile."""
    segments = FINE_SEGMENTS if shape.holes else SEGMENTS
    angles = np.linspace(0.0, 2 * np.pi, segments, endpoint=False)
    round_about = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    outline = np.asarray(shape.profile, dtype=np.float64)
    vertices: list[FloatArray] = []
    triangles: list[npt.NDArray[np.int32]] = []
    count = 0
    for start, end in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        if max(start[0], end[0]) <= 0.0 or np.array_equal(start, end):
            continue
        steps = int(np.ceil(np.linalg.norm(end - start) / FINE_STEP)) if shape.holes else 1
        # Each straight stretch has vertices of its own, so that edges look sharp.
        points = start + np.linspace(0.0, 1.0, steps + 1)[:, None] * (end - start)
        rings = np.concatenate(
            [points[:, None, :1] * round_about, np.repeat(points[:, None, 1:], segments, axis=1)], axis=2
        )
        first = np.arange(segments)
        then = np.roll(first, -1)
        for k in range(steps):
            a, b = count + k * segments, count + (k + 1) * segments
            triangles.append(np.stack([a + first, a + then, b + first], axis=1).astype(np.int32))
            triangles.append(np.stack([a + then, b + then, b + first], axis=1).astype(np.int32))
        vertices.append(rings.reshape(-1, 3))
        count += rings.shape[0] * segments
    corners, faces = np.concatenate(vertices), np.concatenate(triangles)
    sides = np.cross(corners[faces[:, 1]] - corners[faces[:, 0]], corners[faces[:, 2]] - corners[faces[:, 0]])
    kept = np.linalg.norm(sides, axis=1) > 1e-12
    middles = corners[faces].mean(axis=1)
    for hole in shape.holes:
        kept &= ~_drilled(middles, hole)
    return corners, faces[kept]


def _drilled(points: FloatArray, hole: Hole) -> npt.NDArray[np.bool_]:
    away = points - np.asarray(hole.position)
    along = away @ np.asarray(hole.direction)
    across = np.linalg.norm(away - along[:, None] * np.asarray(hole.direction), axis=1)
    return (along > 0.0) & (across < hole.radius)
