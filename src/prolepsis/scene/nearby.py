"""What solids there are now, and how far points are from them."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray, Shape
from prolepsis.geometry.signed_distance import field_of
from prolepsis.geometry.solids import bounded
from prolepsis.scene.running import Running

NUDGE = 1.0e-5
"""Step with which the direction to a surface is found [m]."""
SAMPLES = 9
"""Places on the way to a surface that are looked at [1]."""
WITHIN = 1.0e-5
"""So far within a solid a place is in it, and not where two touch [m]."""


def solids_of(state: Running) -> list[int]:
    """Return the things that are solid now: the own shape of an intact whole stands for its pieces."""
    things = state.scene.things
    return [
        i
        for i, thing in enumerate(things)
        if thing.shape.geoms
        and (carrier := int(state.carrier[i])) >= 0
        and (carrier == i or not things[carrier].is_body)
    ]


def touching(state: Running, index: int, points: FloatArray, reach: float) -> IntArray:
    """Return which world points, shape (n, 3), are nearer than ``reach`` [m] to a thing where it is now, shape (k,)."""
    shape = state.scene.things[index].shape
    pose = state.pose(state.scene.things[index].name)
    local = (points - pose[:3]) @ matrix(pose[3:])
    low, high = _box(shape)
    near = np.flatnonzero(((local > low - reach) & (local < high + reach)).all(axis=1))
    return near[field_of(shape).distance(local[near]) < reach]


def unobstructed(state: Running, index: int, points: FloatArray) -> BoolArray:
    """Return at which world points near a thing, shape (n, 3), no other solid is on the way to its surface, shape (n,).

    Where a wall is thinner than a particle, what lies on one side of it is near what is on the other.
    """
    free = np.ones(len(points), dtype=np.bool_)
    if not len(points):
        return free
    distance = distance_to(state, index, points)
    slope = [distance_to(state, index, points + NUDGE * axis) - distance for axis in np.eye(3)]
    out = np.stack(slope, axis=1) / NUDGE
    out /= np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-9)
    path = (
        points[:, None] - np.linspace(0.0, 1.0, SAMPLES)[:, None] * (np.maximum(distance, 0.0)[:, None] * out)[:, None]
    )
    for other in solids_of(state):
        if other != index:
            shape, pose = state.scene.things[other].shape, state.pose(state.scene.things[other].name)
            local = (path - pose[:3]) @ matrix(pose[3:])
            low, high = _box(shape)
            beside = np.flatnonzero(((local > low) & (local < high)).all(axis=2).any(axis=1) & free)
            if len(beside):
                inside = field_of(shape).distance(local[beside].reshape(-1, 3)).reshape(-1, SAMPLES) < -WITHIN
                free[beside] &= ~inside.any(axis=1)
    return free


@lru_cache(maxsize=4096)
def _box(shape: Shape) -> tuple[FloatArray, FloatArray]:
    """Return the least and greatest coordinates of a shape in its thing's frame [m], each of shape (3,)."""
    solids = bounded(shape)
    if len(solids) < len(shape.geoms):
        return np.full(3, -np.inf), np.full(3, np.inf)
    low, high = np.array([solid.bounds() for solid in solids]).swapaxes(0, 1)
    return low.min(axis=0), high.max(axis=0)


def distance_to(state: Running, index: int, points: FloatArray) -> FloatArray:
    """Return the distance of world points, shape (n, 3), to a thing where it is now [m], shape (n,)."""
    thing = state.scene.things[index]
    pose = state.pose(thing.name)
    return field_of(thing.shape).distance((points - pose[:3]) @ matrix(pose[3:]))
