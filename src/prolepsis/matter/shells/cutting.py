"""An egg: an ellipsoid whose shell is a graph of convex pieces joined along their common edges."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from prolepsis.geometry.shape import FloatArray, IntArray

SAMPLE_COUNT = 12000
"""Points that sample the shell; a piece has some 400 of them, so edge lengths are known to about 3 %."""
RELAXATIONS = 40
"""Lloyd steps that make the pieces equally large."""
RIM_COUNT = 12
"""Vertices along the rim of a piece, on each face: a polygon of five to seven corners keeps them."""
CROWN_STRIDE = 24
"""Every so many samples of the middle of a piece is a vertex: some five, which keep it domed."""
SHRINK = 0.985
"""Pieces are drawn in by 1.5 % of their size, so that neighbours do not push each other when they part."""


@dataclass(frozen=True, kw_only=True, slots=True)
class CutShell:
    """A closed shell as a graph: n pieces (nodes) and m bonds (edges), in the egg's frame."""

    centres: FloatArray
    """Centre of each piece on the mid-surface [m], shape (n, 3)."""
    normals: FloatArray
    """Outward unit normals at the centres, shape (n, 3)."""
    areas: FloatArray
    """Surface of each piece [m^2], shape (n,)."""
    outlines: tuple[FloatArray, ...]
    """Convex vertices of each piece relative to its centre [m], n arrays of shape (v, 3)."""
    bonds: IntArray
    """Neighbouring pieces, shape (m, 2), the smaller index first."""
    widths: FloatArray
    """Length of the common edge of each bond [m], shape (m,)."""


def ellipsoid_points(semi_axes: FloatArray, count: int) -> FloatArray:
    """Return ``count`` points spread evenly over an ellipsoid's surface, shape (count, 3) [m]."""
    # A spiral over the unit sphere, thinned to equal area: keep the points in the order of the area stretch.
    i = np.arange(4 * count) + 0.5
    z = 1 - 2 * i / (4 * count)
    angle = np.pi * (1 + 5**0.5) * i
    unit = np.stack([np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle), z], axis=1)
    stretch = np.prod(semi_axes) * np.linalg.norm(unit / semi_axes, axis=1)
    chosen = np.floor(np.cumsum(stretch) / stretch.sum() * count - 1e-9)
    _, first = np.unique(chosen, return_index=True)
    return unit[first] * semi_axes


def ellipsoid_normals(points: FloatArray, semi_axes: FloatArray) -> FloatArray:
    """Return the outward unit normals of an ellipsoid at ``points`` on its surface, shape (n, 3)."""
    gradient = points / semi_axes**2
    return gradient / np.linalg.norm(gradient, axis=1, keepdims=True)


def curvature_radius(semi_axes: FloatArray, point: FloatArray) -> float:
    """Return the radius of the sphere with the Gaussian curvature that an ellipsoid has at a point on it [m]."""
    return float(np.prod(semi_axes) * ((point / semi_axes**2) ** 2).sum())


@lru_cache(maxsize=8)
def ellipsoid_shell(semi_axes: tuple[float, float, float], piece_count: int, thickness: float) -> CutShell:
    """Return the shell of an ellipsoid, cut into equally large convex pieces.

    The pieces are the Voronoi cells of ``piece_count`` points after Lloyd's relaxation, so the cut is the
    same for the same arguments.

    Args:
        semi_axes: Half lengths of the ellipsoid along x, y, z [m].
        piece_count: Number of pieces, at least 4.
        thickness: Thickness of the shell [m].
    """
    axes = np.asarray(semi_axes)
    samples = ellipsoid_points(axes, SAMPLE_COUNT)
    normals = ellipsoid_normals(samples, axes)
    centres = ellipsoid_points(axes, piece_count)
    coarse = samples[::3]
    for _ in range(RELAXATIONS):
        owner = _nearest(coarse, centres)
        sums = np.zeros((piece_count, 3))
        np.add.at(sums, owner, coarse)
        means = sums / np.bincount(owner, minlength=piece_count)[:, None]
        centres = means / np.linalg.norm(means / axes, axis=1, keepdims=True)
    order = np.lexsort((centres[:, 2], centres[:, 1], centres[:, 0]))
    centres = centres[order]
    owner = _nearest(samples, centres)
    bonds, widths = _common_edges(samples, owner, centres, axes)
    outlines = tuple(
        _outline(samples[owner == k], normals[owner == k], centres[k], thickness) for k in range(piece_count)
    )
    surface = _ellipsoid_area(axes)
    areas = np.bincount(owner, minlength=piece_count) / len(samples) * surface
    return CutShell(
        centres=centres,
        normals=ellipsoid_normals(centres, axes),
        areas=areas,
        outlines=outlines,
        bonds=bonds,
        widths=widths,
    )


