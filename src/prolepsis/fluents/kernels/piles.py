"""Which particles lie on, or cling to, others that lie on a surface, so that they share their lot."""

from __future__ import annotations

import math

import numpy as np

from prolepsis.fluents.kernels.locations import ON, Bits, Labels, Positions
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.system.kernels import njit


@njit(cache=True)
def pile_up(
    position: Positions,
    tick: IntArray,
    dt: float,
    look: BoolArray,
    up: FloatArray,
    reach: float,
    together_speed: float,
    manner: Bits,
    on: Labels,
) -> None:
    """Let particles share the lot of those that they lie on or cling to: connected, and of about the same velocity.

    Args:
        position: World frame [m], shape (F, P, 3).
        tick: Tick of each frame, shape (F,).
        dt: Tick [s].
        look: Particles to look at, shape (F, P).
        up: Direction up in the world, shape (3,).
        reach: Greatest distance of neighbours [m].
        together_speed: Greatest difference of their velocities [m/s].
        manner: How each particle touches a surface, extended, shape (F, P).
        on: Which surface, extended, shape (F, P).
    """
    frame_count, count = position.shape[0], position.shape[1]
    height = np.empty(count)
    chosen = np.empty(count, dtype=np.int64)
    velocity = np.empty((count, 3))
    size = 1
    while size < 2 * count:
        size *= 2
    head = np.full(size, -1, dtype=np.int64)
    following = np.empty(count, dtype=np.int64)
    for f in range(frame_count):
        number, open_ = 0, 0
        for p in range(count):
            if look[f, p]:
                chosen[number] = p
                number += 1
                if manner[f, p] < ON:
                    open_ += 1
        if open_ == 0 or open_ == number:
            continue
        first, last = max(f - 1, 0), min(f + 1, frame_count - 1)
        time = max((tick[last] - tick[first]) * dt, 1e-9)
        head[:] = -1
        for n in range(number):
            p = chosen[n]
            h = 0.0
            for axis in range(3):
                h += position[f, p, axis] * up[axis]
                velocity[p, axis] = (position[last, p, axis] - position[first, p, axis]) / time
            height[p] = h
            cell = _cell(position[f, p, 0], position[f, p, 1], position[f, p, 2], reach, size)
            following[p] = head[cell]
            head[cell] = p
        order = chosen[:number][np.argsort(height[chosen[:number]])]
        # First what lies on others, from below; then what clings to their sides, as the flank of a heap.
        beside, done = False, False
        while not done:
            changed = False
            for p in order:
                if manner[f, p] >= ON:
                    continue
                best, body = manner[f, p], on[f, p]
                x, y, z = position[f, p, 0], position[f, p, 1], position[f, p, 2]
                for i in range(-1, 2):
                    for j in range(-1, 2):
                        for k in range(-1, 2):
                            q = head[_cell(x + i * reach, y + j * reach, z + k * reach, reach, size)]
                            while q >= 0:
                                lies = manner[f, q] >= ON if beside else height[q] < height[p]
                                if lies and manner[f, q] > best:
                                    square, apart = 0.0, 0.0
                                    for axis in range(3):
                                        square += (position[f, p, axis] - position[f, q, axis]) ** 2
                                        apart += (velocity[p, axis] - velocity[q, axis]) ** 2
                                    under = (height[p] - height[q]) ** 2 >= 0.25 * square
                                    slow = apart < together_speed * together_speed
                                    if square < reach * reach and slow and (beside or under):
                                        best, body = manner[f, q], on[f, q]
                                q = following[q]
                changed |= best > manner[f, p]
                manner[f, p], on[f, p] = best, body
            beside, done = True, beside and not changed


@njit(cache=True)
def _cell(x: float, y: float, z: float, reach: float, size: int) -> int:
    i, j, k = int(math.floor(x / reach)), int(math.floor(y / reach)), int(math.floor(z / reach))
    return (i * 73856093 ^ j * 19349663 ^ k * 83492791) & (size - 1)
