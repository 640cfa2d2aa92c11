"""Where a held vessel's lip is while it turns, and how high it must be so that nothing touches what is below.

The frame here is the hand's when level: x forward, y to the left, z up; side is 1 when it pours to the left, else -1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from prolepsis.geometry.rotations import rolled
from prolepsis.geometry.shape import FloatArray

RIM = 1.0e-3
"""Points within this height of the topmost belong to the rim [m]."""
CLEARANCE = 0.006
"""What is moved keeps this far from what is below [m]."""
STEPS = 91
"""Angles at which the path is checked; in between it is interpolated."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Below:
    """What is poured to, as a box."""

    half_forward: float
    """Half its extent along the hand's forward axis [m]."""
    half_aside: float
    """Half its extent along the pouring direction [m]."""
    height: float
    """From its bottom to its top [m]."""


def lip_of(points: FloatArray, side: int) -> FloatArray:
    """Return the point of a vessel's rim that is lowest once it is tilted to a side [m], shape (3,).

    Args:
        points: On the vessel as it stands upright in the hand's frame [m], shape (n, 3).
        side: 1 for left, -1 for right.
    """
    rim = points[points[:, 2] > points[:, 2].max() - RIM]
    reach = side * rim[:, 1]
    return rim[reach > reach.max() - RIM].mean(axis=0)


def needed_height(moved: FloatArray, lip: FloatArray, below: Below, *, side: int, angle: float, offset: float) -> float:
    """Return the least height of the lip over the top of what is below at which nothing touches [m].

    Args:
        moved: Points on vessel and hand in the hand's frame, upright [m], shape (n, 3).
        lip: The lip, likewise.
        below: What is poured to.
        side: 1 for left, -1 for right.
        angle: By which the hand has turned to that side [rad].
        offset: The lip is this far beyond the middle along the pouring direction [m].
    """
    away = (moved - lip) @ rolled(-side * angle).T
    aside, forward = side * away[:, 1] + offset, away[:, 0]
    over = (np.abs(aside) < below.half_aside + CLEARANCE) & (np.abs(forward) < below.half_forward + CLEARANCE)
    beside = float((-away[:, 2]).max()) - below.height
    above = float((-away[over, 2]).max()) if over.any() else 0.0
    return max(above, beside) + CLEARANCE


def heights(
    moved: FloatArray, lip: FloatArray, below: Below, angles: FloatArray, *, side: int, offset: float, height: float
) -> FloatArray:
    """Return the lip's height over the top of what is below for each of ``angles``, at least ``height`` [m].

    The lip sinks as the vessel turns and never rises again.
    """
    grid = np.linspace(float(angles.min()), float(angles.max()), STEPS)
    needed = np.array(
        [needed_height(moved, lip, below, side=side, angle=float(a), offset=offset) for a in grid], dtype=np.float64
    )
    falling = np.maximum.accumulate(np.maximum(needed, height)[::-1])[::-1]
    # The greatest of five neighbours, then their mean: smooth, and nowhere less than needed.
    padded = np.concatenate([np.full(4, falling[0]), falling, np.full(4, falling[-1])])
    widest: FloatArray = sliding_window_view(padded, 5).max(axis=1)
    smooth: FloatArray = sliding_window_view(widest, 5).mean(axis=1)
    return np.asarray(np.interp(angles, grid, smooth), dtype=np.float64)
