"""The smoothing kernel, and what a flat wall contributes to its sums, as tables over the distance.

The kernel is the cubic spline with a support of two spacings. A wall counts as filled with liquid at rest: what the
sum over its matter would be depends on the distance alone, and is integrated once.

Source: Monaghan, Reports on Progress in Physics 68:1703 (2005), for the spline.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from prolepsis.geometry.kept import kept_array
from prolepsis.geometry.shape import FloatArray
from prolepsis.system.kernels import njit

Singles = npt.NDArray[np.float32]
"""Numbers in single precision, where there are very many."""
Indices = npt.NDArray[np.uint32]
"""Numbers of particles, where there are very many; unsigned, since a kernel looks at the sign of every index else."""
Counts = npt.NDArray[np.uint64]
"""Places in long arrays."""

SUPPORT = 2.0
"""Support radius of the kernel [spacings]."""
TABLE_SIZE = 256
"""Entries of a table from distance 0 to the support."""
PAIR_TABLE_SIZE = 1024
"""Entries of the table for pairs, from 0 to the square of the support."""
CLOSEST = 0.25
"""Least distance to a wall for which its drag is computed [spacings]."""
ATTRACTION_START = 0.95
"""Distance below which neighbours do not attract but repel each other [spacings]."""


INNER, OUTER = 0.98, 0.90
"""Sums of liquid and walls from which on a particle is within, and up to which it is of the surface [1]."""


@njit(cache=True, inline="always")
def weight(q: float) -> float:
    """Return the kernel times the spacing cubed at ``q`` spacings [1]."""
    if q < 1.0:
        return (1.0 - 1.5 * q * q + 0.75 * q * q * q) / np.pi
    if q < 2.0:
        return 0.25 * (2.0 - q) ** 3 / np.pi
    return 0.0


@njit(cache=True, inline="always")
def slope(q: float) -> float:
    """Return the kernel's derivative by distance times the spacing to the fourth at ``q`` spacings [1]."""
    if q < 1.0:
        return (-3.0 * q + 2.25 * q * q) / np.pi
    if q < 2.0:
        return -0.75 * (2.0 - q) ** 2 / np.pi
    return 0.0


@njit(cache=True, inline="always")
def attraction(q: float) -> float:
    """Return how strongly neighbours at ``q`` spacings attract each other, negative if they repel [1]."""
    if q >= SUPPORT:
        return 0.0
    if q < ATTRACTION_START:
        return 3.0 * (q - ATTRACTION_START)
    return (q - ATTRACTION_START) * (SUPPORT - q) * 4.0 / (SUPPORT - ATTRACTION_START) ** 2


@lru_cache(maxsize=1)
def pair_table() -> Singles:
    """Return what two neighbours are to each other, over the square of their distance, shape (PAIR_TABLE_SIZE, 4).

    Columns, all in spacings: kernel; its derivative over the distance; factor of the viscous force; attraction over
    the kernel's steepness.
    """
    table = np.zeros((PAIR_TABLE_SIZE, 4), dtype=np.float32)
    for k, square in enumerate(np.linspace(0.0, SUPPORT**2, PAIR_TABLE_SIZE)):
        q = max(float(np.sqrt(square)), 1e-3)
        w = slope(q)
        table[k] = weight(q), w / q, 10.0 * q / ((q * q + 0.01) * max(-w, 1e-4)), attraction(q) / max(-w, 1e-4)
    return table


