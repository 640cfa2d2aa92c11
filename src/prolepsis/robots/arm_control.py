"""Control of a hand on an arm: servos on its joints follow joint targets, or a target of the hand itself."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.geometry.rotations import angle_between, angles_of, compose_pose, from_axes, relative_pose, turned
from prolepsis.geometry.shape import FloatArray, Quaternion, Triple, quaternion, triple
from prolepsis.log.things import Thing
from prolepsis.robots.arm_paths import ArmPaths, name_of
from prolepsis.robots.commands import ArmTarget, Command, HandSense, HandTarget
from prolepsis.robots.effectors.kind import KINDS, EffectorControl
from prolepsis.robots.inverse import ArmKinematics
from prolepsis.robots.model import robot_model
from prolepsis.robots.touch import on_fingers
from prolepsis.scene.robot import Robot
from prolepsis.scene.running import Running
from prolepsis.system.mujoco import mujoco

PERIOD = 4
"""Ticks between two solutions of the inverse kinematics; in between the joints go on evenly."""
SETTLING = 60
"""Ticks after the last target of the hand in which the joints catch up with it."""
RESTING = 4
"""Ticks after the last command in which the servos get their targets anew."""
CATCHING_UP = 0.3
"""Share of the hand's distance from its target that is caught up at each solution [1]."""
BUMP = 8.0
"""Force on an arm or a palm [N] that tells of a collision; a hand that rolls an egg aside feels less."""


