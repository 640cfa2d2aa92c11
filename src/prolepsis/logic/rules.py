"""Files of chronicles: how they are read, and what is said of one that is not permitted."""

from __future__ import annotations

import difflib
from pathlib import Path

from prolepsis.logic.refusals import PERMITTED
from prolepsis.logic.unknown_names import unknown_name
from prolepsis.system.text_files import read_text
from prolepsis.terms.errors import GoalLimitError, InputError, brief

LONGEST_RULES = 1_000_000
"""Longest file of chronicles [bytes]."""
FORM = "a file holds rules chronicle(Event, Start-End) :- Goal, and rules of its own helpers"


def read_rules(file: Path) -> str:
    """Return the text of a file of chronicles.

    Raises:
        InputError: If it is no file, too long, or no UTF-8.
    """
    return read_text(file, "file", most=LONGEST_RULES, error=InputError, called=f"chronicles, {brief(file, 100)}")


def rule_refusal(reply: str, file: Path, *, text: str = "", limit: float = 0.0) -> InputError:
    """Return the error for a file of chronicles that is refused.

    Args:
        reply: What Prolog said: a kind, where, and what about.
        file: The file, as the user knows it.
        text: Its text, where a syntax error is to be found in it.
        limit: Time that one chronicle may take [s].
    """
    kind, _, rest = reply.partition("\n")
    where, _, about = rest.partition("\n")
    at = f"chronicles, {brief(file, 100)}"
    where = brief(where)
    line = f"{at}, line {where}"
    match kind:
        case "syntax":
            number = text.count("\n", 0, int(where)) + 1
            return InputError(f"{at}, line {number}: syntax error: {_short(about)}")
        case "rule":
            return InputError(f"{line}: no rule: {_short(about)}; {FORM}, and nothing in it is executed")
        case "head":
            return InputError(f"{line}: no event or interval: {_short(about)}; {FORM}")
        case "taken":
            return InputError(f"{line}: {_short(about)} exists already; give the helper another name")
        case "known":
            return InputError(f"{line}: {_short(about)} is known without this file; give the event another name")
        case "late":
            return GoalLimitError(f"{at}: the rules take too long to be read and checked")
        case "goal":
            return InputError(f"{line}: {_goal(about)}")
        case "many":
            return InputError(f"{line}: too many rules")
        case "none":
            return InputError(f"{at}: holds no chronicle; {FORM}")
        case "answers":
            return GoalLimitError(f"{at}: chronicle {where} has {int(about):,} answers or more")
        case "open":
            what = "needs a value before it is known, or leaves its event or interval open, or too large"
            return InputError(f"{at}: chronicle {where} {what}")
        case "backwards":
            return InputError(f"{at}: chronicle {where} has an interval that ends before it starts, {_short(about)}")
        case "failed":
            return _failed(f"{at}: chronicle {where}", about, limit)
        case _:
            return InputError(f"{at}: {_short(rest)}")


def _goal(about: str) -> str:
    reason, _, what = about.partition("\n")
    if reason == "predicate":
        name, _, known = what.partition("\n")
        near = difflib.get_close_matches(name, known.split("\t"), n=1, cutoff=0.75)
        return f"unknown predicate {brief(name)}" + (f"; did you mean {near[0]}?" if near else "")
    if reason == "unbound":
        return "not permitted: a goal that is known only when the rule runs"
    if reason == "relation":
        return f"unknown relation {_short(what)!r}"
    return f"not permitted: {_short(what)}: {PERMITTED}"


def _failed(chronicle: str, about: str, limit: float) -> InputError:
    reason, _, what = about.partition("\n")
    if reason == "name":
        return InputError(f"{chronicle}: {unknown_name(what)}")
    if reason in ("time", "memory"):
        most = f" of {limit:g} s" if reason == "time" else ""
        return GoalLimitError(f"{chronicle}: {reason} limit{most} reached")
    return InputError(f"{chronicle} fails: {_short(what or reason)}")


def _short(text: str) -> str:
    return brief(" ".join(text.split()), 100)
