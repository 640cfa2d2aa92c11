"""What of a robot's model follows what, and what of it can touch."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.system.mujoco import mujoco


def follow_couplings(model: Any, data: Any) -> None:
    """Set the joints that equalities couple to others; kinematics alone does not."""
    joint, powers = int(mujoco.mjtEq.mjEQ_JOINT), np.arange(5)
    coupled: list[tuple[int, int, FloatArray]] = []
    for equality in range(model.neq):
        if int(model.eq_type[equality]) != joint or model.eq_obj2id[equality] < 0:
            continue
        first, second = (int(model.jnt_qposadr[i[equality]]) for i in (model.eq_obj1id, model.eq_obj2id))
        coupled.append((first, second, np.asarray(model.eq_data[equality][:5])))
    start, now = model.qpos0, data.qpos
    for _ in range(3):
        for first, second, shape in coupled:
            away = float(now[second] - start[second])
            now[first] = start[first] + float(shape @ away**powers)


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
