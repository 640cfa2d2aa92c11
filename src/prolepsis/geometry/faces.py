"""The faces of solids near a point: distance and outward normal, for numba kernels.

A solid is a row of flat arrays, so that a kernel needs no objects. Most solids show one face, the nearest; a
turned profile shows each of its sides that the point is in front of, so that a corner is seen as two walls.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.geometry.thin_shells import shell_face
from prolepsis.system.kernels import njit

PLANE, SPHERE, CAPSULE, ELLIPSOID, CYLINDER, BOX, HULL, PROFILE, GRID, SHELL = range(10)
"""Kinds of solids: MuJoCo's primitives, planes of a convex hull, a turned outline, distances on a grid, pieces of a
thin shell."""
ON_AXIS = 1e-9
"""What is nearer to the axis than this is on it [m]."""
MOST_FACES = 3
"""Greatest number of faces that one solid shows to a point."""


class Solids(NamedTuple):
    """K solids as flat arrays."""

    kind: IntArray
    """One of the kinds above, shape (K,)."""
    frame: FloatArray
    """Position, then the rotation's rows, in the frame of the body, shape (K, 12)."""
    size: FloatArray
    """MuJoCo's size parameters [m], shape (K, 3)."""
    bounds: FloatArray
    """Least and greatest coordinates in the solid's own frame [m], shape (K, 6)."""
    span: IntArray
    """First number and count of the solid's own numbers, first number and count of its holes', shape (K, 4)."""
    numbers: FloatArray
    """One after the other: planes (normal, offset), sides of outlines (begin, end, direction, length), holes
    (position, direction, radius), grids (origin, step, shape, values), pieces of a shell (see ``thin_shells``)."""


@njit(cache=True)
def faces_of(
    solids: Solids, k: int, points: FloatArray, count: int, reach: float, found: FloatArray, seen: IntArray
) -> None:
    """Write the faces of solid ``k`` that points see within ``reach``, nearest first, and how many.

    Args:
        solids: The solids.
        k: Which of them.
        points: In the frame of the body [m], shape (m, 3).
        count: How many of the points are meant, from the first on: a call costs more than a point.
        reach: Faces further than this [m] need not be found.
        found: Signed distance and outward normal in the frame of the body, shape (m, MOST_FACES, 4).
        seen: Number of faces of each point, shape (m,).
    """
    kinds, frame, sizes, bounds, span, numbers = solids
    kind, size = kinds[k], sizes[k]
    ox, oy, oz = frame[k, 0], frame[k, 1], frame[k, 2]
    xx, xy, xz = frame[k, 3], frame[k, 4], frame[k, 5]
    yx, yy, yz = frame[k, 6], frame[k, 7], frame[k, 8]
    zx, zy, zz = frame[k, 9], frame[k, 10], frame[k, 11]
    left, front, low = bounds[k, 0] - reach, bounds[k, 1] - reach, bounds[k, 2] - reach
    right, back, high = bounds[k, 3] + reach, bounds[k, 4] + reach, bounds[k, 5] + reach
    first, length, first_hole, holes = span[k, 0], span[k, 1], span[k, 2], span[k, 3]
    near = np.empty((MOST_FACES, 4))
    for i in range(count):
        seen[i] = 0
        dx, dy, dz = points[i, 0] - ox, points[i, 1] - oy, points[i, 2] - oz
        x = xx * dx + yx * dy + zx * dz
        y = xy * dx + yy * dy + zy * dz
        z = xz * dx + yz * dy + zz * dz
        if x < left or x > right or y < front or y > back or z < low or z > high:
            continue
        faces = 1
        if kind == PLANE:
            near[0, 0], near[0, 1], near[0, 2], near[0, 3] = z, 0.0, 0.0, 1.0
        elif kind == SPHERE:
            _round(x, y, z, size[0], near)
        elif kind == CAPSULE:
            _round(x, y, z - min(max(z, -size[1]), size[1]), size[0], near)
        elif kind == ELLIPSOID:
            _ellipsoid(x, y, z, size, near)
        elif kind == CYLINDER:
            _cylinder(x, y, z, size, near)
        elif kind == BOX:
            _box(x, y, z, size, near)
        elif kind == HULL:
            _hull(x, y, z, numbers, first, length, near)
        elif kind == PROFILE:
            faces = _profile(x, y, z, numbers, first, length, reach, near)
            if holes > 0:
                _drill(x, y, z, numbers, first_hole, holes, near, faces)
        elif kind == SHELL:
            shell_face(x, y, z, size, numbers, first, length, reach, near)
        else:
            _grid(x, y, z, numbers, first, near)
        kept = 0
        for face in range(faces):
            if near[face, 0] < reach:
                nx, ny, nz = near[face, 1], near[face, 2], near[face, 3]
                found[i, kept, 0] = near[face, 0]
                found[i, kept, 1] = xx * nx + xy * ny + xz * nz
                found[i, kept, 2] = yx * nx + yy * ny + yz * nz
                found[i, kept, 3] = zx * nx + zy * ny + zz * nz
                kept += 1
        seen[i] = kept


