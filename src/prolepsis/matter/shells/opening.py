"""Opening: what an egg has inside goes with it until its shell falls apart, and then goes on as it did."""

from __future__ import annotations

import numpy as np

from prolepsis.geometry.solids import matrix
from prolepsis.log.log import FREE
from prolepsis.log.things import Thing
from prolepsis.matter.shells.shelled import Shell
from prolepsis.scene.kind import Controller
from prolepsis.scene.running import Running


def start(state: Running) -> list[Opening]:
    """Return a controller for each shell that encloses particles."""
    if state.particles is None:
        return []
    holders = set(state.particles.holder.tolist())
    wholes = [state.scene.thing(shell.whole) for shell in state.scene.each(Shell)]
    return [Opening(state, whole) for whole in wholes if state.scene.index(whole.name) in holders]


class Opening(Controller):
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
        state.particles.home[self._inside] = self._places
        self._pose, self._motion = state.pose(thing.name), np.zeros(6)

    def bind(self, state: Running) -> None:
        """Look up what it needs in a model that is new."""
        if state.carrier[self._index] >= 0:
            joint = state.model.joint(self._name)
            place, speed = int(joint.qposadr[0]), int(joint.dofadr[0])
            self._now = state.data.qpos[place : place + 7], state.data.qvel[speed : speed + 6]

    def end_tick(self, state: Running) -> None:
        """Let out what is inside where the shell has fallen apart."""
        particles = state.particles
        if particles is None or not len(self._inside):
            return
        if state.carrier[self._index] >= 0:
            self._pose, self._motion = self._now[0].copy(), self._now[1].copy()
            return
        turn = matrix(self._pose[3:])
        arms = self._places @ turn.T
        particles.position[self._inside] = self._pose[:3] + arms
        # Shells break in an impact: what is inside goes on as fast as it was before.
        particles.velocity[self._inside] = self._motion[:3] + np.cross(turn @ self._motion[3:], arms)
        particles.holder[self._inside] = FREE
        self._inside = self._inside[:0]
