"""Nodes of a grid and all others that free ways of some steps lead to."""

from __future__ import annotations

import numpy as np

from prolepsis.geometry.shape import BoolArray
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
