"""What floats in a liquid and what is immersed in it, on logs made by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.fluents.liquids import HEIGHT, WALL, D, poured, puddle, says, table, vessel, wet

from prolepsis.fluents import recognize
from prolepsis.fluents.liquids.immersion import lattice
from prolepsis.fluents.observation import observe
from prolepsis.fluents.shapes_in_time import rigid_shapes
from prolepsis.geometry.shape import FloatArray, Geom, Shape
from prolepsis.log.near import is_near
from prolepsis.log.things import Thing
from prolepsis.log.timeline import Fact, Timeline

LEVEL = WALL + 0.04
"""Height of the surface [m]."""
RADIUS, WEIGHT = 0.012, 0.04
"""Of the ball [m], [N]."""


def ball(height: float, weight: float = WEIGHT) -> Thing:
    """Return a ball whose middle is at a height."""
    shape = Shape(geoms=(Geom(type="sphere", size=(RADIUS, 0.0, 0.0)),))
    return Thing(name="ball1", kind="Ball", shape=shape, mass=weight / 9.81, position=(0.0, 0.0, height))


def water(height: float) -> FloatArray:
    """Return particles up to the level in a cup, with room for a ball."""
    points = poured(high=LEVEL)
    return points[np.linalg.norm(points - [0.0, 0.0, height], axis=1) > RADIUS + 0.4 * D]


def with_ball(
    height: float,
    *,
    lifts: dict[tuple[str, str], float] | None = None,
    fall: float = 0.0,
    weight: float = WEIGHT,
) -> Timeline:
    """Return the timeline of a cup of water with a ball, which goes down by some way [m] in a second."""
    things = [table(), vessel(), ball(height, weight)]
    poses = np.tile(np.array([0.0, 0.0, height, 1.0, 0.0, 0.0, 0.0]), (100, 1))
    poses[:, 2] -= np.linspace(0.0, fall, 100)
    log = wet(things, {"liq1": water(height)}, ticks=100, poses={"ball1": poses}, lifts=lifts)
    return recognize(log)


def the(timeline: Timeline, type: str) -> Fact:
    """Return the one fact of a type about the ball."""
    (fact,) = (fact for fact in timeline.select(type=type) if "ball1" in fact.args)
    return fact


def test_what_a_liquid_bears_floats_in_it_and_is_in_its_vessel() -> None:
    timeline = with_ball(LEVEL)
    wanted = {"floats(ball1,liq1)", "immersed(ball1,liq1)", "contains(cup1,ball1)", "contains(cup1,liq1)"}
    assert says(timeline, "floats", "immersed", "contains") == wanted
    assert the(timeline, "immersed").evidence["fraction"] == pytest.approx(0.5, abs=0.1)
    assert the(timeline, "immersed").evidence["margin"] == pytest.approx(5.0, abs=1.0)
    assert the(timeline, "floats").evidence["share"] == 1.0


def test_what_has_sunk_is_immersed_and_does_not_float() -> None:
    timeline = with_ball(WALL + RADIUS, lifts={("cup1", "ball1"): 0.8 * WEIGHT})
    assert says(timeline, "floats", "immersed") == {"immersed(ball1,liq1)"}
    assert the(timeline, "immersed").evidence["fraction"] == 1.0


def test_what_something_else_bears_does_not_float() -> None:
    timeline = with_ball(LEVEL, lifts={("table1", "ball1"): 0.9 * WEIGHT})
    assert says(timeline, "floats", "immersed") == {"immersed(ball1,liq1)"}


DISPLACED = 4 / 3 * np.pi * RADIUS**3 * 1000 * 9.81
"""Weight of the water in the ball's stead [N]."""


