"""Control of an effector that pinches, at every tick: it closes guarded, then ramps its force."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.robots.commands import CloseGripper, Command, OpenGripper
from prolepsis.robots.effectors.gap import Gap
from prolepsis.robots.touch import between_pads, is_borne
from prolepsis.scene.running import Running
from prolepsis.system.mujoco import mujoco

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
RESTING = 4
"""Ticks between two settings of a servo that only keeps its gap."""
WIDTH_TOLERANCE = 1.0e-3
"""Gap error at which an opening has ended [m]."""
SLID = 0.03
"""What has slid so far between the pads since they closed on it, and is borne from below, has slipped out [m]: a pad is
2 to 4 cm long."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Drive:
    """What of a model opens and closes an effector."""

    motor: str
    """Actuator on the tendon."""
    tendon: str
    """Joins the joints that open it."""
    pads: tuple[str, ...]
    """Bodies that carry the pads."""
    moving: int
    """How many of the pads move."""
    gap: Gap
    """Gap over the length of the tendon."""
    max_force: float
    """Greatest force of a pad [N]."""
    stiffness: float
    """Servo stiffness of the opening [N/m]."""
    damping: float
    """Servo damping of the opening [N s/m]."""


class GripperControl:
    """The controller of one effector in a running simulation."""

    def __init__(self, state: Running, drive: Drive) -> None:
        """Take over a gripper as it is."""
        self.motion = 0
        """1 opening, -1 closing, 0 idle."""
        self.command = 0.0
        """Commanded pad force [N]."""
        self.pad_force = 0.0
        """The smaller of the two pads' normal forces [N]."""
        self.share = 1.0
        """Motor force over that for which the drive's lever asks [1]."""
        self._drive = drive
        self._goal: CloseGripper | OpenGripper | None = None
        self._elapsed = 0.0
        self._still = 0.0
        self._ramp: float | None = None
        self._ramp_from = 0.0
        self._motor_force = 0.0
        self._gains = (0.0, 0.0)
        self._opening = (math.nan, 0.0)
        self._taken: dict[str, FloatArray] = {}
        self.bind(state)
        self._width = self.opening

    def bind(self, state: Running) -> None:
        """Look the gripper up in a model that is new."""
        model: Any = state.model
        self._state, self._model, self._data = state, model, state.data
        self._motor = int(model.actuator(self._drive.motor).id)
        self._tendon = int(model.tendon(self._drive.tendon).id)
        self._pads = [int(model.body(pad).id) for pad in self._drive.pads]
        self._resting = -1
        gains, self._gains = self._gains, (math.nan, math.nan)
        self._set_gains(*gains)

    def _set_gains(self, stiffness: float, damping: float) -> None:
        if self._gains == (stiffness, damping):
            return
        self._gains = (stiffness, damping)
        self._model.actuator_gainprm[self._motor, 0] = 1.0
        self._model.actuator_biasprm[self._motor, :3] = (0.0, stiffness, damping)

    @property
    def length(self) -> float:
        """Length of the tendon: the sum of the joints [m or rad]."""
        return float(self._data.ten_length[self._tendon])

    @property
    def opening(self) -> float:
        """Gap between the pads [m]."""
        length = self.length
        # Asked several times a tick.
        if self._opening[0] != length:
            self._opening = (length, self._drive.gap.opening(length))
        return self._opening[1]

    def accept(self, command: Command) -> None:
        """Take a command for this gripper."""
        if isinstance(command, CloseGripper):
            gripping = isinstance(self._goal, CloseGripper) and self._ramp is not None
            self._goal, self.motion, self.command = command, -1, command.force
            self._elapsed, self._still = 0.0, 0.0
            # What is held must not be let go of while the force changes.
            touch = min(TOUCH_FORCE, command.force)
            self._ramp, self._ramp_from = (0.0, self._motor_force) if gripping else (None, touch)
            if not gripping:
                self._taken.clear()
            self._width = self.opening
        elif isinstance(command, OpenGripper):
            self._goal, self.command = command, 0.0
            self._width = self.opening
            self.motion = 1 if command.width > self._width else -1

    def act(self, dt: float) -> None:
        """Set the motor for the coming tick of ``dt`` [s]."""
        if isinstance(self._goal, CloseGripper):
            self._close(self._goal, dt)
            return
        keeps = self._goal is None or (self.motion == 0 and self._width == self._goal.width)
        self._resting = self._resting + 1 if keeps else 0
        if self._resting % RESTING == 0:
            self._move(self._goal, dt)

    def _close(self, goal: CloseGripper, dt: float) -> None:
        if self._ramp is None and not self._elapsed and self._width > goal.width:
            self._approach(goal.width, FAST_SPEED, dt)
            return
        force = min(goal.force, self._drive.max_force)
        touch = self._ramp_from
        lever = self._drive.gap.lever(self.length)
        speed = abs(float(self._data.ten_velocity[self._tendon])) * lever / self._drive.moving
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
        # The motor pulls at the tendon, by whose lever its force becomes a pad's; all moving pads make the gap's speed.
        self._set_gains(0.0, -now * lever * lever / (self._drive.moving * limit))
        self._data.ctrl[self._motor] = -now * lever * self.share

    def _move(self, goal: OpenGripper | None, dt: float) -> None:
        if goal is None:
            self._approach(self._width, FAST_SPEED, dt)
            return
        self._approach(goal.width, goal.speed, dt)
        if self._width == goal.width and abs(self.opening - goal.width) < WIDTH_TOLERANCE:
            self.motion = 0

    def _approach(self, width: float, speed: float, dt: float) -> None:
        """Move the pads towards a gap of ``width`` [m] at ``speed`` [m/s]."""
        self._width += min(max(width - self._width, -speed * dt), speed * dt)
        length = self.length
        opening, lever = self._drive.gap.opening(length), self._drive.gap.lever(length)
        stiffness = self._drive.stiffness * lever * lever
        self._set_gains(-stiffness, -self._drive.damping * lever * lever)
        missing = self._width - opening
        self._data.ctrl[self._motor] = self._drive.stiffness * lever * missing + stiffness * length

    def measure(self, forces: list[tuple[int, int, int, float]]) -> None:
        """Read the pressure of the pads from the normal forces of the last substep, as ``Running`` gives them."""
        pads = dict.fromkeys(self._pads, 0.0)
        for _, first, second, force in forces:
            if first in pads:
                pads[first] += force
            if second in pads:
                pads[second] += force
        self.pad_force = min(pads.values())

    def between(self, own: Collection[int], middle: FloatArray) -> tuple[str, ...]:
        """Return the wholes that lie between the pads, as ``EffectorControl`` has it."""
        return between_pads(self._state, self._pads, own, middle)

    def held(self, own: Collection[int], middle: FloatArray) -> tuple[str, ...]:
        """Return the wholes between the pads that have not slipped out since they were first felt there."""
        between = self.between(own, middle)
        return tuple(name for name in between if not self._slipped_out(name, middle)) if self.command else between

    def _slipped_out(self, name: str, middle: FloatArray) -> bool:
        """Return whether a whole has slid between the pads, and something else bears it now.

        What turns about the pads does not slide, and of what has fallen apart it cannot be said.
        """
        body = mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_BODY, name)
        if body < 0:
            return False
        rotation: FloatArray = np.asarray(self._data.xmat[body], dtype=np.float64).reshape(3, 3)
        here: FloatArray = rotation.T @ (middle - self._data.xpos[body])
        slid = float(np.linalg.norm(here - self._taken.setdefault(name, here)))
        return slid > SLID and is_borne(self._state, body)
