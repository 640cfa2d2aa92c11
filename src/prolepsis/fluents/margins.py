"""How near the edge a fact is: what decided it over its threshold, and what was nearly so."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from prolepsis.fluents.intervals import debounce, mask_of
from prolepsis.fluents.observation import Observation
from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.log.near import MARGIN, NEAR
from prolepsis.log.timeline import Argument, Fact, Kind

PAUSE = 0.1
"""Gap in being nearly so that is not noticed [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class NearMiss:
    """What did not come about, but nearly."""

    fact: Fact
    """What it would have been, over the time in which it nearly was; its evidence is the greatest margin."""


def margin_of(ratio: FloatArray, start: int, end: int) -> float:
    """Return the margin of a fact over ticks: the greatest of what decides it over its threshold, shape (T,)."""
    return float(ratio[start:end].max())


def nearly(
    observation: Observation,
    what: tuple[Kind, str, tuple[Argument, ...]],
    ratio: FloatArray,
    stretches: IntArray,
) -> Iterator[NearMiss]:
    """Yield when something was nearly so, and at no tick of that time was.

    Args:
        observation: The log.
        what: Kind, type and arguments of the fact that it would be.
        ratio: What decides over its threshold [1], shape (T,).
        stretches: When it was so.
    """
    close = ratio >= 1 - NEAR
    if not close.any():
        return
    kind, type, args = what
    was = mask_of(stretches, observation.tick_count)
    for start, end in debounce(close | was, observation.dt, gap=PAUSE).tolist():
        margin = margin_of(ratio, start, end)
        if margin < 1 and not was[start:end].any():
            yield NearMiss(fact=observation.fact(kind, type, args, (start, end), {MARGIN: margin}))
