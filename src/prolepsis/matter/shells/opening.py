"""Opening: what an egg has inside goes with it until its shell falls apart, and then goes on as it did."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from prolepsis.geometry.solids import matrix
from prolepsis.log.log import FREE
from prolepsis.log.things import Thing
from prolepsis.matter.phenomenon import Draw, Phenomenon
from prolepsis.scene.particles import PERIOD
from prolepsis.scene.running import Running


def attach(state: Running, draw: Draw) -> Sequence[Phenomenon]:
    """Return a controller for each thing that encloses particles and may break."""
    del draw
    particles = state.particles
    if particles is None:
        return []
    things = state.scene.things
    holders = set(particles.holder.tolist())
    return [Opening(state, thing) for i, thing in enumerate(things) if i in holders and "Breakable" in thing.roles]


class Opening(Phenomenon):
    """The controller of what is inside one breakable thing."""

    def __init__(self, state: Running, thing: Thing) -> None:
        """Attach to a thing that holds particles."""
        assert state.particles is not None
        self._name = thing.name
        self._index = state.scene.index(thing.name)
        self._inside = np.flatnonzero(state.particles.holder == self._index)
        body = state.data.body(thing.name)
        turn = body.xmat.reshape(3, 3)
        self._places = (state.particles.position[self._inside] - body.xpos) @ turn
        self._version = -1
        self._pose, self._motion = state.pose(thing.name), np.zeros(6)
        self._ticks = 0

    def tick(self, state: Running) -> None:
        """Carry what is inside, or let it out."""
        particles = state.particles
        if particles is None or not len(self._inside):
            return
        self._ticks += 1
        if state.carrier[self._index] >= 0:
            if self._version != state.version:
                self._version = state.version
                joint = state.model.joint(self._name)
                place, speed = int(joint.qposadr[0]), int(joint.dofadr[0])
                self._now = state.data.qpos[place : place + 7], state.data.qvel[speed : speed + 6]
            self._pose, self._motion = self._now[0].copy(), self._now[1].copy()
            if self._ticks % PERIOD == 0:
                particles.position[self._inside] = self._pose[:3] + self._places @ matrix(self._pose[3:]).T
            return
        turn = matrix(self._pose[3:])
        arms = self._places @ turn.T
        particles.position[self._inside] = self._pose[:3] + arms
        # Shells break in an impact: what is inside goes on as fast as it was before.
        particles.velocity[self._inside] = self._motion[:3] + np.cross(turn @ self._motion[3:], arms)
        particles.holder[self._inside] = FREE
        self._inside = self._inside[:0]
