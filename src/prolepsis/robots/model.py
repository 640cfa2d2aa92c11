"""A robot's model, read from its file: which body belongs to what, how wide its grippers open, where all is at home."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.robots.gap import Gap
from prolepsis.robots.hand import rotate
from prolepsis.scene.robot import ParallelGripper, Robot
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import ScenarioError

TABLE = 257
"""Lengths at which a gripper's gap is measured: it is interpolated to a micrometre."""
FARTHEST = 1.0
"""No gripper opens wider [m]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RobotModel:
    """What is read from a robot's file."""

    robot: Robot
    model: Any
    """The ``mujoco.MjModel`` of the robot alone."""
    owner: Mapping[str, str | None]
    """Name of the gripper that each body belongs to, None for the robot itself; by body."""
    root: str
    """Body that carries all others."""
    gaps: Mapping[str, Gap]
    """Gap over the length of the finger joints' tendon, by gripper."""

    def spec(self) -> Any:
        """Return a fresh ``mujoco.MjSpec`` of the robot."""
        return read_spec(self.robot)

    def at_home(self, openings: Mapping[str, float]) -> tuple[Any, dict[str, float]]:
        """Return ``mujoco.MjData`` at home with the given gaps [m], and the coordinates by joint."""
        data = mujoco.MjData(self.model)
        posture = {joint.name: joint.home for joint in self.robot.joints}
        for arm in self.robot.arms:
            half = self.gaps[arm.name].length(openings[arm.name]) / 2
            posture |= dict.fromkeys(arm.gripper.fingers, half)
        for name, value in posture.items():
            data.joint(name).qpos[0] = value
        follow_couplings(self.model, data)
        mujoco.mj_kinematics(self.model, data)
        joints = _single(self.model)
        return data, {self.model.joint(j).name: float(data.qpos[self.model.jnt_qposadr[j]]) for j in joints}


@lru_cache(maxsize=8)
def robot_model(robot: Robot) -> RobotModel:
    """Return the model of a robot.

    Raises:
        ScenarioError: If its file cannot be read or lacks something that the robot names.
    """
    try:
        model: Any = read_spec(robot).compile()
    except ValueError as error:
        raise ScenarioError(f"{robot.file}: the robot cannot be built: {' '.join(str(error).split())}") from None
    owner: dict[str, str | None] = {model.body(b).name: None for b in range(1, model.nbody)}
    for arm in robot.arms:
        palm = model.body(arm.gripper.palm).id
        for body in range(1, model.nbody):
            if _is_below(model, body, palm):
                owner[model.body(body).name] = arm.name
    gaps = {arm.name: gap_of(model, arm.gripper, arm.name) for arm in robot.arms}
    return RobotModel(robot=robot, model=model, owner=owner, root=model.body(1).name, gaps=gaps)


def read_spec(robot: Robot) -> Any:
    """Return the ``mujoco.MjSpec`` in a robot's file.

    Raises:
        ScenarioError: If it cannot be read.
    """
    try:
        return mujoco.MjSpec.from_string(robot.model) if robot.model else mujoco.MjSpec.from_file(str(robot.file))
    except (ValueError, OSError) as error:
        raise ScenarioError(f"{robot.file}: the robot cannot be read: {' '.join(str(error).split())}") from None


def _single(model: Any) -> list[int]:
    """Return the joints that have one coordinate."""
    kinds = (int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE))
    return [j for j in range(model.njnt) if int(model.jnt_type[j]) in kinds]


def _is_below(model: Any, body: int, top: int) -> bool:
    while body:
        if body == top:
            return True
        body = int(model.body_parentid[body])
    return False


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


def gap_of(model: Any, gripper: ParallelGripper, name: str) -> Gap:
    """Return the gap between the geoms of the pads over the range of the fingers; half open, the pads' middles are at
    the origin of the gripper's frame.

    Raises:
        ScenarioError: If the pads of the gripper, which is called ``name``, do not part.
    """
    data = mujoco.MjData(model)
    low, high = (float(v) for v in model.joint(gripper.fingers[0]).range)
    if not high > low:
        raise ScenarioError(f"{name}: the finger joint {gripper.fingers[0]} has no range")
    lengths = np.linspace(2 * low, 2 * high, TABLE)
    pads = [touching_geoms(model, pad) for pad in gripper.pads]
    _open_to(model, data, gripper, lengths[TABLE // 2])
    tool, forward = _tool(model, data, gripper)
    between = [_seen_from(data, pad, tool) for pad in gripper.pads]
    gaps, places = np.zeros(TABLE), np.zeros(TABLE)
    for k, length in enumerate(lengths):
        _open_to(model, data, gripper, length)
        gaps[k] = min(mujoco.mj_geomDistance(model, data, a, b, FARTHEST, None) for a in pads[0] for b in pads[1])
        moved = [data.body(pad).xpos + data.body(pad).xmat.reshape(3, 3) @ place for pad, place in between]
        places[k] = forward @ (np.mean(moved, axis=0) - tool)
    if not (np.diff(gaps) > 0).all():
        raise ScenarioError(f"{name}: its pads do not part where its finger joints grow")
    return Gap.tabulated(lengths, gaps, places)


def _open_to(model: Any, data: Any, gripper: ParallelGripper, length: float) -> None:
    """Put the fingers where their joints add up to ``length`` [m or rad]."""
    for finger in gripper.fingers:
        data.joint(finger).qpos[0] = length / 2
    follow_couplings(model, data)
    mujoco.mj_kinematics(model, data)


def _tool(model: Any, data: Any, gripper: ParallelGripper) -> tuple[FloatArray, FloatArray]:
    """Return origin and x axis of the gripper's frame [m], each shape (3,)."""
    palm = model.body(gripper.palm).id
    place, turn = np.zeros(3), np.zeros(4)
    mujoco.mju_mulPose(
        place, turn, data.xpos[palm], data.xquat[palm], np.array(gripper.tool), np.array(gripper.tool_orientation)
    )
    return place, rotate((float(turn[0]), float(turn[1]), float(turn[2]), float(turn[3])), (1.0, 0.0, 0.0))


def _seen_from(data: Any, body: str, place: FloatArray) -> tuple[str, FloatArray]:
    """Return a body with a place in its frame [m], shape (3,)."""
    return body, data.body(body).xmat.reshape(3, 3).T @ (place - data.body(body).xpos)


def touching_geoms(model: Any, body: str) -> list[int]:
    """Return the geoms of a body that can touch something."""
    number = model.body(body).id
    return [g for g in range(model.ngeom) if int(model.geom_bodyid[g]) == number and model.geom_contype[g]]
