"""Spill levels on a grid: how high a liquid stands at each node before it runs out over the lowest way there is.

A way rises as high as the matter that it passes over, not as the nodes that it leads through: next to matter a node
counts as high as the nearest point of the matter below it, so that a level does not hang on where the nodes lie.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.system.kernels import njit

FINENESS = 64
"""Ways are tried in the order of their heights, which are told apart to this fraction of a grid step."""
DONE, TODO, OUT = 0, 1, 2
"""What is known of a node: its level, nothing yet, or that it is done and next to one of which nothing is known."""


@njit(cache=True)
def pool_levels(
    free: BoolArray, near: IntArray, drop: FloatArray, base: float, across: FloatArray, least_depth: float
) -> FloatArray:
    """Return the spill level of each node that lies below it [m], minus infinity at the others, shape (nx, ny, nz).

    In a closed hollow it is infinite.

    Args:
        free: Nodes that a way may use, shape (nx, ny, nz). Those on the edge of the grid are outside, and free.
        near: Free nodes that are next to matter, numbered in their order, shape (M,).
        drop: How far below each of them the nearest point of the matter is [m], shape (M,).
        base: Height of the first node [m]; node (i, j, k) is at ``base + (i, j, k) @ across``.
        across: Rise from one node to the next along each axis [m], shape (3,).
        least_depth: Depth of a pool below which it is an artefact of the grid [m].
    """
    pool = np.full(free.shape, -np.inf)
    passed = _passed(free, near, drop, base, across)
    level, kind, left = _drained(passed, across)
    if left == 0:
        return pool
    pools, passes, levels, kinds = pool.ravel(), passed.ravel(), level.ravel(), kind.ravel()
    ny, nz = free.shape[1:]
    beside = (-ny * nz, -nz, -1, 1, nz, ny * nz)
    width = math.sqrt(across[0] ** 2 + across[1] ** 2 + across[2] ** 2) / FINENESS
    lowest, highest = np.inf, -np.inf
    for height in passes:
        lowest = min(lowest, height)
        highest = max(highest, height if height < np.inf else lowest)
    # Of each height the node found last, and for each node the one of its height that was found before.
    last = np.full(int((highest - lowest) / width) + 1, -1, dtype=np.int32)
    before = np.empty(len(levels), dtype=np.int32)
    for n in range(len(kinds)):
        if kinds[n] == TODO:
            for offset in beside:
                m = n + offset
                if kinds[m] == DONE and levels[m] < np.inf:
                    kinds[m] = OUT
                    rank = int((levels[m] - lowest) / width)
                    before[m], last[rank] = last[rank], m
    filled = np.empty(len(levels), dtype=np.int32)
    count, first = 0, 0
    at, bottom = -np.inf, np.inf
    for rank in range(len(last)):
        while last[rank] >= 0:
            n = last[rank]
            last[rank] = before[n]
            if levels[n] > at:
                if at - bottom >= least_depth:
                    _fill(pools, filled, count, at, base, across, ny, nz)
                at, bottom, count, first = float(levels[n]), np.inf, 0, 0
            filled[count] = n
            count += 1
            # Whatever it leads to without rising again is filled up to the same level at once.
            while first < count:
                n = filled[first]
                first += 1
                bottom = min(bottom, _height(n, base, across, ny, nz))
                for offset in beside:
                    m = n + offset
                    if m < 0 or m >= len(kinds) or kinds[m] != TODO:
                        continue
                    kinds[m] = DONE
                    left -= 1
                    if passes[m] <= at:
                        filled[count] = m
                        count += 1
                    else:
                        levels[m] = passes[m]
                        rank_of = int((levels[m] - lowest) / width)
                        before[m], last[rank_of] = last[rank_of], m
    if at - bottom >= least_depth:
        _fill(pools, filled, count, at, base, across, ny, nz)
    if left > 0:
        pools[kinds == TODO] = np.inf
    return pool


@njit(cache=True)
def _passed(free: BoolArray, near: IntArray, drop: FloatArray, base: float, across: FloatArray) -> FloatArray:
    """Return how high a way through each node must rise [m], infinity where none leads, shape (nx, ny, nz)."""
    nx, ny, nz = free.shape
    passed = np.empty((nx, ny, nz))
    for i in range(nx):
        for j in range(ny):
            height = base + i * across[0] + j * across[1]
            for k in range(nz):
                passed[i, j, k] = height + k * across[2] if free[i, j, k] else np.inf
    flat = passed.ravel()
    for m in range(len(near)):
        flat[near[m]] -= max(drop[m], 0.0)
    return passed


@njit(cache=True)
def _drained(passed: FloatArray, across: FloatArray) -> tuple[FloatArray, npt.NDArray[np.uint8], int]:
    """Return levels at which ways lead out, whether there may be lower ones, and of how many nodes.

    There is none where a way leads steadily down.
    """
    nx, ny, nz = passed.shape
    level, kind, left = passed.copy(), np.zeros((nx, ny, nz), dtype=np.uint8), 0
    di, dj, dk = (1 if across[0] >= 0.0 else -1), (1 if across[1] >= 0.0 else -1), (1 if across[2] >= 0.0 else -1)
    # Lower nodes first, so that one pass suffices.
    for a in range(1, nx - 1):
        i = a if di > 0 else nx - 1 - a
        for b in range(1, ny - 1):
            j = b if dj > 0 else ny - 1 - b
            own, side, front, ground, open = level[i, j], level[i - di, j], level[i, j - dj], passed[i, j], kind[i, j]
            k = 1 if dk > 0 else nz - 2
            below = own[k - dk]
            for _ in range(nz - 2):
                below = max(min(min(side[k], front[k]), below), ground[k])
                own[k] = below
                if below > ground[k]:
                    open[k] = TODO
                    left += 1
                k += dk
    return level, kind, left


@njit(cache=True, inline="always")
def _height(n: int, base: float, across: FloatArray, ny: int, nz: int) -> float:
    """Return the height of a node [m]."""
    row = n // nz
    return base + (row // ny) * across[0] + (row % ny) * across[1] + (n - row * nz) * across[2]


@njit(cache=True)
def _fill(
    pools: FloatArray,
    filled: npt.NDArray[np.int32],
    count: int,
    at: float,
    base: float,
    across: FloatArray,
    ny: int,
    nz: int,
) -> None:
    """Write a level at those nodes that lie below it."""
    for c in range(count):
        n = filled[c]
        if _height(n, base, across, ny, nz) < at:
            pools[n] = at


@njit(cache=True)
def level_at(points: FloatArray, apart: FloatArray, step: float, distance: FloatArray, pools: FloatArray) -> FloatArray:
    """Return the highest level at the nodes round each point that are on its side of all walls [m], shape (N,).

    Args:
        points: Seen from the first node [m], shape (N, 3).
        apart: How far from matter they are at least [m], shape (N,).
        step: Distance between nodes [m].
        distance: Signed distance of each node to matter [m], shape (nx, ny, nz).
        pools: Spill level of each node in a pool [m], minus infinity at the others, the same shape.
    """
    nx, ny, nz = pools.shape
    level = np.full(len(points), -np.inf)
    for n in range(len(points)):
        x, y, z = points[n, 0] / step, points[n, 1] / step, points[n, 2] / step
        for i in range(max(math.floor(x), 0), min(math.floor(x) + 2, nx)):
            for j in range(max(math.floor(y), 0), min(math.floor(y) + 2, ny)):
                for k in range(max(math.floor(z), 0), min(math.floor(z) + 2, nz)):
                    if pools[i, j, k] > level[n]:
                        # Two balls without matter that meet: nothing is between their middles.
                        reach = (apart[n] + distance[i, j, k]) / step
                        if math.sqrt((x - i) ** 2 + (y - j) ** 2 + (z - k) ** 2) < reach:
                            level[n] = pools[i, j, k]
    return level
