"""The answer shown in the README is the one that the program prints."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from prolepsis.cli import main

ROOT = Path(__file__).parent.parent.parent
SECONDS = r"\d+\.\d+"
SAME_TIME = 0.02
"""Other processors round differently, and how long shards go on breaking hangs on a rounding [s]."""


def test_the_answer_in_the_readme_is_true(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    shown = re.search(r"\$ prolepsis ask out/drop '(.*?)'\n(.*?)\n```", (ROOT / "README.md").read_text(), re.DOTALL)
    assert shown is not None
    assert main(["project", str(ROOT / "examples" / "dropped_egg.toml"), "--out", str(tmp_path / "drop")]) == 0
    capfd.readouterr()
    assert main(["ask", str(tmp_path / "drop"), shown[1]]) == 0
    # What breaks and what it hits begin within a millisecond, so their order may hang on a rounding as well.
    printed, wanted = (sorted(text.splitlines(), key=without_times) for text in (capfd.readouterr().out, shown[2]))
    assert [without_times(line) for line in printed] == [without_times(line) for line in wanted]
    times = [[float(number) for line in lines for number in re.findall(SECONDS, line)] for lines in (printed, wanted)]
    assert times[0] == pytest.approx(times[1], abs=SAME_TIME)


def without_times(line: str) -> str:
    return re.sub(SECONDS, "_", line.strip())
