"""The matter of a thing at its pose: distances and bounds in the world."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import FloatArray
from prolepsis.geometry.signed_distance import Field, field_of
from prolepsis.geometry.solids import bounded
from prolepsis.log.things import Thing


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Posed:
    """A shape where it is."""

    name: str
    """The thing."""
    field: Field
    """Its field, in its own frame."""
    position: FloatArray
    """Origin of its frame in the world [m], shape (3,)."""
    rotation: FloatArray
    """Columns are its axes in the world, shape (3, 3)."""
    low: FloatArray
    """Least world coordinates [m], shape (3,); minus infinity for a plane."""
    high: FloatArray
    """Greatest world coordinates [m], shape (3,); infinity for a plane."""

    def distance(self, points: FloatArray) -> FloatArray:
        """Return the signed distance of world points, shape (n, 3), to it [m], shape (n,)."""
        return self.field.distance((points - self.position) @ self.rotation)


def posed(thing: Thing) -> Posed:
    """Return a thing's matter where the thing is. It must have some."""
    rotation, position = matrix(np.array(thing.orientation)), np.array(thing.position)
    solids = bounded(thing.shape)
    low, high = np.full(3, -np.inf), np.full(3, np.inf)
    if len(solids) == len(thing.shape.geoms):
        corners: list[FloatArray] = []
        for solid in solids:
            least, greatest = solid.bounds()
            chosen = np.indices((2, 2, 2)).reshape(3, -1).T == 1
            corners.append(np.where(chosen, greatest, least) @ rotation.T + position)
        low, high = np.concatenate(corners).min(axis=0), np.concatenate(corners).max(axis=0)
    return Posed(name=thing.name, field=field_of(thing.shape), position=position, rotation=rotation, low=low, high=high)


def nearest(matter: Iterable[Posed], points: FloatArray) -> FloatArray:
    """Return the distance of world points, shape (n, 3), to the nearest matter [m], shape (n,)."""
    found = np.full(len(points), np.inf)
    for each in matter:
        found = np.minimum(found, each.distance(points))
    return found
