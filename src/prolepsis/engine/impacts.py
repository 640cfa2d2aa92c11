"""Impacts: what comes together fast parts again as fast as its materials allow, and what slides does not lift off.

MuJoCo's contacts are springs, and an impact of hard things is over before a substep is. So it is one substep here:
the normal velocity of each contact becomes minus its restitution times what it was (Newton's law), while friction
takes from the tangential one what Coulomb's cone allows. MuJoCo's cone is convex: it lifts what slides by friction
times what is left of the tangential acceleration (Anitescu 2006, Todorov 2014). That is taken out again.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from prolepsis.engine.softening import Softening
from prolepsis.engine.state import State
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.things import falling_apart
from prolepsis.system.mujoco import mujoco

FAST = 0.01
"""While nothing moves faster, there are neither impacts nor slips to speak of [m/s, rad/s]."""
HITS = 0.1
"""A slower approach is no impact [m/s]: what falls by half a millimetre does not bounce."""
SLIDES = 0.005
"""A slower slip lifts nothing by more than a micrometre [m/s]."""
MATERIAL = {"restitution": 0.0, "restitutionSpeed": 1.0, "restitutionExponent": 0.0, "youngsModulus": np.nan}
"""What counts of a material, and what it is if it is not known."""
PASSES = 5
"""How often the forces of an impact are found anew; each time about a tenth of what they lift too much is left."""


@dataclass(kw_only=True, slots=True)
class Impacts:
    """What is known of the G solids of a model."""

    usual: BoolArray = field(default_factory=lambda: np.zeros(0, dtype=np.bool_))
    """Whether each neither breaks nor comes of what broke: such contacts have laws of their own, shape (G,)."""
    restitution: FloatArray = field(default_factory=lambda: np.zeros(0))
    """Of its material [1], shape (G,)."""
    speed: FloatArray = field(default_factory=lambda: np.zeros(0))
    """At which that was measured [m/s], shape (G,)."""
    exponent: FloatArray = field(default_factory=lambda: np.zeros(0))
    """Power of the speed with which it falls [1], shape (G,)."""
    modulus: FloatArray = field(default_factory=lambda: np.zeros(0))
    """Young's modulus, NaN if it is not known [Pa], shape (G,)."""

    def bind(self, state: State) -> None:
        """Look up what a model that is new consists of."""
        known = [each.quantities for each in state.scene.things]
        rows = [[each.get(name, default) for name, default in MATERIAL.items()] for each in known]
        # A body that is no thing has index -1.
        table = np.array([*rows, [*MATERIAL.values()]])[state.body_thing[state.model.geom_bodyid]]
        self.restitution, self.speed, self.exponent, self.modulus = table.T
        self.usual = usual_solids(state)

    def step(self, model: Any, data: Any, softening: Softening, *, hits: bool) -> bool:
        """Make one substep, in which things may hit each other or slide if ``hits``; return whether some do hit."""
        mujoco.mj_step1(model, data)
        if softening.applies:
            softening.soften(model, data)
        hit = bool(hits and data.ncon) and self._meet(model, data)
        mujoco.mj_step2(model, data)
        return hit

    def _meet(self, model: Any, data: Any) -> bool:
        """Let what hits rebound, and what slides stay down; return whether something hits."""
        contact, velocity = data.contact, data.efc_vel
        address, pair = contact.efc_address, contact.geom
        chosen = np.flatnonzero((address >= 0) & self.usual[pair[:, 0]] & self.usual[pair[:, 1]])
        row = address[chosen]
        normal, first, second = velocity[row], velocity[row + 1], velocity[row + 2]
        slip = np.sqrt(first * first + second * second)
        hits, slides, sought = normal < -HITS, slip > SLIDES, data.efc_aref
        if hits.any():
            step = float(model.opt.timestep)
            rebound = self._rebound(pair[chosen[hits]], -normal[hits])
            sought[row[hits]] = -(1.0 + rebound) * normal[hits] / step
            # What is parting may be stopped by what hits elsewhere.
            parting = normal > 0.0
            sought[row[parting]] = -normal[parting] / step
            sought[row + 1], sought[row + 2] = -first / step, -second / step
            _settle(model, data, row)
        elif slides.any():
            some = row[slides]
            sought[some] -= contact.friction[chosen[slides], 0] * data.efc_KBIP[some, 1] * slip[slides]
        return bool(hits.any())

    def _rebound(self, pair: IntArray, speed: FloatArray) -> FloatArray:
        """Return the restitution of pairs of solids, shape (C, 2), as of two springs in series [1], shape (C,).

        Each gives back its share of the energy that it stores, and they store it in the inverse ratio of their moduli.
        They meet at a ``speed`` [m/s], shape (C,).
        """
        modulus = self.modulus[pair]
        faster = (speed[:, None] / self.speed[pair]) ** -self.exponent[pair]
        returned = np.square(np.minimum(self.restitution[pair] * faster, 1.0))
        share = modulus[:, 1] / modulus.sum(axis=1)
        # Of what is not known, both store the same.
        share[np.isnan(share)] = 0.5
        return np.sqrt(share * returned[:, 0] + (1.0 - share) * returned[:, 1])


def usual_solids(state: State) -> BoolArray:
    """Return which solids of a model neither break nor come of what broke, those of no thing included, shape (G,)."""
    things = state.scene.things
    brittle = falling_apart(things)
    # A body that is no thing has index -1.
    usual = np.array([*(not each.emerges and each.name not in brittle for each in things), True])
    return usual[state.body_thing[state.model.geom_bodyid]]


def _settle(model: Any, data: Any, row: IntArray) -> None:
    """Find forces with which contacts, given by their first rows, part as fast as sought, but not faster.

    They part faster only where nothing presses.
    """
    mujoco.mj_fwdActuation(model, data)
    mujoco.mj_fwdAcceleration(model, data)
    wanted, found = data.efc_aref[row].copy(), np.zeros(data.nefc)
    for _ in range(PASSES):
        mujoco.mj_fwdConstraint(model, data)
        mujoco.mj_mulJacVec(model, data, found, data.qacc)
        pressing = data.efc_force[row] > 0.0
        data.efc_aref[row[pressing]] += (wanted - found[row])[pressing]


def moves(state: State) -> bool:
    """Return whether something moves so fast that there may be impacts or slips."""
    velocity = state.data.qvel
    return not float(velocity.dot(velocity)) < FAST * FAST
