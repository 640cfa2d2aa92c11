"""A rigid shape as values: a union of convex solids, and exactly what they stand for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]
Triple = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Colour = tuple[float, float, float, float]
"""Red, green, blue and opacity, each 0..1."""

GEOM_TYPES = ("plane", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh")
"""Convex primitives, with MuJoCo's names and size conventions (half extents)."""

IDENTITY: Quaternion = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Geom:
    """One convex solid in the frame of its thing."""

    type: str
    """One of ``GEOM_TYPES``."""
    size: Triple = (0.0, 0.0, 0.0)
    """MuJoCo's size parameters [m]: radius; radius and half length; half extents. Unused for a mesh."""
    position: Triple = (0.0, 0.0, 0.0)
    """Centre in the thing's frame [m]."""
    orientation: Quaternion = IDENTITY
    """Unit quaternion (w, x, y, z) in the thing's frame."""
    vertices: tuple[Triple, ...] = ()
    """Vertices of a convex mesh in the geom's frame [m]; empty for primitives."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Hole:
    """A round hole that is drilled through a shape."""

    position: Triple
    """A point on its axis, in the thing's frame [m]: it is drilled from here on."""
    direction: Triple
    """Unit vector along its axis, in the thing's frame."""
    radius: float
    """[m]"""


@dataclass(frozen=True, kw_only=True, slots=True)
class Surface:
    """A closed surface of triangles, seen counter-clockwise from outside."""

    vertices: tuple[Triple, ...]
    """In the thing's frame [m]."""
    triangles: tuple[tuple[int, int, int], ...]
    """Indices of vertices."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Patch:
    """A piece of a thin ellipsoidal shell: what of that is nearer to the origin than to the piece's neighbours."""

    semi_axes: Triple
    """Of the middle of the shell's thickness [m]."""
    thickness: float
    """[m]"""
    middle: Triple
    """Of the ellipsoid [m]; its axes are those of the thing's frame."""
    neighbours: tuple[Triple, ...]
    """Their centres [m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Shape:
    """A rigid shape: a union of convex solids. Its cavities follow from it.

    A profile, a surface or a patch, where there is one, says exactly what the solids approximate: what flows past the
    shape, and what its cavity holds, goes by that.
    """

    geoms: tuple[Geom, ...] = ()
    """The convex solids; empty for a whole that consists of its parts."""
    profile: tuple[tuple[float, float], ...] = ()
    """Closed outline (radius, height) [m] that is turned round the z axis of the thing's frame, counter-clockwise
    (radius to the right, height up): the solid lies to its left. Empty for a shape that is not turned."""
    surface: Surface | None = None
    """The closed surface of a shape that was read from a mesh."""
    patch: Patch | None = None
    """What the shape of a piece of a shell stands for."""
    holes: tuple[Hole, ...] = ()
    """What is drilled out of the profile."""
    colour: Colour = (0.7, 0.7, 0.7, 1.0)
    """Red, green, blue, alpha, each 0..1, for pictures only."""


def triple(values: Any) -> Triple:
    """Return the first three of some numbers as plain floats."""
    return float(values[0]), float(values[1]), float(values[2])


def quaternion(values: Any) -> Quaternion:
    """Return the first four of some numbers (w, x, y, z) as plain floats."""
    return float(values[0]), float(values[1]), float(values[2]), float(values[3])
