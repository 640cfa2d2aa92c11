"""Where a hand goes to grasp a thing: between which of its sides, and from which direction."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from prolepsis.geometry.rotations import rotated, turned, wrapped, yaw_of
from prolepsis.geometry.shape import FloatArray, Quaternion, Triple, triple
from prolepsis.log.things import Thing
from prolepsis.robots.commands import ArmSense, Sense
from prolepsis.robots.hand import HAND as ROBOT
from prolepsis.scene.extent import extent_along, middle

STANDOFF = 0.08
"""Before the last straight stretch, the hand stops this far from the object; one that flies, from its middle [m]."""
CLEARANCE = 0.006
"""The guarded closing begins when the gap exceeds what is to be grasped by this much [m]."""
MARGIN = 0.02
"""The gap with which the hand reaches exceeds what is to be grasped by this much, if it opens so wide [m] ..."""
LEAST_MARGIN = 0.002
"""... and by at least this much [m]."""
TALL = 0.06
"""What is taller, or an open vessel, is grasped from the side if possible, what is lower from above [m]."""
FROM_THE_SIDE = (0.0, 15.0, 30.0, 45.0, 60.0, 90.0)
FROM_ABOVE = (60.0, 75.0, 90.0, 45.0, 30.0, 15.0, 0.0)
FROM_AN_END = (30.0, 45.0, 60.0)
"""Pitches of the hand that are tried, in this order: 0 is level, 90 points down [degrees]."""
ASIDE = (0.0, 25.0, -25.0, 50.0, -50.0)
"""Yaws that are tried, from the direction in which the object lies from the shoulder [degrees]."""
HIGHER = (0.0, 0.004, 0.008)
"""Heights over the middle that are tried, so that the fingertips clear what the object lies on [m]."""
ADJUSTMENTS = 4
"""Times that a grip is turned as an arm of five joints can turn the hand there, which moves its place a little."""
PALM_ROOM = 0.01
"""The palm of a hand that flies stays this far from what it grasps [m]."""
ROLLS = (0.0, 90.0)
"""Rolls that are tried [degrees]: pads to the left and right, then above and below."""


@dataclass(frozen=True, kw_only=True, slots=True)
class GraspPose:
    """A pose of the hand at which an object is between its pads."""

    offset: Triple
    """Of the hand's frame from its first position [m]."""
    rotation: Triple
    """Yaw, pitch and roll of the hand [rad]."""
    width: float
    """Extent of the object between the pads [m]."""
    forward: Triple
    """Unit vector from the palm to the fingertips, in the world."""

    def before(self, distance: float) -> Triple:
        """Return the displacement that is ``distance`` [m] before it, along the hand's axis."""
        x, y, z = (o - distance * f for o, f in zip(self.offset, self.forward, strict=True))
        return (x, y, z)


def as_seen(object: Thing, sense: Sense) -> Thing:
    """Return an object where it is now."""
    return replace(object, position=sense.position(object.name), orientation=sense.orientation(object.name))


def grasping_width(orientation: Quaternion, object: Thing) -> float:
    """Return an object's extent between the pads of a hand with that orientation [m]."""
    return extent_along(object, rotated(orientation, (0.0, 1.0, 0.0)))


def least_width(object: Thing) -> float:
    """Return the least extent of an object along its own axes [m]."""
    return min(extent_along(object, rotated(object.orientation, _axis(k))) for k in range(3))


def longest_axis(object: Thing) -> FloatArray:
    """Return the unit vector along which an object reaches farthest, one of its own axes in the world, shape (3,)."""
    axes = [rotated(object.orientation, _axis(k)) for k in range(3)]
    return max(axes, key=lambda axis: round(extent_along(object, axis), 6))


def displacement_to(hand: Thing, object: Thing, sense: Sense, height: float = 0.0) -> FloatArray:
    """Return the displacement from a hand to ``height`` [m] over the middle of an object [m], shape (3,)."""
    seen = as_seen(object, sense)
    position = np.asarray(seen.position) + middle(seen) + (0.0, 0.0, height)
    return position - np.asarray(sense.hands[hand.name].position)


