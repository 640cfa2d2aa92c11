"""How high a liquid would stand at each node of a grid, along one direction up.

Most free nodes drain: from them a way leads to the edge of the grid that never rises. Only for the others, few of
them, the least pass on a way out has to be found.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.system.kernels import njit

BLOCKED, DRAINED, OPEN, SEEN = 0, 1, 2, 3
"""What is known of a node: no way uses it, a way leads down from it, none is known yet, or it is in a pool."""

_Kinds = npt.NDArray[np.uint8]


@njit(cache=True)
def standing(free: BoolArray, base: float, across: FloatArray, least_depth: float, clearance: float) -> FloatArray:
    """Return how high a liquid would stand at each node [m], minus infinity where none would stay.

    In a closed hollow it is infinite.

    Args:
        free: Nodes that a way may use, shape (nx, ny, nz).
        base: Height of the first node [m]; node (i, j, k) is at ``base + (i, j, k) @ across``.
        across: Rise from one node to the next along each axis [m], shape (3,).
        least_depth: Depth of a pool below which it is an artefact [m].
        clearance: Height above an edge at which the way out passes it [m].
    """
    pool = np.full(free.shape, -np.inf)
    kind, low, high = _surroundings(free)
    if high[0] < low[0]:
        return pool
    _drain(kind, low, high, across)
    nodes = _open_nodes(kind, low, high)
    if len(nodes) > 0:
        level = np.empty(free.shape)
        _least_passes(kind, nodes, base, across, level)
        _fill(kind, nodes, level, base, across, least_depth, clearance, pool)
    return pool


@njit(cache=True)
def _surroundings(free: BoolArray) -> tuple[_Kinds, IntArray, IntArray]:
    """Return the kind of each node, all that is outside the box round the blocked ones drained, and that box."""
    nx, ny, nz = free.shape
    low, high = np.array([nx, ny, nz]), np.array([-1, -1, -1])
    for i in range(nx):
        for j in range(ny):
            row, count = free[i, j], 0
            # Most rows are free, which is quick to see.
            for k in range(nz):
                count += row[k]
            if count == nz:
                continue
            low[0], high[0] = min(low[0], i), i
            low[1], high[1] = min(low[1], j), max(high[1], j)
            first, last = 0, nz - 1
            while row[first]:
                first += 1
            while row[last]:
                last -= 1
            low[2], high[2] = min(low[2], first), max(high[2], last)
    kind = np.empty((nx, ny, nz), dtype=np.uint8)
    first, last = max(low[2], 1), min(high[2], nz - 2)
    for i in range(nx):
        for j in range(ny):
            row, own = free[i, j], kind[i, j]
            for k in range(nz):
                own[k] = DRAINED * row[k]
            if max(low[0], 1) <= i <= min(high[0], nx - 2) and max(low[1], 1) <= j <= min(high[1], ny - 2):
                for k in range(first, last + 1):
                    own[k] = OPEN * row[k]
    return kind, low, high


@njit(cache=True)
def _drain(kind: _Kinds, low: IntArray, high: IntArray, across: FloatArray) -> None:
    """Mark the open nodes from which a way that never rises leads to a drained one."""
    nx, ny, nz = kind.shape
    # Lower nodes first: then one pass suffices, except along axes on which all are equally high.
    level = across[0] == 0.0 or across[1] == 0.0 or across[2] == 0.0
    changed, backward = True, False
    while changed:
        changed = False
        up = np.empty(3, dtype=np.bool_)
        for c in range(3):
            up[c] = across[c] > 0.0 or (across[c] == 0.0 and not backward)
        below_x, above_x = across[0] >= 0.0, across[0] <= 0.0
        below_y, above_y = across[1] >= 0.0, across[1] <= 0.0
        below_z, above_z = across[2] >= 0.0, across[2] <= 0.0
        left, right = max(low[0], 1), min(high[0], nx - 2)
        front, back = max(low[1], 1), min(high[1], ny - 2)
        bottom, top = max(low[2], 1), min(high[2], nz - 2)
        for a in range(right - left + 1):
            i = left + a if up[0] else right - a
            for b in range(back - front + 1):
                j = front + b if up[1] else back - b
                for c in range(top - bottom + 1):
                    k = bottom + c if up[2] else top - c
                    if kind[i, j, k] != OPEN:
                        continue
                    if (
                        (below_x and kind[i - 1, j, k] == DRAINED)
                        or (above_x and kind[i + 1, j, k] == DRAINED)
                        or (below_y and kind[i, j - 1, k] == DRAINED)
                        or (above_y and kind[i, j + 1, k] == DRAINED)
                        or (below_z and kind[i, j, k - 1] == DRAINED)
                        or (above_z and kind[i, j, k + 1] == DRAINED)
                    ):
                        kind[i, j, k] = DRAINED
                        changed = level
        backward = not backward


@njit(cache=True)
def _open_nodes(kind: _Kinds, low: IntArray, high: IntArray) -> npt.NDArray[np.int32]:
    """Return the open nodes in their order, shape (N, 3)."""
    count = 0
    for i in range(low[0], high[0] + 1):
        for j in range(low[1], high[1] + 1):
            row = kind[i, j]
            for k in range(len(row)):
                count += row[k] == OPEN
    nodes = np.empty((count, 3), dtype=np.int32)
    found = 0
    for i in range(low[0], high[0] + 1):
        for j in range(low[1], high[1] + 1):
            row, more = kind[i, j], 0
            for k in range(len(row)):
                more += row[k] == OPEN
            for k in range(low[2], high[2] + 1 if more > 0 else 0):
                if row[k] == OPEN:
                    nodes[found, 0], nodes[found, 1], nodes[found, 2] = i, j, k
                    found += 1
    return nodes


@njit(cache=True)
def _least_passes(
    kind: _Kinds, nodes: npt.NDArray[np.int32], base: float, across: FloatArray, level: FloatArray
) -> None:
    """Write the least possible greatest height on a way to the edge of the grid, for open nodes and those beside."""
    sx, sy, sz = across[0], across[1], across[2]
    for n in range(len(nodes)):
        i, j, k = nodes[n, 0], nodes[n, 1], nodes[n, 2]
        for axis in range(3):
            for side in (-1, 1):
                u, v, w = _beside(i, j, k, axis, side)
                if kind[u, v, w] == DRAINED:
                    level[u, v, w] = base + u * sx + v * sy + w * sz
                elif kind[u, v, w] == BLOCKED:
                    level[u, v, w] = np.inf
        level[i, j, k] = np.inf
    changed, backward = True, False
    while changed:
        changed = False
        for number in range(len(nodes)):
            n = len(nodes) - 1 - number if backward else number
            i, j, k = nodes[n, 0], nodes[n, 1], nodes[n, 2]
            least = min(level[i - 1, j, k], level[i + 1, j, k])
            least = min(least, min(level[i, j - 1, k], level[i, j + 1, k]))
            least = min(least, min(level[i, j, k - 1], level[i, j, k + 1]))
            least = max(least, base + i * sx + j * sy + k * sz)
            if least < level[i, j, k]:
                level[i, j, k] = least
                changed = True
        # A pass that changed nothing ends it; else the way back carries levels against the order.
        backward = not backward


@njit(cache=True)
def _fill(
    kind: _Kinds,
    nodes: npt.NDArray[np.int32],
    level: FloatArray,
    base: float,
    across: FloatArray,
    least_depth: float,
    clearance: float,
    pool: FloatArray,
) -> None:
    """Write the levels of the pools that are deep enough, less the height at which an edge is passed."""
    sx, sy, sz = across[0], across[1], across[2]
    stack = np.empty((len(nodes), 3), dtype=np.int32)
    for n in range(len(nodes)):
        i, j, k = nodes[n, 0], nodes[n, 1], nodes[n, 2]
        if kind[i, j, k] != OPEN or level[i, j, k] <= base + i * sx + j * sy + k * sz:
            continue
        stack[0, 0], stack[0, 1], stack[0, 2] = i, j, k
        kind[i, j, k] = SEEN
        first, count, deepest = 0, 1, 0.0
        while first < count:
            x, y, z = stack[first, 0], stack[first, 1], stack[first, 2]
            first += 1
            deepest = max(deepest, level[x, y, z] - (base + x * sx + y * sy + z * sz))
            for axis in range(3):
                for side in (-1, 1):
                    u, v, w = _beside(x, y, z, axis, side)
                    if kind[u, v, w] != OPEN or level[u, v, w] <= base + u * sx + v * sy + w * sz:
                        continue
                    kind[u, v, w] = SEEN
                    stack[count, 0], stack[count, 1], stack[count, 2] = u, v, w
                    count += 1
        if deepest >= least_depth:
            for s in range(count):
                x, y, z = stack[s, 0], stack[s, 1], stack[s, 2]
                pool[x, y, z] = level[x, y, z] - clearance


@njit(cache=True, inline="always")
def _beside(i: int, j: int, k: int, axis: int, side: int) -> tuple[int, int, int]:
    """Return the next node along an axis."""
    return i + side * (axis == 0), j + side * (axis == 1), k + side * (axis == 2)
