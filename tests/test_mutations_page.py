"""The list of what has been broken on purpose does not rot: page and table agree, and all of it can be broken again."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tools.mutations import Mutation, mutations

ROOT = Path(__file__).parents[1]
KNOWN = mutations()
PAGE = (ROOT / "docs" / "mutations.md").read_text(encoding="utf-8")
ROWS = [[cell.strip() for cell in row.strip("|").split("|")] for row in PAGE.splitlines() if row.startswith("| `")]


@pytest.mark.parametrize("mutation", KNOWN, ids=[each.name for each in KNOWN])
def test_what_is_broken_stands_once_in_the_sources(mutation: Mutation) -> None:
    text = (ROOT / "src" / "prolepsis" / mutation.file).read_text(encoding="utf-8")
    assert mutation.broken(text) != text
    with pytest.raises(ValueError, match="stands 0 times in .*; needed: once"):
        mutation.broken("")
    with pytest.raises(ValueError, match="stands 2 times in .*; needed: once"):
        mutation.broken(2 * mutation.old)


def test_the_page_lists_what_the_table_does() -> None:
    assert [row[:3] for row in ROWS] == [[f"`{each.name}`", each.breaks, f"`{each.file}`"] for each in KNOWN]


@pytest.mark.parametrize("row", ROWS, ids=[row[0].strip("`") for row in ROWS])
def test_the_tests_that_the_page_names_are_there(row: list[str]) -> None:
    named = re.findall(r"`([\w/]+\.py)::(\w+)`", " ".join(row[3:]))
    assert named
    for file, test in named:
        assert f"def {test}(" in (ROOT / "tests" / file).read_text(encoding="utf-8")
