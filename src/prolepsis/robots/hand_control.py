"""Control of a hand at every tick: the base follows its target; the gripper closes guarded, then ramps its force."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.programs.commands import BaseTarget, CloseGripper, Command, HandSense, OpenGripper
from prolepsis.robots.hand import Hand
from prolepsis.state import State

TOUCH_FORCE = 0.6
"""Greatest motor force before contact [N]: too weak to push away what is touched first."""
SPEED_LIMIT = 0.05
"""Finger speed at which the closing force has tapered to zero [m/s]: no slamming when what is held gives way."""
FAST_SPEED = 0.1
"""Speed of the gap where nothing is expected between the pads [m/s]."""
RAMP_TIME = 0.4
"""Time in which the force grows from touch to command [s], long against the 5 ms of the contact's own vibration."""
SETTLING_TIME = 0.03
"""The force has settled this long after the ramp [s]."""
STALL_TIME = 0.02
"""Fingers that have hardly moved for this long are in contact [s]."""
STALL_SPEED = 0.1
"""Part of the guarded speed below which fingers hardly move [1]."""
START_TIME = 0.04
"""Fingers need this long to get going [s]; only then does standing still mean contact."""
WIDTH_TOLERANCE = 1.0e-3
"""Gap error at which an opening has ended [m]."""


