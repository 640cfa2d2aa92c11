"""How actions end: all outcomes stand in one place; what is done has reached what it aims at, and every action ends."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

from tests.scenes import run

from prolepsis.log.outcomes import GOES_ON, OUTCOMES, Outcome

DOCS = Path(__file__).parents[2] / "docs"


def test_all_outcomes_stand_in_one_place_and_in_the_docs() -> None:
    assert list(OUTCOMES) == list(get_args(Outcome))
    page = (DOCS / "actions.md").read_text(encoding="utf-8")
    for name, says in OUTCOMES.items():
        plan = "goes on" if name in GOES_ON else "its sequence ends" if name != "unfinished" else ""
        assert f"| `{name}` | {says} | {plan} |" in page


def test_what_the_end_of_a_run_cuts_off_is_unfinished() -> None:
    log = run(":floor a :Floor .", "sequence([wait(0.01), wait(1.0)])", duration=0.05)
    assert [action.outcome for action in log.actions] == ["done", "unfinished"]
