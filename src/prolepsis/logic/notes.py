"""All that is said beside the answers to a goal, of a "no" also where another answer rests on it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from prolepsis.log.timeline import Timeline
from prolepsis.logic.near_threshold import near_note
from prolepsis.logic.not_as_meant import meaning_notes, uncomputed_note
from prolepsis.logic.only_of import only_of_note
from prolepsis.logic.open_ends import open_note
from prolepsis.logic.otherwise import otherwise_note
from prolepsis.logic.refusals import shown
from prolepsis.logic.undone import undone_note
from prolepsis.terms.terms import Value

DENIED, ITS = "\x1d", "\x1e"
"""Stand between the goals that are denied, and between what is told of each."""
MOST = 5
"""So many notes are told of what is denied."""


def notes(
    timeline: Timeline,
    goal: str,
    answers: Sequence[Mapping[str, Value]],
    *,
    read: str,
    open_ends: Sequence[str],
    denied: str,
) -> list[str]:
    """Return the notes on the answers to a goal, each once.

    Args:
        timeline: What was asked.
        goal: The goal as it was asked.
        answers: All answers.
        read: What may not have been meant, as Prolog tells it.
        open_ends: What still went on when the log ended, as Prolog tells it.
        denied: Each goal that is not so, on which an answer rests, and what is told of that.
    """
    of_denied: list[str] = []
    for each in denied.split(DENIED) if denied else ():
        told, its_read = each.split(ITS)
        text, *ends = told.split("\t")
        of_denied += _notes(timeline, text, (), its_read, ends and ["until", *ends])
    of_denied = [*dict.fromkeys(filter(None, of_denied))]
    if len(of_denied) > MOST:
        of_denied[MOST:] = [f"{len(of_denied) - MOST} more notes on what is not so are left out: {shown(goal)}"]
    return [*filter(None, _notes(timeline, goal, answers, read, open_ends)), *of_denied]


def _notes(
    timeline: Timeline, goal: str, answers: Sequence[Mapping[str, Value]], read: str, open_ends: Sequence[str]
) -> Iterator[str]:
    yield from meaning_notes(read, goal, timeline.duration, answers)
    yield open_note(open_ends, goal)
    if not answers:
        yield undone_note(timeline, goal)
        yield only_of_note(timeline, goal)
        yield otherwise_note(timeline, goal)
    yield uncomputed_note(answers, goal)
    yield near_note(timeline, answers, goal)
