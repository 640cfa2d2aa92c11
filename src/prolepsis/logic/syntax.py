"""Where a goal cannot be read, and what is wrong there, as far as that is seen without reading it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise

from prolepsis.logic.pasting import SKIPPED
from prolepsis.terms.errors import brief

SYNTAX = {
    "operator expected": "two terms stand side by side; between them a comma, an operator or a bracket is missing",
    "operator clash": "these operators cannot be combined without brackets",
    "operator balance": "an operator lacks what it should stand between",
    "end of clause": "the goal ends too early, or a full stop stands within it",
    "end of clause expected": "the goal should end here; is an opening bracket missing?",
    "cannot start term": "no term can begin here; a bracket or a comma is too many",
    "illegal start of term": "no term can begin here; a bracket or a comma is too many",
    "end of file in quoted": "a quoted name has no closing quote",
    "end of file in block comment": "a comment has no closing */",
    "undefined char escape": "no such escape after a backslash; a backslash itself is written twice",
    "quoted punctuation": "a bracket or a comma stands where a term should",
    "punct": "a bracket or a comma stands where a term should",
}
"""What SWI-Prolog's messages mean."""
INSTEAD = {
    "and": ",",
    "&&": ",",
    "&": ",",
    "or": ";",
    "||": ";",
    "not": "\\+",
    "<=": "=<",
    "!=": "\\=",
    "=>": ">=",
    "“": "'",
    "”": "'",
    "„": "'",
    "‘": "'",
    "’": "'",
    "≤": "=<",
    "≥": ">=",
    "≠": "\\=",
    "→": "->",
    "∧": ",",
    "∨": ";",
    "¬": "\\+",
    "–": "-",
    "−": "-",
    "…": "_",
}
"""What is written otherwise elsewhere, and on a page."""
_CLOSING = {"(": ")", "[": "]", "{": "}"}
_TOKEN = re.compile(
    rf"(?P<skipped>{SKIPPED})|(?P<open>['\"`]|/\*)|(?P<number>\d+(?:\.\d+)?)|\w+|\|\||[()\[\]{{}},;!|]|[-+*/\\^<>=~:.?@#&$]+|\S",
    re.DOTALL,
)


def syntax_error(position: int, message: str, goal: str, known: Sequence[str]) -> str:
    """Return what is wrong with the text of a goal, and where.

    Args:
        position: Where SWI-Prolog stopped to read [characters].
        message: What it says.
        goal: The goal as it was asked.
        known: Names of predicates, fluents and events.
    """
    cause = _cause(goal, position, message, known)
    if cause is not None:
        position, told = cause
    else:
        meaning = next((text for known, text in SYNTAX.items() if message.startswith(known)), "")
        told = f"{message}: {meaning}" if meaning else message
        position = _token_at(position, goal, behind=message.startswith("operator expected"))
    position = min(position, len(goal))
    line, column = goal.count("\n", 0, position) + 1, position - (goal.rfind("\n", 0, position) + 1) + 1
    at = f"column {column}" if "\n" not in goal else f"line {line}, column {column}"
    rest = goal[position:].split()
    return f"syntax error at {at}, {f'before {brief(rest[0], 20)}' if rest else 'at the end'}: {told}"


def _token_at(position: int, goal: str, *, behind: bool) -> int:
    """Return where the token begins in which a position lies, or the one behind it."""
    for token in _TOKEN.finditer(goal):
        if token.start() >= position or (not behind and token.end() > position):
            return token.start()
    return len(goal)


def _cause(goal: str, position: int, message: str, known: Sequence[str]) -> tuple[int, str] | None:
    """Return a place and what is wrong there, or None if it is nothing that is known here."""
    found = [*_TOKEN.finditer(goal)]
    for token in found:
        if token["open"]:
            what = "comment" if token["open"] == "/*" else "quoted name"
            return token.start(), f"a {what} begins here and has no end"
        if token[0] in INSTEAD and not token[0].islower():
            return token.start(), f"{token[0]} is no sign of Prolog; write {INSTEAD[token[0]]}"
    tokens = [token for token in found if not token["skipped"] or token[0][0] in "'\"`0"]
    return _unbalanced(tokens) or _missing(tokens, known) or _other_language(tokens, position, message, known)


