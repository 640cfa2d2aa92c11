"""What floats in a liquid and what is immersed in it, on logs made by hand."""

from __future__ import annotations

import numpy as np
import pytest
from tests.fluents.liquids import HEIGHT, WALL, D, poured, puddle, says, table, vessel, wet

from prolepsis.fluents import recognize
from prolepsis.fluents.liquids.immersion import lattice
from prolepsis.fluents.observation import observe
from prolepsis.fluents.shapes_in_time import rigid_shapes
from prolepsis.geometry.shape import FloatArray, Geom, Shape
from prolepsis.log.things import Thing
from prolepsis.log.timeline import Fact, Timeline

LEVEL = WALL + 0.04
"""Height of the surface [m]."""
RADIUS, WEIGHT = 0.012, 0.04
"""Of the ball [m], [N]."""


def ball(height: float) -> Thing:
    """Return a ball whose middle is at a height."""
    shape = Shape(geoms=(Geom(type="sphere", size=(RADIUS, 0.0, 0.0)),))
    return Thing(name="ball1", kind="Ball", shape=shape, mass=WEIGHT / 9.81, position=(0.0, 0.0, height))


def water(height: float) -> FloatArray:
    """Return particles up to the level in a cup, with room for a ball."""
    points = poured(high=LEVEL)
    return points[np.linalg.norm(points - [0.0, 0.0, height], axis=1) > RADIUS + 0.4 * D]


def with_ball(height: float, *, lifts: dict[tuple[str, str], float] | None = None, fall: float = 0.0) -> Timeline:
    """Return the timeline of a cup of water with a ball, which goes down by some way [m] in a second."""
    things = [table(), vessel(), ball(height)]
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
