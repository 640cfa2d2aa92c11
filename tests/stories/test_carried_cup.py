"""A question of the paper's introduction: does a full cup spill when it is tilted, or picked up too rapidly?"""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.projection import project

EXAMPLE = Path(__file__).parents[2] / "examples" / "carry_cup.toml"


@pytest.mark.parametrize(
    ("settings", "spills"),
    [
        ({}, False),
        # Four fifths full, it spills from atan((85 mm - 68 mm) / 35 mm) = 26 degrees on.
        ({"Angle": "12 deg"}, False),
        ({"Angle": "45 deg"}, True),
        # While it is slowed down faster than it would fall, the coffee goes on upward.
        ({"Acceleration": 5.0}, False),
        ({"Acceleration": 25.0}, True),
    ],
)
def test_a_full_cup_spills_when_tilted_or_picked_up_too_rapidly(settings: dict[str, float | str], spills: bool) -> None:
    carried = project(EXAMPLE, settings={**settings, "particles": 1000})
    assert bool(carried.ask("holds(spilled(liq1), T)")) == spills
    assert carried.ask("holds(attached(hand1, cup1), T)")
