"""The particles of all liquids in a running simulation, as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

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
    """How much the cosine of the contact angle may rise before an edge draws back [1], shape (P,)."""
    spacing: float
    """Distance of neighbours at rest [m]."""

    @property
    def free(self) -> BoolArray:
        """Whether each particle flows, shape (P,)."""
        return self.holder == FREE
