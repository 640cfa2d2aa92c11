"""Points all over a thing: enough of them to know where it is in the way of another."""

from __future__ import annotations

import itertools

import numpy as np

from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import FloatArray, Geom
from prolepsis.log.things import Thing

SPACING = 0.008
"""Greatest distance of two points along an edge [m]."""
ROUND, TURNED = 24, 72
"""Points round a cylinder, and round a shape that is turned: at every 5 degrees."""


def outline(thing: Thing) -> FloatArray:
    """Return points on a thing in its own frame [m], shape (n, 3); none for a plane or a thing without a body."""
    if thing.shape.profile:
        corners = np.asarray(thing.shape.profile, dtype=np.float64)
        ends = np.roll(corners, -1, axis=0)
        stretch = np.concatenate([_along(start, end) for start, end in zip(corners, ends, strict=True)])
        angles = np.linspace(0.0, 2 * np.pi, TURNED, endpoint=False)
        circle = np.stack([np.cos(angles), np.sin(angles), np.zeros(TURNED)], axis=1)
        return (stretch[:, None, :1] * circle + stretch[:, None, 1:] * (0.0, 0.0, 1.0)).reshape(-1, 3)
    return np.concatenate([np.zeros((0, 3)), *(_points(geom) for geom in thing.shape.geoms)])


def _points(geom: Geom) -> FloatArray:
    corners = _corners(geom)
    if geom.type in ("mesh", "box"):
        sides = [_along(start, end) for start, end in itertools.combinations(corners, 2)]
        corners = np.concatenate([corners, *sides])
    return corners @ matrix(geom.orientation).T + np.asarray(geom.position)


def _along(start: FloatArray, end: FloatArray) -> FloatArray:
    count = max(int(np.ceil(np.linalg.norm(end - start) / SPACING)), 1)
    return start + np.linspace(0.0, 1.0, count + 1)[:, None] * (end - start)


def _corners(geom: Geom) -> FloatArray:
    x, y, z = geom.size
    if geom.type == "mesh":
        return np.asarray(geom.vertices, dtype=np.float64)
    if geom.type == "box":
        return np.array(list(itertools.product((-x, x), (-y, y), (-z, z))))
    if geom.type == "plane":
        return np.zeros((0, 3))
    angles = np.linspace(0.0, 2 * np.pi, ROUND, endpoint=False)
    circle = np.stack([np.cos(angles), np.sin(angles), np.zeros(ROUND)], axis=1)
    if geom.type == "cylinder":
        return np.concatenate([x * circle + (0.0, 0.0, y), x * circle - (0.0, 0.0, y)])
    # A sphere, an ellipsoid, a capsule: circles of latitude.
    latitudes = np.linspace(-np.pi / 2, np.pi / 2, ROUND // 2)
    ball = np.concatenate([np.cos(a) * circle + (0.0, 0.0, np.sin(a)) for a in latitudes])
    if geom.type == "ellipsoid":
        return ball * np.array([x, y, z])
    if geom.type == "capsule":
        return x * ball + np.sign(ball[:, 2:]) * (0.0, 0.0, y)
    return x * ball
