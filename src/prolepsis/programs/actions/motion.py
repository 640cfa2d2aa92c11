"""Moving the hand: reach for an object, lift, carry, hold still, wait."""

from __future__ import annotations

from collections.abc import Collection, Iterator

import numpy as np

from prolepsis.geometry.shape import FloatArray, Quaternion, Triple, triple
from prolepsis.log.things import Thing
from prolepsis.programs.action import HAND, ParameterSpec, action
from prolepsis.programs.moving.following import follow, go, refuse_bump, unhindered
from prolepsis.programs.moving.grasping import (
    LEAST_MARGIN,
    MARGIN,
    STANDOFF,
    as_seen,
    grasp_as_turned,
    grasp_poses,
    grasping_width,
    least_width,
    longest_axis,
)
from prolepsis.programs.moving.profile import PEAK_ACCELERATION, PEAK_SPEED, least_jerk
from prolepsis.programs.moving.reached import arrived
from prolepsis.robots.commands import ActionFailedError, Behaviour, HandTarget, JointPath, OpenGripper, Sense
from prolepsis.robots.hand import HAND as ROBOT
from prolepsis.scene.extent import extent_along
from prolepsis.scene.scene import Scene, reference_of, robot_of_gripper
from prolepsis.terms.errors import PlanError

ARRIVED = 1.0e-4
"""Shorter displacements are not worth a move [m]."""
TICK = 1.0e-3
"""Period of the commands [s]."""
OPENING_SPEED = 0.2
"""Speed of the gap when nothing is held [m/s]."""
OPENING_SLACK = 2.0
"""An opening that takes longer than it should by this is blocked [s]."""

SPEED = ParameterSpec(name="speed", kind="speed", default=0.25)
ACCELERATION = ParameterSpec(name="acceleration", kind="acceleration", default=1.0)
REACHED = ParameterSpec(name="object", kind="object", needs="solid")
HEIGHT = ParameterSpec(name="height", kind="length", default=0.0)
SHORT = ParameterSpec(name="short", kind="length", default=0.0, sign="not negative")


def line(displacement: Triple, acceleration: float, speed: float) -> Iterator[tuple[Triple, Triple]]:
    """Yield displacement [m] and velocity [m/s] at each tick along a line, from rest to rest, with the least jerk."""
    x, y, z = displacement
    distance = float(np.linalg.norm(displacement))
    duration = max(PEAK_SPEED * distance / speed, (PEAK_ACCELERATION * distance / acceleration) ** 0.5)
    for share, rate in least_jerk(duration):
        yield (share * x, share * y, share * z), (rate * x, rate * y, rate * z)


def travel(
    hand: Thing,
    sense: Sense,
    displacement: Triple,
    acceleration: float,
    speed: float,
    ignoring: Collection[str] = (),
) -> Behaviour:
    """Move a hand along a straight line, from rest to rest, with the least jerk.

    Args:
        hand: The hand.
        sense: What is sensed now.
        displacement: Where to, from the present target [m].
        acceleration: Greatest acceleration [m/s^2].
        speed: Greatest speed [m/s].
        ignoring: What the palm of a hand that flies may be pressed against.
    """
    start, rotation = sense.hands[hand.name].offset, sense.hands[hand.name].rotation
    if sense.hands[hand.name].arm is not None:
        steps = np.array([step for step, _ in line(displacement, acceleration, speed)])
        return (yield from follow(hand, sense, steps + start, np.tile(rotation, (len(steps), 1)), loose=True))
    for step, velocity in line(displacement, acceleration, speed):
        offset = (start[0] + step[0], start[1] + step[1], start[2] + step[2])
        sense = yield (HandTarget(hand=hand.name, offset=offset, velocity=velocity, rotation=rotation),)
        refuse_bump(hand, sense, ignoring)
    return (yield from arrived(hand, sense))


def travel_over(hand: Thing, sense: Sense, displacement: FloatArray, acceleration: float, speed: float) -> Behaviour:
    """Move a hand by ``displacement`` [m], shape (3,): up as far as needed, across, and down."""
    up, down = max(float(displacement[2]), 0.0), min(float(displacement[2]), 0.0)
    for step in ((0.0, 0.0, up), (float(displacement[0]), float(displacement[1]), 0.0), (0.0, 0.0, down)):
        if any(step):
            sense = yield from travel(hand, sense, step, acceleration, speed)
    return sense


def stay(duration: float, sense: Sense) -> Behaviour:
    """Let ``duration`` [s] pass without a command."""
    for _ in range(max(round(duration / TICK), 1)):
        sense = yield ()
    return sense


def open_to(hand: Thing, width: float, sense: Sense) -> Behaviour:
    """Move the pads to a gap of ``width`` [m] and wait until they are there.

    Raises:
        ActionFailedError: If they do not get there in time; what presses on the fingers then is in the way.
    """
    deadline = sense.time + abs(width - sense.hands[hand.name].opening) / OPENING_SPEED + OPENING_SLACK
    sense = yield (OpenGripper(hand=hand.name, width=width, speed=OPENING_SPEED),)
    while sense.hands[hand.name].motion != 0:
        if sense.time > deadline:
            raise _blocked(hand, width, sense)
        sense = yield ()
    return sense


def _blocked(hand: Thing, width: float, sense: Sense) -> ActionFailedError:
    """Return why the pads of a hand do not get to a gap of ``width`` [m]."""
    here = sense.hands[hand.name]
    gap = f"its pads are {here.opening * 1000:.0f} mm apart instead of {width * 1000:.0f} mm"
    against = " and ".join(sorted(here.fingers()))
    if against:
        return ActionFailedError("in_collision", f"{hand.name}: {gap}, its fingers are pressed against {against}")
    return ActionFailedError("timed_out", f"{hand.name}: {gap}")


