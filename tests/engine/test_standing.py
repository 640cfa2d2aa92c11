"""What stands stays, and nothing gains energy: a few rows of the tables in ``tests/laws``."""

from __future__ import annotations

import pytest
from tests.laws import energy_scenes, rest_scenes
from tests.laws.verdicts import gained, moved


@pytest.mark.parametrize(
    "name",
    [
        "a cube of 1 mm on a table",
        "a cube of 2000 mm on the floor",
        "a sheet of 0.5 mm on a table",
        "a tower of 5 cubes of 5 cm",
        "10 kg on 0.01 kg",
        "a tower of 10 cubes of 5 cm",
        "ten sheets of 1 mm",
        "a pyramid of six cubes",
        "a ball in a bowl",
    ],
)
def test_what_stands_stays(name: str) -> None:
    assert moved(rest_scenes.SCENES[name]) == []


@pytest.mark.parametrize(
    "name",
    [
        "a cube of 5 cm from 1 m",
        "a pencil that topples",
        "a ball that rolls down a slope",
        "a ball into a pile of cubes",
    ],
)
def test_nothing_gains_energy(name: str) -> None:
    assert gained(*energy_scenes.SCENES[name]) == []


def test_a_rebound_and_a_motion_are_noticed() -> None:
    # What tells of complaints can complain: a ball on a slope moves, and a drop is a rebound if none is allowed.
    slope = energy_scenes.SCENES["a ball that rolls down a slope"][0]
    assert any("moving(b)" in wrong for wrong in moved(slope))
    assert gained(energy_scenes.SCENES["a cube of 5 cm from 1 m"][0], 0.001) == ["it rebounds to 0.31 of the drop"]
