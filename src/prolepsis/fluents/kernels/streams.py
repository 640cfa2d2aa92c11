"""Which particles leave a vessel for good and when, found by going through the frames once."""

from __future__ import annotations

import numpy as np

from prolepsis.geometry.shape import BoolArray, IntArray
from prolepsis.system.kernels import njit


@njit(cache=True)
def departures(within: BoolArray, near: BoolArray, loose: BoolArray) -> IntArray:
    """Return the (frame, particle) of each departure: last seen within, and then seen away. Shape (D, 2).

    What is near, at the rim, has not made up its mind; what is taken up by a body did not leave.

    Args:
        within: Shape (F, P).
        near: Shape (F, P), true wherever ``within`` is.
        loose: Particles that flow, shape (F, P).
    """
    frame_count, count = within.shape
    found = np.empty((frame_count * count // 2 + 1, 2), dtype=np.int64)
    number = 0
    for p in range(count):
        last = -1
        for f in range(frame_count):
            if not loose[f, p]:
                last = -1
            elif within[f, p]:
                last = f
            elif last >= 0 and not near[f, p]:
                found[number, 0], found[number, 1] = last, p
                number += 1
                last = -1
    return found[:number].copy()


@njit(cache=True)
def arrivals(at: IntArray) -> IntArray:
    """Return the (frame, particle, whence) of each arrival at another location than the last one. Shape (A, 3).

    Args:
        at: Number of the location of each particle in each frame, -1 for the air between, shape (F, P).
    """
    frame_count, count = at.shape
    found = np.empty((frame_count * count + 1, 3), dtype=np.int64)
    number = 0
    for p in range(count):
        last = -2
        for f in range(frame_count):
            location = at[f, p]
            if location < 0:
                # What starts in the air comes from nowhere.
                if f == 0:
                    last = -1
                continue
            if last != location:
                if last > -2:
                    found[number, 0], found[number, 1], found[number, 2] = f, p, last
                    number += 1
                last = location
    return found[:number].copy()
