"""Values of individuals, each with its origin: asserted, derived, overridden, drawn, its batch's or its class's."""

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
    """``asserted`` (the situation says so), ``batch`` (it says so of the batch), ``class default``, ``derived`` (from
    other values), ``override``, or ``drawn`` (round what the batch or the class has)."""
    source: str
    """The file, the default's source and class, or the formula."""
    certainty: str = ""
    """T, R, C, M or D of a class default; empty otherwise."""
    deviation: float = 0.0
    """Standard deviation between individuals, in the SI unit; 0 if not known."""
    batch_deviation: float = 0.0
    """That between individuals of one batch; at most as great."""
