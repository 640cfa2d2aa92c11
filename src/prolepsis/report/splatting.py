"""Splatting: particles become the nearest surface and the thickness of the liquid in each pixel of a picture."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.system.kernels import njit

NOTHING = 1.0e9
"""Distance of a pixel in which there is no liquid [m]."""


@njit(cache=True, fastmath=True)
def splat(positions: Any, kinds: Any, radius: float, focal: float, behind: Any, count: int) -> Any:
    """Return how near the liquid is and how thick each kind of it is, pixel by pixel.

    Args:
        positions: Centres of the particles seen from the eye, to the right, downward and ahead [m], shape (n, 3).
        kinds: Kind of liquid of each particle, 0 to ``count`` - 1, shape (n,).
        radius: Radius of the ball that stands for a particle [m].
        focal: Focal length [pixel].
        behind: Distance of what is behind the liquid [m], shape (height, width).
        count: Number of kinds.

    Returns:
        Distance of the nearest ball [m], shape (height, width); sums of their chords [m], shape (count, height, width).
    """
    height, width = behind.shape
    nearest = np.full((height, width), NOTHING)
    thickness = np.zeros((count, height, width))
    for p in range(len(positions)):
        right, down, ahead = positions[p]
        if ahead <= radius:
            continue
        scale = focal / ahead
        size = radius * scale
        column, row = width / 2 + right * scale, height / 2 + down * scale
        # Even a ball smaller than a pixel is seen.
        reach = max(size, 0.71)
        for i in range(max(0, int(np.ceil(row - reach))), min(height, int(np.floor(row + reach)) + 1)):
            for j in range(max(0, int(np.ceil(column - reach))), min(width, int(np.floor(column + reach)) + 1)):
                inside = 1.0 - ((i - row) ** 2 + (j - column) ** 2) / (reach * reach)
                if inside <= 0.0:
                    continue
                half = radius * np.sqrt(inside)
                front = ahead - half
                if front >= behind[i, j]:
                    continue
                nearest[i, j] = min(nearest[i, j], front)
                thickness[kinds[p], i, j] += 2.0 * half * min(1.0, size / reach)
    return nearest, thickness


@njit(cache=True, fastmath=True)
def _smoothed_along_rows(nearest: Any, reach: int, step: float) -> Any:
    height, width = nearest.shape
    result = nearest.copy()
    weights = np.exp(-(((np.arange(2 * reach + 1) - reach) * 1.5 / max(reach, 1)) ** 2))
    for i in range(height):
        for j in range(width):
            here = nearest[i, j]
            if here >= NOTHING:
                continue
            total, weight = 0.0, 0.0
            for k in range(-reach, reach + 1):
                if 0 <= j + k < width:
                    there = nearest[i, j + k]
                    if abs(there - here) < step:
                        w = weights[k + reach]
                        total += w * there
                        weight += w
            result[i, j] = total / weight
    return result


def smoothed(nearest: FloatArray, *, reach: int, step: float, times: int = 3) -> FloatArray:
    """Return the distances smoothed within surfaces, but not across their edges.

    Args:
        nearest: Distance of the liquid [m], shape (height, width).
        reach: Half width of the filter [pixel].
        step: Neighbours whose distance differs by more belong to another surface [m].
        times: How often the filter passes.
    """
    for _ in range(times):
        nearest = _smoothed_along_rows(nearest, reach, step)
        nearest = np.ascontiguousarray(_smoothed_along_rows(np.ascontiguousarray(nearest.T), reach, step).T)
    return nearest
