"""How a hand turns: a course of angles that starts and ends gently, and rotations as matrices."""

from __future__ import annotations

import numpy as np

from prolepsis.geometry.shape import FloatArray, Quaternion

TICK = 1.0e-3
"""Period of the commands [s]."""
EASING = 0.2
"""Time in which a turn reaches its rate, and in which it ends [s]."""


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


def matrix(orientation: Quaternion) -> FloatArray:
    """Return the rotation matrix of a unit quaternion (w, x, y, z), shape (3, 3)."""
    w, x, y, z = orientation
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def rolled(angle: float) -> FloatArray:
    """Return the rotation matrix of a roll about x by ``angle`` [rad], shape (3, 3)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
