"""Decimals: what was converted from a unit, or computed, is the short decimal that it is but for rounding."""

from __future__ import annotations

import math

DIGITS = 12
"""Significant digits of a short decimal; whoever writes a number by hand writes no more."""
ROUNDINGS = 4
"""So many roundings of a float may lie between a short decimal and what was computed of it."""


def decimal_of(number: float) -> float:
    """Return the decimal of few digits that a number is but for rounding (35 * 0.01 is 0.35), or the number itself."""
    if not isinstance(number, float) or not math.isfinite(number):
        return number
    short = float(f"{number:.{DIGITS}g}")
    return short if abs(short - number) <= ROUNDINGS * math.ulp(number) else number