def grasp_as_turned(hand: Thing, object: Thing, sense: Sense, height: float, short: float = 0.0) -> GraspPose:
    """Return the grasp pose for which the hand need not turn; what is too long for its fingers it holds by the end.

    So it does, ``short`` [m] of the middle, if that is said: the end at which its palm is.
    """
    here, seen = sense.hands[hand.name], as_seen(object, sense)
    width = grasping_width(here.orientation, seen)
    displacement = displacement_to(hand, object, sense, height)
    forward, back = rotated(here.orientation, (1.0, 0.0, 0.0)), 0.0
    if short:
        along = longest_axis(seen)
        aside = math.copysign(short, -float(along @ (displacement + STANDOFF * forward))) * along
        displacement, back = displacement + aside, -float(aside @ forward)
    if here.arm is not None:
        ahead, across = here.arm.held_at(width)
        displacement = displacement - ahead * forward - across * rotated(here.orientation, (0.0, 1.0, 0.0))
    else:
        palm = -ROBOT.palm_offset - ROBOT.palm_half_size[0]
        displacement = displacement - max(extent_along(seen, forward) / 2 + PALM_ROOM - palm - back, 0.0) * forward
    return GraspPose(
        offset=_sum(here.offset, displacement), rotation=here.rotation, width=width, forward=triple(forward)
    )


def grasp_poses(
    hand: Thing, object: Thing, sense: Sense, height: float, arm: ArmSense, reference: Quaternion, short: float = 0.0
) -> Iterator[GraspPose]:
    """Yield the poses at which a hand on an arm can hold an object, the most natural first.

    The pads' middle stops ``short`` [m] of the middle of the object, so that another hand finds room.
    """
    here, least = sense.hands[hand.name], hand.quantities.get("minOpening", 0.0)
    seen = as_seen(object, sense)
    position = np.asarray(seen.position) + middle(seen) + (0.0, 0.0, height)
    first = np.asarray(here.position) - np.asarray(here.offset)
    bearing = arm.bearing(triple(position))
    # An open vessel may be full: its content is not to be touched.
    aside = bool(seen.shape.profile) or extent_along(seen, np.array([0.0, 0.0, 1.0])) > TALL
    yaws = [bearing + math.radians(away) for away in ASIDE]
    if short:
        along = longest_axis(seen)
        heading = math.atan2(along[1], along[0]) - yaw_of(reference)
        yaws = sorted((heading, heading + math.pi), key=lambda yaw: abs(wrapped(yaw - bearing)))
    pitches = FROM_THE_SIDE if aside else FROM_AN_END if short else FROM_ABOVE

    def grasp_at(rotation: Triple, higher: float) -> GraspPose:
        orientation = turned(reference, rotation)
        width = grasping_width(orientation, seen)
        forward = rotated(orientation, (1.0, 0.0, 0.0))
        level = np.array([forward[0], forward[1], 0.0]) / max(float(np.hypot(forward[0], forward[1])), 1e-9)
        ahead, across = arm.held_at(width)
        held = ahead * forward + across * rotated(orientation, (0.0, 1.0, 0.0))
        offset = position + (0.0, 0.0, higher) - short * level - held - first
        return GraspPose(offset=triple(offset), rotation=rotation, width=width, forward=triple(forward))

    for pitch, roll, yaw, higher in itertools.product(pitches, ROLLS, yaws, HIGHER):
        pose = grasp_at((yaw, math.radians(pitch), math.radians(roll)), higher)
        for _ in range(ADJUSTMENTS):
            rotation = arm.feasible(pose.offset, pose.rotation)
            if rotation == pose.rotation:
                break
            pose = grasp_at(rotation, higher)
        if pose.width + LEAST_MARGIN <= hand.quantities["maxOpening"] and pose.width >= least:
            yield pose


def _axis(k: int) -> Triple:
    return (float(k == 0), float(k == 1), float(k == 2))


def _sum(first: Triple, second: FloatArray) -> Triple:
    return (first[0] + float(second[0]), first[1] + float(second[1]), first[2] + float(second[2]))
