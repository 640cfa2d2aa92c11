"""Small loops over the particles of a run, for which numpy takes ten times as long."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.log.log import FREE
from prolepsis.system.kernels import njit


@njit(cache=True)
def put(target: FloatArray, ids: IntArray, rows: FloatArray) -> None:
    """Write rows of three to where they belong; numpy takes ten times as long."""
    for k in range(len(ids)):
        for c in range(3):
            target[ids[k], c] = rows[k, c]


@njit(cache=True)
def greatest_speed(velocity: FloatArray, holder: npt.NDArray[np.int16]) -> float:
    """Return the speed of the fastest free particle [m/s], 0 if there is none."""
    greatest = 0.0
    for i in range(len(velocity)):
        if holder[i] == FREE:
            x, y, z = velocity[i, 0], velocity[i, 1], velocity[i, 2]
            greatest = max(greatest, x * x + y * y + z * z)
    return math.sqrt(greatest)


@njit(cache=True)
def pressure_wave(impulse: FloatArray, mass: FloatArray, holder: npt.NDArray[np.int16], lasted: float) -> float:
    """Return the speed ``sqrt(p / rho)`` where the free particles' pressure is high [m/s], 0 if there is none.

    The pressure at the bottom of a liquid at rest is half as much again as the mean that is weighted by itself.

    Args:
        impulse: Pressure impulses of the last step [N s m], shape (n,).
        mass: [kg], shape (n,).
        holder: Who holds each, shape (n,).
        lasted: Length of that step [s].
    """
    total, squares = 0.0, 0.0
    for i in range(len(impulse)):
        if holder[i] == FREE and impulse[i] > 0.0:
            square = impulse[i] / (lasted * mass[i])
            total += square
            squares += square * square
    return math.sqrt(1.5 * squares / total) if total > 0.0 else 0.0


@njit(cache=True)
def first_beyond(position: FloatArray, holder: npt.NDArray[np.int16], centre: FloatArray, reach: float) -> int:
    """Return the first free particle that is further than ``reach`` [m] from ``centre``, or nowhere; -1 for none."""
    for i in range(len(position)):
        if holder[i] == FREE:
            x, y, z = position[i, 0] - centre[0], position[i, 1] - centre[1], position[i, 2] - centre[2]
            if not x * x + y * y + z * z <= reach * reach:
                return i
    return -1