def within_workspace(scene: Scene, *, hand: Thing, object: Thing, short: float, **_: object) -> None:
    """Refuse an object that the hand cannot get to or around, or a place beyond its end."""
    half = extent_along(object, longest_axis(object)) / 2
    if short > 0 and short >= half:
        raise PlanError(
            f"plan: {short * 1000:.0f} mm short of the middle of {object.name} is beyond its end, "
            f"which is {half * 1000:.0f} mm from there"
        )
    widest = hand.quantities["maxOpening"]
    width = grasping_width(hand.orientation, object)
    if robot_of_gripper(scene, hand) is not None:
        width = least_width(object) + LEAST_MARGIN
    else:
        away = np.abs(np.asarray(object.position) - np.asarray(hand.position)).max()
        if away > ROBOT.workspace:
            raise PlanError(
                f"plan: {object.name} is out of reach of {hand.name}: {away:.2f} m away, allowed {ROBOT.workspace:g} m"
            )
    if width > widest:
        raise PlanError(
            f"plan: {object.name} is not graspable: {width * 1000:.0f} mm wide between the pads, "
            f"{hand.name} opens {widest * 1000:.0f} mm"
        )


@action(HAND, REACHED, SPEED, HEIGHT, SHORT, check=within_workspace)
def reach(
    scene: Scene, sense: Sense, *, hand: Thing, object: Thing, speed: float, height: float, short: float
) -> Behaviour:
    """Open the gripper wider than the object, if it is not, and move it round that, a height above or short of it."""
    if sense.hands[hand.name].arm is not None:
        return (yield from _reach_by_arm(hand, object, sense, speed, height, short, reference_of(scene, hand)))
    pose = grasp_as_turned(hand, object, sense, height, short)
    width = min(pose.width + MARGIN, ROBOT.max_opening)
    if sense.hands[hand.name].opening < width:
        sense = yield from open_to(hand, width, sense)
        pose = grasp_as_turned(hand, object, sense, height, short)
    displacement = np.subtract(pose.offset, sense.hands[hand.name].offset)
    ahead = float(displacement @ np.asarray(pose.forward))
    first = displacement - min(ahead, STANDOFF) * np.asarray(pose.forward)
    for part in (first, displacement - first):
        if np.linalg.norm(part) > ARRIVED:
            step = (float(part[0]), float(part[1]), float(part[2]))
            sense = yield from unhindered(hand, travel(hand, sense, step, 2.0, speed, {object.name}), {object.name})
    return sense


def _reach_by_arm(
    hand: Thing, object: Thing, sense: Sense, speed: float, height: float, short: float, reference: Quaternion
) -> Behaviour:
    """Move round the object from the first direction from which the arm can."""
    arm = sense.hands[hand.name].arm
    assert arm is not None
    first: JointPath | None = None
    for pose in grasp_poses(hand, object, sense, height, arm, reference, short):
        width = max(min(pose.width + MARGIN, hand.quantities["maxOpening"]), sense.hands[hand.name].opening)
        # Only the last stretch is straight: before it, the object is in the way as anything is.
        back = STANDOFF + extent_along(as_seen(object, sense), np.asarray(pose.forward)) / 2
        there, before = (pose.offset, {object.name}), (pose.before(back), set[str]())
        for (position, ignored), opening in ((there, pose.width), (there, width), (before, width)):
            found = arm.path_to(position, pose.rotation, ignored, opening)
            if found.problem:
                first = first or found
                break
        else:
            if sense.hands[hand.name].opening < width:
                sense = yield from open_to(hand, width, sense)
            sense = yield from go(hand, sense, pose.before(back), pose.rotation, ())
            step = triple(np.subtract(pose.offset, pose.before(back)))
            return (yield from travel(hand, sense, step, 2.0, speed))
    if first is None or not first.problem:
        raise ActionFailedError("not_graspable", f"{object.name} is too wide or too thin for {hand.name} as it lies")
    raise ActionFailedError(first.problem, f"{object.name} by {hand.name}: {first.detail}")


@action(HAND, ParameterSpec(name="height", kind="length", sign="not zero"), SPEED, ACCELERATION)
def lift(scene: Scene, sense: Sense, *, hand: Thing, height: float, speed: float, acceleration: float) -> Behaviour:
    """Move the hand straight up (down if negative)."""
    del scene
    return (yield from travel(hand, sense, (0.0, 0.0, height), acceleration, speed))


@action(
    HAND,
    ParameterSpec(name="displacement", kind="displacement"),
    ACCELERATION,
    ParameterSpec(name="speed", kind="speed", default=1.0),
)
def carry(
    scene: Scene, sense: Sense, *, hand: Thing, displacement: Triple, acceleration: float, speed: float
) -> Behaviour:
    """Move the hand along a straight line, from rest to rest, at up to the given acceleration."""
    del scene
    return (yield from travel(hand, sense, displacement, acceleration, speed))


@action(HAND, ParameterSpec(name="duration", kind="duration"))
def hold(scene: Scene, sense: Sense, *, hand: Thing, duration: float) -> Behaviour:
    """Keep the hand where it is and its grip as it is."""
    del scene
    sense = yield from stay(duration, sense)
    return (yield from arrived(hand, sense))


@action(ParameterSpec(name="duration", kind="duration"))
def wait(scene: Scene, sense: Sense, *, duration: float) -> Behaviour:
    """Let time pass."""
    del scene
    return (yield from stay(duration, sense))
