"""The plunit tests of the Prolog modules."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

FILES = sorted((Path(__file__).parent / "prolog").glob("*.plt"))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_plunit(file: Path) -> None:
    command = ["swipl", "-q", "-f", "none", "-g", "run_tests", "-t", "halt", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert not any(word in done.stderr for word in ("FAILED", "ERROR", "Warning")), done.stderr
