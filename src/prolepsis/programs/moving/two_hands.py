"""Where two hands take one thing by its ends: each from its own side and from above, a V."""

from __future__ import annotations

import math
from collections.abc import Generator, Iterator
from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.rotations import angles_of, from_axes, matrix, turned_about, yaw_of, yawed
from prolepsis.geometry.shape import FloatArray, Quaternion, Triple, triple
from prolepsis.log.things import Thing
from prolepsis.programs.action import ParameterSpec
from prolepsis.programs.moving.following import go
from prolepsis.programs.moving.grasping import longest_axis
from prolepsis.robots.commands import Command, HandSense, JointPath, Sense, no_joint_path
from prolepsis.scene.extent import middle
from prolepsis.scene.scene import Scene, robot_of_gripper
from prolepsis.terms.errors import PlanError

OTHER = ParameterSpec(name="other", kind="hand")
"""The second hand."""
AWAY = (0.0, 20.0, -20.0, 40.0, -40.0)
"""The line through both hands is tried across the robot's front, and turned by these [degrees]."""
LIFTED = (0.0, 0.05, -0.03)
"""Heights over where the thing is that are tried [m]."""
SHORTS = tuple(0.001 * k for k in range(16, 37, 2))
"""How far from its middle the second hand's pads are, the nearest first [m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class HandPose:
    """Where a hand is, in the world."""

    position: FloatArray
    """[m], shape (3,)."""
    rotation: FloatArray
    """Its axes as columns, shape (3, 3)."""

    def seen(self, hand: HandSense, reference: Quaternion) -> tuple[Triple, Triple]:
        """Return it as displacement from the hand's first position [m] and as yaw, pitch and roll [rad]."""
        first = np.asarray(hand.position) - np.asarray(hand.offset)
        return triple(self.position - first), angles_of(reference, from_axes(self.rotation))

    def moved(self, about: FloatArray, axis: FloatArray, angle: float, by: FloatArray) -> HandPose:
        """Return it turned about an axis through a point by ``angle`` [rad], then moved ``by`` [m]."""
        rotation = turned_about(axis, angle)
        return HandPose(position=about + rotation @ (self.position - about) + by, rotation=rotation @ self.rotation)


@dataclass(frozen=True, kw_only=True, slots=True)
class HeldOut:
    """How the first hand holds a thing out to the second."""

    first: HandPose
    middle: FloatArray
    """Of the thing [m], shape (3,)."""
    across: FloatArray
    """Unit vector from the first hand to the second, along the thing, level, shape (3,)."""
    pinch: FloatArray
    """Unit vector from pad to pad, level, shape (3,)."""

    def second(self, short: float, held_at: tuple[float, float]) -> Iterator[HandPose]:
        """Yield poses of the second hand, mirror images, at which it holds ``short`` [m] from the thing's middle."""
        ahead = self.first.rotation[:, 0]
        forward = ahead - 2 * float(ahead @ self.across) * self.across
        for pinch in (self.pinch, -self.pinch):
            rotation = np.stack([forward, pinch, np.cross(forward, pinch)], axis=1)
            held = held_at[0] * forward + held_at[1] * pinch
            yield HandPose(position=self.middle + short * self.across - held, rotation=rotation)


def holds(hand: HandSense, other: HandSense, object: Thing, reference: Quaternion) -> Iterator[HeldOut]:
    """Yield how a hand may hold out a thing that it holds, as seen now, by one end: level, across the robot's front."""
    rotation = matrix(hand.orientation)
    centre = np.asarray(object.position) + middle(object)
    along = longest_axis(object)
    along = along if (centre - hand.position) @ along > 0 else -along
    along = along - float(along @ rotation[:, 1]) * rotation[:, 1]
    free_end = rotation.T @ (along / np.linalg.norm(along))
    pinched = np.array([0.0, 1.0, 0.0])
    own = np.stack([free_end, pinched, np.cross(free_end, pinched)], axis=1)
    arm = rotation.T @ (centre - hand.position)
    yaw = yaw_of(reference)
    left = np.array([-math.sin(yaw), math.cos(yaw), 0.0])
    side = 1.0 if np.subtract(other.position, hand.position) @ left > 0 else -1.0
    for lifted in LIFTED:
        for away in AWAY:
            across = side * (yawed(math.radians(away)) @ left)
            for pinch in (np.cross(across, (0.0, 0.0, 1.0)), np.cross((0.0, 0.0, 1.0), across)):
                axes = np.stack([across, pinch, np.cross(across, pinch)], axis=1) @ own.T
                if axes[2, 0] < 0:
                    there = centre + (0.0, 0.0, lifted)
                    first = HandPose(position=there - axes @ arm, rotation=axes)
                    yield HeldOut(first=first, middle=there, across=across, pinch=pinch)


def check_two_arms(scene: Scene, doing: str, hand: Thing, other: Thing, object: Thing) -> None:
    """Refuse two hands that are not on two arms of one robot.

    Raises:
        PlanError: If they are not; it says that what is ``doing``, such as "split", needs them.
    """
    if hand.name == other.name:
        raise PlanError(f"plan: {hand.name} cannot {doing} {object.name} alone; name another gripper")
    robots = [robot_of_gripper(scene, each) for each in (hand, other)]
    if None in robots or robots[0] != robots[1]:
        raise PlanError(f"plan: {hand.name} and {other.name} are not on two arms of one robot")


Presenting = Generator[tuple[Command, ...], Sense, tuple[HeldOut, Sense]]


def hold_out(hand: Thing, other: Thing, sense: Sense, seen: Thing, short: float, reference: Quaternion) -> Presenting:
    """Hold a thing, as seen now, out across the robot's front, where both arms can be; return how it is held.

    Args:
        hand: The hand that holds it.
        other: The hand that will take it.
        sense: What is sensed now.
        seen: The thing.
        short: How far from its middle the other hand's pads will be at least [m].
        reference: The first orientation of the hand.

    Raises:
        ActionFailedError: If there is no such pose.
    """
    here, there = sense.hands[hand.name], sense.hands[other.name]
    assert here.arm is not None and there.arm is not None
    first: JointPath | None = None
    for held in holds(here, there, seen, reference):
        pose = held.first.seen(here, reference)
        found = here.arm.path_to(*pose, {seen.name}, held=seen.name)
        if not found.problem:
            for second in held.second(short, there.arm.held_at(0.0)):
                found = there.arm.path_to(*second.seen(there, reference), {seen.name}, 0.0)
                # Both arms will be elsewhere than now: whether they touch is looked at then.
                if found.problem != "unreachable":
                    sense = yield from go(hand, sense, *pose, {seen.name}, seen.name)
                    return held, sense
        first = first or found
    what = f"{seen.name} between {hand.name} and {other.name}"
    raise no_joint_path(first, what, f"{hand.name} cannot hold it out from above")
