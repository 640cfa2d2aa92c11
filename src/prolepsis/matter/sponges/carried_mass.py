"""A rigid body that takes up liquid becomes heavier, and is slowed down by what it takes up."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.scene.running import Running


class CarriedMass:
    """The mass of one free body with what it has taken up, which is spread evenly in it."""

    def __init__(self, name: str, mass: float) -> None:
        """Look after the body of a given name and own mass [kg]."""
        self._name = name
        self._own = mass
        self._now = mass

    def set(self, state: Running, carried: float) -> None:
        """Make the body as heavy as itself and what it carries [kg]."""
        model: Any = state.model
        heavier = self._own + carried
        if heavier == self._now:
            return
        body = model.body(self._name).id
        factor = heavier / self._now
        model.body_mass[body] *= factor
        model.body_inertia[body] *= factor
        # What MuJoCo derives from these when it compiles a model.
        model.body_subtreemass[body] *= factor
        model.body_subtreemass[0] += heavier - self._now
        model.body_invweight0[body] /= factor
        dofs = slice(model.body_dofadr[body], model.body_dofadr[body] + model.body_dofnum[body])
        model.dof_invweight0[dofs] /= factor
        model.dof_M0[dofs] *= factor
        self._now = heavier

    def bind(self) -> None:
        """Begin with a model that was rebuilt: it knows the own mass only."""
        self._now = self._own

    def collide(self, state: Running, positions: FloatArray, velocity: FloatArray, mass: FloatArray) -> None:
        """Give the body the momentum, linear and angular, of particles that become a part of it; call before ``set``.

        Args:
            state: The simulation; the body moves freely.
            positions: World frame [m], shape (n, 3).
            velocity: [m/s], shape (n, 3).
            mass: [kg], shape (n,).
        """
        model, data = state.model, state.data
        body = model.body(self._name).id
        first = model.body_dofadr[body]
        centre, rotation = data.xipos[body], data.ximat[body].reshape(3, 3)
        frame = data.xmat[body].reshape(3, 3)
        spin = frame @ data.qvel[first + 3 : first + 6]
        middle = data.qvel[first : first + 3] + np.cross(spin, centre - data.xpos[body])
        arms = positions - centre
        impulses = mass[:, None] * (velocity - middle)
        # The whole that results is as much heavier, and evenly so.
        factor = (self._now + float(mass.sum())) / self._now
        push = impulses.sum(axis=0) / (model.body_mass[body] * factor)
        kick = np.cross(arms, impulses).sum(axis=0)
        twist = rotation @ (rotation.T @ kick / (model.body_inertia[body] * factor)) + spin * (1 / factor - 1)
        data.qvel[first : first + 3] += push + np.cross(twist, data.xpos[body] - centre)
        data.qvel[first + 3 : first + 6] += frame.T @ twist
