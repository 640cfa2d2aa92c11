"""What a hand holds goes with it: where the hand must be for it to touch something, and where that can be hit."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from prolepsis.geometry.rotations import inverse, matrix, product, turned, wrapped, yaw_of
from prolepsis.geometry.shape import Quaternion, Triple, triple
from prolepsis.log.things import Thing
from prolepsis.programs.moving.following import follow, go
from prolepsis.programs.moving.grasping import as_seen, longest_axis
from prolepsis.programs.moving.profile import PEAK_SPEED, least_jerk
from prolepsis.robots.commands import ActionFailedError, Behaviour, HandSense, JointPath, Sense, no_joint_path
from prolepsis.scene.extent import extent_along, middle, support
from prolepsis.terms.errors import PlanError

PITCHES = (20.0, 30.0, 10.0, 45.0, 0.0, 60.0)
"""Pitches of the hand that are tried when it hits or presses with what it holds [degrees]."""
RIM_POINTS = 16
"""Places round a rim that are tried."""
RIM = 1.0e-3
"""Points within this height of the topmost belong to the rim [m]."""
CLEAR = 2.0e-3
"""So far above the position it is looked whether anything but what is held would touch something [m]."""
FACING = math.radians(80.0)
"""The hand points at most this far away from where its shoulder sees the spot."""
LONGER = 1.1
"""What is so many times as long as broad has a middle to be hit at [1]."""
LEVEL = 0.7
"""So much of its longest axis is level in the hand, at least [1]."""
STRAIGHT_SPEED = 0.3
"""Of a free hand's straight path [m/s, rad/s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Spot:
    """A place on the surface of a thing."""

    point: Triple
    """In the world [m]."""
    along: Triple
    """Unit vector along the edge, level; zeros if there is none."""


def spots(against: Thing, part: str) -> list[Spot]:
    """Return where a thing can be hit from above, each on its ``edge`` or its ``top``.

    Raises:
        PlanError: If it has no such part.
    """
    up = np.array([0.0, 0.0, 1.0])
    top = against.position[2] + support(against, up)
    centre = np.asarray(against.position) + middle(against)
    rotation = matrix(against.orientation)
    if part == "top":
        # What is upright and hollow is met on the ground inside it.
        upright = [(1.0 if rotation[2, 2] > 0 else -1.0) * z for r, z in against.shape.profile if r < RIM]
        top = against.position[2] + max(upright) if upright else top
        return [Spot(point=(float(centre[0]), float(centre[1]), top), along=(0.0, 0.0, 0.0))]
    if against.shape.profile:
        corners = np.asarray(against.shape.profile) * (1.0, 1.0 if rotation[2, 2] > 0 else -1.0)
        radius = float(corners[corners[:, 1] > corners[:, 1].max() - RIM][:, 0].mean())
        angles = np.arange(RIM_POINTS) * 2 * np.pi / RIM_POINTS
        return [
            Spot(
                point=(float(centre[0] + radius * np.cos(a)), float(centre[1] + radius * np.sin(a)), top),
                along=(float(-np.sin(a)), float(np.cos(a)), 0.0),
            )
            for a in angles
        ]
    boxes = [geom for geom in against.shape.geoms if geom.type == "box"]
    if not boxes or rotation[2, 2] < 0.99:
        raise PlanError(f"plan: {against.name} has no edge that can be hit; take its top")
    box = max(boxes, key=lambda geom: geom.position[2] + geom.size[2])
    found: list[Spot] = []
    for k, sign in ((0, 1), (0, -1), (1, 1), (1, -1)):
        local = np.asarray(box.position) + sign * box.size[k] * np.eye(3)[k] + box.size[2] * up
        position, along = np.asarray(against.position) + rotation @ local, rotation[:, 1 - k]
        found.append(Spot(point=(float(position[0]), float(position[1]), top), along=triple(along)))
    return found


def hand_poses(hand: HandSense, held: Thing, spot: Spot, reference: Quaternion) -> Iterator[tuple[Triple, Triple]]:
    """Yield poses of a hand at which the thing it holds touches a spot from above, natural ones first.

    Where there is an edge, it goes across what is held, which may crack round its middle; with what is as long as broad
    the fingers are on both sides of it. A hand that flies stays turned as it is.
    """
    if hand.arm is None:
        yield position_of(hand, held, spot.point, hand.orientation), hand.rotation
        return
    bearing = hand.arm.bearing(spot.point)
    yaws = [bearing]
    if any(spot.along):
        heading = math.atan2(spot.along[1], spot.along[0]) - yaw_of(reference) + _across(hand, held)
        around = [wrapped(heading + half - bearing) for half in (0.0, math.pi)]
        yaws = [bearing + away for away in sorted(around, key=abs) if abs(away) <= FACING]
    for yaw in yaws:
        for pitch in PITCHES:
            rotation = (yaw, math.radians(pitch), hand.rotation[2])
            yield position_of(hand, held, spot.point, turned(reference, rotation)), rotation


