"""The particles of a running scene, as plain arrays: what flows consists of them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.log import FREE

PERIOD = 20
"""Ticks from one frame to the next: what a person sees of a liquid takes longer."""


@dataclass(kw_only=True, slots=True)
class ParticleState:
    """P particles. None is ever added or taken away; kinds of matter change where they are and what holds them."""

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
    home: FloatArray
    """Where each is in the frame of the thing that holds it [m], shape (P, 3); of no meaning for others."""
    spacing: float
    """Distance of neighbours at rest [m]."""
    behind: float = 0.0
    """Time since their last step [s]; the bodies are that much ahead."""
    rider: npt.NDArray[np.int16] = field(init=False)
    """Index of the soft thing that has ridden up on each, so that it lies as a film between that and what it is on; -1
    for none, as at the start, shape (P,)."""
    columns: dict[str, FloatArray] = field(default_factory=dict[str, FloatArray])
    """What kinds of matter know of them beside, by name, each of shape (P,): temperature, share of milk ..."""

    def __post_init__(self) -> None:
        """Let nothing ride on any of them yet."""
        self.rider = np.full(len(self.mass), -1, dtype=np.int16)

    def now(self) -> FloatArray:
        """Return where they are by now if they have gone on as in their last step, shape (P, 3)."""
        return self.position + self.behind * self.free[:, None] * self.velocity

    def holds(self, thing: int) -> bool:
        """Return whether a thing, given by its index, holds any."""
        return bool((self.holder == thing).any())

    @property
    def free(self) -> BoolArray:
        """Whether each particle flows, shape (P,)."""
        return self.holder == FREE
