"""What of a robot's model follows what, and what of it can touch."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.system.mujoco import mujoco


def follow_couplings(model: Any, data: Any) -> None:
    """Set the joints that equalities couple to others; kinematics alone does not."""
    for _ in range(3):
        for equality in range(model.neq):
            if int(model.eq_type[equality]) != int(mujoco.mjtEq.mjEQ_JOINT) or model.eq_obj2id[equality] < 0:
                continue
            first, second = (model.jnt_qposadr[i[equality]] for i in (model.eq_obj1id, model.eq_obj2id))
            away = float(data.qpos[second] - model.qpos0[second])
            shape = np.asarray(model.eq_data[equality][:5])
            data.qpos[first] = model.qpos0[first] + float(shape @ away ** np.arange(5))


def pad_geoms(model: Any, pad: str) -> list[int]:
    """Return the geoms of a pad: those of the body called so that can touch something, else the geom called so."""
    number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, pad)
    if number < 0:
        return [int(model.geom(pad).id)]
    return [g for g in range(model.ngeom) if int(model.geom_bodyid[g]) == number and model.geom_contype[g]]


def pad_body(model: Any, pad: str) -> str:
    """Return the body of a pad, which is called so or has a geom that is."""
    number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, pad)
    return pad if number >= 0 else model.body(int(model.geom(pad).bodyid[0])).name
