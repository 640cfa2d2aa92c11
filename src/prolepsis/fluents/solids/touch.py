"""The contact rows of a log, gathered for each pair of units: who presses on whom, and from below or not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from prolepsis.fluents.observation import Observation
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray

UNDER_COSINE = 0.5
"""A contact lies under what it pushes at when its normal is within 60 degrees of up: grooves and slopes carry
so, a wall or a pad does not."""

AT_ONCE = 0.01
"""Contact that begins within this time [s] was there from the start: a thing that is put down in a scene carries
no force until it has sunk in by a hair."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Touch:
    """All contact between two units a and b: one row a tick, R of them."""

    a: int
    """Unit."""
    b: int
    """Unit, ``a < b``."""
    tick: IntArray
    """Ticks with contact, ascending, shape (R,)."""
    force: FloatArray
    """Normal force, summed over contact points [N], shape (R,)."""
    peak: FloatArray
    """Greatest normal force within the tick [N], shape (R,)."""
    bears_b: FloatArray
    """Upward force of a on b through contacts that lie under b [N], shape (R,)."""
    bears_a: FloatArray
    """Upward force of b on a through contacts that lie under a [N], shape (R,)."""
    lifts_b: FloatArray
    """Upward force of a on b through all contacts [N], shape (R,)."""
    rows: IntArray
    """Rows of the log's contacts that these come from, tick by tick."""
    first: IntArray
    """Where in ``rows`` each tick begins, shape (R,)."""

    def mask(self, tick_count: int, dt: float) -> BoolArray:
        """Return whether there is contact at each tick, shape (T,)."""
        found = np.zeros(tick_count, dtype=np.bool_)
        found[self.tick] = True
        if self.tick[0] * dt <= AT_ONCE:
            found[: self.tick[0]] = True
        return found

    def series(self, values: FloatArray, tick_count: int) -> FloatArray:
        """Return values of the rows at each tick, zero without contact, shape (T,)."""
        found = np.zeros(tick_count)
        found[self.tick] = values
        return found


def touches(observation: Observation) -> tuple[Touch, ...]:
    """Return the contacts of each pair of units that ever touch, in order of the pair."""
    contacts = observation.log.contacts
    if not len(contacts.tick):
        return ()
    first, second = observation.unit[contacts.a], observation.unit[contacts.b]
    count = len(observation.unit)
    swapped = first > second
    pair = np.where(swapped, second * count + first, first * count + second)
    # Pairs are numbered densely, so that sorting them is a radix sort.
    present = np.zeros(count * count, dtype=np.bool_)
    present[pair] = True
    present[:: count + 1] = False
    numbers = np.cumsum(present) - 1
    if not present.any():
        return ()
    number = numbers[pair].astype(np.uint16 if numbers[-1] < 2**16 else np.int64)
    order = np.argsort(number, kind="stable")
    order = order[(first != second)[order]]
    number, tick = number[order], contacts.tick[order]
    begins = np.concatenate(([0], np.flatnonzero((number[1:] != number[:-1]) | (tick[1:] != tick[:-1])) + 1))
    sign = np.where(swapped, -1.0, 1.0)
    upward = (contacts.force @ observation.up) * sign
    slope = (contacts.normal @ observation.up) * sign
    press = np.abs(np.einsum("ci,ci->c", contacts.force, contacts.normal))

    def gather(values: FloatArray) -> FloatArray:
        return np.add.reduceat(values[order], begins)

    force, lifts = gather(press), gather(upward)
    bears_b = gather(np.where(slope >= UNDER_COSINE, upward, 0.0))
    bears_a = gather(np.where(slope <= -UNDER_COSINE, -upward, 0.0))
    peak = np.maximum(gather(contacts.peak), force)
    codes = np.flatnonzero(present)
    bounds = np.searchsorted(number[begins].astype(np.int64), np.arange(len(codes) + 1))
    ends = np.append(begins, len(order))
    row_tick = tick[begins]
    return tuple(
        Touch(
            a=int(code // count),
            b=int(code % count),
            tick=row_tick[low:high],
            force=force[low:high],
            peak=peak[low:high],
            bears_b=bears_b[low:high],
            bears_a=bears_a[low:high],
            lifts_b=lifts[low:high],
            rows=order[ends[low] : ends[high]],
            first=begins[low:high] - ends[low],
        )
        for code, low, high in zip(codes.tolist(), bounds[:-1].tolist(), bounds[1:].tolist(), strict=True)
    )
