"""Write docs/how_right.md: every comparison with a closed form or with what others measured, as it comes out now.

    make right                                  all of them
    .venv/bin/python tools/how_right.py FILE    only those of some files of tests, printed and not written

A comparison is a call of ``compare`` in a test (tests/comparing.py). Rows of the same kind stand together, with the one
that is farthest off.
"""

from __future__ import annotations

import ast
import sys
from collections import defaultdict
from collections.abc import Iterable, Sequence
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))
from tests.comparing import PROPERTY, Row  # noqa: E402

PAGE = ROOT / "docs" / "how_right.md"
HEAD = """\
# How right is it?

Every comparison of what is simulated with a closed form, or with what others have measured, made by `make right`. A
row is all cases of a kind; of its numbers it gives the one that is farthest off, beside what it should be, and how far
off it may be. All are tests, most of them in `make laws`: one that is not within its bounds fails, but for those under
*What falls short*.
"""
SHORT = """\
## What falls short

Known, with the reason; a test says when one of them holds.
"""
Found = tuple[str, Row, str]
"""Where a test stands, a row of it, and why it is known to fail, or an empty text."""


class Gathering:
    """A plugin of pytest that keeps the rows of what has run."""

    def __init__(self) -> None:
        self.found: list[Found] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Keep the rows of one test."""
        if report.when == "call":
            for name, row in report.user_properties:
                if name == PROPERTY:
                    self.found.append((report.nodeid, Row(**row), getattr(report, "wasxfail", "")))  # type: ignore[arg-type]


def files() -> list[str]:
    """Return the files of tests in which something is compared, sorted."""
    return sorted(
        str(file.relative_to(ROOT))
        for file in (ROOT / "tests").rglob("test_*.py")
        if "compare: Compare" in file.read_text(encoding="utf-8")
    )


def page(found: Iterable[Found]) -> str:
    """Return the text of the page."""
    sections: dict[str, list[Found]] = defaultdict(list)
    for each in sorted(found, key=lambda each: (each[0].split("::")[0], each[1].what)):
        sections[each[0].split("::")[0]].append(each)
    text = [HEAD]
    for file, rows in sections.items():
        text += [f"## {_title(file)}\n", f"`{file}`\n", _table([each for each in rows if not each[2] or each[1].holds])]
    short = [each for rows in sections.values() for each in rows if each[2] and not each[1].holds]
    if short:
        text += [SHORT, "| compared | case | by | measured | expected | why |\n|---|---|---|---|---|---|"]
        text += [
            f"| {row.what} | {_case(test)} | {row.by} | {_number(row.measured, row)} | {_expected(row)} | {why} |"
            for test, row, why in short
        ]
        text.append("")
    return "\n".join(text)


def _table(found: Sequence[Found]) -> str:
    kinds: dict[tuple[str, str], list[Found]] = defaultdict(list)
    for each in found:
        kinds[each[1].what, each[1].by].append(each)
    lines = ["| compared | by | cases | farthest off | by | may be |", "|---|---|---|---|---|---|"]
    for (what, by), rows in kinds.items():
        if rows[0][1].verdict:
            right = sum(row.holds for _, row, _ in rows)
            lines.append(f"| {what} | {by} | {len(rows)} | {right} of {len(rows)} right | | |")
            continue
        worst = max((row for _, row, _ in rows), key=lambda row: row.off / (row.allowed or 1.0))
        numbers = f"{_number(worst.measured, worst)}, expected {_expected(worst)}"
        bounds = f"{_bound(worst.off, worst)} | {_bound(worst.allowed, worst)}"
        lines.append(f"| {what} | {by} | {len(rows)} | {numbers} | {bounds} |")
    return "\n".join(lines) + "\n"


def _number(number: float, row: Row) -> str:
    if row.verdict:
        return "yes" if number else "no"
    return f"{number:.3g} {row.unit}".strip()


def _bound(off: float, row: Row) -> str:
    """Return how far beside something is, in its unit or as a share of what was expected."""
    if row.relative:
        return f"{100 * off / max(abs(row.low), abs(row.high)):.2g} %"
    return f"{off:.2g} {row.unit}".strip() if off or row.allowed else ""


def _expected(row: Row) -> str:
    return _number(row.low, row) if row.low == row.high else f"{row.low:.3g} to {_number(row.high, row)}"


def _case(test: str) -> str:
    return test.partition("[")[2].rstrip("]") or "-"


def _title(file: str) -> str:
    docstring = ast.get_docstring(ast.parse((ROOT / file).read_text(encoding="utf-8")))
    return (docstring or file).partition("\n")[0].rstrip(".")


def main(arguments: Sequence[str]) -> int:
    """Run the comparisons of some files, or of all, and write or print the page."""
    gathering = Gathering()
    only = list(arguments)
    status = pytest.main(["-q", "-n", "2", "-m", "laws or not laws", *(only or files())], plugins=[gathering])
    text = page(gathering.found)
    if only:
        print(text)
    elif gathering.found:
        PAGE.write_text(text, encoding="utf-8")
    return int(status)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
