"""Motion from rest to rest with the least jerk: how long it takes, and how far it has come at each tick."""

from __future__ import annotations

from collections.abc import Iterator

from prolepsis.geometry.shape import FloatArray
from prolepsis.programs.turning import TICK

PEAK_SPEED, PEAK_ACCELERATION = 1.875, 5.7735
"""Greatest speed and acceleration of the profile, over displacement / time and displacement / time^2 [1]."""
SHORTEST = 0.05
"""Joints take at least this long [s]."""


def least_time(displacements: FloatArray, speeds: FloatArray, accelerations: FloatArray) -> float:
    """Return the least time in which all go their displacements within their greatest speeds and accelerations [s]."""
    by_speed = float((PEAK_SPEED * displacements / speeds).max())
    by_acceleration = float((PEAK_ACCELERATION * displacements / accelerations).max()) ** 0.5
    return max(by_speed, by_acceleration, SHORTEST)


def least_jerk(duration: float) -> Iterator[tuple[float, float]]:
    """Yield the share of the displacement [1] and its rate of change [1/s] at each tick over ``duration`` [s]."""
    count = max(round(duration / TICK), 1)
    for k in range(1, count + 1):
        s = k / count
        yield s**3 * (10 - 15 * s + 6 * s * s), 30 * s * s * (1 - s) ** 2 / (count * TICK)