@njit(cache=True, forceinline=True)
def _round(x: float, y: float, z: float, radius: float, found: FloatArray) -> None:
    length = math.sqrt(x * x + y * y + z * z)
    found[0, 0] = length - radius
    if length > 1e-12:
        found[0, 1], found[0, 2], found[0, 3] = x / length, y / length, z / length
    else:
        found[0, 1], found[0, 2], found[0, 3] = 0.0, 0.0, 1.0


@njit(cache=True, forceinline=True)
def _ellipsoid(x: float, y: float, z: float, size: FloatArray, found: FloatArray) -> None:
    # A close estimate: the implicit function over the length of its gradient, exact on the surface and for a sphere.
    sx, sy, sz = x / size[0], y / size[1], z / size[2]
    gx, gy, gz = sx / size[0], sy / size[1], sz / size[2]
    scaled = math.sqrt(sx * sx + sy * sy + sz * sz)
    slope = math.sqrt(gx * gx + gy * gy + gz * gz)
    if slope < 1e-12:
        found[0, 0] = -min(size[0], min(size[1], size[2]))
        found[0, 1], found[0, 2], found[0, 3] = 0.0, 0.0, 1.0
        return
    found[0, 0] = scaled * (scaled - 1.0) / slope
    found[0, 1], found[0, 2], found[0, 3] = gx / slope, gy / slope, gz / slope


@njit(cache=True, forceinline=True)
def _cylinder(x: float, y: float, z: float, size: FloatArray, found: FloatArray) -> None:
    radial = math.sqrt(x * x + y * y)
    cx, cy = (x / radial, y / radial) if radial > 1e-12 else (1.0, 0.0)
    side, top = radial - size[0], abs(z) - size[1]
    up = 1.0 if z >= 0.0 else -1.0
    if side > 0.0 and top > 0.0:
        distance = math.sqrt(side * side + top * top)
        found[0, 0] = distance
        found[0, 1], found[0, 2], found[0, 3] = cx * side / distance, cy * side / distance, up * top / distance
    elif side > top:
        found[0, 0], found[0, 1], found[0, 2], found[0, 3] = side, cx, cy, 0.0
    else:
        found[0, 0], found[0, 1], found[0, 2], found[0, 3] = top, 0.0, 0.0, up


