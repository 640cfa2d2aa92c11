"""Two tables of laws: what stands stays, and nothing gains energy.

A row that fails for want of better liquids is a strict expected failure, with its reason; so is one whose
run is invalid, which is no answer and no pass. ``docs/rest_and_energy.md`` tells of them.
"""

from __future__ import annotations

import pytest
from tests.comparing import Compare
from tests.laws import energy_scenes, rest_scenes
from tests.laws.verdicts import gained, moved

PUSHED = "liquid: particles that are put round a thing push it before they have settled"
SOAKS = "liquid: what a sponge takes up is put anywhere in it, and the energy of wetting is not counted"
MOVES = {
    "a glass ball on the bottom of a bowl of water": PUSHED,
}
GAINS = {
    "a dry sponge into water": SOAKS,
    "a dry sponge from 5 cm into water": SOAKS,
    "a sponge into a bowl of water": SOAKS,
    "a sponge that is let go over water": SOAKS,
}

pytestmark = pytest.mark.laws


def rows(names: list[str], failing: dict[str, str]) -> list[object]:
    """Return the rows of a table, those that are known to fail marked."""
    assert set(failing) <= set(names)
    return [
        pytest.param(name, marks=pytest.mark.xfail(strict=True, reason=failing[name])) if name in failing else name
        for name in names
    ]


@pytest.mark.parametrize("name", rows(list(rest_scenes.SCENES), MOVES))
def test_what_stands_stays(compare: Compare, name: str) -> None:
    wrong = moved(rest_scenes.SCENES[name])
    compare("what stands stays (scenes)", not wrong, True, by="statics")
    assert wrong == []


@pytest.mark.parametrize("name", rows(list(energy_scenes.SCENES), GAINS))
def test_nothing_gains_energy(compare: Compare, name: str) -> None:
    wrong = gained(*energy_scenes.SCENES[name])
    compare("nothing gains energy (scenes)", not wrong, True, by="conservation of energy")
    assert wrong == []


def test_the_tables_are_long_enough() -> None:
    assert len(rest_scenes.SCENES) >= 60
    assert len(energy_scenes.SCENES) >= 30
