"""The paper's figure 12: shell sticks to the gripper when the arm moves away, and falls off later."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis import project

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_wet_shell_goes_up_with_the_gripper_and_falls_off_later() -> None:
    run = project(EXAMPLES / "pr2_stick.toml")
    carried = run.ask(
        "holds(attached(rightGripper, P), A), evidence(attached(rightGripper, P), A, by, joint), "
        "occurs(lifting(rightGripper, _), L), allen(contains, A, L), occurs(falling(P), F), after(F, A)"
    )
    assert carried
    assert all("piece" in str(answer["P"]) for answer in carried)


@pytest.mark.filterwarnings("ignore:near its threshold")
def test_a_hand_that_closes_on_pieces_stays_stable() -> None:
    """In substeps of a millisecond the solver came to no end at a fingertip."""
    crushed = project(EXAMPLES / "pr2_stick.toml", settings={"Crush": "47 N", "Gentle": "1 N"})
    assert crushed.ask("holds(crushed(egg1), _)")
