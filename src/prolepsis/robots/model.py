"""A robot's model, read from its file: which body belongs to what, how wide its grippers open, where all is at home."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from prolepsis.robots.effectors.gap import Gap
from prolepsis.robots.effectors.kind import KINDS
from prolepsis.robots.parts import follow_couplings
from prolepsis.scene.robot import Robot
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import ScenarioError


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
    """Gap over the length of the tendon that joins an effector's joints, by gripper."""

    def spec(self) -> Any:
        """Return a fresh ``mujoco.MjSpec`` of the robot."""
        return read_spec(self.robot)

    def at_home(self, openings: Mapping[str, float]) -> tuple[Any, dict[str, float]]:
        """Return ``mujoco.MjData`` at home with the given gaps [m], and the coordinates by joint."""
        data = mujoco.MjData(self.model)
        posture = {joint.name: joint.home for joint in self.robot.joints}
        for arm in self.robot.arms:
            joints = arm.gripper.joints
            posture |= dict.fromkeys(joints, self.gaps[arm.name].length(openings[arm.name]) / max(len(joints), 1))
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
        spec = read_spec(robot)
        model: Any = spec.compile()
    except ValueError as error:
        raise ScenarioError(f"{robot.file}: the robot cannot be built: {' '.join(str(error).split())}") from None
    owner: dict[str, str | None] = {model.body(b).name: None for b in range(1, model.nbody)}
    for arm in robot.arms:
        palm = model.body(arm.gripper.palm).id
        for body in range(1, model.nbody):
            if _is_below(model, body, palm):
                owner[model.body(body).name] = arm.name
    gaps = {arm.name: KINDS[arm.gripper.kind].gap(spec, model, arm.gripper, arm.name) for arm in robot.arms}
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


def unit_of(model: Any, joint: int) -> str:
    """Return the unit of a joint's coordinate, ``m`` or ``rad``."""
    return "m" if int(model.jnt_type[joint]) == int(mujoco.mjtJoint.mjJNT_SLIDE) else "rad"


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
