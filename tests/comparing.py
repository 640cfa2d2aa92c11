"""Comparisons with closed forms and with what others measured: the rows of the page "How right is it?"."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, Protocol

PROPERTY = "comparison"
"""Under this name a row travels in the report of a test."""
Range = tuple[float, float]


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """One comparison."""

    what: str
    """Such rows stand together: ``restitution of a ball``."""
    by: str
    """Closed form, or who measured it and where."""
    measured: float
    low: float
    high: float
    """From where to where it is expected; equal for a closed form."""
    allowed: float
    """How far beside that it may be."""
    relative: bool
    """Whether that was told as a share."""
    unit: str
    verdict: bool
    """Whether it is a yes or no, 1 or 0."""

    @property
    def off(self) -> float:
        """How far it is beside what is expected."""
        return max(self.low - self.measured, self.measured - self.high, 0.0)

    @property
    def holds(self) -> bool:
        """Whether it is within what is allowed."""
        return self.off <= self.allowed


class Compare(Protocol):
    """Compares two numbers and fails if they are too far apart; see `comparing`."""

    def __call__(
        self,
        what: str,
        measured: float,
        expected: float | Range,
        *,
        by: str,
        within: float | None = None,
        share: float | None = None,
        unit: str = "",
    ) -> None: ...


def comparing(record: Callable[[str, Any], None]) -> Compare:
    """Return what compares, and tells each comparison to ``record`` before it fails.

    Of what it is given, ``expected`` is a number, a range of numbers or a truth, ``by`` says by whom, ``within`` in the
    same unit or as a ``share`` of it how far beside it may be.
    """

    def compare(
        what: str,
        measured: float,
        expected: float | Range,
        *,
        by: str,
        within: float | None = None,
        share: float | None = None,
        unit: str = "",
    ) -> None:
        low, high = (float(end) for end in (expected if isinstance(expected, tuple) else (expected, expected)))
        allowed = share * max(abs(low), abs(high)) if share is not None else within or 0.0
        row = Row(
            what=what,
            by=by,
            measured=float(measured),
            low=low,
            high=high,
            allowed=allowed,
            relative=share is not None,
            unit=unit,
            verdict=isinstance(expected, bool),
        )
        record(PROPERTY, asdict(row))
        assert row.holds, (
            f"{what}: {row.measured:g} {unit}, expected {low:g} to {high:g}, {allowed:g} beside it at most"
        )

    return compare
