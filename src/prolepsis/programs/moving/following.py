"""Following: a hand goes along given positions and rotations, or anywhere by a free path, as fast as its joints may."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray, Triple, triple
from prolepsis.log.things import Thing
from prolepsis.programs.moving.profile import least_jerk, least_time
from prolepsis.programs.moving.reached import arrived
from prolepsis.robots.commands import ActionFailedError, ArmSense, ArmTarget, Behaviour, HandTarget, JointPath, Sense
from prolepsis.scene.running import TICK

BUMP = 8.0
"""Force on the fingers that tells of a collision [N]."""
KNOTS = 40
"""Ticks between two positions at which the joints of a given course are computed."""


def follow(hand: Thing, sense: Sense, offsets: FloatArray, rotations: FloatArray, *, loose: bool = False) -> Behaviour:
    """Go along positions and rotations, one a tick, each shape (n, 3); slower where the joints of an arm cannot follow.

    ``loose`` turns may be off about the vertical where an arm of five joints cannot have them.

    Raises:
        ActionFailedError: If the arm cannot get there, or is pressed against something on its path.
    """
    here = sense.hands[hand.name]
    if here.arm is None:
        velocities = np.diff(offsets, axis=0, prepend=[here.offset]) / TICK
        rates = np.diff(rotations, axis=0, prepend=[here.rotation]) / TICK
        courses = (_triples(each) for each in (offsets, velocities, rotations, rates))
        for offset, velocity, rotation, rate in zip(*courses, strict=True):
            sense = yield (
                HandTarget(hand=hand.name, offset=offset, velocity=velocity, rotation=rotation, angular_velocity=rate),
            )
            refuse_bump(hand, sense)
        return (yield from arrived(hand, sense))
    knots = np.unique(np.append(np.arange(KNOTS - 1, len(offsets), KNOTS), len(offsets) - 1))
    path = here.arm.path(offsets[knots], rotations[knots], loose=loose)
    _refuse(hand, path)
    times = np.concatenate([[0.0], (knots + 1) * TICK])
    points = np.concatenate([[here.arm.joints], path.joints])
    course = _spline(times, points)
    duration = float(times[-1])
    count = max(round(duration * _stretch(course, duration, here.arm) / TICK), 1)
    moments = np.asarray(np.arange(1, count + 1) * (duration / count), dtype=np.float64)
    joints, rates = course(moments), course(moments, 1) * (duration / (count * TICK))
    indices = np.maximum(np.minimum((moments / TICK).astype(int), len(offsets)) - 1, 0)
    poses = zip(_triples(offsets[indices]), _triples(rotations[indices]), strict=True)
    for coordinates, speeds, (offset, rotation) in zip(joints, rates, poses, strict=True):
        sense = yield (_target(hand, coordinates, speeds, offset, rotation),)
        refuse_bump(hand, sense)
    sense = yield (_target(hand, joints[-1], 0 * rates[-1], triple(offsets[-1]), triple(rotations[-1])),)
    return (yield from arrived(hand, sense))


def go(
    hand: Thing, sense: Sense, offset: Triple, rotation: Triple, ignoring: Collection[str], held: str | None = None
) -> Behaviour:
    """Go to a pose by any path on which the arm, and what it holds, touches nothing but what is ignored.

    Raises:
        ActionFailedError: If there is no such path, or the arm is pressed against something on it.
    """
    arm = sense.hands[hand.name].arm
    assert arm is not None, "a hand that flies goes straight"
    path = arm.path_to(offset, rotation, ignoring, held=held)
    _refuse(hand, path)
    for start, end in zip(path.joints[:-1], path.joints[1:], strict=True):
        step = end - start
        duration = least_time(np.abs(step), arm.speeds, arm.accelerations)
        for share, rate in least_jerk(duration):
            sense = yield (_target(hand, start + share * step, rate * step, offset, rotation),)
            refuse_bump(hand, sense)
    return (yield from arrived(hand, sense))


def unhindered(hand: Thing, moving: Behaviour, ignoring: Collection[str]) -> Behaviour:
    """Carry out a movement as long as nothing but what is ignored presses on the hand's fingers.

    Raises:
        ActionFailedError: If something does.
    """
    made = next(moving)
    while True:
        sense = yield made
        hit = [name for name, force in sense.hands[hand.name].fingers().items() if force > BUMP]
        if not {*ignoring}.issuperset(hit):
            against = " and ".join(sorted({*hit} - {*ignoring}))
            raise ActionFailedError("in_collision", f"{hand.name}: its fingers are pressed against {against}")
        try:
            made = moving.send(sense)
        except StopIteration as ended:
            return ended.value


def _spline(times: FloatArray, points: FloatArray) -> Callable[..., FloatArray]:
    """Return the cubic spline through points, at rest at both ends; its second argument is the derivative's order."""
    # The import takes longer than a scene without an arm.
    from scipy.interpolate import CubicSpline  # pyright: ignore[reportMissingTypeStubs]

    spline: Any = CubicSpline(times, points, bc_type="clamped")
    return spline


def _stretch(course: Callable[..., FloatArray], duration: float, arm: ArmSense) -> float:
    """Return by how much slower a course must be gone for the joints to follow: at least 1."""
    moments = np.linspace(0.0, duration, max(int(duration / (5 * TICK)), 2))
    speeds = np.abs(course(moments, 1)).max(axis=0) / arm.speeds
    accelerations = np.abs(course(moments, 2)).max(axis=0) / arm.accelerations
    return max(1.0, float(speeds.max()), float(np.sqrt(accelerations.max())))


def _triples(rows: FloatArray) -> list[Triple]:
    """Return rows, shape (n, 3), as plain floats, which is faster than one by one."""
    return [(x, y, z) for x, y, z in rows.tolist()]


def _target(hand: Thing, joints: FloatArray, rates: FloatArray, offset: Triple, rotation: Triple) -> ArmTarget:
    return ArmTarget(
        hand=hand.name,
        joints=tuple(joints.tolist()),
        speeds=tuple(rates.tolist()),
        offset=offset,
        rotation=rotation,
    )


def _refuse(hand: Thing, path: JointPath) -> None:
    if path.problem:
        raise ActionFailedError(path.problem, f"{hand.name}: {path.detail}")


def refuse_bump(hand: Thing, sense: Sense, ignoring: Collection[str] = ()) -> None:
    """End an action if the palm of its hand, or the arm that carries it, is pressed against what is not ignored."""
    bump = sense.hands[hand.name].bump
    if bump and bump not in ignoring:
        raise ActionFailedError("in_collision", f"{hand.name}: it is pressed against {bump}")
