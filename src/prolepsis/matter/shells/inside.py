"""What is inside a shell: it goes with the shell until that falls apart; the membrane of a yolk holds it together then.

The particles of an intact yolk are drawn towards the shape that they had in the egg, turned and moved as they are now:
so it flattens where it lands, and springs back.

Source:
    Müller, Heidelberger, Teschner and Gross, Meshless deformations based on shape matching, SIGGRAPH (2005).
"""

from __future__ import annotations

import math

import numpy as np

from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.log.happenings import detachment
from prolepsis.log.log import FREE
from prolepsis.matter.shells.crushing_front import CrushingFront
from prolepsis.matter.shells.parts import Membraned
from prolepsis.matter.shells.yielding import ShellPadding
from prolepsis.scene.kind import Controller
from prolepsis.scene.running import MAX_STEP, Running


class Opening(Controller):
    """The controller of what is inside one breakable thing."""

    def __init__(self, state: Running, name: str, padding: ShellPadding) -> None:
        """Look after the particles that the thing called ``name`` holds, and which comes out of its ``padding``."""
        assert state.particles is not None
        self._padding = padding
        self._name = name
        self._index = state.scene.index(name)
        self._inside = np.flatnonzero(state.particles.holder == self._index)
        body = state.data.body(name)
        rotation = body.xmat.reshape(3, 3)
        self._positions = (state.particles.position[self._inside] - body.xpos) @ rotation
        state.particles.home[self._inside] = self._positions
        self._pose, self._motion = state.pose(name), np.zeros(6)

    def bind(self, state: Running) -> None:
        """Look up what it needs in a model that is new."""
        if state.carrier[self._index] >= 0:
            joint = state.model.joint(self._name)
            coordinate, speed = int(joint.qposadr[0]), int(joint.dofadr[0])
            self._now = state.data.qpos[coordinate : coordinate + 7], state.data.qvel[speed : speed + 6]

    def end_tick(self, state: Running) -> None:
        """Let out what is inside where the shell has fallen apart."""
        particles = state.particles
        if particles is None or not len(self._inside):
            return
        if state.carrier[self._index] >= 0:
            self._pose, self._motion = self._now[0].copy(), self._now[1].copy()
            return
        rotation = matrix(self._pose[3:])
        arms = self._positions @ rotation.T
        particles.position[self._inside] = self._pose[:3] + self._padding.lifted + arms
        # Shells break in an impact: what is inside goes on as fast as it was before.
        velocity = self._motion[:3] + self._padding.stopped
        particles.velocity[self._inside] = velocity + np.cross(rotation @ self._motion[3:], arms)
        particles.holder[self._inside] = FREE
        self._inside = self._inside[:0]


WOBBLE = 40.0
"""Angular frequency with which a yolk quivers [rad/s]: under its weight it sinks by g / w^2, a fifth of its height."""


class Membrane(Controller):
    """The controller of one yolk."""

    def __init__(self, state: Running, stuff: Membraned, front: CrushingFront) -> None:
        """Look after the particles of a stuff, which edges of its shell pierce where a ``front`` reaches it."""
        assert state.particles is not None
        self._front: CrushingFront | None = front
        self._name = stuff.name
        self._index = state.scene.index(stuff.name)
        own = np.flatnonzero(state.particles.stuff == self._index)
        self._first, last = int(own[0]), int(own[-1])
        # As a slice they are reached ten times faster.
        self._own: IntArray | slice = slice(self._first, last + 1) if len(own) == last + 1 - self._first else own
        positions = state.particles.position[self._own]
        self._rest = positions - positions.mean(axis=0)
        self._positions, self._push = np.zeros_like(positions), np.zeros_like(positions)
        self.strength = stuff.force / (2 * math.pi * stuff.probe_radius)
        """Tension at which it tears: the probe's force over its rim [N/m]."""
        volume = float(state.particles.volume[self._own].sum())
        self._radius = (3 * volume / (4 * math.pi)) ** (1 / 3)
        self.tension = 0.0
        """Tension round the yolk [N/m]."""
        self.broken = False

    def end_tick(self, state: Running) -> None:
        """Hold the yolk together, or tear."""
        particles = state.particles
        if self.broken or particles is None or particles.holder[self._first] != FREE:
            return
        positions = particles.position[self._own].copy()
        front, self._front = self._front, None
        pierced = front.pierces(state, positions.mean(axis=0), self._radius) if front else 0.0
        if front and pierced >= 1.0:
            state.set_attribute(self._name, "membrane_load", pierced)
            self._tear(state, front.force)
            return
        if np.array_equal(positions, self._positions):
            # A step of the liquid takes several ticks.
            particles.velocity[self._own] += self._push
            return
        middle = positions.mean(axis=0)
        pull = WOBBLE**2 * (middle + self._rest @ _best_rotation(self._rest, positions - middle).T - positions)
        mass = particles.mass[self._own]
        # Halves of the yolk pull on each other through the membrane round its middle.
        force = float(mass @ np.linalg.norm(pull, axis=1)) / 2
        self.tension = force / (2 * math.pi * self._radius)
        if self.tension > self.strength:
            # What the tension would have come to nobody knows: it is as it was.
            self._tear(state, force)
            return
        state.set_attribute(self._name, "membrane_load", max(self.tension / self.strength, pierced))
        self._positions, self._push = positions, MAX_STEP * pull
        particles.velocity[self._own] += self._push

    def _tear(self, state: Running, force: float) -> None:
        self.broken = True
        state.set_attribute(self._name, "broken", 1.0)
        state.report(detachment(self._index, self._index, self._index, force))


def _best_rotation(rest: FloatArray, now: FloatArray) -> FloatArray:
    """Return the rotation that brings one set of points nearest to another, both about their middle, shape (3, 3)."""
    u, _, v = np.linalg.svd(now.T @ rest)
    u[:, 2] *= np.sign(np.linalg.det(u @ v))
    return u @ v