def _nearest(samples: FloatArray, centres: FloatArray) -> IntArray:
    # |s - c|^2 without |s|^2, which is the same for every centre.
    return ((centres**2).sum(axis=1) - 2 * samples @ centres.T).argmin(axis=1)


def _common_edges(
    samples: FloatArray, owner: IntArray, centres: FloatArray, axes: FloatArray
) -> tuple[IntArray, FloatArray]:
    """Return neighbouring pairs and the lengths of their common edges [m].

    A strip of half width h along an edge of length w has the area 2 h w; the samples in it measure w.
    """
    squared = (samples**2).sum(axis=1)[:, None] + (centres**2).sum(axis=1) - 2 * samples @ centres.T
    distance = np.sqrt(np.maximum(squared, 0))
    rows = np.arange(len(samples))
    first = owner
    masked = distance.copy()
    masked[rows, first] = np.inf
    second = masked.argmin(axis=1)
    gap = np.linalg.norm(centres[first] - centres[second], axis=1)
    offset = (distance[rows, second] ** 2 - distance[rows, first] ** 2) / (2 * gap)
    half_width = 1.5 * np.sqrt(_ellipsoid_area(axes) / len(samples))
    near = offset < half_width
    pairs = np.sort(np.stack([first[near], second[near]], axis=1), axis=1)
    bonds, counts = np.unique(pairs, axis=0, return_counts=True)
    widths = counts * (_ellipsoid_area(axes) / len(samples)) / (2 * half_width)
    real = widths > 1.5 * half_width  # a corner that touches only in a point is no edge
    return bonds[real], widths[real]


def _outline(points: FloatArray, normals: FloatArray, centre: FloatArray, thickness: float) -> FloatArray:
    """Return some dozens of vertices, outer and inner, of the piece that owns ``points``, relative to its centre."""
    offsets = (points - centre) * SHRINK
    normal = normals.mean(axis=0)
    normal /= np.linalg.norm(normal)
    helper = np.eye(3)[np.argmin(np.abs(normal))]
    u = np.cross(normal, helper)
    u /= np.linalg.norm(u)
    v = np.cross(normal, u)
    angles = np.arctan2(offsets @ v, offsets @ u)
    sector = np.floor((angles + np.pi) / (2 * np.pi) * RIM_COUNT).astype(int)
    radius = np.linalg.norm(offsets, axis=1)
    rim = np.array([np.flatnonzero(sector == k)[radius[sector == k].argmax()] for k in np.unique(sector)])
    crown = np.flatnonzero(radius < 0.5 * radius.max())[::CROWN_STRIDE]
    chosen = np.concatenate([rim, crown, [radius.argmin()]])
    return np.concatenate([offsets[chosen], offsets[rim] - normals[rim] * thickness])


def _ellipsoid_area(axes: FloatArray) -> float:
    """Return the surface of an ellipsoid [m^2], by Thomsen's formula (error below 1.1 %)."""
    a, b, c = axes**1.6075
    return float(4 * np.pi * ((a * b + a * c + b * c) / 3) ** (1 / 1.6075))
