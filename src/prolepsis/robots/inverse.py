"""Inverse kinematics of one arm: joint coordinates that put its gripper where it should be.

In motion mink takes the hand to its target within the joints' speeds. A search for a posture takes hundreds of steps of
the same kind, so it states the quadratic program itself: that is ten times as fast. Both are solved by daqp. Poses of
the model are put together by MuJoCo, as the model does: other roundings would lead a search elsewhere.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.robots.model import robot_model
from prolepsis.scene.robot import Arm, Robot
from prolepsis.system.mujoco import mujoco

SITE = "prolepsis_tool"
"""Name of the gripper's frame in the arm's model."""
POSTURE_COST = 1.0e-3
"""Weight of staying near the home posture, against 1 for each metre and radian of the gripper's frame: it decides where
the elbow goes and moves the gripper by less than a tenth of a millimetre."""
WEIGHTS = np.array([1.0, 1.0, 1.0, 0.5, 0.5, 0.5])
"""Of position and orientation [1/m, 1/rad]."""
NO_ROWS = np.zeros((0, 16))
"""The quadratic program has bounds on the joints and nothing else."""
DAMPING = 1.0e-6
"""Regularization of the quadratic program, small against the squared reach of an arm [m^2]."""
CLOSE, TURNED = 5.0e-4, 2.0e-3
"""A solution is at most this far from where the gripper should be [m, rad]."""
EXACT = 2.0e-5
"""A search ends here, so that solutions for neighbouring positions lie evenly [m + rad]."""
STEPS = 60
"""Iterations before a search from one start gives up ..."""
PATIENCE, PROGRESS = 6, 0.9
"""... or if so many iterations did not bring the error below this share of what it was."""
LONGEST_STEP = 0.3
"""Greatest change of a joint in one iteration of a search [rad]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Found:
    """Where an arm's joints should be."""

    joints: FloatArray
    """Coordinates, shape (n,)."""
    distance: float
    """Of the gripper's frame from where it should be [m]."""
    angle: float
    """Between the two frames [rad]."""

    @property
    def is_there(self) -> bool:
        """Whether the gripper gets to where it should be."""
        return self.distance <= CLOSE and self.angle <= TURNED


