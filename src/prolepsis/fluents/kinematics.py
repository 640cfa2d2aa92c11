"""How units move: centres, speeds, and whether something bears their weight, from poses alone."""

from __future__ import annotations

from typing import Any

import numpy as np

from prolepsis.fluents.intervals import ticks_of
from prolepsis.fluents.observation import Observation
from prolepsis.geometry.rotations import angle_between, cross, rotate, rotation_vectors
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.geometry.solids import centroid, radius

BALANCE_WINDOW = 0.05
"""Time over which weight and support are weighed against each other [s]: longer than a contact flickers (10-20
ms), shorter than one notices."""
BALANCED_ACCELERATION = (-0.75, 2.0)
"""Vertical acceleration in shares of gravity [1] between which the weight counts as balanced by what bears it:
a fall has -1 and a steep slide -0.75; a ball that rolls to and fro in a bowl has up to 2, an impact more."""


def centres(observation: Observation) -> FloatArray:
    """Return where the middle of each thing is, world frame [m], shape (n, T, 3)."""
    poses = observation.log.poses
    found = np.ascontiguousarray(poses[:, :, :3].transpose(1, 0, 2))
    for i, thing in enumerate(observation.log.things):
        offset = centroid(thing.shape)
        if np.abs(offset).max() > 1e-9:
            found[i] += rotate(poses[:, i, 3:], offset)
    return found


def velocities(observation: Observation) -> FloatArray:
    """Return the velocity of each thing's middle during each tick [m/s], shape (n, T, 3)."""
    position = observation.of(centres)
    found = np.zeros_like(position)
    if observation.tick_count > 1:
        np.subtract(position[:, 1:], position[:, :-1], out=found[:, :-1])
        found /= observation.dt
        found[:, -1] = found[:, -2]
        carrier = observation.log.carrier
        for tick in observation.segments[observation.segments > 1].tolist():
            # What is carried by another body from here on did not move there.
            changed = carrier[tick] != carrier[tick - 1]
            found[changed, tick - 1] = found[changed, tick - 2]
    return found


def point_velocities(observation: Observation, thing: IntArray, tick: IntArray, point: FloatArray) -> FloatArray:
    """Return how fast points that move with things do so during some ticks but the last [m/s], shape (N, 3).

    Args:
        observation: The log.
        thing: What each point moves with, shape (N,).
        tick: When, shape (N,).
        point: Where it is then, world frame [m], shape (N, 3).
    """
    quaternions = observation.log.poses[:, :, 3:]
    now, later = quaternions[tick, thing], quaternions[tick + 1, thing]
    spin = rotation_vectors(now, later) / observation.dt
    arm = point - observation.of(centres)[thing, tick]
    return observation.of(velocities)[thing, tick] + cross(spin, arm)


def heights(observation: Observation) -> FloatArray:
    """Return how high each thing's middle is [m], shape (n, T)."""
    return observation.of(centres) @ observation.up


def climb_speeds(observation: Observation) -> FloatArray:
    """Return the upward velocity of each thing's middle during each tick [m/s], shape (n, T)."""
    return observation.of(velocities) @ observation.up


def radii(observation: Observation) -> FloatArray:
    """Return the greatest distance of each thing's surface from its frame's origin [m], shape (n,)."""
    return np.array([radius(thing.shape) for thing in observation.log.things])


def travel(observation: Observation, ticks_before: int, ticks_after: int) -> FloatArray:
    """Return how far each thing's surface gets from ``ticks_before`` before to ``ticks_after`` after each tick.

    Turning counts as the path of the outermost point.

    Returns:
        Mean speed over that time [m/s], shape (n, T).
    """
    count, span = observation.tick_count, ticks_before + ticks_after
    found = np.zeros((len(observation.log.things), count))
    if count > span:
        found[:, ticks_before : count - ticks_after] = _speeds(observation, slice(0, count - span), slice(span, count))
    now = np.arange(count)
    edge = np.flatnonzero((now < ticks_before) | (now >= count - ticks_after))
    if count > 1 and len(edge):
        first, last = np.maximum(edge - ticks_before, 0), np.minimum(edge + ticks_after, count - 1)
        # At the ends, where one side is empty, the nearest tick speaks for it.
        alone = first == last
        first, last = np.where(alone & (last > 0), last - 1, first), np.where(alone & (last == 0), 1, last)
        found[:, edge] = _speeds(observation, first, last)
    return found


def _speeds(observation: Observation, first: Any, last: Any) -> FloatArray:
    position, orientation = observation.of(centres), observation.of(orientations)
    displacement = position[:, last] - position[:, first]
    shift = np.sqrt(np.einsum("ntc,ntc->nt", displacement, displacement))
    spin = angle_between(orientation[:, first], orientation[:, last]) * observation.of(radii)[:, None]
    np.maximum(shift, spin, out=shift)
    ticks = np.arange(observation.tick_count)
    return shift / ((ticks[last] - ticks[first]) * observation.dt)


def orientations(observation: Observation) -> FloatArray:
    """Return the unit quaternion of each thing, shape (n, T, 4)."""
    return np.ascontiguousarray(observation.log.poses[:, :, 3:].transpose(1, 0, 2))


def surface_speeds(observation: Observation) -> FloatArray:
    """Return the speed of each thing's fastest surface point during each tick [m/s], shape (n, T)."""
    return travel(observation, 0, 1)


def climb_accelerations(observation: Observation, time: float) -> tuple[FloatArray, FloatArray]:
    """Return the mean upward acceleration of each thing before and from each tick on [m/s^2], two of shape (n, T).

    Args:
        observation: The log.
        time: Length of each of the two windows [s].
    """
    climb = observation.of(climb_speeds)
    count = observation.tick_count
    window = ticks_of(time, observation.dt)
    now = np.arange(count)
    # The last velocity is a copy, so it says nothing of acceleration.
    last = max(count - 2, 0)
    before, here, after = np.maximum(now - window, 0), np.minimum(now, last), np.minimum(now + window, last)
    past = (climb[:, here] - climb[:, before]) / (np.maximum(here - before, 1) * observation.dt)
    future = (climb[:, after] - climb[:, here]) / (np.maximum(after - here, 1) * observation.dt)
    # At the ends one side is empty, and the other speaks for both.
    past[:, here == before] = future[:, here == before]
    future[:, after <= here] = past[:, after <= here]
    return past, future


def balanced(observation: Observation) -> BoolArray:
    """Return whether all that holds a thing balances its weight, shape (n, T): it does not accelerate like a fall."""
    past, future = climb_accelerations(observation, BALANCE_WINDOW)
    least, greatest = (share * max(observation.gravity, 1e-9) for share in BALANCED_ACCELERATION)
    return ((past >= least) & (past <= greatest)) | ((future >= least) & (future <= greatest))
