"""The particles of all liquids in a running simulation, as plain arrays."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from prolepsis.kernels import njit
from prolepsis.log import FREE
from prolepsis.things import BoolArray, FloatArray, IntArray


@dataclass(kw_only=True, slots=True)
class ParticleState:
    """P particles. None is ever added or taken away; phenomena change where they are and what holds them."""

    position: FloatArray
    """World frame [m], shape (P, 3)."""
    velocity: FloatArray
    """World frame [m/s], shape (P, 3)."""
    holder: npt.NDArray[np.int16]
    """``FREE``, ``PARKED`` or the index of the thing that a particle is within, shape (P,)."""
    stuff: IntArray
    """Index of the thing that each is of, shape (P,)."""
    mass: FloatArray
    """[kg], shape (P,)."""
    volume: FloatArray
    """[m^3], shape (P,)."""
    viscosity: FloatArray
    """[Pa s], shape (P,)."""
    tension: FloatArray
    """Surface tension [N/m], shape (P,)."""
    wetting: FloatArray
    """Cosine of the contact angle on walls [1], shape (P,)."""
    pinning: FloatArray
    """How much the cosine of the contact angle may differ before an edge moves [1], shape (P,)."""
    spacing: float
    """Distance of neighbours at rest [m]."""
    behind: float = 0.0
    """Time since their last step [s]; the bodies are that much ahead."""

    def now(self) -> FloatArray:
        """Return where they are by now if they have gone on as in their last step, shape (P, 3)."""
        return self.position + self.behind * self.free[:, None] * self.velocity

    @property
    def free(self) -> BoolArray:
        """Whether each particle flows, shape (P,)."""
        return self.holder == FREE


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
def first_beyond(position: FloatArray, holder: npt.NDArray[np.int16], centre: FloatArray, reach: float) -> int:
    """Return the first free particle that is further than ``reach`` [m] from ``centre``, or nowhere; -1 for none."""
    for i in range(len(position)):
        if holder[i] == FREE:
            x, y, z = position[i, 0] - centre[0], position[i, 1] - centre[1], position[i, 2] - centre[2]
            if not x * x + y * y + z * z <= reach * reach:
                return i
    return -1