class ArmKinematics:
    """One arm on its mount, all other joints of the robot left out. Poses are seen from the mount: (7,), quaternion
    (w, x, y, z) last."""

    def __init__(self, robot: Robot, arm: Arm) -> None:
        """Read the arm's joints from the robot's model."""
        # The import takes longer than a scene without an arm.
        import daqp
        import mink

        spec = robot_model(robot).spec()
        names = [joint.name for joint in arm.joints]
        self.mount: str = spec.joint(names[0]).parent.parent.name
        """Body that carries the arm."""
        palm = spec.body(arm.gripper.palm)
        palm.add_site(name=SITE, pos=list(arm.gripper.tool), quat=list(arm.gripper.tool_orientation))
        for part in (*spec.equalities, *spec.tendons, *spec.actuators, *spec.sensors, *spec.keys, *spec.excludes):
            spec.delete(part)
        for joint in list(spec.joints):
            if joint.name not in names:
                spec.delete(joint)
        self.model: Any = spec.compile()
        self._mink: Any = mink
        self._daqp: Any = daqp
        self._here: Any = mink.Configuration(self.model)
        self._site = int(self.model.site(SITE).id)
        body, data = (self.model.body(self.mount).id if self.mount != "world" else 0), self._here.data
        self._mount_pose = (data.xpos[body].copy(), data.xquat[body].copy())
        self._mount_back = (np.zeros(3), np.zeros(4))
        mujoco.mju_negPose(*self._mount_back, *self._mount_pose)
        shoulder = np.zeros(7)
        mujoco.mju_mulPose(
            shoulder[:3], shoulder[3:], *self._mount_back, data.xanchor[0], np.array([1.0, 0.0, 0.0, 0.0])
        )
        self.shoulder: FloatArray = shoulder
        """Where the first joint is, seen from the mount, shape (7,)."""
        order = [int(self.model.joint(name).qposadr[0]) for name in names]
        if order != list(range(len(names))):
            raise ValueError(f"{arm.name}: its joints are not listed from the trunk outwards: {', '.join(names)}")
        self.home = np.array([joint.home for joint in arm.joints])
        self.speeds = np.array([joint.speed for joint in arm.joints])
        self._frame: Any = mink.FrameTask(
            SITE, "site", position_cost=WEIGHTS[:3], orientation_cost=WEIGHTS[3:], lm_damping=1e-4
        )
        self._posture: Any = mink.PostureTask(self.model, cost=POSTURE_COST)
        self._tasks = [self._frame, self._posture]
        ranges: Any = mink.ConfigurationLimit(self.model)
        speeds = {joint.name: joint.speed for joint in arm.joints}
        self._moving = [ranges, mink.VelocityLimit(self.model, speeds)]
        self._eye, self._free = np.eye(len(names)), np.zeros(len(names), dtype=np.int32)
        self.low, self.high = self._ranges()

    def _ranges(self) -> tuple[FloatArray, FloatArray]:
        limited = np.asarray(self.model.jnt_limited, dtype=bool)
        low = np.where(limited, self.model.jnt_range[:, 0], -np.inf)
        high = np.where(limited, self.model.jnt_range[:, 1], np.inf)
        return low, high

    def pose(self, joints: FloatArray) -> FloatArray:
        """Return where the gripper's frame is with the given coordinates, seen from the mount, shape (7,)."""
        self._here.update(joints)
        data = self._here.data
        rotation, result = np.zeros(4), np.zeros(7)
        mujoco.mju_mat2Quat(rotation, data.site_xmat[self._site])
        mujoco.mju_mulPose(result[:3], result[3:], *self._mount_back, data.site_xpos[self._site], rotation)
        return result

    def jacobian(self, joints: FloatArray) -> FloatArray:
        """Return how the gripper's frame moves with each joint, seen from the mount [m, rad], shape (6, n)."""
        self._here.update(joints)
        result = np.zeros((6, self.model.nv))
        mujoco.mj_jacSite(self.model, self._here.data, result[:3], result[3:], self._site)
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, self._mount_back[1])
        rotation = rotation.reshape(3, 3)
        return np.concatenate([rotation @ result[:3], rotation @ result[3:]])

    def _aim(self, pose: FloatArray) -> None:
        goal = np.zeros(7)
        mujoco.mju_mulPose(goal[:3], goal[3:], *self._mount_pose, pose[:3], pose[3:])
        lie = self._mink
        self._frame.set_target(lie.SE3.from_rotation_and_translation(lie.SO3(goal[3:]), goal[:3]))

    def step(self, joints: FloatArray, pose: FloatArray, duration: float) -> FloatArray:
        """Return the joint velocities [rad/s], shape (n,), that best take the gripper to ``pose`` in ``duration`` [s],
        within the joints' ranges and speeds."""
        self._here.update(joints)
        self._aim(pose)
        self._posture.set_target(joints)
        return self._mink.solve_ik(
            self._here, self._tasks, duration, solver="daqp", damping=DAMPING, limits=self._moving
        )

    def solve(
        self, pose: FloatArray, start: FloatArray, near: FloatArray | None = None, *, any_yaw: bool = False
    ) -> Found:
        """Return coordinates that put the gripper at ``pose``, or as near as a search from ``start`` gets.

        Of all that do, those near home are sought, or near to other coordinates, ``near``. With ``any_yaw`` the gripper
        may be turned about the vertical: an arm of five joints gets nowhere else.
        """
        joints = start.copy()
        best: Found | None = None
        errors: list[float] = []
        goal, rotation, back = np.zeros(7), np.zeros(4), np.zeros(3)
        mujoco.mju_mulPose(goal[:3], goal[3:], *self._mount_pose, pose[:3], pose[3:])
        nearest = self.home if near is None else near
        model, data, count = self.model, self._here.data, len(joints)
        jacobian, error = np.zeros((6, count)), np.zeros(6)
        for _ in range(STEPS):
            data.qpos[:count] = joints
            mujoco.mj_kinematics(model, data)
            mujoco.mj_comPos(model, data)
            mujoco.mj_jacSite(model, data, jacobian[:3], jacobian[3:], self._site)
            mujoco.mju_mat2Quat(rotation, data.site_xmat[self._site])
            # The rotation that is left, turned into the world's axes like the Jacobian's.
            mujoco.mju_subQuat(back, goal[3:], rotation)
            error[:3] = goal[:3] - data.site_xpos[self._site]
            error[3:] = data.site_xmat[self._site].reshape(3, 3) @ back
            if any_yaw:
                error[5], jacobian[5] = 0.0, 0.0
            here = Found(
                joints=joints.copy(),
                distance=math.sqrt(float(error[:3] @ error[:3])),
                angle=math.sqrt(float(error[3:] @ error[3:])),
            )
            if best is None or here.distance + here.angle < best.distance + best.angle:
                best = here
            errors.append(here.distance + here.angle)
            stuck = len(errors) > PATIENCE and errors[-1] > PROGRESS * errors[-1 - PATIENCE]
            if stuck or errors[-1] < EXACT:
                break
            weighted = WEIGHTS[:, None] * jacobian
            squared = weighted.T @ weighted + (POSTURE_COST**2 + DAMPING) * self._eye
            slope = POSTURE_COST**2 * (joints - nearest) - weighted.T @ (WEIGHTS * error)
            high = np.minimum(self.high - joints, LONGEST_STEP)
            low = np.maximum(self.low - joints, -LONGEST_STEP)
            joints = joints + self._daqp.solve(squared, slope, NO_ROWS[:, :count], high, low, self._free)[0]
        assert best is not None
        return best
