"""Nodes of a grid, all others that free ways of some steps lead to, and regions of nodes that hang together."""

from __future__ import annotations

import numpy as np

from prolepsis.geometry.shape import BoolArray, IntArray
from prolepsis.system.kernels import njit


@njit(cache=True)
def spread(nodes: BoolArray, free: BoolArray, steps: int) -> BoolArray:
    """Return nodes and all others that free ways of some steps lead to, also across corners.

    Args:
        nodes: Where the ways begin, shape (nx, ny, nz).
        free: Nodes that a way may use, the same shape.
        steps: Greatest length of a way.
    """
    nx, ny, nz = nodes.shape
    found = nodes.copy()
    queue = np.empty((nx * ny * nz, 3), dtype=np.int32)
    end = 0
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                if nodes[i, j, k]:
                    queue[end, 0], queue[end, 1], queue[end, 2] = i, j, k
                    end += 1
    begin = 0
    for _ in range(steps):
        last = end
        for n in range(begin, last):
            i, j, k = queue[n, 0], queue[n, 1], queue[n, 2]
            for u in range(max(i - 1, 0), min(i + 2, nx)):
                for v in range(max(j - 1, 0), min(j + 2, ny)):
                    for w in range(max(k - 1, 0), min(k + 2, nz)):
                        if free[u, v, w] and not found[u, v, w]:
                            found[u, v, w] = True
                            queue[end, 0], queue[end, 1], queue[end, 2] = u, v, w
                            end += 1
        begin = last
    return found


@njit(cache=True)
def regions(nodes: BoolArray) -> IntArray:
    """Return the number of the region that each node is in, 0 at the others, shape (nx, ny, nz).

    Nodes side by side are in one region. They are numbered from 1, in the order of their first nodes.

    Args:
        nodes: Which nodes are in any, shape (nx, ny, nz).
    """
    nx, ny, nz = nodes.shape
    found = np.zeros(nodes.shape, dtype=np.int64)
    inside, numbers = nodes.ravel(), found.ravel()
    stack = np.empty(len(inside), dtype=np.int32)
    count = 0
    for first in range(len(inside)):
        if not inside[first] or numbers[first] != 0:
            continue
        count += 1
        numbers[first] = count
        stack[0], height = first, 1
        while height > 0:
            height -= 1
            n = stack[height]
            i, j, k = n // (ny * nz), n // nz % ny, n % nz
            for offset, within in (
                (-ny * nz, i > 0),
                (ny * nz, i < nx - 1),
                (-nz, j > 0),
                (nz, j < ny - 1),
                (-1, k > 0),
                (1, k < nz - 1),
            ):
                if within and inside[n + offset] and numbers[n + offset] == 0:
                    numbers[n + offset] = count
                    stack[height] = n + offset
                    height += 1
    return found