@njit(cache=True, inline="always")
def edge(density: float) -> float:
    """Return how much a particle with a given sum of liquid and walls belongs to the surface, from 0 to 1."""
    return min(max((INNER - density) / (INNER - OUTER), 0.0), 1.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class WallTables:
    """Integrals over a half space at a distance of 0 to the support; distances in spacings, shape (TABLE_SIZE,)."""

    share: FloatArray
    """The wall's share of a kernel sum [1]."""
    share_slope: FloatArray
    """Its derivative by the distance [1 / spacing], negative."""
    air: FloatArray
    """The share over the root of what its steepness lacks to the greatest, as a part of that, shape (TABLE_SIZE,)."""
    drag: FloatArray
    """Drag force over viscosity, spacing and slip speed [1] with which a flow of constant shear is undisturbed."""
    pull: FloatArray
    """Attraction by the wall, as strong as that of the same liquid [1]."""
    surface_energy: float
    """Surface tension over the strength of the attraction and the spacing [1], when only the surface attracts."""
    parting_energy: float
    """The same when all attract each other: half the work that parts two half spaces, ``pi / 8 integral of f r^4``."""


@lru_cache(maxsize=1)
def wall_tables() -> WallTables:
    """Return the tables; they hold for every spacing."""
    distances = np.linspace(0.0, SUPPORT, TABLE_SIZE)
    r = (np.arange(4000) + 0.5) * SUPPORT / 4000
    dr = SUPPORT / 4000
    w = np.array([weight(q) for q in r])
    slopes = np.array([slope(q) for q in r])
    attractions = np.array([attraction(q) for q in r])
    share, share_slope, drag, pull = (np.zeros(TABLE_SIZE) for _ in range(4))
    for n, y in enumerate(distances):
        beyond = r > y
        rb = r[beyond]
        share[n] = (w[beyond] * 2 * np.pi * rb**2 * (1 - y / rb)).sum() * dr
        share_slope[n] = -(w[beyond] * 2 * np.pi * rb).sum() * dr
        pull[n] = (attractions[beyond] * np.pi * rb**2 * (1 - (y / rb) ** 2)).sum() * dr
        drag[n] = _drag(y, r, dr, slopes)
    coarse = share, r[::20], attractions[::20]
    # It takes most of a second.
    energy = float(kept_array("tension", coarse, lambda: np.array([_surface_energy(*coarse, 20 * dr)]))[0])
    lacking = np.sqrt(1.0 - share_slope / share_slope[0])
    air = np.interp(np.linspace(0.0, 1.0, TABLE_SIZE), lacking, share)
    return WallTables(
        share=share,
        share_slope=share_slope,
        air=air,
        drag=drag,
        pull=pull,
        surface_energy=energy,
        parting_energy=float((attractions * r**4).sum() * dr) * np.pi / 8,
    )


def _drag(y: float, r: FloatArray, dr: float, slopes: FloatArray) -> float:
    """Return the wall's drag coefficient, such that the force is drag x viscosity x spacing x slip speed [1].

    In a flow with constant shear, the pair forces ``10 mu V (v_ij . x_ij) / r^2 grad W`` of the liquid between ``y``
    and the support above the particle have lost their mirror image below the wall; the drag makes up for it.
    """
    distance = max(y, CLOSEST)
    beyond = r > distance
    q = r[beyond]
    pull = float((-slopes[beyond] * q**2 * (1 - (distance / q) ** 2) ** 2).sum() * dr) * 10 * np.pi / 4
    return pull / distance


def _surface_energy(share: FloatArray, r: FloatArray, attractions: FloatArray, dr: float) -> float:
    """Return the surface tension of a half space whose neighbours attract each other with strength 1 at its edge.

    Source: the difference of the pressures across and along a flat surface, integrated over the depth (Kirkwood and
    Buff, Journal of Chemical Physics 17:338, 1949).
    """
    step = 0.02
    depth = np.arange(step / 2, SUPPORT, step)
    edges = np.array([edge(1.0 - value) for value in share])
    at = np.interp(depth, np.linspace(0.0, SUPPORT, TABLE_SIZE), edges, right=0.0)
    cosine = np.linspace(-1.0, 1.0, 201)[:-1] + 0.005
    there = depth[:, None, None] + r[None, :, None] * cosine[None, None, :]
    both = 0.5 * (at[:, None, None] + np.interp(there, np.linspace(0.0, SUPPORT, TABLE_SIZE), edges, right=0.0))
    both[there < 0.0] = 0.0
    along = (both * (1.0 - 3.0 * cosine**2)).sum(axis=(0, 2)) * step * 0.01
    return float((attractions * r**3 * along).sum() * dr) * np.pi / 2
