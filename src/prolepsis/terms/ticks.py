"""Ticks: the instants of a log are whole numbers of ticks, read and printed as the decimals nearest to them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

_MOST_DECIMALS, _MOST_PARTS = 10**12, 10**6
"""Greatest denominators of a tick that is a decimal (0.001 s), and of one that is a part of a second (1/240 s)."""
_COUNTED = 2**53
"""Ticks that floats tell apart; a time beyond is left as it is."""


@dataclass(frozen=True, slots=True)
class Ticks:
    """Instants ``tick * numerator / denominator`` [s]. Of each there is one float, so that equal times are equal."""

    numerator: float
    """A whole number, but for a tick that is no fraction of a second."""
    denominator: int
    """Ticks in ``numerator`` seconds."""

    def number(self, time: float) -> int:
        """Return the tick nearest to a time [s]."""
        return round(time * self.denominator / self.numerator)

    def time(self, tick: int) -> float:
        """Return the instant of a tick [s]."""
        return tick * self.numerator / self.denominator

    def counts(self, time: float) -> bool:
        """Return whether ticks near a time [s] can be told apart."""
        return abs(time) < _COUNTED / self.denominator * self.numerator

    def snapped(self, time: float) -> float:
        """Return the instant of the tick nearest to a time [s]."""
        return self.time(self.number(time)) if self.counts(time) else time

    @property
    def decimals(self) -> int:
        """Decimals with which printed instants are read back."""
        length = self.numerator / self.denominator
        least = max(3, math.ceil(-math.log10(length)) + 1)
        return next((k for k in range(3, least + 3) if 10**k % self.denominator == 0), least)


@lru_cache(maxsize=64)
def ticks_of(dt: float) -> Ticks:
    """Return the ticks of a length [s]: 0.001 as 1/1000, and 0.004166666666666667 as 1/240."""
    told = Fraction(repr(float(dt)))
    if told.denominator > _MOST_DECIMALS:
        told = told.limit_denominator(_MOST_PARTS)
        if float(told) != dt:
            return Ticks(dt, 1)
    return Ticks(told.numerator, told.denominator)