class ArmHand:
    """The controller of one arm and its gripper in a running simulation."""

    def __init__(self, state: Running, thing: Thing, robot: Robot, robot_name: str, reference: Quaternion) -> None:
        """Take over the arm whose gripper ``thing`` is; ``reference`` is level and faces where the robot faces."""
        self.name = thing.name
        self._arm = robot.arm(thing.name)
        self._prefix = f"{robot_name}/"
        self._kinematics = ArmKinematics(robot, self._arm)
        gripper = self._arm.gripper
        gap = robot_model(robot).gaps[thing.name]
        self.gripper: EffectorControl = KINDS[gripper.kind].control(state, gripper, gap, robot_name, self.name)
        self._reference = reference
        self._rates: FloatArray = np.zeros(len(self._arm.joints))
        self._stiff = np.array([joint.stiffness for joint in self._arm.joints])
        self._target: HandTarget | None = None
        self._idle = 0
        self._lag = 0.0
        self._bump = ""
        mount, palm = self._prefix + self._kinematics.mount, self._prefix + gripper.palm
        self._names = (mount, palm)
        self._joints: FloatArray = self._kinematics.home.copy()
        self._mount = int(state.model.body(mount).id)
        self._state, self._data = state, state.data
        first = self._commanded()
        self._first = triple(first[:3])
        self._offset: Triple = (0.0, 0.0, 0.0)
        self._rotation: Triple = angles_of(reference, quaternion(first[3:]))
        self._turned = (self._rotation, turned(reference, self._rotation))
        self.paths = ArmPaths(self._kinematics, self._arm, gap, self._first, reference, mount, palm)
        self._stiffness = float(1.0 / np.linalg.eigvalsh(self._compliance())[-1])
        self.bind(state)

    def bind(self, state: Running) -> None:
        """Look the arm up in a model that is new."""
        self._idle = min(self._idle, 2)
        self.gripper.bind(state)
        model: Any = state.model
        self._model, self._data = model, state.data
        names = [self._prefix + joint.name for joint in self._arm.joints]
        self._servos = np.array([int(model.actuator(name).id) for name in names])
        addresses = np.array([int(model.joint(name).qposadr[0]) for name in names])
        # The lag of the velocity that the joint's own damping adds.
        dofs = np.array([int(model.joint(name).dofadr[0]) for name in names])
        self._lags = (np.array([joint.damping for joint in self._arm.joints]) + model.dof_damping[dofs]) / self._stiff
        self._mount, self._palm = (int(model.body(name).id) for name in self._names)
        self._tool = int(model.site(f"{self.name}/tool").id)
        self._links, self._fingers = self._bodies(int(model.jnt_bodyid[model.joint(names[0]).id]))
        self._own = frozenset((*self._links, *self._fingers))
        self.paths.bind(state, addresses, self._links, self._fingers)

    def _bodies(self, first: int) -> tuple[dict[int, str], list[int]]:
        """Return the links from ``first`` to the palm by body, and what moves on the palm or is a pad."""
        model = self._model
        pads = {int(model.body(self._prefix + pad).id) for pad in self._arm.gripper.pads}
        links, fingers = {first: model.body(first).name}, list[int]()
        for body in range(first + 1, model.nbody):
            parent = int(model.body_parentid[body])
            if parent in fingers or body in pads or (parent == self._palm and model.body_jntnum[body]):
                fingers.append(body)
            elif parent in links:
                links[body] = model.body(body).name
        return links, fingers

    def _mount_pose(self) -> FloatArray:
        return np.array([*self._data.xpos[self._mount], *self._data.xquat[self._mount]])

    def _commanded(self) -> FloatArray:
        """Return where the commanded joints put the gripper in the world, shape (7,)."""
        return compose_pose(self._mount_pose(), self._kinematics.pose(self._joints))

    def _compliance(self) -> FloatArray:
        """Return how far the servos let a force displace the hand, seen from the mount [m/N], shape (3, 3)."""
        jacobian = self._kinematics.jacobian(self._joints)[:3]
        return jacobian / self._stiff @ jacobian.T

    def accept(self, command: Command) -> None:
        """Take a command for this hand."""
        if isinstance(command, HandTarget):
            self._target, self._idle = command, 0
            self._offset, self._rotation = command.offset, command.rotation
        elif isinstance(command, ArmTarget):
            self._target, self._lag, self._idle = None, 0.0, 0
            self._joints, self._rates = np.array(command.joints), np.array(command.speeds)
            self._offset = command.offset
            self._rotation = command.rotation if self.paths.turns_freely else self.paths.pose(self._joints)[1]
        else:
            self.gripper.accept(command)

    def act(self, state: Running, dt: float) -> None:
        """Set the motors for the coming tick of ``dt`` [s]."""
        if self._target is not None:
            if self._idle % PERIOD == 0:
                self._solve(self._target, PERIOD * dt)
            self._joints = self._joints + dt * self._rates
            if self._idle > SETTLING:
                self._target, self._rates = None, np.zeros(len(self._joints))
        elif self._idle > 1:
            self._rates = np.zeros(len(self._joints))
        self._idle += 1
        # An arm that holds still needs no new targets.
        if self._idle < RESTING or self._target is not None:
            self.paths.joints = self._joints
            self._data.ctrl[self._servos] = self._joints + self._lags * self._rates
        self.gripper.act(dt)

    def _solve(self, target: HandTarget, ahead: float) -> None:
        """Find the joints' rates that take the hand to where its target will be ``ahead`` [s] from now."""
        fresh = ahead if self._idle == 0 else 0.0
        here = self._commanded()[:3]
        goal = np.array(self._first) + target.offset
        self._lag = float(np.linalg.norm(goal - here))
        position = here + CATCHING_UP * (goal - here) + fresh * np.array(target.velocity)
        yaw, pitch, roll = (a + fresh * s for a, s in zip(target.rotation, target.angular_velocity, strict=True))
        pose = np.array([*position, *turned(self._reference, (yaw, pitch, roll))])
        self._rates = self._kinematics.step(self._joints, relative_pose(self._mount_pose(), pose), ahead)

    def measure(self, forces: list[tuple[int, int, int, float]]) -> None:
        """Read the pressure of the pads and what the arm is pressed against from the last substep's normal forces."""
        self.gripper.measure(forces)
        self._bump = ""
        links = self._links
        for _, first, second, force in forces:
            if force > BUMP and (first in links or second in links):
                other = second if first in links else first
                self._bump = name_of(self._state, other) or "the ground"

    def sense(self) -> HandSense:
        """Return what the hand knows of itself."""
        return HandSense(
            position=triple(self._data.site_xpos[self._tool]),
            orientation=self._orientation(),
            offset=self._offset,
            rotation=self._rotation,
            opening=self.gripper.opening,
            grip=self.gripper.command,
            load=self._load,
            velocity=self._velocity,
            pad_force=self.gripper.pad_force,
            between=self._between,
            held=self._held,
            fingers=self._on_fingers,
            motion=self.gripper.motion,
            stiffness=self._stiffness,
            lag=self._lag,
            bump=self._bump,
            away=self._away,
            arm=self.paths,
        )

    def _between(self) -> tuple[str, ...]:
        return self.gripper.between(self._own, self._middle())

    def _held(self) -> tuple[str, ...]:
        return self.gripper.held(self._own, self._middle())

    def _middle(self) -> FloatArray:
        rotation: FloatArray = np.asarray(self._data.site_xmat[self._tool], dtype=np.float64).reshape(3, 3)
        ahead, across = self.paths.held_at(self.gripper.opening)
        middle: FloatArray = self._data.site_xpos[self._tool] + rotation @ (ahead, across, 0.0)
        return middle

    def _away(self) -> tuple[float, float]:
        commanded = self._commanded()
        distance = float(np.linalg.norm(commanded[:3] - self._data.site_xpos[self._tool]))
        rotation: FloatArray = np.asarray(self._data.site_xmat[self._tool], dtype=np.float64).reshape(3, 3)
        return distance, float(angle_between(commanded[3:], np.array(from_axes(rotation))))

    def _on_fingers(self) -> dict[str, float]:
        return on_fingers(self._state, self._fingers, self._own)

    def _orientation(self) -> Quaternion:
        # Most programs do not turn the hand: it is kept.
        if self._turned[0] != self._rotation:
            self._turned = (self._rotation, turned(self._reference, self._rotation))
        return self._turned[1]

    def _velocity(self) -> Triple:
        result = np.zeros(6)
        mujoco.mj_objectVelocity(self._model, self._data, mujoco.mjtObj.mjOBJ_SITE, self._tool, result, 0)
        return triple(result[3:])

    def _load(self) -> Triple:
        # A force at the hand displaces it by the servos' compliance; what it is displaced by tells the force.
        displaced = self._commanded()[:3] - self._data.site_xpos[self._tool]
        rotation: FloatArray = np.asarray(self._data.xmat[self._mount], dtype=np.float64).reshape(3, 3)
        local: FloatArray = np.asarray(np.linalg.solve(self._compliance(), rotation.T @ displaced), dtype=np.float64)
        force: FloatArray = rotation @ local
        return triple(force)
