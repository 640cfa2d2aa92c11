"""The answer shown in the README is the one that the program prints."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from prolepsis.cli import main

ROOT = Path(__file__).parent.parent.parent


def test_the_answer_in_the_readme_is_true(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    shown = re.search(r"\$ prolepsis ask out/drop '(.*)'\n(.*?)\n```", (ROOT / "README.md").read_text(), re.DOTALL)
    assert shown is not None
    assert main(["project", str(ROOT / "examples" / "dropped_egg.toml"), "--out", str(tmp_path / "drop")]) == 0
    capfd.readouterr()
    assert main(["ask", str(tmp_path / "drop"), shown[1]]) == 0
    assert capfd.readouterr().out.splitlines() == shown[2].splitlines()
