"""What is said of a goal that is answered, and asks something else than was meant, perhaps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from prolepsis.logic.open_ends import MOST_LOOKED_AT
from prolepsis.logic.refusals import shown
from prolepsis.logic.unknown_names import WHAT, nearest
from prolepsis.terms.errors import brief, brief_list
from prolepsis.terms.terms import Value, format_value

TOLD = "\x1f"
"""Stands between the values that are told."""


def meaning_notes(read: str, goal: str, duration: float, answers: Sequence[Mapping[str, Value]]) -> list[str]:
    """Return notes on names with a capital, which are variables for Prolog, and on a no to what no run could tell.

    Args:
        read: What stands in the goal, its kind and the name that it is like, in threes, between tabs.
        goal: The goal as it was asked.
        duration: What the log lasts [s].
        answers: All answers; of one that they all bind to the individual that was meant nothing is said.
    """
    fields = read.split("\t") if read else []
    told: list[str] = []
    for text, kind, name in zip(fields[0::3], fields[1::3], fields[2::3], strict=True):
        if kind.startswith("value of "):
            if not answers:
                told.append(f"no, but no {kind} is {brief(text)} here; {_meant(text, name.split(TOLD))}")
        elif kind != "time":
            if kind == "individual" and answers and all(_is(answer.get(text, ""), name) for answer in _some(answers)):
                continue
            what = WHAT.get(kind, kind)
            told.append(f"{brief(text)} is a variable and stands for any {what}; write {brief(name)} for one")
        elif not answers:
            told.append(f"no, but the log tells nothing of {brief(text)} s: it lasts from 0 to {duration:g} s")
    return [f"{each}: {shown(goal)}" for each in dict.fromkeys(told)]


def _some(answers: Sequence[Mapping[str, Value]]) -> Iterator[Mapping[str, Value]]:
    return islice(answers, MOST_LOOKED_AT)


def _is(value: Value, name: str) -> bool:
    return format_value(value) == name


def _meant(text: str, told: list[str]) -> str:
    near = nearest(text, told)
    return f"did you mean {' or '.join(map(brief, near))}?" if near else f"those told are {brief_list(told)}"
