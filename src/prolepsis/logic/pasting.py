"""Goals as they are pasted from a page, a paper or Prolog's own prompt: with ``?-`` and with spaces before brackets."""

from __future__ import annotations

import re

_WORDS = """
    as discontiguous div divs dynamic initialization is meta_predicate mod module_transparent multifile public rdiv rem
    table thread_initialization thread_local tnot volatile xor
"""
OPERATORS = frozenset(_WORDS.split())
"""Words that may stand before a bracket with a space between: ``X is (1 + 2) mod (3)``."""

SKIPPED = r"0'(?:\\.|''|.)|'(?:\\.|''|[^'\\])*'|\"(?:\\.|\"\"|[^\"\\])*\"|`(?:\\.|[^`\\])*`|%[^\n]*|/\*.*?\*/"
"""Characters, quoted texts and comments, in which nothing is changed."""
_TOKEN = re.compile(rf"(?P<skipped>{SKIPPED})|(?P<word>\b[a-z]\w*)(?P<space>\s+)\(|\w+", re.DOTALL)


def pasted(goal: str) -> str:
    """Return a goal without ``?-`` before it, and each predicate's name joined to its bracket.

    Where a space was, one is put behind the bracket, so that what follows stands where it stood.
    """
    return _TOKEN.sub(_joined, goal.strip().removeprefix("?-").lstrip())


def _joined(found: re.Match[str]) -> str:
    word = found["word"]
    return found[0] if word is None or word in OPERATORS else f"{word}({found['space']}"
