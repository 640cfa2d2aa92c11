"""What is said of a goal that is answered, and asks something else than was meant, perhaps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import islice

from prolepsis.logic.near_threshold import MOST_LOOKED_AT
from prolepsis.logic.refusals import shown
from prolepsis.logic.unknown_names import WHAT, a_kind, nearest
from prolepsis.terms.errors import brief, brief_list
from prolepsis.terms.terms import Term, Value, format_value

ANOTHER_TIME = {
    "shared": "one interval, the very same, is asked of {}; write T1 and T2, and allen(R, T1, T2)",
    "whole": "an interval is the whole of it, as of {}; write S-E, and compare S and E",
    "last": "there is {}, where the log ends; no interval contains its end",
}
"""What is said where it is so over another interval than was asked for."""
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
        if kind == "value" or kind.startswith("value of "):
            meant = _meant(text, name.split(TOLD)) if name else "it is what values are called, and stands before them"
            if not answers:
                told.append(f"no, but no {kind} is {brief(text)} here; {meant}")
        elif kind == "compared":
            if not answers:
                told.append(f"no, but nothing gives {text} the value that == compares; = gives it one, and is computes")
        elif kind == "both":
            if not answers:
                fact = "fluent" if name == "event" else "fluent or event"
                told.append(f"no, but {text} stands for a {fact}, and for {a_kind(name)}, and nothing is both")
        elif kind == "spelling":
            if not answers:
                told.append(f"no, but a type that is found is told as {name}, not {text}")
        elif kind == "together":
            if not answers:
                stand = "allen(R, I, J) tells how two intervals stand"
                told.append(f"no, but they begin in the same tick, and {text} asks that one begins first; {stand}")
        elif kind in ANOTHER_TIME:
            if not answers:
                told.append(f"no, but {ANOTHER_TIME[kind].format(text)}")
        elif kind == "collected":
            told.append(f"{text} is collected, and stands in no goal that gives it a value")
        elif kind != "time":
            if kind == "individual" and answers and all(_is(answer.get(text, ""), name) for answer in _some(answers)):
                continue
            what = WHAT.get(kind, kind)
            told.append(f"{brief(text)} is a variable and stands for any {what}; write {brief(name)} for one")
        elif not answers:
            told.append(f"no, but the log tells nothing of {brief(text)} s: it lasts from 0 to {duration:g} s")
    return [f"{each}: {shown(goal)}" for each in dict.fromkeys(told)]


def uncomputed_note(answers: Sequence[Mapping[str, Value]], goal: str) -> str:
    """Return the note on answers that hold sums of numbers that nothing has computed, empty if there are none.

    What is written as a difference is an interval as long as its start is before its end.
    """
    for answer in _some(answers):
        for name, value in answer.items():
            match value:
                case Term(functor="+" | "*" | "/", args=(int() | float(), int() | float())):
                    computed = False
                case Term(functor="-", args=(int() | float() as start, int() | float() as end)):
                    computed = start <= end
                case _:
                    computed = True
            if not computed:
                return f"{name} = {format_value(value)} is not computed; write {name} is ...: {shown(goal)}"
    return ""


def _some(answers: Sequence[Mapping[str, Value]]) -> Iterator[Mapping[str, Value]]:
    return islice(answers, MOST_LOOKED_AT)


def _is(value: Value, name: str) -> bool:
    return format_value(value) == name


def _meant(text: str, told: list[str]) -> str:
    near = nearest(text, told)
    return f"did you mean {' or '.join(map(brief, near))}?" if near else f"those told are {brief_list(told)}"
