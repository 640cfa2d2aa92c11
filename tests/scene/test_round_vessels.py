"""Cups and bowls: outlines with real walls, and convex pieces that leave their holes open."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from prolepsis.geometry import turned
from prolepsis.geometry.shape import FloatArray, Shape
from prolepsis.geometry.signed_distance import field_of
from prolepsis.geometry.solids import solid_of
from prolepsis.scene.shapes import SHAPES
from prolepsis.terms.errors import KnowledgeError

CUP = {"radius": 0.04, "height": 0.09, "thickness": 0.005}
BOWL = {"radius": 0.08, "height": 0.06, "thickness": 0.005}


def solid_distance(shape: Shape, points: Any) -> FloatArray:
    """Return the distance of points to the union of the convex pieces [m]."""
    where = np.atleast_2d(np.array(points, dtype=np.float64))
    return np.min([solid_of(geom).distance(where) for geom in shape.geoms], axis=0)


def test_a_cup_has_the_volume_and_the_capacity_of_a_cylinder_in_a_cylinder() -> None:
    vessel = turned.cup(CUP)
    inner = math.pi * 0.035**2 * 0.085
    assert vessel.capacity == pytest.approx(inner)
    assert vessel.volume == pytest.approx(math.pi * 0.04**2 * 0.09 - inner)


def test_a_bowl_has_the_capacity_of_a_spherical_cap_that_ends_on_a_flat_bottom() -> None:
    vessel = turned.bowl(BOWL)
    ball = (0.08**2 + 0.06**2) / 0.12 - 0.005
    middle = ball + 0.005

    def cap(height: float) -> float:
        depth = ball - (middle - height)
        return math.pi * depth**2 * (3 * ball - depth) / 3

    exact = cap(vessel.inner[-1][1]) - cap(vessel.inner[0][1])
    # 15 chords in place of the arc.
    assert vessel.capacity == pytest.approx(exact, rel=2e-3)
    assert vessel.volume == pytest.approx(math.pi * (0.08**2 + 0.06**2) * 0.005, rel=0.1)


@pytest.mark.parametrize(("shape", "extents"), [("cup", CUP), ("bowl", BOWL)])
def test_outlines_run_counter_clockwise_and_a_lid_closes_them(shape: str, extents: dict[str, float]) -> None:
    for lid in (0.0, 1.0):
        vessel = turned.VESSELS[shape]({**extents, "lid": lid})
        line = np.array(vessel.outline)
        following = np.roll(line, -1, axis=0)
        assert np.sum(line[:, 0] * following[:, 1] - line[:, 1] * following[:, 0]) > 0
        assert (line[:, 0] >= 0).all()
    open_one, closed = (turned.VESSELS[shape]({**extents, "lid": lid}) for lid in (0.0, 1.0))
    assert closed.volume - open_one.volume > 0.9 * math.pi * 0.9 * extents["radius"] ** 2 * extents["thickness"]


@pytest.mark.parametrize(("shape", "extents"), [("cup", CUP), ("bowl", BOWL)])
def test_the_pieces_of_a_vessel_lie_where_its_outline_says(shape: str, extents: dict[str, float]) -> None:
    built = SHAPES[shape]({**extents, "lid": 1.0})
    random = np.random.default_rng(7)
    points = random.uniform((-0.1, -0.1, -0.02), (0.1, 0.1, 0.12), (4000, 3))
    exact, pieces = field_of(built).distance(points), solid_distance(built, points)
    # Walls of 20 flat pieces in 5 rings: 1.2 % of the radius off at most, and the corner under a bowl's rim.
    clear = np.abs(exact) > 0.0025
    assert ((exact < 0) == (pieces < 0))[clear].all()


def test_a_hole_in_the_side_is_open_and_the_wall_beside_it_is_not() -> None:
    cup = SHAPES["cup"]({**CUP, "holeRadius": 0.006, "holeHeight": 0.03, "holeCount": 3.0, "holeAngle": 0.5})
    assert len(cup.holes) == 3
    for k in range(3):
        angle = 0.5 + k * math.tau / 3
        way = np.array([math.cos(angle), math.sin(angle), 0.0])
        assert solid_distance(cup, 0.0375 * way + (0.0, 0.0, 0.03)) > 0.004
        assert (solid_distance(cup, [0.0375 * way + (0, 0, z) for z in (0.02, 0.04, 0.08)]) < 0).all()
        beside = np.array([math.cos(angle + 0.4), math.sin(angle + 0.4), 0.0])
        assert solid_distance(cup, 0.0375 * beside + (0, 0, 0.03)) < 0
        hole = cup.holes[k]
        assert hole.direction == pytest.approx(way)
        assert np.linalg.norm(hole.position[:2]) < 0.035


@pytest.mark.parametrize(("shape", "extents"), [("cup", CUP), ("bowl", BOWL)])
def test_a_hole_in_the_bottom_goes_through_and_leaves_the_rest(shape: str, extents: dict[str, float]) -> None:
    built = SHAPES[shape]({**extents, "bottomHoleRadius": 0.006})
    assert (solid_distance(built, [(0, 0, z) for z in (0.0, 0.0025, 0.005)]) > 0.005).all()
    assert (solid_distance(built, [(0.008, 0.001, 0.0025), (0.001, -0.02, 0.0025)]) < 0).all()
    (hole,) = built.holes
    assert hole.direction == (0.0, 0.0, -1.0) and hole.radius == 0.006


def test_a_bowl_has_a_hole_where_the_wall_slants() -> None:
    bowl = SHAPES["bowl"]({**BOWL, "holeRadius": 0.005, "holeHeight": 0.025, "holeAngle": 0.1})
    (hole,) = bowl.holes
    through = np.array(hole.position) + np.linspace(0.0, 0.2, 400)[:, None] * np.array(hole.direction)
    assert (solid_distance(bowl, through) > 0.002).all()
    whole = SHAPES["bowl"](BOWL)
    assert (solid_distance(whole, through) < 0).any()


@pytest.mark.parametrize(
    ("shape", "said", "message"),
    [
        ("cup", {"thickness": 0.04}, "thickness 0.04 m leaves no cavity; allowed: less than radius and height"),
        ("cup", {"holeRadius": 0.005}, "holeRadius is given without holeHeight"),
        ("cup", {"holeRadius": 0.005, "holeHeight": 0.008}, "at the height 0.008 m does not fit into the wall"),
        ("cup", {"holeRadius": 0.005, "holeHeight": 0.04, "holeCount": 30.0}, "30 holes of radius .* allowed: 1 to 23"),
        ("cup", {"bottomHoleRadius": 0.04}, "bottomHoleRadius 0.04 m: allowed: less than 0.035 m"),
        ("openBox", {"length": 0.2, "width": 0.1, "holeRadius": 0.01}, "an open box cannot have one; allowed: cups"),
    ],
)
def test_holes_and_walls_that_do_not_fit_are_refused(shape: str, said: dict[str, float], message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        SHAPES[shape]({**CUP, **said})
