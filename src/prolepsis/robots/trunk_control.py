"""Control of what no arm owns: servos on a robot's base, torso and head follow their targets."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.robots.commands import Command, JointTarget, RobotSense
from prolepsis.robots.model import robot_model
from prolepsis.scene.robot import Robot
from prolepsis.scene.running import Running


class Trunk:
    """The controller of one robot's base, torso and head in a running simulation."""

    def __init__(self, state: Running, name: str, robot: Robot) -> None:
        """Take over the robot called ``name``."""
        self.name = name
        joints = (*robot.base, *robot.torso, *robot.head)
        self._joints = {joint.name: joint for joint in joints}
        self._targets = {joint.name: (joint.home, 0.0) for joint in joints}
        self._base = tuple(joint.name for joint in robot.base)
        self._head = tuple(joint.name for joint in robot.head)
        self._speeds = {joint.name: joint.speed for joint in joints}
        self._accelerations = {joint.name: joint.acceleration for joint in joints}
        self._root = f"{name}/{robot_model(robot).root}"
        self.bind(state)

    def bind(self, state: Running) -> None:
        """Look the robot up in a model that is new."""
        self._fresh = True
        model: Any = state.model
        self._data = state.data
        names = [f"{self.name}/{joint}" for joint in self._joints]
        self._servos = np.array([int(model.actuator(name).id) for name in names], dtype=np.int64)
        self._addresses = [int(model.joint(name).qposadr[0]) for name in names]
        dofs = [int(model.joint(name).dofadr[0]) for name in names]
        self._lags = [
            (joint.damping + float(model.dof_damping[dof])) / joint.stiffness
            for joint, dof in zip(self._joints.values(), dofs, strict=True)
        ]
        self._ranges = {joint: _range(model, name) for joint, name in zip(self._joints, names, strict=True)}
        base = [model.joint(f"{self.name}/{joint}").id for joint in self._base]
        self._facing = int(model.jnt_bodyid[base[-1]]) if base else int(model.body(self._root).id)
        self._neck = int(model.joint(f"{self.name}/{self._head[-1]}").id) if self._head else -1

    def accept(self, command: Command) -> None:
        """Take a command for this robot."""
        if isinstance(command, JointTarget):
            self._fresh = True
            self._targets |= {name: (command.joints[name], command.speeds[name]) for name in command.joints}

    def act(self, state: Running) -> None:
        """Set the motors for the coming tick."""
        if self._fresh and len(self._servos):
            self._fresh = False
            self._data.ctrl[self._servos] = [
                position + lag * speed
                for (position, speed), lag in zip(self._targets.values(), self._lags, strict=True)
            ]

    def sense(self) -> RobotSense:
        """Return what the robot knows of these joints."""
        rotation = self._data.xmat[self._facing]
        neck = self._data.xanchor[self._neck] if self._neck >= 0 else self._data.xpos[self._facing]
        x, y, z = (float(value) for value in neck)
        return RobotSense(
            joints={name: position for name, (position, _) in self._targets.items()},
            measured=self._measured,
            speeds=self._speeds,
            accelerations=self._accelerations,
            ranges=self._ranges,
            base=self._base,
            head=self._head,
            neck=(x, y, z),
            yaw=float(np.arctan2(rotation[3], rotation[0])),
        )

    def _measured(self) -> dict[str, float]:
        return dict(zip(self._joints, map(float, self._data.qpos[self._addresses]), strict=True))


def _range(model: Any, joint: str) -> tuple[float, float]:
    number = model.joint(joint).id
    if not model.jnt_limited[number]:
        return (-np.inf, np.inf)
    low, high = (float(value) for value in model.jnt_range[number])
    return (low, high)