def _across(hand: HandSense, held: Thing) -> float:
    """Return the angle from an edge to a hand that points so that the longest of what it holds is across it [rad]."""
    ahead, aside, _ = matrix(hand.orientation).T @ longest_axis(held)
    longest = max(abs(ahead), abs(aside))
    lengths = sorted(extent_along(held, axis) for axis in matrix(held.orientation).T)
    if lengths[-1] < LONGER * lengths[-2] or longest < LEVEL:
        return 0.0
    return math.pi / 2 - math.atan2(aside, ahead)


def holding(hand: Thing, held: Thing, sense: Sense) -> HandSense:
    """Return the sense of a hand that holds something.

    Raises:
        ActionFailedError: If it does not.
    """
    here = sense.hands[hand.name]
    if here.grip == 0.0 or held.name not in here.held():
        between = here.between() if here.grip else ()
        instead = ", which has slipped in its grip" if held.name in between else ""
        if here.grip and not instead:
            instead = f": between its pads is {' and '.join(between) or 'nothing'}"
        raise ActionFailedError("not_held", f"{hand.name} does not hold {held.name}{instead}")
    return here


def free_pose(
    hand: Thing, held: Thing, sense: Sense, against: Thing, part: str, reference: Quaternion, windup: float
) -> tuple[Triple, Triple]:
    """Return the first pose at which what the hand holds touches a thing and nothing else touches anything.

    So it is ``windup`` [m] above as well, where the hand can get to.

    Raises:
        ActionFailedError: If there is none.
    """
    here, seen = holding(hand, held, sense), as_seen(held, sense)
    first: JointPath | None = None
    for spot in sorted(spots(as_seen(against, sense), part), key=lambda each: _away(here, each)):
        for offset, rotation in hand_poses(here, seen, spot, reference):
            if here.arm is None:
                return offset, rotation
            for height in (CLEAR, windup):
                above = (offset[0], offset[1], offset[2] + height)
                found = here.arm.path_to(above, rotation, {held.name}, held=held.name)
                if found.problem:
                    first = first or found
                    break
            else:
                return offset, rotation
    reason = f"{held.name} to the {part} of {against.name} by {hand.name}"
    raise no_joint_path(first, reason, "the hand would point backwards")


def _away(hand: HandSense, spot: Spot) -> float:
    return float(np.linalg.norm(np.subtract(spot.point, hand.position)))


def position_of(hand: HandSense, held: Thing, point: Triple, orientation: Quaternion) -> Triple:
    """Return the position of a hand, turned to ``orientation``, where what it holds touches a point from above [m]."""
    angular_velocity = product(orientation, inverse(hand.orientation))
    there = replace(held, orientation=product(angular_velocity, held.orientation))
    arm = matrix(angular_velocity) @ (np.asarray(held.position) + middle(held) - np.asarray(hand.position))
    goal = np.asarray(point) + (0.0, 0.0, _depth_below(there)) - arm
    first = np.asarray(hand.position) - np.asarray(hand.offset)
    return triple(goal - first)


def move_held(hand: Thing, held: Thing, sense: Sense, offset: Triple, rotation: Triple) -> Behaviour:
    """Move a hand with what it holds to a pose by any free path; a hand that flies goes straight."""
    here = sense.hands[hand.name]
    if here.arm is not None:
        return (yield from go(hand, sense, offset, rotation, {held.name}, held.name))
    displacement, turning = np.subtract(offset, here.offset), np.subtract(rotation, here.rotation)
    duration = PEAK_SPEED * max(float(np.linalg.norm(displacement)), float(np.abs(turning).max())) / STRAIGHT_SPEED
    shares = np.array([share for share, _ in least_jerk(duration)])[:, None]
    offsets, rotations = (
        np.asarray(here.offset) + shares * displacement,
        np.asarray(here.rotation) + shares * turning,
    )
    return (yield from follow(hand, sense, offsets, rotations))


def _depth_below(thing: Thing) -> float:
    """Return how far a thing reaches straight below its middle [m]."""
    geom = thing.shape.geoms[0]
    if len(thing.shape.geoms) == 1 and geom.type == "ellipsoid":
        local = matrix(thing.orientation).T @ np.array([0.0, 0.0, 1.0])
        return float(1.0 / np.sqrt(((local / np.asarray(geom.size)) ** 2).sum()))
    return support(thing, np.array([0.0, 0.0, -1.0])) + float(middle(thing)[2])
