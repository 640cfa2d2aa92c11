"""What is said of a name with a capital that stands where a name should, and is a variable for Prolog."""

from __future__ import annotations

from prolepsis.logic.refusals import shown
from prolepsis.logic.unknown_names import WHAT
from prolepsis.terms.errors import brief


def variables_note(read: str, goal: str) -> str:
    """Return the note on names that were read as variables, empty if none was.

    Args:
        read: Variable, kind and name, in threes, between tabs.
        goal: The goal as it was asked.
    """
    if not read:
        return ""
    fields = read.split("\t")
    told: list[str] = []
    for variable, kind, name in zip(fields[0::3], fields[1::3], fields[2::3], strict=True):
        what = WHAT.get(kind, kind)
        told.append(f"{brief(variable)} is a variable and stands for any {what}; write {brief(name)} for one")
    return f"{'; '.join(told)}: {shown(goal)}"
