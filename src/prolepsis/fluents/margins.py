"""How near the edge a fact is: what decided it over its threshold, and what was nearly so."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from prolepsis.fluents.intervals import debounce, mask_of
from prolepsis.fluents.observation import Observation
from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.log.near import MARGIN, NEAR, ROUNDING
from prolepsis.log.timeline import Argument, Fact, Kind

PAUSE = 0.1
"""Gap in being nearly so that is not noticed [s]."""
LEVELS = 41
"""So many levels, half a hundredth apart, at which it is looked how long something was nearly so."""


@dataclass(frozen=True, kw_only=True, slots=True)
class NearMiss:
    """What did not come about, but nearly."""

    fact: Fact
    """What it would have been, over the time in which it nearly was; its evidence is the greatest margin."""


def margin_of(ratio: FloatArray, start: int, end: int, least: int = 0) -> float:
    """Return the margin of a fact over ticks: the greatest of what decides it over its threshold, shape (T,).

    It is no more than how long the fact held over the least time that counts, ``least`` [ticks]. What begins or ends
    with the log may have held for longer.
    """
    greatest = float(ratio[start:end].max())
    brief = least > 0 and start > 0 and end < len(ratio)
    return min(greatest, (end - start) / least) if brief else greatest


def nearly(
    observation: Observation,
    what: tuple[Kind, str, tuple[Argument, ...]],
    ratio: FloatArray,
    stretches: IntArray,
    least: int = 0,
) -> Iterator[NearMiss]:
    """Yield when something was nearly so, and at no tick of that time was.

    Args:
        observation: The log.
        what: Kind, type and arguments of the fact that it would be.
        ratio: What decides over its threshold [1], shape (T,).
        stretches: When it was so.
        least: For how long it would have to be so [ticks].
    """
    close = ratio >= 1 - NEAR
    if not close.any():
        return
    kind, type, args = what
    was = mask_of(stretches, observation.tick_count)
    for start, end in debounce(close | was, observation.dt, gap=PAUSE).tolist():
        if was[start:end].any():
            continue
        margin = _lasting(observation, ratio, start, end, least) if least else margin_of(ratio, start, end)
        if 1 - NEAR <= margin < 1:
            yield NearMiss(fact=observation.fact(kind, type, args, (start, end), {MARGIN: margin}))


def _lasting(observation: Observation, ratio: FloatArray, start: int, end: int, least: int) -> float:
    """Return the greatest level for which a ratio was there for as large a share of the least time, both at most 1."""
    best = 0.0
    for level in np.linspace(1 - NEAR, min(margin_of(ratio, start, end), 1.0), LEVELS).tolist():
        held = debounce(ratio[start:end] >= level - ROUNDING, observation.dt, gap=PAUSE) + start
        cut = (held[:, 0] == 0) | (held[:, 1] == len(ratio))
        times = np.where(cut, 1.0, np.minimum((held[:, 1] - held[:, 0]) / least, 1.0))
        best = max(best, min(level, float(times.max())))
    return best
