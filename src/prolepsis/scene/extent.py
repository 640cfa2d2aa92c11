"""How far a thing reaches along a direction: for placing things on each other and for grasping."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import FloatArray, Geom, Quaternion
from prolepsis.log.things import Thing


def support(thing: Thing, direction: FloatArray) -> float:
    """Return how far a thing reaches beyond its origin along a unit direction of the world [m]."""
    return max(_reach(geom, thing.orientation, direction) for geom in thing.shape.geoms)


def extent_along(thing: Thing, direction: FloatArray) -> float:
    """Return a thing's whole extent along a unit direction of the world [m]."""
    return support(thing, direction) + support(thing, -direction)


def middle(thing: Thing) -> FloatArray:
    """Return the middle of a thing's bounds, seen from its origin in the world's axes [m], shape (3,)."""
    return np.array([support(thing, axis) - support(thing, -axis) for axis in np.eye(3)]) / 2


def place_on(thing: Thing, under: Sequence[Sequence[Thing]]) -> tuple[float, float]:
    """Return where a thing's origin is in the world [m], x and y: as far as it states from the origin of what it is on.

    The way is along the world's axes, however the supporter is turned, as a thing's own angles are about them.

    Args:
        thing: What is placed.
        under: What each supporter is made of; of several the middle counts.
    """
    origins = [things[0].position for things in under]
    x, y = (sum(origin[axis] for origin in origins) / len(origins) for axis in (0, 1))
    return x + thing.quantities.get("x", 0.0), y + thing.quantities.get("y", 0.0)


def _reach(geom: Geom, orientation: Quaternion, direction: FloatArray) -> float:
    local = matrix(np.asarray(orientation)).T @ direction
    offset = float(np.asarray(geom.position) @ local)
    own = matrix(np.asarray(geom.orientation)).T @ local
    size = np.asarray(geom.size)
    if geom.type == "sphere":
        return offset + float(size[0])
    if geom.type == "ellipsoid":
        return offset + float(np.linalg.norm(size * own))
    if geom.type == "box":
        return offset + float(np.abs(own) @ size)
    if geom.type == "cylinder":
        return offset + float(size[0] * np.hypot(own[0], own[1]) + size[1] * abs(own[2]))
    if geom.type == "capsule":
        return offset + float(size[0] + size[1] * abs(own[2]))
    if geom.type == "mesh":
        return offset + float((np.asarray(geom.vertices) @ own).max())
    return offset  # a plane reaches as far as its surface
