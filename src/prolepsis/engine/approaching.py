"""Approaching: the shorter the substep, the faster things come together and the thinner they are."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from prolepsis.engine.impacts import usual_solids
from prolepsis.engine.state import State
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.scene.running import MAX_STEP, TICK
from prolepsis.system.mujoco import mujoco

DEEPEST = 2.5e-4
"""So far may things have come into each other when their impact is noticed [m]..."""
SHARE = 0.25
"""... and by this share of the thinner one [1]: from its middle on it would be pushed out on the far side."""
SHORTEST = 1.0e-5
"""Shortest substep [s]: 25 m/s at the greatest depth."""
AHEAD = 2.0 * TICK
"""What is so near in time is looked at [s]."""
FAR = 1.0e6
"""Half of the extents of the ground [m]."""
MOST = 50_000
"""Of so many pairs of a fast body and a solid it is not looked which are near."""


@dataclass(kw_only=True, slots=True)
class Approaching:
    """What is known of the G solids of a model, and the F bodies of them that move freely."""

    usual: BoolArray = field(default_factory=lambda: np.zeros(0, dtype=np.bool_))
    """Whether each solid neither breaks nor comes of what broke: kinds ask for substeps of these, shape (G,)."""
    middle: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    """Middle of the box round each in its frame [m], shape (G, 3)."""
    half: FloatArray = field(default_factory=lambda: np.zeros((0, 3)))
    """Half of the extents of that box [m], shape (G, 3)."""
    thickness: FloatArray = field(default_factory=lambda: np.zeros(0))
    """Least extent [m], shape (G,)."""
    bodies: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    """MuJoCo bodies, shape (F,)."""
    freedoms: IntArray = field(default_factory=lambda: np.zeros((0, 6), dtype=np.int64))
    """Their degrees of freedom, shape (F, 6)."""
    reach: FloatArray = field(default_factory=lambda: np.zeros(0))
    """How far they reach from their centre of mass [m], shape (F,)."""
    arm: FloatArray = field(default_factory=lambda: np.zeros(0))
    """Fastest approach of their surface when they turn on the spot, over how fast they turn [m], shape (F,)."""
    thin: FloatArray = field(default_factory=lambda: np.zeros(0))
    """Thickness of the thinnest solid of each [m], shape (F,)."""
    lever: FloatArray = field(default_factory=lambda: np.zeros(0))
    """By what the velocity of each degree of freedom is multiplied to be one of a surface, shape (nv,)."""

    def bind(self, state: State) -> None:
        """Look up what a model that is new consists of."""
        model = state.model
        self.usual = usual_solids(state)
        self.middle, self.half = model.geom_aabb[:, :3].copy(), model.geom_aabb[:, 3:].copy()
        plane = model.geom_type == int(mujoco.mjtGeom.mjGEOM_PLANE)
        # All that is below it counts as within.
        self.middle[plane], self.half[plane] = (0.0, 0.0, -FAR), FAR
        self.thickness = 2.0 * self.half.min(axis=1)
        body = model.geom_bodyid
        away = np.linalg.norm(model.geom_pos - model.body_ipos[body], axis=1)
        reach, thin = np.zeros(model.nbody), np.full(model.nbody, np.inf)
        np.maximum.at(reach, body, away + model.geom_rbound)
        np.minimum.at(thin, body, self.thickness)
        # What is round about its centre of mass does not approach anything by turning.
        inner = np.zeros(model.nbody)
        alone = np.bincount(body, minlength=model.nbody)[body] == 1
        inner[body[alone]] = np.maximum(self.thickness[alone] / 2.0 - away[alone], 0.0)
        free = np.flatnonzero(model.jnt_type == int(mujoco.mjtJoint.mjJNT_FREE))
        freedoms = model.jnt_dofadr[free, None] + np.arange(6)
        lever: FloatArray = np.ones(int(model.nv))
        lever[freedoms[:, 3:]] = reach[model.jnt_bodyid[free], None]
        self.lever = lever
        solid = np.zeros(model.nbody, dtype=np.bool_)
        solid[body[self.usual]] = True
        chosen = solid[model.jnt_bodyid[free]]
        self.freedoms, self.bodies = freedoms[chosen], model.jnt_bodyid[free[chosen]].astype(np.int64)
        self.reach, self.thin = reach[self.bodies], thin[self.bodies]
        self.arm = np.sqrt(np.maximum(self.reach**2 - np.minimum(inner[self.bodies], self.reach) ** 2, 0.0))
        self.arm += np.linalg.norm(model.body_ipos[self.bodies], axis=1)

    def longest_step(self, state: State) -> float:
        """Return the longest substep with which what is about to meet does not go into each other too far [s]."""
        if not len(self.bodies):
            return MAX_STEP
        velocity = state.data.qvel[self.freedoms]
        linear = velocity[:, :3]
        turning = np.sqrt(np.square(velocity[:, 3:]).sum(axis=1)) * self.arm
        speed = np.sqrt(np.square(linear).sum(axis=1)) + turning
        fast = np.flatnonzero(speed > DEEPEST / TICK)
        if not len(fast):
            return MAX_STEP
        if len(fast) * len(self.usual) > MOST:
            allowed = min(DEEPEST, SHARE * float(self.thickness.min())) / float(speed.max())
        else:
            allowed = self._allowed(state, fast, linear, turning)
        return min(max(allowed, SHORTEST), MAX_STEP)

    def _allowed(self, state: State, fast: IntArray, linear: FloatArray, turning: FloatArray) -> float:
        """Return how long some of the bodies take to go as far into what is near as they may [s].

        Args:
            state: Now.
            fast: Which of the bodies.
            linear: Velocities of all of them [m/s], shape (F, 3).
            turning: How fast the surface of each approaches something as it turns [m/s], shape (F,).
        """
        model, data = state.model, state.data
        moving, spinning = np.zeros((model.nbody, 3)), np.zeros(model.nbody)
        moving[self.bodies], spinning[self.bodies] = linear, turning
        body, own = model.geom_bodyid, self.bodies[fast]
        rotation = data.geom_xmat.reshape(-1, 3, 3)
        # As seen from the box round each solid.
        away = np.einsum("gji,fgj->fgi", rotation, data.xipos[own][:, None] - data.geom_xpos) - self.middle
        beyond = away - np.clip(away, -self.half, self.half)
        distance = np.sqrt(np.square(beyond).sum(axis=2))
        relative = np.einsum("gji,fgj->fgi", rotation, linear[fast][:, None] - moving[body])
        closing = -(relative * beyond).sum(axis=2) / np.maximum(distance, 1e-12)
        within = distance < 1e-9
        closing[within] = np.sqrt(np.square(relative[within]).sum(axis=1))
        closing = np.maximum(closing, 0.0)
        closing += turning[fast][:, None] + spinning[body]
        near = (
            self.usual
            & (closing > 0.0)
            & (body != own[:, None])
            & (distance - self.reach[fast][:, None] < AHEAD * closing)
        )
        if not near.any():
            return MAX_STEP
        allowed = SHARE * np.minimum(self.thin[fast][:, None], self.thickness)
        pairs = np.unique(np.sort(body[data.contact.geom], axis=1) @ (model.nbody, 1))
        touching = np.isin(np.minimum(own[:, None], body) * model.nbody + np.maximum(own[:, None], body), pairs)
        allowed = np.where(touching, allowed, np.minimum(allowed, DEEPEST))
        return float((allowed[near] / closing[near]).min())
