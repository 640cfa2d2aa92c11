"""Stretches of a run in which the model stays the same: what can touch what, what moves freely, what is driven."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from prolepsis.geometry.rotations import rotate, rotate_back, rotation_vectors
from prolepsis.geometry.shape import BoolArray, FloatArray, Geom, IntArray
from prolepsis.log.things import Thing
from prolepsis.system.mujoco import mujoco


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Movers:
    """What the n things of a run are while the model stays the same."""

    free: BoolArray
    """Whether each is a body that moves freely, shape (n,)."""
    driven: BoolArray
    """Whether each is a body with joints, that motors or springs may move, shape (n,)."""
    number: IntArray
    """Its MuJoCo body, 0 if it is none, shape (n,)."""
    mass: FloatArray
    """[kg], shape (n,)."""
    inertia: FloatArray
    """Moments about the main axes over the mass [m^2], shape (n, 3)."""
    centre: FloatArray
    """Centre of mass in the body's frame [m], shape (n, 3)."""
    axes: FloatArray
    """Main axes in the body's frame, unit quaternions, shape (n, 4)."""

    @classmethod
    def of(cls, model: Any, body_of: IntArray) -> Movers:
        """Return the bodies of a model, of which ``body_of`` tells each thing's, 0 for none."""
        mass = np.where(body_of > 0, model.body_mass[body_of], 0.0)
        unjointed = np.zeros(model.nbody, dtype=np.bool_)
        unjointed[model.jnt_bodyid[model.jnt_type == int(mujoco.mjtJoint.mjJNT_FREE)]] = True
        # What has parts on joints, as a vessel with walls that give way, stores energy in their springs.
        jointed = np.bincount(model.body_rootid[model.body_dofnum > 0], minlength=model.nbody) > 1
        free = unjointed[body_of] & ~jointed[model.body_rootid[body_of]]
        return cls(
            free=free,
            driven=~free & (model.body_weldid[body_of] > 0),
            number=body_of.copy(),
            mass=mass,
            inertia=model.body_inertia[body_of] / np.maximum(mass, 1e-12)[:, None],
            centre=model.body_ipos[body_of].copy(),
            axes=model.body_iquat[body_of].copy(),
        )

    def energy(self, thing: int, poses: FloatArray, gravity: FloatArray, dt: float) -> FloatArray:
        """Return a thing's kinetic and potential energy over its mass [J/kg] from one pose to the next, shape (T - 1,).

        Args:
            thing: Its index; it is free.
            poses: Its poses, shape (T, 7).
            gravity: [m/s^2], shape (3,).
            dt: From one to the next [s].
        """
        middle = poses[:, :3] + rotate(poses[:, 3:], self.centre[thing])
        speed = np.diff(middle, axis=0) / dt
        spin = rotation_vectors(poses[:-1, 3:], poses[1:, 3:]) / dt
        own = rotate_back(self.axes[thing], rotate_back(poses[:-1, 3:], spin))
        turning = 0.5 * np.square(own) @ self.inertia[thing]
        return 0.5 * np.square(speed).sum(axis=1) + turning - (middle[1:] + middle[:-1]) @ gravity / 2


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Matter:
    """What can touch something while the model stays the same, G solids of things."""

    thing: IntArray
    """Index of the thing of each, shape (G,)."""
    number: IntArray
    """Which of the thing's solids it is, shape (G,)."""
    fixed: BoolArray
    """Whether it never moves, shape (G,)."""
    tree: IntArray
    """Top of the tree of bodies that it is in, shape (G,)."""
    body: IntArray
    """Its MuJoCo body, shape (G,)."""
    meets: IntArray
    """MuJoCo's contype and conaffinity, shape (G, 2)."""
    geom: IntArray
    """Its MuJoCo geom, shape (G,), ascending."""
    strangers: frozenset[int]
    """Pairs of bodies that are kept from touching, as MuJoCo signs them."""

    @classmethod
    def of(cls, model: Any, things: Sequence[Thing]) -> Matter:
        """Return the solids of a model whose geoms are called after thing and number."""
        index = {thing.name: i for i, thing in enumerate(things)}
        rows: list[tuple[int, int, int]] = []
        for geom in np.flatnonzero(model.geom_contype | model.geom_conaffinity).tolist():
            name, _, number = model.geom(geom).name.rpartition("/")
            if name in index:
                rows.append((index[name], int(number), geom))
        table = np.array(rows, dtype=np.int64).reshape(-1, 3)
        geoms = table[:, 2]
        body = model.geom_bodyid[geoms].astype(np.int64)
        return cls(
            thing=table[:, 0],
            number=table[:, 1],
            fixed=model.body_weldid[body] == 0,
            tree=model.body_rootid[body].astype(np.int64),
            body=body,
            meets=np.stack([model.geom_contype[geoms], model.geom_conaffinity[geoms]], axis=1).astype(np.int64),
            geom=geoms,
            strangers=frozenset(model.exclude_signature.tolist()),
        )

    def meet(self, first: IntArray, second: IntArray) -> BoolArray:
        """Return which solids of one thing, on one body, may touch which of another, shape (first, second)."""
        low, high = sorted((int(self.body[first[0]]), int(self.body[second[0]])))
        if (low << 16) + high in self.strangers:
            return np.zeros((len(first), len(second)), dtype=np.bool_)
        one, other = self.meets[first][:, None], self.meets[second]
        return (one[..., 0] & other[..., 1] | other[..., 0] & one[..., 1]) > 0

    def row(self, geom: int) -> int:
        """Return which solid a MuJoCo geom is."""
        return int(np.flatnonzero(self.geom == geom)[0])

    def solid(self, row: int, things: Sequence[Thing]) -> Geom:
        """Return one of the solids."""
        return things[int(self.thing[row])].shape.geoms[int(self.number[row])]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Stretch:
    """Ticks over which the model stays the same."""

    start: int
    """First tick."""
    end: int
    """First tick no longer."""
    matter: Matter
    """What can touch something meanwhile."""
    bodies: Movers
    """What moves freely meanwhile, and what is driven."""
