"""Pouring: a held vessel turns while its lip stays over the middle of what is poured to."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from prolepsis.geometry.rotations import angles_of, inverse, matrix, product, rolled, rotated, turned
from prolepsis.geometry.shape import FloatArray, Quaternion
from prolepsis.log.things import Thing
from prolepsis.programs.action import HAND, ParameterSpec, action
from prolepsis.programs.actions.motion import stay, travel_over
from prolepsis.programs.actions.turning import RATE
from prolepsis.programs.moving.following import follow
from prolepsis.programs.moving.holding import holding
from prolepsis.programs.moving.lip import Below, heights, lip_of
from prolepsis.programs.moving.outline import outline
from prolepsis.programs.moving.profile import course
from prolepsis.programs.nesting import as_event
from prolepsis.robots.commands import Behaviour, Sense
from prolepsis.robots.hand import HAND as ROBOT
from prolepsis.scene.scene import Scene, reference_of, robot_of_gripper
from prolepsis.terms.errors import PlanError

LEVEL = 0.05
"""The hand's forward and left axes may rise by this much and still count as level [1]."""
FARTHEST = 0.5
"""Greatest height of the lip, and its greatest offset [m]: farther away nobody pours."""
APPROACH_SPEED, APPROACH_ACCELERATION = 0.4, 1.5
"""With which the vessel is carried over the other [m/s, m/s^2]: a cup that is not full to the brim does not spill."""


def _can_pour(
    scene: Scene, *, hand: Thing, source: Thing, target: Thing, height: float, offset: float, **_: object
) -> None:
    """Refuse a pouring that has no lip, no target, no sensible place, or for a flying hand no level axis."""
    if not 0.0 <= height <= FARTHEST:
        raise PlanError(f"plan: height {height:g} m of pour, allowed 0 to {FARTHEST:g} m")
    if abs(offset) > FARTHEST:
        raise PlanError(
            f"plan: offset {offset:g} m of pour, allowed up to {FARTHEST:g} m; other units need a parameter"
        )
    if source.name == target.name:
        raise PlanError(f"plan: {source.name} cannot be poured into itself")
    for thing in (source, target):
        if not len(outline(thing)):
            raise PlanError(f"plan: {thing.name} has no body to pour {'from' if thing is source else 'to'}")
    if robot_of_gripper(scene, hand) is not None:
        return
    if max(abs(rotated(hand.orientation, axis)[2]) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))) > LEVEL:
        raise PlanError(f"plan: {hand.name} is not level, so it cannot pour; allowed: pitch 0 and roll 0, any yaw")
    away = np.abs(np.asarray(target.position) - np.asarray(hand.position)).max()
    if away > ROBOT.workspace:
        raise PlanError(
            f"plan: {target.name} is out of reach of {hand.name}: {away:.2f} m away, allowed {ROBOT.workspace:g} m"
        )


@action(
    HAND,
    ParameterSpec(name="source", kind="object", needs="loose"),
    ParameterSpec(name="target", kind="object", needs="solid"),
    ParameterSpec(name="angle", kind="angle", default=math.radians(110.0), sign="positive"),
    RATE,
    ParameterSpec(name="height", kind="length", default=0.02),
    ParameterSpec(name="offset", kind="length", default=0.0),
    ParameterSpec(name="duration", kind="duration", default=1.0),
    check=_can_pour,
)
def pour(
    scene: Scene,
    sense: Sense,
    *,
    hand: Thing,
    source: Thing,
    target: Thing,
    angle: float,
    rate: float,
    height: float,
    offset: float,
    duration: float,
) -> Behaviour:
    """Tilt the held source over the target, its lip at a height over the target's top, offset past its middle."""
    state = holding(hand, source, sense)
    reference = reference_of(scene, hand)
    ahead = turned(reference, (state.rotation[0], 0.0, 0.0))
    level = matrix(ahead)
    left, here = level[:, 1], np.asarray(state.position)
    top = _points(sense, [target])
    middle = (top.min(axis=0) + top.max(axis=0)) / 2
    side = 1 if float((middle - here) @ left) >= 0.0 else -1
    # Everything that moves, in a level frame at the hand, as it would be if the source stood upright.
    lean = _lean(sense.orientation(source.name), level)
    upright = level @ rolled(lean)
    held = (_points(sense, [source]) - here) @ upright
    moved = np.concatenate([held, (_points(sense, scene.parts(hand.name)) - here) @ upright])
    lip = lip_of(held, side)
    below = Below(half_forward=_half(top @ level[:, 0]), half_aside=_half(top @ left), height=float(np.ptp(top[:, 2])))
    angles = course(-side * lean, angle, rate)
    lifts = heights(moved, lip, below, angles, side=side, offset=offset, height=height)
    goal = np.array([middle[0], middle[1], top[:, 2].max()]) + side * offset * left
    tilted = np.array([level @ rolled(-side * a) @ lip for a in angles])
    displacement = goal - tilted + lifts[:, None] * (0.0, 0.0, 1.0) - here
    approach = travel_over(hand, sense, displacement[0], APPROACH_ACCELERATION, APPROACH_SPEED)
    sense = yield from as_event("bring", {"hand": hand, "target": target}, approach, sense)
    # The path is seen from where the hand is, the commands from where they were: the servo may lag by a little.
    grip = product(inverse(ahead), state.orientation)
    rotations = [
        angles_of(reference, product(turned(ahead, (0.0, 0.0, -side * float(a) - lean)), grip)) for a in angles
    ]
    turning = follow(hand, sense, np.asarray(state.offset) + displacement, np.unwrap(rotations, axis=0))
    sense = yield from as_event("tilt", {"hand": hand, "angle": round(-side * angle, 3)}, turning, sense)
    return (yield from stay(duration, sense))


def _lean(orientation: Quaternion, level: FloatArray) -> float:
    """Return by how much a vessel has turned already about the forward axis of a level frame [rad]."""
    up = level.T @ matrix(orientation)[:, 2]
    return math.atan2(-float(up[1]), float(up[2]))


def _points(sense: Sense, things: Sequence[Thing]) -> FloatArray:
    """Return points on things where they are now, in the world [m], shape (n, 3)."""
    return np.concatenate(
        [outline(t) @ matrix(sense.orientation(t.name)).T + np.asarray(sense.position(t.name)) for t in things]
    )


def _half(values: FloatArray) -> float:
    return float(np.ptp(values)) / 2
