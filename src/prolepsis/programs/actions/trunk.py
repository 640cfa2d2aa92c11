"""Moving a robot's trunk: drive over the floor, turn the head to something, raise the torso."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from prolepsis.geometry.rotations import wrapped, yaw_of
from prolepsis.geometry.shape import Triple
from prolepsis.log.things import Thing
from prolepsis.programs.action import OBJECT, ROBOT_NAME, ParameterSpec, action
from prolepsis.programs.moving.profile import least_jerk, least_time
from prolepsis.programs.moving.reached import PLACE_WITHIN, TURN_WITHIN
from prolepsis.robots.commands import ActionFailedError, Behaviour, JointTarget, Measured, RobotSense, Sense
from prolepsis.scene.scene import Scene
from prolepsis.terms.errors import PlanError

STRAIGHT, TURNING = (PLACE_WITHIN, "m"), (TURN_WITHIN, "rad")
"""Joints that move straight and those that turn are where they should be within this."""


def move_joints(robot: Thing, sense: Sense, goals: Mapping[str, float], speed: float | None = None) -> Behaviour:
    """Move joints of a robot's trunk from rest to rest, all in the same time, as fast as they may, or at ``speed``."""
    here = sense.robots[robot.name]
    starts = np.array([here.joints[name] for name in goals])
    displacements = np.array(list(goals.values())) - starts
    speeds = np.array([here.speeds[name] if speed is None else min(here.speeds[name], speed) for name in goals])
    duration = least_time(np.abs(displacements), speeds, np.array([here.accelerations[name] for name in goals]))
    for share, rate in least_jerk(duration):
        positions, rates = starts + share * displacements, rate * displacements
        sense = yield (
            JointTarget(
                robot=robot.name,
                joints=dict(zip(goals, map(float, positions), strict=True)),
                speeds=dict(zip(goals, map(float, rates), strict=True)),
            ),
        )
    return sense


def _stopped(
    robot: Thing, sense: Sense, goals: Mapping[str, float], within: Mapping[str, tuple[float, str]]
) -> Behaviour:
    """Say so if joints are not where they should be by now; ``within`` says how near, and the unit, by joint."""
    here = sense.robots[robot.name].measured()
    for name, goal in goals.items():
        away, (most, unit) = abs(here[name] - goal), within[name]
        if away > most:
            reason = f"{name} of {robot.name} is {away:.3g} {unit} from where it should be"
            sense = yield (Measured(evidence={"away": away, "reason": reason}, outcome="not_reached"),)
            break
    return sense


def _can_drive(scene: Scene, *, robot: Thing, **_: object) -> None:
    if not scene.robots[robot.name].base:
        raise PlanError(f"plan: {robot.name} stands where it is; it has no base to drive")


@action(
    ROBOT_NAME,
    ParameterSpec(name="position", kind="position"),
    ParameterSpec(name="yaw", kind="angle", default=0.0),
    ParameterSpec(name="speed", kind="speed", default=0.4),
    check=_can_drive,
    moves="base",
)
def drive(
    scene: Scene, sense: Sense, *, robot: Thing, position: tuple[float, float], yaw: float, speed: float
) -> Behaviour:
    """Drive to a position on the floor, in the world's axes, and face a direction there (0: along x)."""
    del scene
    first = yaw_of(robot.orientation)
    dx, dy = position[0] - robot.position[0], position[1] - robot.position[1]
    along = math.cos(first) * dx + math.sin(first) * dy
    aside = math.cos(first) * dy - math.sin(first) * dx
    x, y, about = sense.robots[robot.name].base
    goals = {x: along, y: aside, about: yaw - first}
    sense = yield from move_joints(robot, sense, goals, speed)
    return (yield from _stopped(robot, sense, goals, {x: STRAIGHT, y: STRAIGHT, about: TURNING}))


def _can_look(scene: Scene, *, robot: Thing, **_: object) -> None:
    if not scene.robots[robot.name].head:
        raise PlanError(f"plan: {robot.name} has no head to turn")


@action(ROBOT_NAME, OBJECT, check=_can_look, moves="head")
def look_at(scene: Scene, sense: Sense, *, robot: Thing, object: Thing) -> Behaviour:
    """Turn the head so that the camera looks at an object."""
    del scene
    here = sense.robots[robot.name]
    goals = _towards(here, sense.position(object.name))
    _refuse_beyond(robot, here, goals, object)
    sense = yield from move_joints(robot, sense, goals)
    # It may be somewhere else by now.
    goals = _towards(sense.robots[robot.name], sense.position(object.name))
    return (yield from _stopped(robot, sense, goals, dict.fromkeys(goals, TURNING)))


def _towards(here: RobotSense, position: Triple) -> dict[str, float]:
    """Return the joints of the head at which it looks at a position in the world [rad]."""
    x, y, z = (there - at for there, at in zip(position, here.neck, strict=True))
    return dict(zip(here.head, (wrapped(math.atan2(y, x) - here.yaw), math.atan2(-z, math.hypot(x, y))), strict=True))


def _refuse_beyond(robot: Thing, here: RobotSense, goals: Mapping[str, float], object: Thing) -> None:
    for name, goal in goals.items():
        low, high = here.ranges[name]
        if not low <= goal <= high:
            reason = f"{name} of {robot.name} would be at {goal:.2f} rad, allowed {low:.2f} to {high:.2f}"
            raise ActionFailedError("unreachable", f"{object.name}: {reason}")


def _can_raise(scene: Scene, *, robot: Thing, **_: object) -> None:
    if not scene.robots[robot.name].torso:
        raise PlanError(f"plan: {robot.name} has no torso to raise")


@action(ROBOT_NAME, ParameterSpec(name="height", kind="length"), check=_can_raise, moves="torso")
def raise_torso(scene: Scene, sense: Sense, *, robot: Thing, height: float) -> Behaviour:
    """Move the torso to a height in its range."""
    torso = scene.robots[robot.name].torso[-1].name
    low, high = sense.robots[robot.name].ranges[torso]
    if not low <= height <= high:
        reason = f"{torso} of {robot.name} would be at {height:g} m, allowed {low:g} to {high:g} m"
        raise ActionFailedError("unreachable", reason)
    sense = yield from move_joints(robot, sense, {torso: height})
    return (yield from _stopped(robot, sense, {torso: height}, {torso: STRAIGHT}))