class HandControl:
    """The controller of one hand in a running simulation."""

    def __init__(self, state: State, name: str, hand: Hand, opening: float) -> None:
        """Take over the hand called ``name``, whose first gap is ``opening`` [m]."""
        self.name = name
        self.hand = hand
        self.motion = 0
        """1 opening, -1 closing, 0 idle."""
        self.command = 0.0
        """Commanded pad force [N]."""
        self.pad_force = 0.0
        """The smaller of the two pads' normal forces [N]."""
        self._first_opening = opening
        self._width = opening
        self._base = np.zeros(6)
        self._velocity = np.zeros(6)
        self._lags = np.repeat([hand.velocity_gain / hand.position_gain, hand.turn_damping / hand.turn_gain], 3)
        self._goal: CloseGripper | OpenGripper | None = None
        self._elapsed = 0.0
        self._still = 0.0
        self._ramp: float | None = None
        self._ramp_from = 0.0
        self._motor_force = 0.0
        self._gains = (-hand.opening_gain, -hand.opening_damping)
        self._version = -1
        self.bind(state)

    def bind(self, state: State) -> None:
        """Look the hand up in a model that is new."""
        if self._version == state.version:
            return
        self._version = state.version
        model: Any = state.model
        self._model, self._data = model, state.data
        joints = ("x", "y", "z", "yaw", "pitch", "roll")
        self._servos = np.array([model.actuator(f"{self.name}/{joint}").id for joint in joints])
        self._motor = int(model.actuator(f"{self.name}/gap").id)
        self._gap = int(model.tendon(f"{self.name}/gap").id)
        self._palm = int(model.body(f"{self.name}/palm").id)
        self._fingers = [int(model.body(f"{self.name}/{side}_finger").id) for side in ("left", "right")]
        self._set_gains(*self._gains)

    def _set_gains(self, stiffness: float, damping: float) -> None:
        self._gains = (stiffness, damping)
        self._model.actuator_gainprm[self._motor, 0] = 1.0
        self._model.actuator_biasprm[self._motor, :3] = (0.0, stiffness, damping)

    @property
    def opening(self) -> float:
        """Gap between the pads [m]."""
        return self._first_opening + float(self._data.ten_length[self._gap])

    def accept(self, command: Command) -> None:
        """Take a command for this hand."""
        if isinstance(command, BaseTarget):
            self._base[:] = (*command.offset, *command.turn)
            self._velocity[:] = (*command.velocity, *command.spin)
        elif isinstance(command, CloseGripper):
            gripping = isinstance(self._goal, CloseGripper) and self._ramp is not None
            self._goal, self.motion, self.command = command, -1, command.force
            self._elapsed, self._still = 0.0, 0.0
            # What is held must not be let go of while the force changes.
            touch = min(TOUCH_FORCE, command.force)
            self._ramp, self._ramp_from = (0.0, self._motor_force) if gripping else (None, touch)
            self._width = self.opening
        elif isinstance(command, OpenGripper):
            self._goal, self.command = command, 0.0
            self._width = self.opening
            self.motion = 1 if command.width > self._width else -1

    def act(self, state: State, dt: float) -> None:
        """Set the motors for the coming tick of ``dt`` [s]."""
        self.bind(state)
        # The base's target runs ahead by the lag that the servo's damping causes.
        target = self._base + self._lags * self._velocity
        self._data.ctrl[self._servos] = target
        if isinstance(self._goal, CloseGripper):
            self._close(self._goal, dt)
        else:
            self._move(self._goal, dt)

    def _close(self, goal: CloseGripper, dt: float) -> None:
        if self._ramp is None and not self._elapsed and self._width > goal.width:
            self._approach(goal.width, FAST_SPEED, dt)
            return
        force = min(goal.force, self.hand.max_force)
        touch = self._ramp_from
        speed = abs(float(self._data.ten_velocity[self._gap])) / 2
        limit = SPEED_LIMIT
        if self._ramp is None:
            self._elapsed += dt
            self._still = self._still + dt if speed < STALL_SPEED * goal.speed else 0.0
            if self._elapsed > START_TIME and self._still >= STALL_TIME:
                self._ramp = 0.0
            now, limit = touch, goal.speed
        else:
            self._ramp += dt
            share = min(self._ramp / RAMP_TIME, 1.0)
            now = touch + (force - touch) * share * share * (3 - 2 * share)
            if self._ramp >= RAMP_TIME + SETTLING_TIME and speed < STALL_SPEED * SPEED_LIMIT:
                self.motion = 0
        self._motor_force = now
        # The motor acts on the gap, whose speed is twice a finger's.
        self._set_gains(0.0, -now / (2 * limit))
        self._data.ctrl[self._motor] = -now

    def _move(self, goal: OpenGripper | None, dt: float) -> None:
        if goal is None:
            self._approach(self._width, FAST_SPEED, dt)
            return
        self._approach(goal.width, goal.speed, dt)
        if self._width == goal.width and abs(self.opening - goal.width) < WIDTH_TOLERANCE:
            self.motion = 0

    def _approach(self, width: float, speed: float, dt: float) -> None:
        """Move the pads towards a gap of ``width`` [m] at ``speed`` [m/s]."""
        self._width += float(np.clip(width - self._width, -speed * dt, speed * dt))
        self._set_gains(-self.hand.opening_gain, -self.hand.opening_damping)
        self._data.ctrl[self._motor] = self.hand.opening_gain * (self._width - self._first_opening)

    def measure(self, forces: list[tuple[int, int, int, float]]) -> None:
        """Read the pressure of the pads from the normal forces of the last substep, as ``State`` gives them."""
        pads = dict.fromkeys(self._fingers, 0.0)
        for _, first, second, force in forces:
            for body in (first, second):
                if body in pads:
                    pads[body] += force
        self.pad_force = min(pads.values())

    def sense(self) -> HandSense:
        """Return what the hand knows of itself."""
        x, y, z = (float(value) for value in self._data.xpos[self._palm])
        a, b, c, yaw, pitch, roll = (float(value) for value in self._base)
        # The slides of the base lie along the world's axes.
        fx, fy, fz = (float(value) for value in self._data.actuator_force[self._servos[:3]])
        return HandSense(
            position=(x, y, z),
            offset=(a, b, c),
            turn=(yaw, pitch, roll),
            opening=self.opening,
            grip=self.command,
            load=(fx, fy, fz),
            pad_force=self.pad_force,
            motion=self.motion,
        )
