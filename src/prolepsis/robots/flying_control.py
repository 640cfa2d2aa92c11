"""Control of a hand that flies freely: its base follows the target on six servos."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.geometry.rotations import angle_between, turned
from prolepsis.geometry.shape import Triple
from prolepsis.log.things import Thing
from prolepsis.robots.commands import HandSense, HandTarget
from prolepsis.robots.effectors.gap import Gap
from prolepsis.robots.effectors.gripper_control import Drive, GripperControl
from prolepsis.robots.hand import Hand
from prolepsis.robots.touch import on_fingers, whole_of
from prolepsis.scene.running import Running
from prolepsis.system.mujoco import mujoco

BUMP = 8.0
"""Force on the palm [N] that tells of a collision."""


class FlyingHand:
    """The controller of one free hand in a running simulation."""

    def __init__(self, state: Running, thing: Thing, hand: Hand) -> None:
        """Take over the hand that ``thing`` is."""
        self.name = thing.name
        self._start, self._first = thing.position, thing.orientation
        self._stiffness = hand.position_gain
        self._lags = np.repeat([hand.velocity_gain / hand.position_gain, hand.rotation_damping / hand.rotation_gain], 3)
        self._target = HandTarget(hand=self.name, offset=(0.0, 0.0, 0.0))
        self._set: HandTarget | None = None
        self._bump = ""
        self._turned = ((0.0, 0.0, 0.0), thing.orientation)
        drive = Drive(
            motor=f"{self.name}/gap",
            tendon=f"{self.name}/gap",
            pads=(f"{self.name}/left_finger", f"{self.name}/right_finger"),
            moving=2,
            gap=Gap.sliding(thing.quantities["opening"], hand.max_opening),
            max_force=hand.max_force,
            stiffness=hand.opening_gain,
            damping=hand.opening_damping,
        )
        self.gripper = GripperControl(state, drive)
        self.bind(state)

    def bind(self, state: Running) -> None:
        """Look the hand up in a model that is new."""
        self.gripper.bind(state)
        self._set = None
        model: Any = state.model
        self._state, self._model, self._data = state, model, state.data
        joints = ("x", "y", "z", "yaw", "pitch", "roll")
        self._servos = np.array([model.actuator(f"{self.name}/{joint}").id for joint in joints])
        self._palm = int(model.body(f"{self.name}/palm").id)
        self._fingers = [int(model.body(f"{self.name}/{side}_finger").id) for side in ("left", "right")]
        self._own = frozenset((self._palm, *self._fingers))

    def accept(self, command: object) -> None:
        """Take a command for this hand."""
        if isinstance(command, HandTarget):
            self._target = command
        else:
            self.gripper.accept(command)  # type: ignore[arg-type]

    def act(self, state: Running, dt: float) -> None:
        """Set the motors for the coming tick of ``dt`` [s]."""
        target = self._target
        if target is not self._set:
            self._set = target
            # The base's target runs ahead by the lag that the servo's damping causes.
            where = np.array([*target.offset, *target.rotation])
            self._data.ctrl[self._servos] = where + self._lags * np.array([*target.velocity, *target.angular_velocity])
        self.gripper.act(dt)

    def measure(self, forces: list[tuple[int, int, int, float]]) -> None:
        """Read the pressure of the pads from the normal forces of the last substep, as ``Running`` gives them."""
        self.gripper.measure(forces)
        self._bump = ""
        for _, first, second, force in forces:
            if force > BUMP and self._palm in (first, second):
                self._bump = whole_of(self._state, second if first == self._palm else first)

    def sense(self) -> HandSense:
        """Return what the hand knows of itself."""
        target = self._target
        x, y, z = self._data.xpos[self._palm].tolist()
        if self._turned[0] is not target.rotation:
            self._turned = (target.rotation, turned(self._first, target.rotation))
        return HandSense(
            position=(x, y, z),
            orientation=self._turned[1],
            offset=target.offset,
            rotation=target.rotation,
            opening=self.gripper.opening,
            grip=self.gripper.command,
            load=self._load,
            velocity=self._velocity,
            pad_force=self.gripper.pad_force,
            motion=self.gripper.motion,
            stiffness=self._stiffness,
            between=self._between,
            held=self._held,
            fingers=self._on_fingers,
            bump=self._bump,
            away=self._away,
        )

    def _away(self) -> tuple[float, float]:
        goal = np.add(self._start, self._target.offset)
        wanted = turned(self._first, self._target.rotation)
        distance = float(np.linalg.norm(goal - self._data.xpos[self._palm]))
        return distance, float(angle_between(np.array(wanted), self._data.xquat[self._palm]))

    def _between(self) -> tuple[str, ...]:
        return self.gripper.between(self._own, self._data.xpos[self._palm])

    def _held(self) -> tuple[str, ...]:
        return self.gripper.held(self._own, self._data.xpos[self._palm])

    def _on_fingers(self) -> dict[str, float]:
        return on_fingers(self._state, self._fingers, self._own)

    def _velocity(self) -> Triple:
        result = np.zeros(6)
        mujoco.mj_objectVelocity(self._model, self._data, mujoco.mjtObj.mjOBJ_XBODY, self._palm, result, 0)
        return (float(result[3]), float(result[4]), float(result[5]))

    def _load(self) -> Triple:
        # The slides of the base lie along the world's axes.
        x, y, z = (float(value) for value in self._data.actuator_force[self._servos[:3]])
        return (x, y, z)