@njit(cache=True, forceinline=True)
def _box(x: float, y: float, z: float, size: FloatArray, found: FloatArray) -> None:
    qx, qy, qz = abs(x) - size[0], abs(y) - size[1], abs(z) - size[2]
    ux, uy, uz = (1.0 if x >= 0.0 else -1.0), (1.0 if y >= 0.0 else -1.0), (1.0 if z >= 0.0 else -1.0)
    if qx <= 0.0 and qy <= 0.0 and qz <= 0.0:
        found[0, 1], found[0, 2], found[0, 3] = 0.0, 0.0, 0.0
        if qx >= qy and qx >= qz:
            found[0, 0], found[0, 1] = qx, ux
        elif qy >= qz:
            found[0, 0], found[0, 2] = qy, uy
        else:
            found[0, 0], found[0, 3] = qz, uz
        return
    ox, oy, oz = max(qx, 0.0), max(qy, 0.0), max(qz, 0.0)
    distance = math.sqrt(ox * ox + oy * oy + oz * oz)
    found[0, 0] = distance
    found[0, 1], found[0, 2], found[0, 3] = ux * ox / distance, uy * oy / distance, uz * oz / distance


@njit(cache=True, forceinline=True)
def _hull(x: float, y: float, z: float, numbers: FloatArray, first: int, size: int, found: FloatArray) -> None:
    # Inside and in front of a side it is exact, at edges too near by a little.
    found[0, 0] = -np.inf
    for p in range(first, first + size, 4):
        distance = numbers[p] * x + numbers[p + 1] * y + numbers[p + 2] * z - numbers[p + 3]
        if distance > found[0, 0]:
            found[0, 0] = distance
            found[0, 1], found[0, 2], found[0, 3] = numbers[p], numbers[p + 1], numbers[p + 2]


@njit(cache=True, forceinline=True)
def _profile(
    x: float, y: float, z: float, numbers: FloatArray, first: int, size: int, reach: float, found: FloatArray
) -> int:
    """Return the sides of a turned outline that the point is in front of, or the nearest if there is none."""
    r = math.sqrt(x * x + y * y)
    cx, cy = (x / r, y / r) if r > 1e-12 else (1.0, 0.0)
    nearest, nearest_r, nearest_z = np.inf, 0.0, 1.0
    inside, corner = False, False
    count = 0
    for p in range(first, first + size, 7):
        # Where the side begins and ends, its direction, its length.
        ar, az, br, bz = numbers[p], numbers[p + 1], numbers[p + 2], numbers[p + 3]
        er, ez, length = numbers[p + 4], numbers[p + 5], numbers[p + 6]
        if (az > z) != (bz > z) and (r - ar) * ez * (1.0 if ez > 0.0 else -1.0) < er * (z - az) * (
            1.0 if ez > 0.0 else -1.0
        ):
            inside = not inside
        if ar < ON_AXIS and br < ON_AXIS:
            continue
        along = (r - ar) * er + (z - az) * ez
        signed = ez * (r - ar) - er * (z - az)
        beyond = -along if along < 0.0 else along - length if along > length else 0.0
        square = signed * signed + beyond * beyond
        if square < nearest:
            nearest, corner = square, beyond > 0.0
            nearest_r, nearest_z = ez, -er
            if corner:
                end = 0.0 if along < 0.0 else length
                nearest_r, nearest_z = r - ar - end * er, z - az - end * ez
        if beyond == 0.0 and 0.0 < signed < reach and count < found.shape[0]:
            slot = count
            while slot > 0 and found[slot - 1, 0] > signed:
                for c in range(4):
                    found[slot, c] = found[slot - 1, c]
                slot -= 1
            found[slot, 0], found[slot, 1], found[slot, 2], found[slot, 3] = signed, ez * cx, ez * cy, -er
            count += 1
    nearest = math.sqrt(nearest)
    if corner and nearest > 0.0:
        nearest_r, nearest_z = nearest_r / nearest, nearest_z / nearest
    if inside:
        nearest, count = -nearest, 0
        if corner:
            nearest_r, nearest_z = -nearest_r, -nearest_z
    if count == 0 or nearest < found[0, 0] - 1e-9:
        count = min(count, found.shape[0] - 1)
        for slot in range(count, 0, -1):
            for c in range(4):
                found[slot, c] = found[slot - 1, c]
        found[0, 0], found[0, 1], found[0, 2], found[0, 3] = nearest, nearest_r * cx, nearest_r * cy, nearest_z
        count += 1
    return count


