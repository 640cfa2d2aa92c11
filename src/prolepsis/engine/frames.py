"""Frames of the liquids: where every particle is, each few ticks."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from prolepsis.engine.state import State
from prolepsis.geometry.shape import FloatArray
from prolepsis.geometry.solids import matrix
from prolepsis.log.log import Particles
from prolepsis.log.particle_tables import rounded
from prolepsis.scene.particles import PERIOD, ParticleState


@dataclass(kw_only=True)
class Frames:
    """Copies of the particles, in the order of time."""

    ticks: list[int] = field(default_factory=list[int])
    positions: list[npt.NDArray[np.float32]] = field(default_factory=list["npt.NDArray[np.float32]"])
    columns: list[dict[str, npt.NDArray[np.float32]]] = field(
        default_factory=list["dict[str, npt.NDArray[np.float32]]"]
    )
    holders: list[npt.NDArray[np.int16]] = field(default_factory=list["npt.NDArray[np.int16]"])

    def tick(self, state: State, tick: int) -> None:
        """Copy the particles, if it is time."""
        if state.particles is None or tick % PERIOD:
            return
        self.ticks.append(tick)
        self.positions.append(rounded(_places(state, state.particles)))
        self.holders.append(state.particles.holder.copy())
        self.columns.append({name: column.astype(np.float32) for name, column in state.particles.columns.items()})

    def table(self, state: State) -> Particles:
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
            columns={name: np.stack([row[name] for row in self.columns]) for name in self.columns[0]},
            spacing=particles.spacing,
        )


def _places(state: State, particles: ParticleState) -> FloatArray:
    """Return where all particles are by now [m], shape (P, 3): those that are held are where what holds them is."""
    places = particles.now()
    holders: list[int] = np.unique(particles.holder[particles.holder >= 0]).tolist()
    for holder in holders:
        pose, held = state.pose(state.scene.things[holder].name), particles.holder == holder
        places[held] = pose[:3] + particles.home[held] @ matrix(pose[3:]).T
    return places
