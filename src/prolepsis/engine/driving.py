"""What drives a body on to what it touches, were it held there: its weight, or a motor."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.system.mujoco import mujoco


def driving_force(model: Any, data: Any, geom: int, contact: int) -> float:
    """Return the force with which what touches a geom at a contact is driven on to it [N].

    That is what holds it there at rest, and all that touches the geom where it does: motors are felt at their full
    force, not as they are while they move, and also through joints that are coupled.

    Args:
        model: A model.
        data: Its state, with contacts; it stays as it is.
        geom: Number of one of both geoms.
        contact: Number of the contact.
    """
    held = mujoco.MjData(model)
    held.qpos[:], held.ctrl[:], held.act[:] = data.qpos, data.ctrl, data.act
    held.mocap_pos[:], held.mocap_quat[:] = data.mocap_pos, data.mocap_quat
    held.qfrc_applied[:], held.xfrc_applied[:] = data.qfrc_applied, data.xfrc_applied
    mujoco.mj_fwdPosition(model, held)
    mujoco.mj_fwdVelocity(model, held)
    mujoco.mj_fwdActuation(model, held)
    mujoco.mj_fwdAcceleration(model, held)
    found = data.contact
    touching = [k for k in np.flatnonzero((found.geom == geom).any(axis=1)).tolist() if found.efc_address[k] >= 0]
    rows = np.zeros((len(touching) + held.ne, model.nv))
    jacobian = np.zeros((3, model.nv))
    for row, k in zip(rows, touching, strict=False):
        first, second = found.geom[k].tolist()
        mujoco.mj_jac(
            model, held, jacobian, None, found.pos[k], int(model.geom_bodyid[first if second == geom else second])
        )
        row[:] = (1.0 if second == geom else -1.0) * found.frame[k, :3] @ jacobian
    for number, each in enumerate(np.eye(held.ne, held.nefc)):
        mujoco.mj_mulJacTVec(model, held, rows[len(touching) + number], each)
    moved = np.zeros_like(rows)
    mujoco.mj_solveM(model, held, moved, rows)
    forces = np.linalg.pinv(rows @ moved.T, rcond=1e-10, hermitian=True) @ (rows @ held.qacc_smooth)
    return float(forces[touching.index(contact)]) if contact in touching else 0.0