@njit(cache=True, forceinline=True)
def _drill(
    x: float, y: float, z: float, numbers: FloatArray, first: int, size: int, found: FloatArray, count: int
) -> None:
    """Change the faces where a hole is drilled through them."""
    for h in range(first, first + size, 7):
        ox, oy, oz = x - numbers[h], y - numbers[h + 1], z - numbers[h + 2]
        ax, ay, az = numbers[h + 3], numbers[h + 4], numbers[h + 5]
        along = ox * ax + oy * ay + oz * az
        if along <= 0.0:
            continue
        ox, oy, oz = ox - along * ax, oy - along * ay, oz - along * az
        off = math.sqrt(ox * ox + oy * oy + oz * oz)
        room = numbers[h + 6] - off
        if room <= 0.0:
            continue
        if off > 1e-12:
            ox, oy, oz = -ox / off, -oy / off, -oz / off
        for i in range(count):
            ahead = found[i, 0]
            # A face that the hole's axis does not pierce (the bottom, beside a hole in the wall) stays.
            if abs(found[i, 1] * ax + found[i, 2] * ay + found[i, 3] * az) < 0.5:
                continue
            if ahead <= 0.0:
                found[i, 0], found[i, 1], found[i, 2], found[i, 3] = room, ox, oy, oz
            else:
                distance = math.sqrt(ahead * ahead + room * room)
                found[i, 1] = (ahead * found[i, 1] + room * ox) / distance
                found[i, 2] = (ahead * found[i, 2] + room * oy) / distance
                found[i, 3] = (ahead * found[i, 3] + room * oz) / distance
                found[i, 0] = distance


@njit(cache=True, forceinline=True)
def _grid(x: float, y: float, z: float, numbers: FloatArray, start: int, found: FloatArray) -> None:
    step = numbers[start + 3]
    nx, ny, nz = int(numbers[start + 4]), int(numbers[start + 5]), int(numbers[start + 6])
    gx, gy, gz = (x - numbers[start]) / step, (y - numbers[start + 1]) / step, (z - numbers[start + 2]) / step
    cx, cy, cz = min(max(gx, 0.0), nx - 1.001), min(max(gy, 0.0), ny - 1.001), min(max(gz, 0.0), nz - 1.001)
    i, j, k = int(cx), int(cy), int(cz)
    u, v, w = cx - i, cy - j, cz - k
    base = start + 7 + (i * ny + j) * nz + k
    a = numbers[base] * (1 - w) + numbers[base + 1] * w
    b = numbers[base + nz] * (1 - w) + numbers[base + nz + 1] * w
    base += ny * nz
    c = numbers[base] * (1 - w) + numbers[base + 1] * w
    d = numbers[base + nz] * (1 - w) + numbers[base + nz + 1] * w
    sx = (c * (1 - v) + d * v) - (a * (1 - v) + b * v)
    sy = (b - a) * (1 - u) + (d - c) * u
    base = start + 7 + (i * ny + j) * nz + k
    front = (numbers[base + 1] - numbers[base]) * (1 - v) + (numbers[base + nz + 1] - numbers[base + nz]) * v
    base += ny * nz
    back = (numbers[base + 1] - numbers[base]) * (1 - v) + (numbers[base + nz + 1] - numbers[base + nz]) * v
    sz = front * (1 - u) + back * u
    slope = max(math.sqrt(sx * sx + sy * sy + sz * sz), 1e-12)
    beyond = step * math.sqrt((gx - cx) ** 2 + (gy - cy) ** 2 + (gz - cz) ** 2)
    found[0, 0] = (a * (1 - v) + b * v) * (1 - u) + (c * (1 - v) + d * v) * u + beyond
    found[0, 1], found[0, 2], found[0, 3] = sx / slope, sy / slope, sz / slope
