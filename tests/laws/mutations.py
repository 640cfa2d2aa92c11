"""Mutations of valid texts: what is within one is swapped, lost, doubled, or becomes a value that nobody expects."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from random import Random

from hypothesis import strategies as st

TOKENS = re.compile(
    r""" '''.*?''' | \"\"\".*?\"\"\" | "(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])*'  # texts
    | -?\d+(?:\.\d+)?(?:[eE][-+]?\d+)? | [:@]?\w+ | \s+ | [^\w\s] """,
    re.VERBOSE | re.DOTALL,
)
# None of these makes a run long: what is not refused takes some seconds of simulated time at most.
NUMBERS = (
    *(
        "0",
        "-0.0",
        "-1",
        "1",
        "2",
        "2.5",
        "-7.3",
        "0.001",
        "1e-300",
        "-1e-9",
        "1e6",
        "-1e6",
        "1e300",
        "-1e300",
        "1e400",
    ),
    *("nan", "inf", "-inf", "0x10", "1_000", "00", "1.", ".5", "1e", "9" * 19, "1" + "0" * 400, "1" + "0" * 5000),
    *("1r3", "0'a", "true", "2026-01-01", "12:00:00"),
)
WORDS = (
    *(
        "floor",
        "table1",
        "block1",
        "cup1",
        "egg1",
        "eggshell1",
        "yolk1",
        "hand1",
        "water1",
        "force7",
        "world",
        "nothing",
    ),
    *(":floor", ":table1", ":block1", ":cup1", ":egg1", ":hand1", ":water1", ":world", ":", ":Block", ":Egg", ":Water"),
    *(
        ":Floor",
        ":Gripper",
        ":Robot",
        ":Cup",
        ":Sponge",
        ":PaperBowl",
        ":on",
        ":contains",
        ":hasPart",
        ":absorbs",
        ":mass",
    ),
    *(
        ":shape",
        ":file",
        ":breakingForce",
        ":fill",
        ":wetWith",
        "a",
        "owl:sameAs",
        "_:b",
        "X",
        "_",
        "Force",
        "wait",
        "lift",
    ),
    *(
        "grasp",
        "carry",
        "pour",
        "together",
        "sequence",
        "repeat_until",
        "replay",
        "not",
        "touching",
        "true",
        "false",
        "is",
    ),
    *(
        "holds",
        "occurs",
        "findall",
        "forall",
        "call",
        "member",
        "situation",
        "plan",
        "seed",
        "robot",
        "monitors",
        "draw",
    ),
    *("x" * 3000, "\u202eevil", "\u0430", "\u0000", "\x1b[31m", "\ud7ff", "\U0010ffff", "e\u0301", "../s", "/dev/zero"),
)
MARKS = (*"()[]{}.,;:|=+-*/\\^'\"#@<>%!?&$~`\n\t", "[[", "]]", "'''", '"""', "\\+", ":-", "-->", "((", "))", "[]", "\r")
TEXTS = ('""', "''", '"5 mm"', '"5 kg"', '"nan N"', '"x"', '"\\u0000"', '"../x"', '"/dev/zero"', '"' + "y" * 3000 + '"')

VALUES = (NUMBERS, WORDS, MARKS, TEXTS)
LONGEST = 100_000
"""Longest text that is made [characters]; what is longer is refused for its length."""
OTHERS = os.environ.get("PROLEPSIS_FUZZ_SEED", "")
"""Chooses other inputs than those of always."""
ALIKE = 0.7
"""Share of values that are of the same kind as what they replace, so that what reads them gets far."""
OWN = 0.3
"""Share of values that come from the text itself."""
KINDS = ("replace",) * 12 + (
    "drop",
    "double",
    "swap",
    "drop line",
    "double line",
    "swap lines",
    "insert",
    "cut",
    "repeat",
)


def mutated(text: str) -> st.SearchStrategy[str]:
    """Return texts that differ from a valid one by one to three mutations.

    The number that hypothesis draws is a seed: its own choices would cling to the first of everything.
    """

    def change(number: int) -> str:
        chance, changed = Random(f"{number} {OTHERS}"), text
        for _ in range(chance.choice((1, 1, 1, 2, 3))):
            changed = _mutation(changed, chance)[:LONGEST]
        return changed

    return st.integers(0, 2**32 - 1).map(change)


def _mutation(text: str, chance: Random) -> str:
    """Return a text with one change."""
    kind = chance.choice(KINDS)
    if kind.endswith(("line", "lines")):
        lines = text.split("\n")
        return "\n".join(_changed(lines, kind.split()[0], chance, range(len(lines))))
    if kind == "insert":
        k = chance.randint(0, len(text))
        return text[:k] + chance.choice(chance.choice(VALUES)) + text[k:]
    if kind == "cut":
        return text[: chance.randint(0, len(text))]
    parts = TOKENS.findall(text)
    # A mark that is wrong is noticed at once; what is said with the right ones gets farther.
    marks = chance.random() > ALIKE
    meant = [k for k, part in enumerate(parts) if not part.isspace() and (marks or re.match(r"[\w:\"'-]", part))]
    return "".join(_changed(parts, kind, chance, meant)) if meant else text


def _changed(items: list[str], kind: str, chance: Random, meant: Sequence[int]) -> list[str]:
    """Return the items with one change of those that are meant."""
    i, j = chance.choice(meant), chance.choice(meant)
    match kind:
        case "drop":
            del items[i]
        case "double":
            items.insert(j, items[i])
        case "swap":
            items[i], items[j] = items[j], items[i]
        case "repeat":
            items[i] *= max(min(2000, LONGEST // max(len(items[i]), 1)), 1)
        case _:
            items[i] = items[j] if chance.random() < OWN else _another(items[i], chance)
    return items


def _another(item: str, chance: Random) -> str:
    """Return a value in place of ``item``."""
    if chance.random() > ALIKE:
        return chance.choice(chance.choice(VALUES))
    if item[:1] in "\"'" and len(item) > 1:
        inner = chance.choice(chance.choice(VALUES)) if chance.random() < 0.5 else _mutation(item[1:-1], chance)
        return f"{item[0]}{inner}{item[0]}"
    if re.fullmatch(r"-?\d.*", item):
        return chance.choice(NUMBERS)
    if re.fullmatch(r":?\w+", item):
        return chance.choice([word for word in WORDS if word.startswith(":") == item.startswith(":")])
    return chance.choice(MARKS)
