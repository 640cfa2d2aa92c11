"""Motion from rest to rest, with the least jerk or at a steady rate: how far it has come at each tick."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.scene.running import TICK

PEAK_SPEED, PEAK_ACCELERATION = 1.875, 5.7735
"""Greatest speed and acceleration of the profile, over displacement / time and displacement / time^2 [1]."""
EASING = 0.2
"""Time in which a turn reaches its rate, and in which it ends [s]."""
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


def course(start: float, end: float, rate: float) -> FloatArray:
    """Return the angles [rad], one a tick after ``start``, to ``end`` at up to ``rate`` [rad/s]."""
    away = abs(end - start)
    if away == 0.0:
        return np.array([end])
    easing = min(EASING, away / rate)
    # The speed rises and falls along a smooth step, so that easing in and out covers half the angle of full speed.
    time = np.arange(0.5, max(round((away / rate + easing) / TICK), 1)) * TICK
    share = np.clip(np.minimum(time, time[::-1]) / easing, 0.0, 1.0)
    speed: FloatArray = share * share * (3.0 - 2.0 * share)
    return start + (end - start) * np.cumsum(speed) / speed.sum()
