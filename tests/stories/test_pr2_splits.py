"""The paper's third experiment: two hands part a cracked egg."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis import Projection, project

SPLIT = Path(__file__).parents[2] / "examples" / "pr2_split.toml"

pytestmark = pytest.mark.laws


@pytest.fixture(scope="module")
def parted() -> Projection:
    return project(SPLIT)


def test_both_hands_hold_the_cracked_egg_before_it_opens(parted: Projection) -> None:
    assert parted.ask(
        "occurs(splitting(rightGripper, leftGripper, egg1, _, _), S), occurs(breaking(egg1), B), before(B, S), "
        "holds(attached(leftGripper, egg1), L), allen(during, L, S), holds(attached(rightGripper, egg1), _)"
    )


def test_what_was_inside_ends_in_the_bowl(parted: Projection) -> None:
    assert parted.ask("evidence(contains(bowl1, yolk1), T, fraction, F), F > 0.9")
    assert not parted.ask("holds(broken(yolk1), T)")
