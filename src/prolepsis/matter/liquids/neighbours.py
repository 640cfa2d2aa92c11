"""Neighbours: particles sorted along rows of cells, and for each the others within the support of the kernel."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.matter.liquids.kernel import PAIR_TABLE_SIZE, SUPPORT, Counts, Indices, Singles, weight
from prolepsis.system.kernels import njit

RADIX_BITS = 11
"""Bits that one pass of the sort looks at."""
FINE = 32
"""Parts of a cell that are told apart along x when sorting."""


class Neighbours(NamedTuple):
    """The neighbours of n particles, one particle's after the other's."""

    start: Counts
    """First neighbour of each particle, shape (n,)."""
    end: Counts
    """The one after its last, shape (n,)."""
    other: Indices
    """The neighbours, shape (room,)."""
    gradient: Singles
    """Volume times gradient of the kernel for each neighbour [1/m], shape (room, 3)."""
    drag: Singles
    """What viscosity times ``(v . gradient) gradient`` is multiplied with for a force [m^3], shape (room,)."""
    attraction: Singles
    """What strength times spacing times ``gradient`` is multiplied with for a force [1], shape (room,)."""


def no_neighbours(n: int, room: int) -> Neighbours:
    """Return room for so many neighbours of n particles in all."""
    return Neighbours(
        start=np.zeros(n, dtype=np.uint64),
        end=np.zeros(n, dtype=np.uint64),
        other=np.zeros(room, dtype=np.uint32),
        gradient=np.zeros((room, 3), dtype=np.float32),
        drag=np.zeros(room, dtype=np.float32),
        attraction=np.zeros(room, dtype=np.float32),
    )


@njit(cache=True)
def row_order(position: FloatArray, size: float) -> tuple[IntArray, IntArray, int]:
    """Return the order of particles by row and along it, their rows in that order, and the rows in a layer.

    Rows run along x; they are numbered along y, then z, with an empty one at the ends of each layer.

    Args:
        position: [m], shape (n, 3).
        size: Height and width of a row [m].
    """
    n = len(position)
    low = np.array([np.inf, np.inf, np.inf])
    high = -low
    for i in range(n):
        for c in range(3):
            low[c] = min(low[c], position[i, c])
            high[c] = max(high[c], position[i, c])
    length = int((high[0] - low[0]) / size * FINE) + 1
    layer = int((high[1] - low[1]) / size) + 3
    keys, rows = np.empty(n, dtype=np.int64), np.empty(n, dtype=np.int64)
    greatest = 0
    for i in range(n):
        x = int((position[i, 0] - low[0]) / size * FINE)
        y = int((position[i, 1] - low[1]) / size)
        z = int((position[i, 2] - low[2]) / size)
        rows[i] = y + 1 + layer * (z + 1)
        keys[i] = x + length * rows[i]
        greatest = max(greatest, keys[i])
    order, spare = np.arange(n), np.empty(n, dtype=np.int64)
    shift, mask = 0, (1 << RADIX_BITS) - 1
    while (greatest >> shift) > 0:
        counts = np.zeros(mask + 2, dtype=np.int64)
        for i in range(n):
            counts[((keys[i] >> shift) & mask) + 1] += 1
        for b in range(mask + 1):
            counts[b + 1] += counts[b]
        for i in range(n):
            bucket = (keys[order[i]] >> shift) & mask
            spare[counts[bucket]] = order[i]
            counts[bucket] += 1
        order, spare = spare, order
        shift += RADIX_BITS
    # Within a part of a cell the order is that of before; full order lets a search stop at the right place.
    for i in range(1, n):
        k, moved = i, order[i]
        while k > 0 and rows[order[k - 1]] == rows[moved] and position[order[k - 1], 0] > position[moved, 0]:
            order[k] = order[k - 1]
            k -= 1
        order[k] = moved
    sorted_rows = np.empty(n, dtype=np.int64)
    for i in range(n):
        sorted_rows[i] = rows[order[i]]
    return order, sorted_rows, layer


@njit(cache=True, fastmath=True)
def find_neighbours(
    position: FloatArray,
    rows: IntArray,
    layer: int,
    spacing: float,
    side: FloatArray,
    table: Singles,
    neighbours: Neighbours,
    density: FloatArray,
    steepness: FloatArray,
) -> bool:
    """Write each particle's neighbours with what depends on the distance alone, and return whether there is room.

    Args:
        position: In the order of rows [m], shape (n, 3).
        rows: Row of each particle, ascending, shape (n,).
        layer: Rows in a layer.
        spacing: [m].
        side: Normal of the nearest wall and distance to it in spacings, shape (n, 4): neighbours behind a wall do
            not count.
        table: ``pair_table()``.
        neighbours: Written here; those of the first n particles.
        density: Kernel sum over the liquid [1], shape (n,).
        steepness: Its gradient [1/m], shape (n, 3).
    """
    n = len(position)
    start, end, other, gradient, drag, attraction = neighbours
    room = len(other)
    metre = np.float32(1.0 / spacing)
    # In spacings, and relative to a corner, single precision suffices and is twice as fast.
    xs, ys, zs = np.zeros(n + 1, dtype=np.float32), np.empty(n, dtype=np.float32), np.empty(n, dtype=np.float32)
    cx, cy, cz = position[0, 0], position[0, 1], position[0, 2]
    for i in range(n):
        xs[i] = (position[i, 0] - cx) / spacing
        ys[i] = (position[i, 1] - cy) / spacing
        zs[i] = (position[i, 2] - cz) / spacing
    offsets = np.array([-layer - 1, -layer, 1 - layer, -1, 0, 1, layer - 1, layer, layer + 1])
    # Of the nine rows around: where each begins and ends, and the part of it that is within reach along x.
    began, ended = np.zeros(9, dtype=np.uint32), np.zeros(9, dtype=np.uint32)
    first, last, one = np.zeros(9, dtype=np.uint32), np.zeros(9, dtype=np.uint32), np.uint32(1)
    near, squares = np.empty(n, dtype=np.uint32), np.empty(n, dtype=np.float32)
    square, reach = np.float32(SUPPORT * SUPPORT), np.float32(SUPPORT)
    fine = np.float32((PAIR_TABLE_SIZE - 1) / (SUPPORT * SUPPORT))
    p = np.uint64(0)
    for i in range(n):
        if i == 0 or rows[i] != rows[i - 1]:
            for c in range(9):
                row, k = rows[i] + offsets[c], ended[c]
                while k < n and rows[k] < row:
                    k += 1
                began[c], first[c], last[c] = k, k, k
                while k < n and rows[k] == row:
                    k += 1
                ended[c] = k
        x, y, z = xs[i], ys[i], zs[i]
        # First who is near, without a branch that half the candidates take; then what they are to this one.
        count, least, most = np.uint32(0), x - reach, x + reach
        for c in range(9):
            end_of_row = ended[c]
            if began[c] == end_of_row:
                continue
            k = first[c]
            k += np.uint32(k < end_of_row and xs[k] < least)
            k += np.uint32(k < end_of_row and xs[k] < least)
            while k < end_of_row and xs[k] < least:
                k += one
            first[c] = k
            begin, k = k, max(k, last[c])
            k += np.uint32(k < end_of_row and xs[k] < most)
            k += np.uint32(k < end_of_row and xs[k] < most)
            while k < end_of_row and xs[k] < most:
                k += one
            last[c] = k
            for j in range(begin, k):
                dx, dy, dz = x - xs[j], y - ys[j], z - zs[j]
                r2 = dx * dx + dy * dy + dz * dz
                near[count], squares[count] = j, r2
                count += np.uint32(r2 < square)
        start[i] = p
        if p + np.uint64(count) > np.uint64(room):
            return False
        walled = side[i, 3] < SUPPORT
        total, sx, sy, sz = np.float32(weight(0.0)), np.float32(0.0), np.float32(0.0), np.float32(0.0)
        for m in range(count):
            j = near[m]
            if j == i:
                continue
            dx, dy, dz = x - xs[j], y - ys[j], z - zs[j]
            if walled and side[j, 3] < SUPPORT:
                facing = side[i, 0] * side[j, 0] + side[i, 1] * side[j, 1] + side[i, 2] * side[j, 2]
                # Back to back, each in front of its own side of a wall that is thinner than the support.
                if (
                    facing < -0.5
                    and dx * (side[i, 0] - side[j, 0]) + dy * (side[i, 1] - side[j, 1]) + dz * (side[i, 2] - side[j, 2])
                    > 0.0
                ):
                    continue
            coordinate = squares[m] * fine
            t = min(np.uint32(coordinate), np.uint32(PAIR_TABLE_SIZE - 2))
            part = coordinate - np.float32(t)
            entry, following = table[t], table[t + np.uint32(1)]
            total += entry[0] + part * (following[0] - entry[0])
            w = (entry[1] + part * (following[1] - entry[1])) * metre
            gx, gy, gz = w * dx, w * dy, w * dz
            other[p] = j
            gradient[p, 0], gradient[p, 1], gradient[p, 2] = gx, gy, gz
            sx += gx
            sy += gy
            sz += gz
            drag[p] = entry[2] + part * (following[2] - entry[2])
            attraction[p] = entry[3] + part * (following[3] - entry[3])
            p += np.uint64(1)
        end[i] = p
        density[i] = total
        steepness[i, 0], steepness[i, 1], steepness[i, 2] = sx, sy, sz
    return True
