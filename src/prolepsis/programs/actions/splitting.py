"""Splitting: what is cracked is held out by one hand, taken by the other, drawn apart and bent open below."""

from __future__ import annotations

import math
from collections.abc import Generator

import numpy as np

from prolepsis.geometry.rotations import angles_of, from_axes
from prolepsis.geometry.shape import FloatArray, Quaternion, triple
from prolepsis.log.things import Thing
from prolepsis.programs.action import FORCE, HAND, HELD, ParameterSpec, action
from prolepsis.programs.actions.gripping import close_from, felt
from prolepsis.programs.actions.motion import MARGIN, open_to, stay, travel
from prolepsis.programs.combining import Maker, all_together
from prolepsis.programs.moving.following import follow, go
from prolepsis.programs.moving.grasping import CLEARANCE, STANDOFF, as_seen
from prolepsis.programs.moving.holding import holding
from prolepsis.programs.moving.profile import least_jerk
from prolepsis.programs.moving.two_hands import OTHER, SHORTS, HandPose, HeldOut, check_two_arms, hold_out
from prolepsis.robots.commands import Behaviour, Command, JointPath, Sense, no_joint_path
from prolepsis.scene.extent import extent_along, support
from prolepsis.scene.scene import Scene, reference_of
from prolepsis.terms.errors import PlanError

PARTING_TIME = 1.5
"""Drawing apart and bending open, at once, take so long [s]."""

_Taken = Generator[tuple[Command, ...], Sense, tuple[HandPose, Sense]]


def _can_split(
    scene: Scene, *, hand: Thing, other: Thing, object: Thing, angle: float, distance: float, **_: object
) -> None:
    if not angle and not distance:
        raise PlanError(f"plan: {object.name} is not split by no angle and no distance; give one of them")
    check_two_arms(scene, "split", hand, other, object)


@action(
    HAND,
    OTHER,
    HELD,
    FORCE,
    ParameterSpec(name="angle", kind="angle", default=math.radians(30.0), sign="not negative"),
    ParameterSpec(name="distance", kind="length", default=0.08, sign="not negative"),
    check=_can_split,
)
def split(
    scene: Scene, sense: Sense, *, hand: Thing, other: Thing, object: Thing, force: float, angle: float, distance: float
) -> Behaviour:
    """Hold out to the other hand what a hand holds by one end; draw the ends apart and bend it open below."""
    reference = reference_of(scene, hand)
    holding(hand, object, sense)
    seen = as_seen(object, sense)
    held, sense = yield from hold_out(hand, other, sense, seen, SHORTS[-1], reference)
    sense = yield from stay(0.2, sense)
    second, sense = yield from _take(other, sense, object, held, reference, force)
    return (
        yield from _draw_apart(((hand, held.first), (other, second)), sense, object, held, reference, angle, distance)
    )


def _take(other: Thing, sense: Sense, object: Thing, held: HeldOut, reference: Quaternion, force: float) -> _Taken:
    """Close the other hand round the free end."""
    there = sense.hands[other.name]
    assert there.arm is not None
    width = extent_along(as_seen(object, sense), held.pinch)
    opening = min(width + MARGIN, other.quantities["maxOpening"])
    first: JointPath | None = None
    for short in SHORTS:
        for second in held.second(short, there.arm.held_at(width)):
            offset, rotation = second.seen(there, reference)
            back = HandPose(position=second.position - STANDOFF * second.rotation[:, 0], rotation=second.rotation)
            before, _ = back.seen(there, reference)
            found = there.arm.path_to(offset, rotation, {object.name}, width)
            if not found.problem:
                found = there.arm.path_to(offset, rotation, {object.name}, opening)
            if not found.problem:
                found = there.arm.path_to(before, rotation, (), opening)
            if not found.problem:
                sense = yield from open_to(other, opening, sense)
                sense = yield from go(other, sense, before, rotation, ())
                sense = yield from travel(other, sense, triple(np.subtract(offset, before)), 1.0, 0.1)
                sense = yield from close_from(other, width + CLEARANCE, force, sense)
                sense = yield from felt(other, force, sense, object)
                return second, sense
            first = first or found
    raise no_joint_path(first, f"the free end of {object.name} by {other.name}", "there is none")


def _draw_apart(
    hands: tuple[tuple[Thing, HandPose], tuple[Thing, HandPose]],
    sense: Sense,
    object: Thing,
    held: HeldOut,
    reference: Quaternion,
    angle: float,
    distance: float,
) -> Behaviour:
    """Move both ends away from each other, and turn them about the top of the middle meanwhile: it opens below."""
    up = np.array([0.0, 0.0, 1.0])
    top = held.middle + support(as_seen(object, sense), up) * up
    shares = [share for share, _ in least_jerk(PARTING_TIME)]

    def course(start: HandPose, side: float) -> tuple[FloatArray, FloatArray]:
        # What is below the axis moves to the hand's own side.
        axis = side * np.cross(held.across, up)
        steps = [
            start.moved(top, axis, -angle / 2 * share, side * share * distance / 2 * held.across) for share in shares
        ]
        rotations = [angles_of(reference, from_axes(step.rotation)) for step in steps]
        return np.array([step.position for step in steps]), np.array(rotations)

    def maker(hand: Thing, start: HandPose, side: float) -> Maker:
        positions, rotations = course(start, side)
        here = sense.hands[hand.name]
        first = np.asarray(here.position) - np.asarray(here.offset)
        return lambda now: follow(hand, now, positions - first, rotations)

    makers = [maker(hand, start, side) for (hand, start), side in zip(hands, (-1.0, 1.0), strict=True)]
    return (yield from all_together(makers)(sense))
