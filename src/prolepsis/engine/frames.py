"""Frames of the liquids: where every particle is, each few ticks."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from prolepsis.engine.state import State
from prolepsis.log.log import Particles
from prolepsis.log.particle_tables import rounded
from prolepsis.scene.particles import PERIOD


@dataclass(kw_only=True)
class Frames:
    """Copies of the particles, in the order of time."""

    ticks: list[int] = field(default_factory=list[int])
    positions: list[npt.NDArray[np.float32]] = field(default_factory=list["npt.NDArray[np.float32]"])
    holders: list[npt.NDArray[np.int16]] = field(default_factory=list["npt.NDArray[np.int16]"])

    def tick(self, state: State, tick: int) -> None:
        """Copy the particles, if it is time."""
        if state.particles is None or tick % PERIOD:
            return
        self.ticks.append(tick)
        self.positions.append(rounded(state.particles.now()))
        self.holders.append(state.particles.holder.copy())

    def columns(self, state: State) -> Particles:
        """Return the frames as columns of the log."""
        particles = state.particles
        if particles is None or not self.ticks:
            return Particles()
        return Particles(
            tick=np.array(self.ticks),
            position=np.stack(self.positions),
            holder=np.stack(self.holders),
            stuff=particles.stuff.copy(),
            mass=particles.mass.copy(),
            volume=particles.volume.copy(),
            spacing=particles.spacing,
        )
