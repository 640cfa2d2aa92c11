"""What drives a body on to what it touches, were it held there: its weight, or a motor."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.system.mujoco import mujoco


def driving_force(model: Any, data: Any, geom: int, contact: int) -> float:
    """Return the force with which the body of a geom is driven on to the other one of a contact [N].

    That is what holds it there at rest, whatever else touches it: motors are felt at their full force, not as they are
    while they move.

    Args:
        model: A model.
        data: Its state, with contacts; it stays as it is.
        geom: Number of one of both geoms.
        contact: Number of the contact.
    """
    if not model.body_weldid[model.geom_bodyid[geom]]:
        return 0.0
    held = mujoco.MjData(model)
    held.qpos[:], held.ctrl[:], held.act[:] = data.qpos, data.ctrl, data.act
    held.mocap_pos[:], held.mocap_quat[:] = data.mocap_pos, data.mocap_quat
    held.qfrc_applied[:], held.xfrc_applied[:] = data.qfrc_applied, data.xfrc_applied
    mujoco.mj_fwdPosition(model, held)
    mujoco.mj_fwdVelocity(model, held)
    mujoco.mj_fwdActuation(model, held)
    mujoco.mj_fwdAcceleration(model, held)
    found = data.contact
    towards = found.frame[contact, :3] * (1.0 if int(found.geom[contact, 0]) == geom else -1.0)
    jacobian = np.zeros((3, model.nv))
    mujoco.mj_jac(model, held, jacobian, None, found.pos[contact], int(model.geom_bodyid[geom]))
    row = (towards @ jacobian)[None]
    moved = np.zeros_like(row)
    mujoco.mj_solveM(model, held, moved, row)
    return float(row[0] @ held.qacc_smooth) / max(float(row[0] @ moved[0]), 1e-12)
