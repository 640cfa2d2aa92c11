"""What is in a vessel that is in, or dips into, another one."""

from __future__ import annotations

import numpy as np
import pytest
from tests.fluents.liquids import DISH, HEIGHT, RADIUS, WALL, block, level_in, says, table, tilted, vessel, wet, within
from tests.fluents.worlds import FLOOR, ball, cup_geoms, free, of_type, watch, world

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.things import Thing
from prolepsis.log.timeline import Timeline

POT = ((0.0, 0.0), (0.12, 0.0), (0.12, 0.1), (0.117, 0.1), (0.117, 0.003), (0.0, 0.003))
TICKS = 100


def around(*cups: Thing, level: float) -> FloatArray:
    """Return the particles that fill a dish up to a height, but for cups that stand upright or upside down there."""
    found = within(block((-0.095, -0.095, WALL), (0.095, 0.095, level)), 0.095)
    for cup in cups:
        away = found - np.array(cup.position)
        found = found[(np.hypot(away[:, 0], away[:, 1]) > RADIUS + 0.002) | (away[:, 2] < -0.002)]
    return found


def carried(cup: Thing, tea: FloatArray, dish: FloatArray, rise: float, *others: Thing) -> Timeline:
    """Return the timeline of a cup of tea in a dish of water, which from 0.4 s on is lifted by some way [m]."""
    path = np.tile(np.array([*cup.position, *cup.orientation]), (TICKS, 1))
    path[:, 2] += np.clip((np.arange(TICKS) - 40) / 50, 0.0, 1.0) * rise
    moved = tea + (path[::2, :3] - path[0, :3])[:, None]
    things = [table(), vessel("dish1", profile=DISH), cup, *others]
    return recognize(wet(things, {"tea1": moved, "water1": dish}, ticks=TICKS, poses={"cup1": path}))


@pytest.mark.parametrize("mesh", [False, True])
def test_what_is_in_a_cup_that_dips_into_a_dish_is_in_the_cup_alone_and_is_carried_out_in_it(mesh: bool) -> None:
    cup = vessel(at=(0.0, 0.0, 0.015), mesh=mesh)
    timeline = carried(cup, level_in(cup, 0.07), around(cup, level=0.031), 0.15)
    assert says(timeline, "contains") == {"contains(cup1,tea1)", "contains(dish1,water1)"}
    assert not says(timeline, "flowingOut", "flowingOnto", "inFlight")


def test_of_three_vessels_each_has_what_is_kept_by_it() -> None:
    cup = vessel(at=(0.0, 0.0, 0.018))
    pot = vessel("pot1", profile=POT, at=(0.0, 0.0, -0.003))
    timeline = carried(cup, level_in(cup, 0.07), around(cup, level=0.031), 0.0, pot)
    assert says(timeline, "contains") == {
        "contains(cup1,tea1)", "contains(dish1,water1)", "contains(pot1,water1)", "contains(pot1,tea1)",
    }  # fmt: skip


def test_a_cup_that_stands_in_a_dish_to_its_half_leaves_it_with_its_tea() -> None:
    cup = vessel(at=(0.0, 0.0, WALL))
    timeline = carried(cup, level_in(cup, 0.07), around(cup, level=0.031), 0.15)
    (inside,) = (fact for fact in timeline.facts if str(fact.term) == "contains(dish1,tea1)")
    assert inside.start == 0.0
    assert 0.4 < inside.end < 0.5
    assert not says(timeline, "flowingOut")


def test_what_a_cup_scoops_is_in_both_as_long_as_it_could_flow_back() -> None:
    # It lies with its lower lip a centimetre below the rim of the dish, and most of it above that.
    cup = vessel(at=(0.0, 0.03, 0.045), turn=tilted(75.0))
    timeline = carried(cup, level_in(cup, 0.03), around(level=0.007), 0.0)
    assert says(timeline, "contains") == {"contains(cup1,tea1)", "contains(dish1,tea1)", "contains(dish1,water1)"}


def test_a_cup_that_dips_its_rim_holds_nothing_of_what_it_is_dipped_into() -> None:
    cup = vessel(at=(0.0, 0.0, 0.02 + HEIGHT), turn=tilted(180.0))
    timeline = recognize(wet([table(), vessel("dish1", profile=DISH), cup], {"water1": around(level=0.031)}))
    assert says(timeline, "contains") == {"contains(dish1,water1)"}


@pytest.mark.parametrize(("height", "both"), [(0.1, False), (0.03, True)])
def test_a_ball_in_a_cup_on_a_saucer_is_in_the_saucer_if_most_of_the_cup_is(height: float, both: bool) -> None:
    saucer = free("saucer", "0 0 .0001", cup_geoms(0.1, 0.025))
    cup = free("cup", "0 0 .0043", cup_geoms(0.04, height))
    timeline = watch(world(FLOOR + saucer + cup + ball("ball", "0 0 .0165", 0.008, 0.01)), 0.6)
    assert ("contains(saucer,ball)" in of_type(timeline, "contains")) == both
    assert ("contains(saucer,cup)" in of_type(timeline, "contains")) == both
    assert "contains(cup,ball)" in of_type(timeline, "contains")
