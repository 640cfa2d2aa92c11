"""Replaying: a hand does what was recorded of another one, a row of a file at a time."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from prolepsis.geometry.rotations import angles_of
from prolepsis.geometry.shape import FloatArray, Quaternion, triple
from prolepsis.log.things import Thing
from prolepsis.programs.action import HAND, ParameterSpec, action
from prolepsis.programs.actions.gripping import FASTEST, SLOWEST, SPEED_PER_FORCE
from prolepsis.programs.actions.motion import ARRIVED, OPENING_SPEED
from prolepsis.programs.moving.profile import PEAK_SPEED, least_jerk, least_time
from prolepsis.programs.moving.reached import arrived
from prolepsis.programs.recording import Recording, read_recording
from prolepsis.robots.commands import (
    ActionFailedError,
    ArmTarget,
    Behaviour,
    CloseGripper,
    Command,
    HandSense,
    HandTarget,
    Measured,
    OpenGripper,
    Sense,
)
from prolepsis.robots.hand import HAND as FREE_HAND
from prolepsis.robots.model import robot_model, unit_of
from prolepsis.scene.robot import Joint
from prolepsis.scene.running import TICK
from prolepsis.scene.scene import Scene, reference_of, robot_of_gripper
from prolepsis.terms.errors import PlanError

START_SPEED = 0.25
"""With which the hand goes to where the recording starts [m/s, rad/s]."""
FARTHEST_BEHIND = 0.02
"""A hand on an arm that is this far from where it was recorded cannot follow [m]."""
ROUNDED = 1.0e-6
"""Recorded numbers may exceed a range by this: they are written with so many digits."""
FORCE_STEP, OPENING_STEP = 0.1, 2.0e-4
"""Smaller changes are the sensor's: the gripper is not told anew [N, m]."""


def _joints_of(scene: Scene, hand: Thing) -> tuple[Joint, ...]:
    """Return the joints of the arm that carries a hand; none for one that flies."""
    robot = robot_of_gripper(scene, hand)
    return scene.robots[robot].arm(hand.name).joints if robot is not None else ()


def _can_replay(scene: Scene, *, hand: Thing, file: Path) -> None:
    """Refuse a recording of what the hand cannot do."""
    joints = _joints_of(scene, hand)
    recording = read_recording(file, [joint.name for joint in joints])
    for what, values, unit, limit in (
        ("opening", recording.openings, "m", hand.quantities["maxOpening"]),
        ("force", recording.forces, "N", hand.quantities["maxForce"]),
    ):
        if values is not None:
            _refuse_beyond(recording, values, 0.0, limit, f"{what} of {hand.name}", unit)
    for joint in joints if recording.joints else ():
        positions = recording.joints[joint.name]
        model: Any = robot_model(scene.robots[str(robot_of_gripper(scene, hand))]).model
        number = model.joint(joint.name).id
        unit = unit_of(model, number)
        if model.jnt_limited[number]:
            low, high = (float(value) for value in model.jnt_range[number])
            _refuse_beyond(recording, positions, low, high, f"joint {joint.name}", unit)
        _refuse_fast(recording, np.abs(np.diff(positions)), joint.speed, f"joint {joint.name}", f"{unit}/s")
    positions = recording.positions if recording.positions is not None else recording.displacements
    if positions is not None:
        displacements = np.linalg.norm(np.diff(positions, axis=0), axis=1)
        _refuse_fast(recording, displacements, hand.quantities.get("maxSpeed", np.inf), hand.name, "m/s")
    if not joints:
        _refuse_for_free_hand(recording, hand)


def _refuse_for_free_hand(recording: Recording, hand: Thing) -> None:
    if recording.positions is not None:
        away = np.abs(recording.positions - np.asarray(hand.position)).max(axis=1)
        wrong = np.flatnonzero(away > FREE_HAND.workspace)
        if len(wrong):
            raise PlanError(
                f"{recording.row(wrong[0])}: out of reach of {hand.name}: {away[wrong[0]]:.2f} m away, "
                f"allowed {FREE_HAND.workspace:g} m"
            )
    if recording.orientations is not None:
        cosines = np.abs((recording.orientations[1:] * recording.orientations[:-1]).sum(axis=1))
        angles = 2 * np.arccos(np.clip(cosines, -1.0, 1.0))
        _refuse_fast(recording, angles, FREE_HAND.max_angular_speed, f"{hand.name} turns", "rad/s")