@pytest.mark.parametrize(("density", "near"), [(0.5, False), (0.8, False), (0.9, True), (0.99, True), (1.1, True)])
def test_what_is_about_as_dense_as_its_liquid_floats_near_the_threshold(density: float, near: bool) -> None:
    # What floats though it is too dense does so by an error, or by the surface's tension.
    told = the(with_ball(LEVEL - 0.6 * RADIUS, weight=density * DISPLACED), "floats").evidence
    assert told["margin"] == pytest.approx(max(1 / density, 1.0), abs=0.03)
    assert is_near(told) == near


@pytest.mark.parametrize(("density", "margin"), [(0.5, 0.0), (0.95, 0.97), (1.1, 1 / 1.1), (1.3, 0.0)])
def test_what_is_about_as_dense_as_its_liquid_and_under_it_nearly_floats(density: float, margin: float) -> None:
    timeline = with_ball(LEVEL - 1.5 * RADIUS, weight=density * DISPLACED)
    assert says(timeline, "floats", "immersed") == {"immersed(ball1,liq1)"}
    found = [fact.evidence["margin"] for fact in timeline.near_misses if fact.type == "floats"]
    assert found == ([pytest.approx(margin, abs=0.03)] if margin else [])


def test_of_what_may_hold_air_the_density_tells_nothing() -> None:
    halves = (Geom(type="box", size=(RADIUS, RADIUS, 0.006), position=(0.0, 0.0, z)) for z in (-0.006, 0.006))
    hull = replace(ball(LEVEL, 2 * DISPLACED), shape=Shape(geoms=tuple(halves)))
    timeline = recognize(wet([table(), vessel(), hull], {"liq1": water(LEVEL)}, ticks=100))
    assert the(timeline, "floats").evidence["margin"] == 2.0


def test_what_shoots_through_the_surface_does_not_float() -> None:
    timeline = with_ball(LEVEL, fall=0.9)
    assert says(timeline, "floats") == set()


def test_what_is_above_the_surface_is_not_immersed() -> None:
    timeline = with_ball(LEVEL + 1.5 * RADIUS)
    assert says(timeline, "floats", "immersed") == set()
    assert not with_ball(HEIGHT + 0.1).select(type="immersed")


def test_a_thing_on_a_wet_table_is_not_immersed() -> None:
    box = Thing(
        name="box1",
        kind="Block",
        shape=Shape(geoms=(Geom(type="box", size=(0.02, 0.02, 0.01)),)),
        mass=0.02,
        position=(0.2, 0.0, 0.01),
    )
    wide = puddle(half=0.06)
    around = wide[np.abs(wide[:, :2] - [0.2, 0.0]).max(axis=1) > 0.02 + D / 2]
    timeline = recognize(wet([table(), box], {"liq1": around}, lifts={("table1", "box1"): 0.2}))
    assert says(timeline, "floats", "immersed") == set()


def test_what_is_under_or_round_a_vessel_is_not_in_its_liquid() -> None:
    tray = Thing(
        name="ball1",
        kind="Tray",
        shape=Shape(geoms=(Geom(type="box", size=(0.1, 0.1, 0.004)),)),
        mass=0.3,
        position=(0.0, 0.0, -0.004),
    )
    log = wet([table(), vessel(), tray], {"liq1": poured(high=LEVEL)}, ticks=100)
    assert says(recognize(log), "floats", "immersed") == set()


def test_the_points_in_a_body_are_as_its_middle_and_reach_all_its_sides_alike() -> None:
    # None of its sides but the longest is a whole number of steps of the longest.
    shape = Shape(geoms=(Geom(type="ellipsoid", size=(0.022, 0.0195, 0.0285)),))
    egg = Thing(name="egg1", kind="Ball", shape=shape, mass=0.058, position=(0.0, 0.0, 0.1))
    (rigid,) = observe(wet([egg], {"liq1": puddle()})).of(rigid_shapes)
    points = lattice(rigid)
    np.testing.assert_allclose(points.mean(axis=0), 0.0, atol=1e-9)
    np.testing.assert_allclose(points.max(axis=0), -points.min(axis=0))
