"""Signed distances, bounds and sample points of convex solids, vectorised over points."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from prolepsis.geometry.hull import hull_planes
from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import FloatArray, Geom, Shape

SAMPLE_SCALES = (0.125, 0.25)
"""Where samples lie between the middle (0) and the surface (1) of a solid: deep enough that a wall which the
solid touches is at least three quarters of its least half-width away."""
_STEPS = (-1.0, 0.0, 1.0)
_DIRECTIONS = np.array(
    [(x, y, z) for x in _STEPS for y in _STEPS for z in _STEPS if abs(x) + abs(y) + abs(z) in (1.0, 3.0)]
)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Solid:
    """One convex solid, made ready for distances."""

    type: str
    """One of ``GEOM_TYPES``."""
    size: FloatArray
    """MuJoCo's size parameters [m], shape (3,)."""
    position: FloatArray
    """Centre of the geom's frame [m], shape (3,)."""
    rotation: FloatArray
    """Columns are the geom's axes, shape (3, 3)."""
    geom: Geom
    """The geom that it was made of."""
    corners: FloatArray
    """Extreme points in the geom's frame [m], shape (P, 3)."""

    @property
    def planes(self) -> FloatArray:
        """Hull planes of a mesh (normal, offset), shape (F, 4)."""
        return _planes_of(self.geom)

    @property
    def middle(self) -> FloatArray:
        """Middle of the solid in the thing's frame [m], shape (3,)."""
        return self.position + self.rotation @ self.corners.mean(axis=0)

    @property
    def half_width(self) -> float:
        """Radius of the ball around the middle that fits inside [m]."""
        if self.type == "mesh":
            planes = self.planes
            return float((planes[:, 3] - planes[:, :3] @ self.corners.mean(axis=0)).min())
        return float(self.size[: _size_count(self.type)].min())

    @property
    def volume(self) -> float:
        """Volume of the box around the solid [m^3], as a weight."""
        extent: FloatArray = self.corners.max(axis=0) - self.corners.min(axis=0)
        return float(np.prod(extent))

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Return the least and greatest coordinates in the thing's frame [m], each of shape (3,)."""
        low, high = self.corners.min(axis=0), self.corners.max(axis=0)
        centre, half = (low + high) / 2, (high - low) / 2
        if self.type in ("mesh", "box"):
            points = self.corners @ self.rotation.T + self.position
            return points.min(axis=0), points.max(axis=0)
        reach = np.abs(self.rotation) @ half
        middle = self.position + self.rotation @ centre
        return middle - reach, middle + reach

    def distance(self, points: FloatArray) -> FloatArray:
        """Return the signed distance of points in the thing's frame to the surface [m], negative inside, shape (N,).

        Of an ellipsoid and of a mesh's outer edges it is a close estimate.
        """
        local = (points - self.position) @ self.rotation
        return _DISTANCES[self.type](self, local)


def _size_count(type: str) -> int:
    return {"sphere": 1, "capsule": 1, "cylinder": 2}.get(type, 3)


def _plane(solid: Solid, p: FloatArray) -> FloatArray:
    return p[:, 2].copy()


def _sphere(solid: Solid, p: FloatArray) -> FloatArray:
    return np.sqrt(np.einsum("nc,nc->n", p, p)) - solid.size[0]


def _capsule(solid: Solid, p: FloatArray) -> FloatArray:
    beyond = np.maximum(np.abs(p[:, 2]) - solid.size[1], 0.0)
    return np.sqrt(p[:, 0] ** 2 + p[:, 1] ** 2 + beyond**2) - solid.size[0]


def _ellipsoid(solid: Solid, p: FloatArray) -> FloatArray:
    scaled = p / solid.size
    level = np.sqrt(np.einsum("nc,nc->n", scaled, scaled))
    slope = np.sqrt(np.square(scaled / solid.size).sum(axis=1))
    deepest = -float(solid.size.min())
    return np.where(slope > 1e-12, level * (level - 1.0) / np.maximum(slope, 1e-12), deepest)


def _cylinder(solid: Solid, p: FloatArray) -> FloatArray:
    aside = np.sqrt(p[:, 0] ** 2 + p[:, 1] ** 2) - solid.size[0]
    along = np.abs(p[:, 2]) - solid.size[1]
    outside = np.sqrt(np.maximum(aside, 0.0) ** 2 + np.maximum(along, 0.0) ** 2)
    return outside + np.minimum(np.maximum(aside, along), 0.0)


def _box(solid: Solid, p: FloatArray) -> FloatArray:
    beyond = np.abs(p) - solid.size
    outside = np.sqrt(np.square(np.maximum(beyond, 0.0)).sum(axis=1))
    return outside + np.minimum(beyond.max(axis=1), 0.0)


def _mesh(solid: Solid, p: FloatArray) -> FloatArray:
    planes = solid.planes
    return (p @ planes[:, :3].T - planes[:, 3]).max(axis=1)