def _refuse_beyond(recording: Recording, values: FloatArray, low: float, high: float, what: str, unit: str) -> None:
    wrong = np.flatnonzero((values < low - ROUNDED) | (values > high + ROUNDED))
    if len(wrong):
        k = int(wrong[0])
        raise PlanError(f"{recording.row(k)}: {what} is {values[k]:.4g} {unit}, allowed {low:.4g} to {high:.4g} {unit}")


def _refuse_fast(recording: Recording, displacements: FloatArray, limit: float, what: str, unit: str) -> None:
    speeds = displacements / np.diff(recording.time)
    wrong = np.flatnonzero(speeds > limit * (1 + 1e-6))
    if len(wrong):
        k = int(wrong[0])
        raise PlanError(f"{recording.row(k + 1)}: {what} at {speeds[k]:.3g} {unit}, allowed {limit:.3g} {unit}")


@action(HAND, ParameterSpec(name="file", kind="file"), check=_can_replay)
def replay(scene: Scene, sense: Sense, *, hand: Thing, file: Path) -> Behaviour:
    """Go to where a recorded stream starts, then do what it tells, at its times."""
    recording = read_recording(file, [joint.name for joint in _joints_of(scene, hand)])
    count = max(round(float(recording.time[-1]) / TICK), 1)
    ticks: FloatArray = np.arange(1.0, count + 1.0, dtype=np.float64) * np.float64(TICK)
    if recording.joints:
        return (yield from _replay_joints(hand, sense, recording, ticks))
    here = sense.hands[hand.name]
    reference = reference_of(scene, hand)
    rows = recording.displacements
    offsets = np.asarray(here.offset) + rows if rows is not None else _positions(recording) - np.asarray(hand.position)
    rotations = _rotations(recording, reference, here, ticks)
    start, first = np.array([*here.offset, *here.rotation]), np.array([*offsets[0], *rotations[0]])
    course = np.concatenate([_start(start, first), np.hstack([_smooth(recording.time, offsets)(ticks), rotations[1:]])])
    rates = np.diff(course, axis=0, prepend=start[None]) / TICK
    grips = _grips(recording, hand, len(course) - len(ticks))
    behind = 0.0
    for k, (pose, rate) in enumerate(zip(course, rates, strict=True)):
        target = HandTarget(
            hand=hand.name,
            offset=triple(pose[:3]),
            velocity=triple(rate[:3]),
            rotation=triple(pose[3:]),
            angular_velocity=triple(rate[3:]),
        )
        sense = yield (target, *grips.get(k, ()))
        behind = max(behind, _refuse_behind(hand, sense, (k - len(course) + len(ticks)) * TICK))
    end = HandTarget(hand=hand.name, offset=triple(course[-1, :3]), rotation=triple(course[-1, 3:]))
    sense = yield (end, *([Measured(evidence={"behind": behind})] if here.arm is not None else ()))
    return (yield from arrived(hand, sense))


def _replay_joints(hand: Thing, sense: Sense, recording: Recording, ticks: FloatArray) -> Behaviour:
    """Move the joints of an arm as recorded."""
    arm = sense.hands[hand.name].arm
    assert arm is not None, "only an arm has joints"
    rows = np.stack(list(recording.joints.values()), axis=1)
    displacement = rows[0] - arm.joints
    duration = least_time(np.abs(displacement), arm.speeds, arm.accelerations)
    start = np.array([arm.joints + share * displacement for share, _ in least_jerk(duration)])
    course = np.concatenate([start, _smooth(recording.time, rows)(ticks)])
    rates = np.diff(course, axis=0, prepend=arm.joints[None]) / TICK
    rates[-1] = 0.0
    grips = _grips(recording, hand, len(start))
    for k, (joints, rate) in enumerate(zip(course, rates, strict=True)):
        offset, rotation = arm.pose(joints)
        speeds = tuple(map(float, rate))
        target = ArmTarget(
            hand=hand.name, joints=tuple(map(float, joints)), speeds=speeds, offset=offset, rotation=rotation
        )
        sense = yield (target, *grips.get(k, ()))
        _refuse_behind(hand, sense, (k - len(start)) * TICK)
    return (yield from arrived(hand, sense))


