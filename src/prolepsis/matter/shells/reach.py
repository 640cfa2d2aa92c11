"""What an impact would have come to, had the shell borne it: how far beyond its strength is what breaks it?

The load over the strength is 1 where a bond gives way, whatever the blow. The motion that is left then tells how much
more force, or depth, it would have come to.

Source: a damped linear spring; the energy that a dent takes up under a constant force.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.rotations import cross
from prolepsis.geometry.shape import FloatArray
from prolepsis.scene.running import Running


@dataclass(kw_only=True, slots=True)
class Meeting:
    """What presses on a geom with one body, through one contact or several."""

    force: float = 0.0
    """[N]"""
    stiffness: float = 0.0
    """[N/m]"""
    damping: float = 0.0
    """Damping ratio [1]."""
    mass: float = 0.0
    """What a contact sees of both bodies [kg]."""
    speed: float = 0.0
    """With which they still come closer [m/s]."""

    def peak(self, dt: float) -> float:
        """Return the force to which they come at most [N], in steps of ``dt`` [s]."""
        # What semi-implicit steps keep is the energy less a product of both its parts.
        inert = self.stiffness * self.speed * (self.mass * self.speed - self.force * dt)
        inert = math.sqrt(max(inert, 0.0))
        # It is damped for as long as it still grows.
        return math.hypot(self.force, inert) * math.exp(-self.damping * math.atan2(inert, self.force))


def would_bear(state: Running, geom: int, share: float) -> float:
    """Return the greatest force that would press on a geom over the one at which it has given way [1].

    Args:
        state: The running scene.
        geom: Number of the geom.
        share: Part of what presses now under which it gave way [1].
    """
    dt = float(state.model.opt.timestep)
    return max((met.peak(dt) / met.force for met in _meetings(state, geom)), default=1.0) / share


def would_go_in(state: Running, geom: int, force: float, depth: float) -> float:
    """Return how deep a dent would have become over how deep it is [1].

    Args:
        state: The running scene.
        geom: Number of the geom in which it is.
        force: Force under which it goes in [N].
        depth: How deep it is [m].
    """
    left = max((met.mass * met.speed**2 / 2 for met in _meetings(state, geom)), default=0.0)
    return 1 + left / (force * depth)


def _meetings(state: Running, geom: int) -> Collection[Meeting]:
    model, contact = state.model, state.data.contact
    found: dict[int, Meeting] = {}
    for k, one, two, force in state.normal_forces():
        pair = state.touching()[k]
        if geom not in pair:
            continue
        point, normal = contact.pos[k], contact.frame[k, :3]
        first, second = (state.velocity_at(model.body(body).name, point) for body in (one, two))
        inverse = float(model.body_invweight0[one, 0] + model.body_invweight0[two, 0])
        # MuJoCo's direct form: what the contact does to a body as light as the inverse tells, for each metre and m/s.
        spring, damper = (max(-float(each), 0.0) for each in contact.solref[k])
        met = found.setdefault(two if pair[0] == geom else one, Meeting())
        met.force += force
        met.stiffness += spring / inverse
        met.damping = damper / (2 * math.sqrt(max(spring, 1e-9)))
        met.mass = 1 / sum(_inverse_mass(state, body, point, normal) for body in (one, two))
        met.speed = max(met.speed, float((first - second) @ normal))
    return found.values()


def _inverse_mass(state: Running, body: int, point: FloatArray, normal: FloatArray) -> float:
    """Return what a body gives way at a point to an impulse along a normal [1/kg]."""
    model, data = state.model, state.data
    if model.body_dofnum[body] != 6:
        return float(model.body_invweight0[body, 0])
    turning = data.ximat[body].reshape(3, 3).T @ cross(point - data.xipos[body], normal)
    return float(1 / model.body_mass[body] + np.square(turning) @ (1 / model.body_inertia[body]))
