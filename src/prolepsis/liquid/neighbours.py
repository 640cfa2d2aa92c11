"""Neighbours: particles sorted by cell, and for each the others within the support of the kernel."""

from __future__ import annotations

import numpy as np
from numba import njit  # pyright: ignore[reportMissingTypeStubs, reportUnknownVariableType]

from prolepsis.liquid.kernel import PAIR_TABLE_SIZE, SUPPORT, Indices, Singles, weight
from prolepsis.things import FloatArray, IntArray

RADIX = 2048
"""Buckets of one pass of the sort."""


@njit(cache=True)
def cell_order(position: FloatArray, size: float) -> tuple[IntArray, IntArray, int, int]:
    """Return the order of particles by cell, their cells in that order, and the strides of a row and a layer.

    Cells are numbered along x, then y, then z, with an empty one at the end of each row and layer.

    Args:
        position: [m], shape (n, 3).
        size: Edge of a cell [m].
    """
    n = len(position)
    low = np.array([np.inf, np.inf, np.inf])
    high = -low
    for i in range(n):
        for c in range(3):
            low[c] = min(low[c], position[i, c])
            high[c] = max(high[c], position[i, c])
    row = int((high[0] - low[0]) / size) + 3
    layer = row * (int((high[1] - low[1]) / size) + 3)
    keys = np.empty(n, dtype=np.int64)
    greatest = 0
    for i in range(n):
        x = int((position[i, 0] - low[0]) / size)
        y = int((position[i, 1] - low[1]) / size)
        z = int((position[i, 2] - low[2]) / size)
        keys[i] = x + 1 + row * (y + 1) + layer * (z + 1)
        greatest = max(greatest, keys[i])
    order = np.arange(n)
    spare = np.empty(n, dtype=np.int64)
    shift = 0
    while (greatest >> shift) > 0:
        counts = np.zeros(RADIX + 1, dtype=np.int64)
        for i in range(n):
            counts[((keys[i] >> shift) & (RADIX - 1)) + 1] += 1
        for b in range(RADIX):
            counts[b + 1] += counts[b]
        for i in range(n):
            bucket = (keys[order[i]] >> shift) & (RADIX - 1)
            spare[counts[bucket]] = order[i]
            counts[bucket] += 1
        order, spare = spare, order
        shift += 11
    cells = np.empty(n, dtype=np.int64)
    for i in range(n):
        cells[i] = keys[order[i]]
    return order, cells, row, layer