def _positions(recording: Recording) -> FloatArray:
    assert recording.positions is not None
    return recording.positions


def _smooth(time: FloatArray, rows: FloatArray) -> Any:
    """Return a function of time through rows that never goes beyond two neighbouring ones."""
    # The import takes longer than a scene without a recording.
    from scipy.interpolate import PchipInterpolator  # pyright: ignore[reportMissingTypeStubs]

    return PchipInterpolator(time, rows)


def _rotations(recording: Recording, reference: Quaternion, here: HandSense, ticks: FloatArray) -> FloatArray:
    """Return how the hand is turned at the first row and at each tick [rad], shape (n + 1, 3), without jumps."""
    if recording.orientations is None:
        return np.tile(np.asarray(here.rotation), (len(ticks) + 1, 1))
    # Between rows some hundredths of a radian apart, the straight line between quaternions is the arc.
    between = _smooth(recording.time, recording.orientations)(np.concatenate([[0.0], ticks]))
    units = between / np.linalg.norm(between, axis=1)[:, None]
    rotations = [
        here.rotation,
        *(angles_of(reference, (float(w), float(x), float(y), float(z))) for w, x, y, z in units),
    ]
    return np.unwrap(np.array(rotations), axis=0)[1:]


def _start(start: FloatArray, first: FloatArray) -> FloatArray:
    """Return positions and rotations on the path to the first row, one a tick, shape (n, 6)."""
    displacement = first - start
    longest = max(float(np.linalg.norm(displacement[:3])), float(np.abs(displacement[3:]).max()))
    if longest < ARRIVED:
        return np.zeros((0, 6))
    return np.array([start + share * displacement for share, _ in least_jerk(PEAK_SPEED * longest / START_SPEED)])


def _grips(recording: Recording, hand: Thing, start: int) -> dict[int, tuple[Command, ...]]:
    """Return what the gripper is told, by tick: at each row, what the next one has."""
    told: dict[int, tuple[Command, ...]] = {}
    force, opening = 0.0, -1.0
    for k, (pads, gap, duration) in enumerate(_gripper_rows(recording, hand)):
        tick = start + round(float(recording.time[max(k - 1, 0)]) / TICK)
        if pads > 0.0:
            if abs(pads - force) > FORCE_STEP:
                speed = min(max(SPEED_PER_FORCE * pads, SLOWEST), FASTEST)
                told[tick] = (
                    CloseGripper(hand=hand.name, force=pads, width=hand.quantities["maxOpening"], speed=speed),
                )
                force, opening = pads, -1.0
        elif gap is not None and abs(gap - opening) > OPENING_STEP:
            speed = abs(gap - opening) / duration if opening >= 0.0 and duration > 0.0 else OPENING_SPEED
            told[tick] = (OpenGripper(hand=hand.name, width=gap, speed=speed),)
            force, opening = 0.0, gap
    return told


def _gripper_rows(recording: Recording, hand: Thing) -> Iterator[tuple[float, float | None, float]]:
    """Yield force, gap and the time from the row before; without a force and a gap, the gripper stays as it is."""
    durations = np.diff(recording.time, prepend=recording.time[0])
    for k, duration in enumerate(durations):
        force = float(recording.forces[k]) if recording.forces is not None else 0.0
        gap = float(recording.openings[k]) if recording.openings is not None else None
        if gap is None and recording.forces is not None and force == 0.0:
            gap = hand.quantities["maxOpening"]
        yield force, gap, float(duration)


def _refuse_behind(hand: Thing, sense: Sense, time: float) -> float:
    """Return how far a hand on an arm is from where it was recorded [m].

    Raises:
        ActionFailedError: If that is too far, or its arm is pressed against something.
    """
    here = sense.hands[hand.name]
    if here.bump:
        raise ActionFailedError("in_collision", f"{hand.name}: its arm is pressed against {here.bump}")
    if here.lag > FARTHEST_BEHIND:
        raise ActionFailedError(
            "unreachable", f"{hand.name}: {here.lag * 1000:.0f} mm away from the recording at {max(time, 0.0):.2f} s"
        )
    return here.lag
