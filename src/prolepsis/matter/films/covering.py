"""How much of a surface a film covers: where particles have touched it, in cells, of each what lies on the surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.rotations import cross
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray, Shape
from prolepsis.geometry.signed_distance import field_of

NUDGE = 1.0e-5
"""Step with which the direction to a surface is found [m]."""
SAMPLES = 4
"""Points along each side of a cell, by which is found how much of the surface is in it."""
EXTENT = 0.25
"""How far round its middle a particle surely touches [spacings]; its like are a whole one away."""
OFF = 0.05
"""So far from a surface a point beside that at which it is touched is not on it [spacings]."""
SHIFT = np.array([0.371, 0.413, 0.293])
"""Of the cells from the middle of a thing [cells], so that no face of a box lies just between two of them."""
_BITS = 20
"""Bits of a cell's number along an axis, besides three for the side to which the surface faces."""
_HALF = 1 << (_BITS - 1)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Film:
    """What is wet of a surface; all in the frame of its thing."""

    cells: IntArray
    """Cells a spacing wide and the side of the six to which the surface faces there, as one number each, ascending,
    shape (n,); a thin plate has both of its faces in one cell."""
    positions: FloatArray
    """Where the first particle was that touched the surface in each [m], shape (n, 3)."""
    areas: FloatArray
    """How much of the surface is in each [m^2], shape (n,)."""

    @property
    def area(self) -> float:
        """All of it [m^2]."""
        return float(self.areas.sum())

    def only(self, chosen: BoolArray) -> Film:
        """Return a part of it, chosen by cell, shape (n,)."""
        return Film(cells=self.cells[chosen], positions=self.positions[chosen], areas=self.areas[chosen])

    def grown(self, shape: Shape, spacing: float, positions: FloatArray) -> Film:
        """Return it with what particles near a shape touch, which are at some positions [m], shape (m, 3)."""
        distance, normal = _surface(shape, positions)
        foot = positions - distance[:, None] * normal
        if len(foot):
            foot, normal, positions = _spread(shape, spacing, foot, normal, positions)
        corner = np.floor(foot / spacing + SHIFT)
        numbers = corner.astype(np.int64) + _HALF
        side = _side(normal)
        cells = (((numbers[:, 0] << _BITS | numbers[:, 1]) << _BITS | numbers[:, 2]) << 3) | side
        found, first = np.unique(cells, return_index=True)
        first = first[~np.isin(found, self.cells)]
        if not len(first):
            return self
        areas = _areas(shape, spacing, (corner[first] - SHIFT) * spacing, side[first])
        cells = np.concatenate((self.cells, cells[first]))
        order = np.argsort(cells)
        return Film(
            cells=cells[order],
            positions=np.concatenate((self.positions, positions[first]))[order],
            areas=np.concatenate((self.areas, areas))[order],
        )


NOWHERE = Film(cells=np.zeros(0, dtype=np.int64), positions=np.zeros((0, 3)), areas=np.zeros(0))
"""A film that covers nothing."""


def _spread(
    shape: Shape, spacing: float, foot: FloatArray, normal: FloatArray, positions: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return where particles touch a surface, and four points on it round that of each: they are no points."""
    first = cross(normal, np.eye(3)[np.argmin(np.abs(normal), axis=1)])
    first /= np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-12)
    second = cross(normal, first)
    beside = np.concatenate([foot + EXTENT * spacing * each for each in (first, -first, second, -second)])
    distance, facing = _surface(shape, beside)
    # Beyond the edge of a face there is nothing to touch.
    on = (np.abs(distance) < OFF * spacing) & (_side(facing) == np.tile(_side(normal), 4))
    beside = beside - distance[:, None] * facing
    return (
        np.concatenate((foot, beside[on])),
        np.concatenate((normal, facing[on])),
        np.concatenate((positions, np.tile(positions, (4, 1))[on])),
    )


def _areas(shape: Shape, spacing: float, corners: FloatArray, sides: IntArray) -> FloatArray:
    """Return how much of a surface is in each cell and faces to one of the six sides [m^2], shape (n,).

    A surface has as much area as the space near it has volume, over its thickness.
    """
    step = spacing / SAMPLES
    # Of what is beyond its sides, too, the nearest point of the surface may be in it.
    along = (np.arange(-1, SAMPLES + 1) + 0.5) * step
    grid = np.stack(np.meshgrid(along, along, along, indexing="ij"), axis=-1).reshape(-1, 3)
    points = (corners[:, None] + grid).reshape(-1, 3)
    near = np.flatnonzero(np.abs(field_of(shape).distance(points)) < step)
    distance, normal = _surface(shape, points[near])
    cell = near // len(grid)
    foot = points[near] - distance[:, None] * normal - corners[cell]
    own = ((foot >= 0.0) & (foot < spacing)).all(axis=1) & (_side(normal) == sides[cell])
    weight = np.where(own, 1.0 - np.abs(distance) / step, 0.0)
    areas: FloatArray = np.bincount(cell, weight, len(corners)).astype(np.float64) * step**2
    return areas


def _side(normals: FloatArray) -> IntArray:
    """Return to which of six sides each normal points, shape (n,)."""
    axis = np.argmax(np.abs(normals), axis=1)
    return 2 * axis + (np.take_along_axis(normals, axis[:, None], axis=1)[:, 0] > 0)


def _surface(shape: Shape, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return how far the surface is from each point [m], shape (n,), and its normal there, shape (n, 3)."""
    field = field_of(shape)
    distance = field.distance(points)
    slope = np.stack([field.distance(points + NUDGE * axis) - distance for axis in np.eye(3)], axis=1)
    return distance, slope / np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-12)
