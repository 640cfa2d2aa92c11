"""The plunit tests of the Prolog modules."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from prolepsis.fluents.kinematics import BALANCE_WINDOW
from prolepsis.fluents.solids.attachment import HOLD_GAP
from prolepsis.fluents.solids.contact import FLICKER
from prolepsis.fluents.solids.fall import SAME_MOMENT
from prolepsis.fluents.solids.support import SUPPORT_GAP, SUPPORT_LEAST
from prolepsis.logic.process import PROLOG_FILES

FILES = sorted((Path(__file__).parents[1] / "prolog").glob("*.plt"))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_plunit(file: Path) -> None:
    command = ["swipl", "-q", "-f", "none", "-g", "run_tests", "-t", "halt", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert not any(word in done.stderr for word in ("FAILED", "ERROR", "Warning")), done.stderr


def test_chronicles_allow_for_what_recognition_does_not_notice() -> None:
    (slack,) = re.findall(r"^slack\((.*)\)\.$", (PROLOG_FILES / "chronicles.pl").read_text(), re.MULTILINE)
    unnoticed = max(FLICKER, SUPPORT_GAP, SUPPORT_LEAST, HOLD_GAP, SAME_MOMENT, BALANCE_WINDOW)
    assert float(slack) == unnoticed
