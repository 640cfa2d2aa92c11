"""Contact forces of MuJoCo's constraint solver as rows: one for each pair of geoms that carries force in a tick."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.log import Contacts
from prolepsis.system.mujoco import mujoco


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactRows:
    """The contact points of one instant, C of them."""

    tick: int
    """Tick of the instant."""
    geom: IntArray
    """First and second geom of each, shape (C, 2)."""
    force: FloatArray
    """Force of the first geom on the second, world frame [N], shape (C, 3)."""
    normal: FloatArray
    """Unit normal from the first to the second geom, shape (C, 3)."""
    point: FloatArray
    """Point of contact, world frame [m], shape (C, 3)."""
    sticky: BoolArray
    """Whether the contact can pull, shape (C,)."""


def contact_rows(model: Any, data: Any, tick: int) -> ContactRows | None:
    """Return the contact points of ``data`` that carry force, or None if there are none.

    Args:
        model: The ``mujoco.MjModel``.
        data: Its ``mujoco.MjData`` after ``mj_forward`` or ``mj_step``.
        tick: Tick they are put down to.
    """
    if not data.ncon:
        return None
    contact = data.contact
    active = np.flatnonzero((contact.efc_address >= 0) & (contact.geom >= 0).all(axis=1))
    if not len(active):
        return None
    address, dim = contact.efc_address[active], contact.dim[active]
    frame = contact.frame[active].reshape(-1, 3, 3)
    rows = _elliptic(data.efc_force, address, dim)
    if int(model.opt.cone) != int(mujoco.mjtCone.mjCONE_ELLIPTIC):
        rows = _pyramidal(data.efc_force, address, dim, contact.friction[active])
    # The rows of a contact frame are its axes, the normal first.
    force = np.einsum("ci,cij->cj", rows, frame)
    loaded = np.abs(rows).max(axis=1) > 0
    if not loaded.any():
        return None
    return ContactRows(
        tick=tick,
        geom=contact.geom[active][loaded].astype(np.int64),
        force=force[loaded],
        normal=frame[loaded, 0],
        point=contact.pos[active][loaded],
        sticky=contact.adhesion[active][loaded] > 0,
    )


def _elliptic(efc_force: FloatArray, address: IntArray, dim: IntArray) -> FloatArray:
    """Return normal and two tangential forces of each contact, shape (C, 3); rotational ones are left out."""
    rows = np.zeros((len(address), 3))
    rows[:, 0] = efc_force[address]
    sliding = dim >= 3
    for axis in (1, 2):
        rows[sliding, axis] = efc_force[address[sliding] + axis]
    return rows


def _pyramidal(efc_force: FloatArray, address: IntArray, dim: IntArray, friction: FloatArray) -> FloatArray:
    """Return the same for the pyramid's edges, which come in opposing pairs a friction direction."""
    rows = np.zeros((len(address), 3))
    smooth = dim == 1
    rows[smooth, 0] = efc_force[address[smooth]]
    for axis in range(5):
        pair = np.flatnonzero(dim > axis + 1)
        first, second = efc_force[address[pair] + 2 * axis], efc_force[address[pair] + 2 * axis + 1]
        rows[pair, 0] += first + second
        if axis < 2:
            rows[pair, axis + 1] = (first - second) * friction[pair, axis]
    return rows


def merge_rows(rows: Sequence[ContactRows], of_geom: IntArray) -> tuple[Contacts, BoolArray]:
    """Return one row for each pair of geoms and tick, and which of them can pull.

    Args:
        rows: Contact points of instants in ascending order, each standing for one tick.
        of_geom: Thing that carries each geom, or -1, shape (ngeom,).
    """
    if not rows:
        return empty_contacts(), np.zeros(0, dtype=np.bool_)
    tick = np.repeat(np.array([row.tick for row in rows]), [len(row.geom) for row in rows])
    geom = np.concatenate([row.geom for row in rows])
    force = np.concatenate([row.force for row in rows])
    normal = np.concatenate([row.normal for row in rows])
    point = np.concatenate([row.point for row in rows])
    sticky = np.concatenate([row.sticky for row in rows])
    thing = of_geom[geom]
    kept = (thing >= 0).all(axis=1) & (thing[:, 0] != thing[:, 1])
    swapped = thing[:, 0] > thing[:, 1]
    force[swapped] *= -1
    normal[swapped] *= -1
    low, high = thing.min(axis=1), thing.max(axis=1)
    geom_count = len(of_geom)
    key = (tick * geom_count + geom.min(axis=1)) * geom_count + geom.max(axis=1)
    order = np.flatnonzero(kept)[np.argsort(key[kept], kind="stable")]
    if not len(order):
        return empty_contacts(), np.zeros(0, dtype=np.bool_)
    first = np.flatnonzero(np.diff(key[order], prepend=-1))
    weight = np.abs(np.einsum("ci,ci->c", force, normal))[order]
    # A contact at the edge of touching may carry friction only; it still needs a place and a direction.
    weight = np.maximum(weight, 1e-12)
    total = np.add.reduceat(weight, first)
    mean_normal = np.add.reduceat(normal[order] * weight[:, None], first)
    length = np.linalg.norm(mean_normal, axis=1, keepdims=True)
    contacts = Contacts(
        tick=tick[order][first],
        a=low[order][first],
        b=high[order][first],
        force=np.add.reduceat(force[order], first),
        normal=np.where(length > 1e-15, mean_normal / np.maximum(length, 1e-300), normal[order][first]),
        point=np.add.reduceat(point[order] * weight[:, None], first) / total[:, None],
        peak=total,
    )
    return contacts, np.logical_or.reduceat(sticky[order], first)


def empty_contacts() -> Contacts:
    """Return no contacts."""
    none = np.zeros(0, dtype=np.int64)
    zero = np.zeros((0, 3))
    return Contacts(tick=none, a=none, b=none, force=zero, normal=zero, point=zero, peak=np.zeros(0))
