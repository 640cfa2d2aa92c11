"""Pieces of a thin shell: the parts of an ellipsoid's surface that are nearest to some of several centres.

A shell is thinner than anything that flows past it, and its edges are where its pieces end.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, Triple
from prolepsis.system.kernels import njit

HEAD, ROW = 2, 4
"""Numbers of a shell: thickness and how many pieces; then of each its centre, and whether it is there."""
ROUNDS = 3
"""In which the nearest place of the surface is found: to a thousandth of the distance."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ThinShell:
    """An ellipsoid's shell that is cut into pieces: each is what is nearest to its centre."""

    semi_axes: Triple
    """Of the middle of its thickness [m]."""
    thickness: float
    """[m]"""
    centres: tuple[Triple, ...]
    """Of the pieces, in the ellipsoid's frame [m]."""

    def numbers(self, there: BoolArray) -> FloatArray:
        """Return what ``shell_face`` needs to know of those pieces that are there, given for each."""
        rows = np.column_stack([np.asarray(self.centres), there.astype(np.float64)])
        return np.concatenate([[self.thickness, len(rows)], rows.ravel()])


@njit(cache=True)
def shell_face(
    x: float,
    y: float,
    z: float,
    size: FloatArray,
    numbers: FloatArray,
    first: int,
    length: int,
    reach: float,
    found: FloatArray,
) -> None:
    """Write signed distance and outward normal of the nearest place of a shell's pieces, shape (1 or more, 4).

    Args:
        x: Of the point, in the ellipsoid's frame [m]; so are y and z.
        y: ..
        z: ..
        size: Semi-axes of the middle of its thickness [m], shape (3,).
        numbers: Those of the shell are among them.
        first: The first of those.
        length: How many they are.
        reach: A shell further than this [m] may be said to be endlessly far.
        found: The distance, then the normal.
    """
    # The foot on the whole ellipsoid: down the gradient, again from where that leads.
    fx, fy, fz = x, y, z
    nx, ny, nz = 0.0, 0.0, 1.0
    for _ in range(ROUNDS):
        sx, sy, sz = fx / size[0], fy / size[1], fz / size[2]
        gx, gy, gz = sx / size[0], sy / size[1], sz / size[2]
        scaled = math.sqrt(sx * sx + sy * sy + sz * sz)
        slope = math.sqrt(gx * gx + gy * gy + gz * gz)
        if slope < 1e-9:
            found[0, 0] = np.inf
            return
        nx, ny, nz = gx / slope, gy / slope, gz / slope
        down = scaled * (scaled - 1.0) / slope
        fx, fy, fz = fx - down * nx, fy - down * ny, fz - down * nz
    thickness, rows = numbers[first], first + HEAD
    end = first + length
    own, nearest = rows, np.inf
    for k in range(rows, end, ROW):
        square = (fx - numbers[k]) ** 2 + (fy - numbers[k + 1]) ** 2 + (fz - numbers[k + 2]) ** 2
        if square < nearest:
            own, nearest = k, square
    beyond, bx, by, bz = 0.0, 0.0, 0.0, 0.0
    if numbers[own + 3] == 0.0:
        # The nearest of the pieces that are there: as far as the farthest of the planes that end it.
        beyond = reach
        for k in range(rows, end, ROW):
            if numbers[k + 3] == 0.0:
                continue
            least = _past(fx, fy, fz, numbers, k, own)
            if least >= beyond:
                continue
            farthest, past = own, least
            for j in range(rows, end, ROW):
                if j != k:
                    other = _past(fx, fy, fz, numbers, k, j)
                    if other > past:
                        farthest, past = j, other
            if past < beyond:
                beyond = past
                bx, by, bz = (
                    numbers[farthest] - numbers[k],
                    numbers[farthest + 1] - numbers[k + 1],
                    numbers[farthest + 2] - numbers[k + 2],
                )
        if beyond >= reach:
            found[0, 0] = np.inf
            return
    dx, dy, dz = x - fx, y - fy, z - fz
    if beyond > 0.0:
        across = bx * nx + by * ny + bz * nz
        bx, by, bz = bx - across * nx, by - across * ny, bz - across * nz
        lateral = max(math.sqrt(bx * bx + by * by + bz * bz), 1e-12)
        dx, dy, dz = dx + beyond * bx / lateral, dy + beyond * by / lateral, dz + beyond * bz / lateral
    distance = math.sqrt(dx * dx + dy * dy + dz * dz)
    found[0, 0] = distance - thickness / 2
    if distance > 1e-9:
        nx, ny, nz = dx / distance, dy / distance, dz / distance
    found[0, 1], found[0, 2], found[0, 3] = nx, ny, nz


@njit(cache=True, forceinline=True)
def _past(x: float, y: float, z: float, numbers: FloatArray, k: int, j: int) -> float:
    """Return how far a point is past the plane halfway from centre k to centre j [m]."""
    ax, ay, az = numbers[j] - numbers[k], numbers[j + 1] - numbers[k + 1], numbers[j + 2] - numbers[k + 2]
    mx, my, mz = numbers[j] + numbers[k], numbers[j + 1] + numbers[k + 1], numbers[j + 2] + numbers[k + 2]
    along = ax * (x - 0.5 * mx) + ay * (y - 0.5 * my) + az * (z - 0.5 * mz)
    return along / math.sqrt(ax * ax + ay * ay + az * az)
