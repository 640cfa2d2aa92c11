"""Liquids as they look: a smooth, translucent surface over the particles, painted into a finished picture.

Screen-space fluid rendering (van der Laan, Green and Sainz 2009): balls are splatted to distances, these are smoothed,
normals follow from them, and light fades in the thickness by Beer's law. It costs milliseconds, whatever the OpenGL.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.things import Thing
from prolepsis.report.splatting import NOTHING, smoothed, splat

Picture = npt.NDArray[np.uint8]


@dataclass(frozen=True, kw_only=True, slots=True)
class Look:
    """How a liquid looks."""

    colour: tuple[float, float, float]
    """Red, green, blue of a thick layer, each 0..1."""
    opacity: float
    """Its share of the light that a layer takes away is ``1 - exp(-opacity * thickness)`` [1/m]."""


LOOKS: Mapping[str, Look] = {
    "Water": Look(colour=(0.22, 0.52, 0.78), opacity=45.0),
    "Coffee": Look(colour=(0.21, 0.10, 0.04), opacity=320.0),
    "Milk": Look(colour=(0.97, 0.96, 0.92), opacity=900.0),
    "OliveOil": Look(colour=(0.70, 0.66, 0.12), opacity=70.0),
    "Honey": Look(colour=(0.86, 0.50, 0.06), opacity=90.0),
    "PancakeBatter": Look(colour=(0.95, 0.87, 0.66), opacity=700.0),
    "EggWhite": Look(colour=(0.95, 0.92, 0.72), opacity=45.0),
    "EggYolk": Look(colour=(0.98, 0.68, 0.08), opacity=700.0),
}
"""Looks by the class of the liquid, for pictures only; other liquids look like water."""

BALL = 0.78
"""Radius of a particle's ball over the spacing [1]: neighbours merge into one surface."""
SUN = np.array([0.35, -0.75, -0.55]) / np.linalg.norm([0.35, -0.75, -0.55])
"""Where light comes from, to the right, downward and ahead of the eye."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Eye:
    """A camera in the world."""

    position: FloatArray
    """[m]"""
    forward: FloatArray
    """Unit vector into the picture."""
    up: FloatArray
    """Unit vector upward in the picture."""
    focal: float
    """Focal length [pixel]."""

    def seen(self, positions: FloatArray) -> FloatArray:
        """Return positions in the world (n, 3) as seen from the eye: to the right, downward and ahead [m]."""
        axes = np.stack([np.cross(self.forward, self.up), -self.up, self.forward], axis=1)
        return np.ascontiguousarray((positions - self.position) @ axes)


def look_of(thing: Thing) -> Look:
    """Return how a liquid individual looks."""
    return LOOKS.get(thing.kind, LOOKS["Water"])


def painted(
    picture: Picture,
    behind: FloatArray,
    eye: Eye,
    positions: FloatArray,
    kinds: IntArray,
    looks: list[Look],
    spacing: float,
) -> tuple[Picture, FloatArray]:
    """Return a picture with the liquids painted into it, and how much of the light they take away.

    Args:
        picture: Without liquids, shape (height, width, 3).
        behind: Distance of what is seen in each pixel, along the line of sight's forward axis [m].
        eye: From where.
        positions: Centres of the particles in the world [m], shape (n, 3).
        kinds: Index of each particle's look, shape (n,).
        looks: The looks.
        spacing: Distance of neighbours in the liquid [m].
    """
    seen = eye.seen(positions)
    radius = BALL * spacing
    nearest, thickness = splat(seen, kinds, radius, eye.focal, behind, len(looks))
    covered = nearest < NOTHING
    if not covered.any():
        return picture, np.zeros(behind.shape)
    middle = float(np.median(seen[:, 2]))
    reach = int(np.clip(0.9 * radius * eye.focal / max(middle, radius), 1, 24))
    # Mostly the liquid is in a small part of the picture: the rest needs no work.
    part = _around(covered, 2 * reach + 2)
    nearest, thickness, covered = (
        smoothed(nearest[part], reach=reach, step=3.0 * spacing),
        thickness[:, *part],
        covered[part],
    )
    # Balls overlap by more than their volumes: chords add up to this much more than the layer's true thickness.
    excess = 4.0 / 3.0 * np.pi * BALL**3
    depth = _blurred(thickness, max(reach // 2, 1)) / excess
    taken = np.array([look.opacity for look in looks])[:, None, None] * depth
    total = taken.sum(axis=0)
    hue = (
        np.einsum("khw,kc->hwc", taken, np.array([look.colour for look in looks])) / np.maximum(total, 1e-9)[..., None]
    )
    normal = _normals(nearest, eye.focal, (behind.shape[1] / 2 - part[1].start, behind.shape[0] / 2 - part[0].start))
    bright = np.clip(normal @ SUN, 0.0, 1.0)
    gleam = np.clip(normal @ _halfway(), 0.0, 1.0) ** 60
    edge = (1.0 - np.clip(-normal[..., 2], 0.0, 1.0)) ** 4
    solid = (1.0 - np.exp(-total))[..., None]
    below = picture[part].astype(np.float64) / 255.0
    body = hue * (0.62 + 0.45 * bright)[..., None]
    shown = below * (1.0 - solid) + body * solid
    shown = shown * (1.0 - 0.18 * edge[..., None]) + 0.55 * gleam[..., None]
    result, taken_away = picture.copy(), np.zeros(behind.shape)
    lit = np.where(covered[..., None], shown, below)
    result[part] = np.clip(np.rint(lit * 255.0), 0, 255).astype(np.uint8)
    taken_away[part] = np.where(covered, solid[..., 0], 0.0)
    return result, taken_away


def _around(covered: BoolArray, margin: int) -> tuple[slice, slice]:
    """Return the rows and columns of a picture that have anything covered in them, and ``margin`` more on each side."""
    ends = [np.flatnonzero(covered.any(axis=axis))[[0, -1]] for axis in (1, 0)]
    rows, columns = (slice(max(int(low) - margin, 0), int(high) + margin + 1) for low, high in ends)
    return rows, columns


def _blurred(layers: FloatArray, reach: int) -> FloatArray:
    """Return each layer averaged over squares of half width ``reach`` [pixel], twice."""
    from scipy import ndimage  # pyright: ignore[reportMissingTypeStubs]

    blur = cast(Any, ndimage).uniform_filter
    return np.stack([blur(blur(layer, 2 * reach + 1), 2 * reach + 1) for layer in layers])


def _halfway() -> FloatArray:
    half = SUN + np.array([0.0, 0.0, -1.0])
    return half / np.linalg.norm(half)


def _normals(nearest: FloatArray, focal: float, middle: tuple[float, float]) -> FloatArray:
    """Return the unit normals of a surface given by its distances, toward the eye, shape (height, width, 3).

    Args:
        nearest: Distances along the eye's forward axis [m], shape (height, width).
        focal: Focal length [pixel].
        middle: Column and row at which the eye looks [pixel].
    """
    height, width = nearest.shape
    known = nearest < NOTHING
    ahead = np.where(known, nearest, np.nan)
    rows, columns = np.mgrid[0:height, 0:width]
    points = np.stack([(columns - middle[0]) * ahead / focal, (rows - middle[1]) * ahead / focal, ahead], axis=-1)
    slopes: list[FloatArray] = []
    for axis in (1, 0):
        later = np.roll(points, -1, axis) - points
        earlier = points - np.roll(points, 1, axis)
        # At an edge, the side that belongs to the same surface is the one that changes less.
        take = ~(np.abs(later[..., 2]) > np.abs(earlier[..., 2])) & np.isfinite(later[..., 2])
        slopes.append(np.where((take | ~np.isfinite(earlier[..., 2]))[..., None], later, earlier))
    normal = -np.cross(slopes[0], slopes[1])
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    facing = np.array([0.0, 0.0, -1.0])
    good = np.isfinite(length) & (length > 0)
    return np.where(good, normal / np.where(good, length, 1.0), facing)
