"""Values of individuals, each with its origin: stated, derived, overridden, or the most specific class default."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class Known:
    """One value and how it is known."""

    value: float | str
    """A quantity in SI units, ``true``/``false``, or the name of an individual."""
    unit: str
    """SI unit, ``1`` for a pure number and empty for what is no quantity."""
    origin: str
    """``asserted`` (the situation says so), ``class default``, ``derived`` (from other values) or ``override``."""
    source: str
    """The file, the default's source and class, or the formula."""
    certainty: str = ""
    """T, R, C, M or D of a class default; empty otherwise."""
    deviation: float = 0.0
    """Standard deviation between individuals, in the SI unit; 0 if not known."""
