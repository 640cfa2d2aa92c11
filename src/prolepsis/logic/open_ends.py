"""What is said of an answer that depends on what still went on when the log ended."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import islice

from prolepsis.logic.refusals import shown
from prolepsis.terms.errors import brief, brief_list
from prolepsis.terms.terms import Term, Value

MOST_LOOKED_AT = 1000
"""Answers that are looked through for open ends; more nobody reads one by one."""


def open_note(answers: Sequence[Mapping[str, Value]], fields: Sequence[str], goal: str) -> str:
    """Return the note on an answer, empty if it needs none.

    A "no" may have become a yes, and an end that an answer shows may be that of the log.

    Args:
        answers: All answers.
        fields: Text, start and end [s] of each event on which the goal bears and that went on when the log ended.
        goal: The goal as it was asked.
    """
    rows = zip(fields[0::3], fields[1::3], fields[2::3], strict=True)
    ends = [(text, float(start), float(end)) for text, start, end in rows]
    if answers:
        ends = [each for each in ends if any(_shows(answer, goal, *each) for answer in islice(answers, MOST_LOOKED_AT))]
    if not ends:
        return ""
    names = brief_list([brief(text) for text, _, _ in ends])
    what = "the end that it shows is the log's" if answers else "the answer no holds until then"
    return f"{names} still went on when the log ended at {ends[0][2]:g} s; {what}: {shown(goal)}"


def _shows(answer: Mapping[str, Value], goal: str, text: str, start: float, end: float) -> bool:
    """Return whether an answer shows the end of an event that the goal asks for or the answer names."""
    if not any(value in (end, Term("-", (start, end))) for value in answer.values()):
        return False
    return text.partition("(")[0] in goal or any(str(value) == text for value in answer.values())
