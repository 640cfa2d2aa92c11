"""The thirteen relations between two intervals, exactly as Allen defines them.

Intervals are right-open and never empty. Between any two of them exactly one relation holds. Of two
relations that are each other's inverse, one holds of (i, j) just when the other holds of (j, i).

Source:
    J. F. Allen, Maintaining Knowledge about Temporal Intervals, CACM 26(11), 1983.
"""

from __future__ import annotations

from dataclasses import dataclass

from prolepsis.terms.errors import InputError

INVERSES = {
    "before": "after",
    "after": "before",
    "meets": "met_by",
    "met_by": "meets",
    "overlaps": "overlapped_by",
    "overlapped_by": "overlaps",
    "starts": "started_by",
    "started_by": "starts",
    "during": "contains",
    "contains": "during",
    "finishes": "finished_by",
    "finished_by": "finishes",
    "equals": "equals",
}
"""Each relation and its inverse."""

RELATIONS = tuple(INVERSES)
"""The names of the thirteen relations."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Interval:
    """A right-open stretch of time: it has its start and lacks its end."""

    start: float
    """First instant [s]."""
    end: float
    """First instant no longer [s]; greater than ``start``."""

    def __post_init__(self) -> None:
        if not self.start < self.end:
            raise InputError(f"interval {self.start}-{self.end}: an interval must end after it starts")


def relation(i: Interval, j: Interval) -> str:
    """Return the one relation of ``RELATIONS`` in which ``i`` stands to ``j``."""
    if i.end <= j.start:
        return "meets" if i.end == j.start else "before"
    if j.end <= i.start:
        return "met_by" if j.end == i.start else "after"
    if i.start == j.start:
        return "equals" if i.end == j.end else "starts" if i.end < j.end else "started_by"
    if i.end == j.end:
        return "finishes" if i.start > j.start else "finished_by"
    if i.start < j.start:
        return "overlaps" if i.end < j.end else "contains"
    return "overlapped_by" if i.end > j.end else "during"