_DISTANCES = {
    "plane": _plane,
    "sphere": _sphere,
    "capsule": _capsule,
    "ellipsoid": _ellipsoid,
    "cylinder": _cylinder,
    "box": _box,
    "mesh": _mesh,
}


@lru_cache(maxsize=4096)
def solid_of(geom: Geom) -> Solid:
    """Return a geom made ready for distances."""
    size = np.array(geom.size)
    vertices = np.array(geom.vertices, dtype=np.float64).reshape(-1, 3)
    return Solid(
        type=geom.type,
        size=size,
        position=np.array(geom.position),
        rotation=matrix(np.array(geom.orientation)),
        geom=geom,
        corners=vertices if geom.type == "mesh" else _corners(geom.type, size),
    )


@lru_cache(maxsize=4096)
def _planes_of(geom: Geom) -> FloatArray:
    # Few meshes are ever looked into, so the hull is not computed before it is needed.
    return hull_planes(np.array(geom.vertices, dtype=np.float64).reshape(-1, 3))


def _corners(type: str, size: FloatArray) -> FloatArray:
    """Return the surface points of a primitive along its axes and diagonals, shape (14, 3)."""
    unit = _DIRECTIONS / np.linalg.norm(_DIRECTIONS, axis=1, keepdims=True)
    if type == "sphere":
        return unit * size[0]
    if type == "ellipsoid":
        return unit * size
    if type == "box":
        return _DIRECTIONS * size
    flat = _DIRECTIONS[:, :2] / np.maximum(np.linalg.norm(_DIRECTIONS[:, :2], axis=1, keepdims=True), 1.0)
    if type == "cylinder":
        return np.column_stack((flat * size[0], _DIRECTIONS[:, 2] * size[1]))
    if type == "capsule":
        return unit * size[0] + np.column_stack((np.zeros((14, 2)), _DIRECTIONS[:, 2] * size[1]))
    return np.zeros((1, 3))


@lru_cache(maxsize=4096)
def matter_of(geom: Geom) -> float:
    """Return the volume of a solid that ends somewhere [m^3]."""
    x, y, z = geom.size
    if geom.type == "mesh":
        # Imported here: the import takes longer than a scene without meshes.
        from scipy import spatial  # pyright: ignore[reportMissingTypeStubs]

        library: Any = spatial
        return float(library.ConvexHull(np.array(geom.vertices)).volume)
    return {
        "sphere": 4 / 3 * math.pi * x**3,
        "capsule": 4 / 3 * math.pi * x**3 + 2 * math.pi * x**2 * y,
        "ellipsoid": 4 / 3 * math.pi * x * y * z,
        "cylinder": 2 * math.pi * x**2 * y,
        "box": 8 * x * y * z,
    }[geom.type]


def bounded(shape: Shape) -> tuple[Solid, ...]:
    """Return the solids of a shape that end somewhere (no planes)."""
    return tuple(solid_of(geom) for geom in shape.geoms if geom.type != "plane")


@lru_cache(maxsize=4096)
def centroid(shape: Shape) -> FloatArray:
    """Return the middle of a shape in its thing's frame [m], shape (3,)."""
    solids = bounded(shape)
    if not solids:
        return np.zeros(3)
    weights = np.array([max(solid.volume, 1e-15) for solid in solids])
    return weights @ np.array([solid.middle for solid in solids]) / weights.sum()


@lru_cache(maxsize=4096)
def centre_of_volume(shape: Shape) -> FloatArray:
    """Return where the centre of mass of a shape of one material is, in its thing's frame [m], shape (3,)."""
    solids = bounded(shape)
    weights = np.array([max(matter_of(solid.geom), 1e-15) for solid in solids])
    return weights @ np.array([solid.middle for solid in solids]) / weights.sum()


@lru_cache(maxsize=4096)
def radius(shape: Shape) -> float:
    """Return the greatest distance of a shape's surface from the origin of its frame [m]."""
    reach = [np.linalg.norm(np.maximum(np.abs(low), np.abs(high))) for low, high in map(Solid.bounds, bounded(shape))]
    return float(max(reach, default=0.0))


def samples(solids: tuple[Solid, ...]) -> tuple[FloatArray, FloatArray]:
    """Return points well inside the solids, in the thing's frame [m], and their shares of the volume.

    Returns:
        Points of shape (N, 3) and weights of shape (N,) that sum to one.
    """
    points: list[FloatArray] = []
    weights: list[FloatArray] = []
    for solid in solids:
        middle = solid.corners.mean(axis=0)
        spread = solid.corners - middle
        if len(spread) > len(_DIRECTIONS):
            spread = spread[np.unique(np.argmax(spread @ _DIRECTIONS.T, axis=0))]
        scales = SAMPLE_SCALES if len(solids) <= 4 else (SAMPLE_SCALES[1],)
        local = np.concatenate([middle[None], *(middle + scale * spread for scale in scales)])
        points.append(local @ solid.rotation.T + solid.position)
        weights.append(np.full(len(local), max(solid.volume, 1e-15) / len(local)))
    weight = np.concatenate(weights)
    return np.concatenate(points), weight / weight.sum()