def _unbalanced(tokens: list[re.Match[str]]) -> tuple[int, str] | None:
    opened: list[re.Match[str]] = []
    for token in tokens:
        if token[0] in _CLOSING:
            opened.append(token)
        elif token[0] in _CLOSING.values():
            if not opened:
                return token.start(), f"nothing is opened that this {token[0]} closes"
            last = opened.pop()
            if _CLOSING[last[0]] != token[0]:
                return token.start(), f"{_CLOSING[last[0]]} should close what {last[0]} opens, not {token[0]}"
    return (opened[-1].start(), f"this {opened[-1][0]} is not closed") if opened else None


def _missing(tokens: list[re.Match[str]], known: Sequence[str]) -> tuple[int, str] | None:
    for before, token in pairwise(tokens):
        if (before[0] in "([{,|;" and token[0] in ",|;") or (before[0] in ",|;" and token[0] in ")]}"):
            return token.start(), f"a term is missing between {before[0]} and {token[0]}"
        name = before[0]
        if token[0] == "(" and (name[0].isupper() or name[0] == "_"):
            small = _small(name, known)
            write = f"; write {brief(small + _bracket(tokens, token), 60)}" if small else ""
            return token.start(), f"a predicate's name begins with a small letter, and {name} is a variable{write}"
        if before["number"] and token[0] == "." and token.start() == before.end() and token is not tokens[-1]:
            return token.start(), f"a number ends with a digit; write {before[0]} or {before[0]}.0"
        if before[0] == "." and token["number"] and token.start() == before.end():
            return before.start(), f"a number begins with a digit; write 0.{token[0]}"
    if tokens and tokens[-1][0] in ",|;":
        return tokens[-1].start(), f"a term is missing after {tokens[-1][0]}"
    return None


def _bracket(tokens: list[re.Match[str]], opening: re.Match[str]) -> str:
    """Return the text from an opening bracket to the one that closes it."""
    depth = 0
    for token in tokens[tokens.index(opening) :]:
        depth += (token[0] in _CLOSING) - (token[0] in _CLOSING.values())
        if depth == 0:
            return opening.string[opening.start() : token.end()]
    return opening[0]


def _small(name: str, known: Sequence[str]) -> str:
    """Return the known name that is spelt like one but for capitals, or how it would be written."""
    alike = [each for each in known if _folded(each) == _folded(name)]
    small = name.lstrip("_")
    return alike[0] if alike else small.lower() if small.isupper() else f"{small[:1].lower()}{small[1:]}"


def _folded(name: str) -> str:
    return name.replace("_", "").casefold()


def _other_language(
    tokens: list[re.Match[str]], position: int, message: str, known: Sequence[str]
) -> tuple[int, str] | None:
    if message.startswith("more than one goal"):
        stop = next((token for token in tokens if token[0] == "."), None)
        return None if stop is None else (stop.start(), message)
    if not message.startswith("operator"):
        return None
    here = next((k for k, token in enumerate(tokens) if token.end() > position), len(tokens) - 1)
    for number in range(max(0, here - 1), min(here + 1, len(tokens))):
        token, behind = tokens[number], tokens[number + 1 : number + 2]
        if token[0] in INSTEAD:
            return token.start(), f"{token[0]} is written {INSTEAD[token[0]]}"
        if token["number"] and behind and behind[0][0].isalpha():
            return behind[
                0
            ].start(), f"a number stands without its unit, in SI units (seconds, N, m, kg); write {token[0]}"
        if token[0] in known and token[0].isidentifier() and behind and behind[0][0].isidentifier():
            return token.start(), f"{token[0]} stands before what it is about, in brackets: {token[0]}(...)"
    return None
