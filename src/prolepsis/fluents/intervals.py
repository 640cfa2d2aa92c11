"""Truth values at each tick become right-open intervals, debounced in seconds.

Runs are arrays of shape (R, 2): the first tick of each stretch, and the first tick no longer.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray


def ticks_of(seconds: float, dt: float) -> int:
    """Return the number of ticks nearest to a time [s], at least one."""
    return max(1, round(seconds / dt))


def runs(mask: BoolArray) -> IntArray:
    """Return the maximal stretches over which ``mask``, shape (T,), is true."""
    # Only the ticks at which the value changes are looked at twice.
    change = np.flatnonzero(mask[1:] != mask[:-1]) + 1
    first = [0] if len(mask) and mask[0] else []
    last = [len(mask)] if len(mask) and mask[-1] else []
    return np.concatenate((first, change, last)).astype(np.int64).reshape(-1, 2)


def mask_of(stretches: IntArray, tick_count: int) -> BoolArray:
    """Return the truth values, shape (T,), of which ``stretches`` are the runs."""
    mask = np.zeros(tick_count, dtype=np.bool_)
    for start, end in stretches.tolist():
        mask[start:end] = True
    return mask


def close_gaps(stretches: IntArray, ticks: int) -> IntArray:
    """Return the runs with every gap of at most ``ticks`` filled."""
    if len(stretches) < 2:
        return stretches
    apart = stretches[1:, 0] - stretches[:-1, 1] > ticks
    starts = stretches[np.concatenate(([True], apart)), 0]
    ends = stretches[np.concatenate((apart, [True])), 1]
    return np.stack((starts, ends), axis=1)


def drop_short(stretches: IntArray, ticks: int) -> IntArray:
    """Return the runs that are at least ``ticks`` long."""
    return stretches[stretches[:, 1] - stretches[:, 0] >= ticks]


def debounce(mask: BoolArray, dt: float, *, gap: float = 0.0, least: float = 0.0) -> IntArray:
    """Return the runs of ``mask`` with short gaps filled, then those that are long enough.

    Args:
        mask: Truth values at each tick, shape (T,).
        dt: Tick [s].
        gap: Longest gap that is filled [s].
        least: Shortest run that is kept [s].
    """
    found = runs(mask)
    if gap > 0:
        found = close_gaps(found, ticks_of(gap, dt))
    return drop_short(found, ticks_of(least, dt)) if least > 0 else found


def hysteresis(low: BoolArray, high: BoolArray) -> IntArray:
    """Return the runs of ``low`` within which ``high`` is true at least once."""
    found = runs(low)
    if not len(found):
        return found
    count = np.concatenate(([0], np.cumsum(high)))
    return found[count[found[:, 1]] > count[found[:, 0]]]


def union(several: Iterable[IntArray]) -> IntArray:
    """Return the runs that cover what any of the given runs covers."""
    kept = [stretches for stretches in several if len(stretches)]
    if not kept:
        return np.zeros((0, 2), dtype=np.int64)
    ordered = np.concatenate(kept)
    ordered = ordered[np.lexsort((ordered[:, 1], ordered[:, 0]))]
    ends = np.maximum.accumulate(ordered[:, 1])
    apart = ordered[1:, 0] > ends[:-1]
    return np.stack((ordered[np.concatenate(([True], apart)), 0], ends[np.concatenate((apart, [True]))]), axis=1)


def one_sided_means(series: FloatArray, window: int) -> tuple[FloatArray, FloatArray]:
    """Return the mean over the ``window`` ticks up to each tick, and over those from it on.

    A property that begins or ends sharply shows at its very edge in one of the two; near the ends of the log
    the windows are shorter.

    Args:
        series: Values at each tick, shape (T,).
        window: Length of both windows [ticks].
    """
    count = len(series)
    total = np.concatenate(([0.0], np.cumsum(series)))
    now = np.arange(count)
    before, after = np.maximum(now + 1 - window, 0), np.minimum(now + window, count)
    return (total[now + 1] - total[before]) / (now + 1 - before), (total[after] - total[now]) / (after - now)


def opened(mask: BoolArray, frames: int) -> BoolArray:
    """Return ``mask``, shape (F, P), without the runs along F that are shorter than ``frames``."""
    count = len(mask)
    total = np.zeros((count + 1, *mask.shape[1:]), dtype=np.int32)
    np.cumsum(mask, axis=0, out=total[1:])
    whole = total[frames:] - total[:-frames] == frames
    found = np.zeros_like(mask)
    for shift in range(frames):
        found[shift : shift + len(whole)] |= whole
    return found


def arriving(there: BoolArray, still: BoolArray, frames: int) -> BoolArray:
    """Return when what is somewhere has not yet come to rest since it came there, shape (F, P).

    Args:
        there: When each is there, shape (F, P).
        still: When each does not move, shape (F, P).
        frames: So many frames without motion are rest.
    """
    now = np.arange(len(there))[:, None]
    came = np.maximum.accumulate(np.where(there, -1, now), axis=0)
    rested = np.maximum.accumulate(np.where(opened(still & there, frames), now, -1), axis=0)
    return there & (rested <= came)
