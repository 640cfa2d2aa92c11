"""Signed distances to solids: at all nodes of a grid, block by block, and at points, with the nearest face.

Most solids are too far from a block of nodes to matter there.
"""

from __future__ import annotations

import math

import numpy as np

from prolepsis.geometry.faces import ELLIPSOID, GRID, HULL, MOST_FACES, PROFILE, SHELL, Solids, faces_of
from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.system.kernels import njit

SIDE = 6
"""Nodes along the edge of a block."""
SLACK = 1.0e-9
"""What rounding may add to a distance [m]."""
AT_ONCE = 1024
"""Points that are looked at together."""


@njit(cache=True)
def node_distances(solids: Solids, origin: FloatArray, step: float, shape: IntArray) -> FloatArray:
    """Return the signed distance of each node to the union of solids [m], of the given shape.

    Args:
        solids: The solids.
        origin: Position of the first node [m], shape (3,).
        step: Distance between nodes [m].
        shape: Number of nodes along each axis, shape (3,).
    """
    nx, ny, nz = shape
    count = len(solids.kind)
    result = np.full((nx, ny, nz), np.inf)
    points, distance = np.empty((SIDE**3, 3)), np.empty(SIDE**3)
    middle, at_middle = np.empty((1, 3)), np.empty(count)
    found, seen = np.empty((SIDE**3, MOST_FACES, 4)), np.empty(SIDE**3, dtype=np.int64)
    for i0 in range(0, nx, SIDE):
        for j0 in range(0, ny, SIDE):
            for k0 in range(0, nz, SIDE):
                i1, j1, k1 = min(i0 + SIDE, nx), min(j0 + SIDE, ny), min(k0 + SIDE, nz)
                size = 0
                for i in range(i0, i1):
                    for j in range(j0, j1):
                        for k in range(k0, k1):
                            points[size, 0] = origin[0] + step * i
                            points[size, 1] = origin[1] + step * j
                            points[size, 2] = origin[2] + step * k
                            distance[size] = np.inf
                            size += 1
                square = 0.0
                for c in range(3):
                    middle[0, c] = 0.5 * (points[0, c] + points[size - 1, c])
                    square += (points[0, c] - middle[0, c]) ** 2
                # No distance changes faster than the point moves.
                across = 2.0 * math.sqrt(square) + SLACK
                nearest = np.inf
                for s in range(count):
                    at_middle[s] = -np.inf
                    if _is_steady(solids.kind[s]):
                        faces_of(solids, s, middle, 1, np.inf, found, seen)
                        at_middle[s] = found[0, 0, 0]
                        nearest = min(nearest, at_middle[s])
                for s in range(count):
                    if at_middle[s] > nearest + across:
                        continue
                    if solids.kind[s] == HULL:
                        _to_hull(solids, s, points, size, middle, across, distance)
                        continue
                    faces_of(solids, s, points, size, np.inf, found, seen)
                    for m in range(size):
                        if seen[m] > 0:
                            distance[m] = min(distance[m], found[m, 0, 0])
                size = 0
                for i in range(i0, i1):
                    for j in range(j0, j1):
                        for k in range(k0, k1):
                            result[i, j, k] = distance[size]
                            size += 1
    return result


@njit(cache=True)
def _is_steady(kind: int) -> bool:
    """Return whether the distances to a solid of this kind never change faster than the point moves."""
    # At the edge of a hole they jump, between nodes they are interpolated, an ellipsoid's are estimates, and those to a
    # shell's pieces are endless from somewhere on.
    return kind not in (PROFILE, GRID, ELLIPSOID, SHELL)


@njit(cache=True)
def _to_hull(
    solids: Solids, s: int, points: FloatArray, count: int, middle: FloatArray, across: float, distance: FloatArray
) -> None:
    """Lower the distances of the points of a block to those to a convex hull, as ``faces_of`` gives them.

    Args:
        solids: The solids.
        s: Which of them.
        points: The block's, shape (m, 3).
        count: How many of the points are meant, from the first on.
        middle: Middle of the block, shape (1, 3).
        across: Twice the greatest distance of its points from the middle [m].
        distance: Lowered, shape (m,).
    """
    frame, numbers = solids.frame, solids.numbers
    ox, oy, oz = frame[s, 0], frame[s, 1], frame[s, 2]
    xx, xy, xz = frame[s, 3], frame[s, 4], frame[s, 5]
    yx, yy, yz = frame[s, 6], frame[s, 7], frame[s, 8]
    zx, zy, zz = frame[s, 9], frame[s, 10], frame[s, 11]
    dx, dy, dz = middle[0, 0] - ox, middle[0, 1] - oy, middle[0, 2] - oz
    x, y, z = xx * dx + yx * dy + zx * dz, xy * dx + yy * dy + zy * dz, xz * dx + yz * dy + zz * dz
    first, length = solids.span[s, 0], solids.span[s, 1]
    ahead, greatest = np.empty(length // 4), -np.inf
    for f in range(length // 4):
        p = first + 4 * f
        ahead[f] = numbers[p] * x + numbers[p + 1] * y + numbers[p + 2] * z - numbers[p + 3]
        greatest = max(greatest, ahead[f])
    # The planes that may be the farthest at some point of the block.
    planes, chosen = np.empty((length // 4, 4)), 0
    for f in range(length // 4):
        if ahead[f] >= greatest - across:
            for c in range(4):
                planes[chosen, c] = numbers[first + 4 * f + c]
            chosen += 1
    for m in range(count):
        dx, dy, dz = points[m, 0] - ox, points[m, 1] - oy, points[m, 2] - oz
        x, y, z = xx * dx + yx * dy + zx * dz, xy * dx + yy * dy + zy * dz, xz * dx + yz * dy + zz * dz
        beyond = -np.inf
        for f in range(chosen):
            beyond = max(beyond, planes[f, 0] * x + planes[f, 1] * y + planes[f, 2] * z - planes[f, 3])
        distance[m] = min(distance[m], beyond)


@njit(cache=True)
def nearest_faces(solids: Solids, points: FloatArray, reach: float) -> FloatArray:
    """Return the signed distance [m] and outward normal of the face nearest to each point, shape (N, 4).

    Args:
        solids: The solids.
        points: In their frame [m], shape (N, 3).
        reach: A face further than this [m] is not found: its distance is infinite, its normal zero.
    """
    result = np.zeros((len(points), 4))
    result[:, 0] = np.inf
    room = min(len(points), AT_ONCE)
    found, seen = np.empty((room, MOST_FACES, 4)), np.empty(room, dtype=np.int64)
    for begin in range(0, len(points), AT_ONCE):
        some = points[begin : begin + AT_ONCE]
        for s in range(len(solids.kind)):
            faces_of(solids, s, some, len(some), reach, found, seen)
            for m in range(len(some)):
                if seen[m] > 0 and found[m, 0, 0] < result[begin + m, 0]:
                    result[begin + m] = found[m, 0]
    return result
