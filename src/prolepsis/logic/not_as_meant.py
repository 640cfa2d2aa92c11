"""What is said of a goal that is answered, and asks something else than was meant, perhaps."""

from __future__ import annotations

from prolepsis.logic.refusals import shown
from prolepsis.logic.unknown_names import WHAT
from prolepsis.terms.errors import brief


def meaning_notes(read: str, goal: str, duration: float, *, no: bool) -> list[str]:
    """Return notes on names with a capital, which are variables for Prolog, and on instants outside the log.

    Args:
        read: What stands in the goal, its kind and the name that it is like, in threes, between tabs.
        goal: The goal as it was asked.
        duration: What the log lasts [s].
        no: Whether the goal has no answer; an instant says nothing else.
    """
    fields = read.split("\t") if read else []
    told: list[str] = []
    for text, kind, name in zip(fields[0::3], fields[1::3], fields[2::3], strict=True):
        if kind != "time":
            what = WHAT.get(kind, kind)
            told.append(f"{brief(text)} is a variable and stands for any {what}; write {brief(name)} for one")
        elif no:
            told.append(f"no, but the log tells nothing of {brief(text)} s: it lasts from 0 to {duration:g} s")
    return [f"{each}: {shown(goal)}" for each in dict.fromkeys(told)]
