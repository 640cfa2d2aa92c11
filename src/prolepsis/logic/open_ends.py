"""What is said of an answer that depends on what still went on when the log ended."""

from __future__ import annotations

from collections.abc import Sequence

from prolepsis.logic.refusals import shown
from prolepsis.terms.errors import brief, brief_list

HOW = {
    "until": "the answer no holds until then",
    "shown": "the end that it shows is the log's",
    "other": "had it ended later, the answer might be another",
}
"""What is said of a no, of an answer that shows an end, and of any other that rests on it."""


def open_note(fields: Sequence[str], goal: str) -> str:
    """Return the note on an answer, empty if it needs none.

    A "no" may have become a yes; an end that is shown may be that of the log, and what is computed of it another.

    Args:
        fields: How the answer rests on them, and text, start and end [s] of each event that went on when the log ended.
        goal: The goal as it was asked.
    """
    if not fields:
        return ""
    how, *rows = fields
    names = brief_list([brief(text) for text in dict.fromkeys(rows[0::3])])
    return f"{names} still went on when the log ended at {float(rows[2]):g} s; {HOW[how]}: {shown(goal)}"