@njit(cache=True, fastmath=True)
def find_neighbours(
    position: FloatArray,
    cells: IntArray,
    row: int,
    layer: int,
    spacing: float,
    side: FloatArray,
    table: Singles,
    start: IntArray,
    other: Indices,
    gradient: Singles,
    drag: Singles,
    density: FloatArray,
    steepness: FloatArray,
    strength: FloatArray,
    force: FloatArray,
) -> int:
    """Write each particle's neighbours, one after the other, with what depends on the distance alone.

    Args:
        position: In the order of cells [m], shape (n, 3).
        cells: Cell of each particle, ascending, shape (n,).
        row: Cells in a row.
        layer: Cells in a layer.
        spacing: [m].
        side: Normal of the nearest wall and distance to it in spacings, shape (n, 4): neighbours behind a wall do
            not count.
        table: ``pair_table()``.
        start: First neighbour of each particle, shape (n + 1,).
        other: The neighbours, shape (capacity,).
        gradient: Volume times gradient of the kernel [1/m], shape (capacity, 3).
        drag: What viscosity times ``(v . gradient) gradient`` is multiplied with for a force [m^3], shape (capacity,).
        density: Kernel sum over the liquid [1], shape (n,).
        steepness: Its gradient [1/m], shape (n, 3).
        strength: Attraction between neighbours [N], shape (n,).
        force: Attraction is added here [N], shape (n, 3).

    Returns:
        Count of neighbours, or -1 if the capacity does not suffice.
    """
    n = len(position)
    inverse = 1.0 / spacing
    # In spacings, and relative to a corner, single precision suffices and is twice as fast.
    xs, ys, zs = np.empty(n, dtype=np.float32), np.empty(n, dtype=np.float32), np.empty(n, dtype=np.float32)
    cx, cy, cz = position[0, 0], position[0, 1], position[0, 2]
    for i in range(n):
        xs[i] = (position[i, 0] - cx) * inverse
        ys[i] = (position[i, 1] - cy) * inverse
        zs[i] = (position[i, 2] - cz) * inverse
    # For each of nine rows of cells around a particle's, the sorted particles that may be in it.
    first, last = np.zeros(9, dtype=np.int64), np.zeros(9, dtype=np.int64)
    offsets = np.empty(9, dtype=np.int64)
    for a in range(3):
        for b in range(3):
            offsets[3 * a + b] = layer * (a - 1) + row * (b - 1)
    squares = np.empty(n, dtype=np.float32)
    near = np.empty(n + 1, dtype=np.int32)
    square = np.float32(SUPPORT * SUPPORT)
    fine = np.float32((PAIR_TABLE_SIZE - 1) / (SUPPORT * SUPPORT))
    metre = np.float32(inverse)
    lone = weight(0.0)
    count = 0
    for i in range(n):
        if i == 0 or cells[i] != cells[i - 1]:
            for c in range(9):
                low, high = cells[i] + offsets[c] - 1, cells[i] + offsets[c] + 1
                k = first[c]
                while k < n and cells[k] < low:
                    k += 1
                first[c] = k
                k = max(k, last[c])
                while k < n and cells[k] <= high:
                    k += 1
                last[c] = k
        start[i] = count
        x, y, z = xs[i], ys[i], zs[i]
        total, sx, sy, sz = 0.0, 0.0, 0.0, 0.0
        fx, fy, fz = 0.0, 0.0, 0.0
        walled = side[i, 3] < SUPPORT
        found = 0
        for c in range(9):
            begin, size = first[c], last[c] - first[c]
            for k in range(size):
                dx, dy, dz = x - xs[begin + k], y - ys[begin + k], z - zs[begin + k]
                squares[k] = dx * dx + dy * dy + dz * dz
            for k in range(size):
                near[found] = begin + k
                found += squares[k] < square
        if count + found > len(other):
            return -1
        for k in range(found):
            j = near[k]
            dx, dy, dz = x - xs[j], y - ys[j], z - zs[j]
            if j == i:
                continue
            if walled and side[j, 3] < SUPPORT:
                facing = side[i, 0] * side[j, 0] + side[i, 1] * side[j, 1] + side[i, 2] * side[j, 2]
                # Back to back, each in front of its own side of a wall that is thinner than the support.
                if facing < -0.5 and dx * side[i, 0] + dy * side[i, 1] + dz * side[i, 2] > 0.0:
                    continue
            place = (dx * dx + dy * dy + dz * dz) * fine
            t = min(int(place), PAIR_TABLE_SIZE - 2)
            part = place - np.float32(t)
            total += table[t, 0] + part * (table[t + 1, 0] - table[t, 0])
            w = (table[t, 1] + part * (table[t + 1, 1] - table[t, 1])) * metre
            gx, gy, gz = w * dx, w * dy, w * dz
            other[count] = j
            gradient[count, 0], gradient[count, 1], gradient[count, 2] = gx, gy, gz
            drag[count] = table[t, 2] + part * (table[t + 1, 2] - table[t, 2])
            sx += gx
            sy += gy
            sz += gz
            pull = (strength[i] + strength[j]) * (table[t, 3] + part * (table[t + 1, 3] - table[t, 3]))
            fx -= pull * dx
            fy -= pull * dy
            fz -= pull * dz
            count += 1
        density[i] = lone + total
        steepness[i, 0], steepness[i, 1], steepness[i, 2] = sx, sy, sz
        force[i, 0] += 0.5 * fx
        force[i, 1] += 0.5 * fy
        force[i, 2] += 0.5 * fz
    start[n] = count
    return count
