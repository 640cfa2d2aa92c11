"""Laws of hollows: walls do not leak, tilting spills when geometry says so, capacities are those of closed forms."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.fluents.liquids import tilted

from prolepsis.geometry.hollows import Space, alike, space_of
from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import FloatArray, Geom, Shape
from prolepsis.geometry.signed_distance import shifted, solids_as_arrays
from prolepsis.geometry.solids import solid_of

UP = np.array([0.0, 0.0, 1.0])
BRIM_TOLERANCE = 0.5
"""Error of a spill level over a sharp corner [steps]; over a round rim it is a twentieth."""
CAPACITY_TOLERANCE = 0.015
"""Error of a capacity over what the vessel keeps when upright [1]: shallow rests are seen too small."""


def around(geoms: Sequence[Geom]) -> Space:
    """Return the space in and round boxes."""
    bounds = [solid_of(geom).bounds() for geom in geoms]
    low, high = np.min([b[0] for b in bounds], axis=0), np.max([b[1] for b in bounds], axis=0)
    return space_of(solids_as_arrays(Shape(geoms=tuple(geoms))), low, high)


def depth(
    space: Space, points: Sequence[Sequence[float]] | FloatArray, up: FloatArray, clearance: float = 0.0
) -> FloatArray:
    """Return how deep points are in the pools along a direction [m]."""
    return space.depth(np.array(points), np.tile(up, (len(points), 1)), space.pools(up, clearance), clearance)


def open_box(half: float, height: float, wall: float) -> list[Geom]:
    """Return a square box without a lid on the origin, of inner half-width ``half`` [m]."""
    geoms = [Geom(type="box", size=(half + 2 * wall, half + 2 * wall, wall), position=(0.0, 0.0, wall))]
    for side in (-1, 1):
        place = side * (half + wall)
        geoms.append(Geom(type="box", size=(wall, half + 2 * wall, height / 2), position=(place, 0.0, height / 2)))
        geoms.append(Geom(type="box", size=(half + 2 * wall, wall, height / 2), position=(0.0, place, height / 2)))
    return geoms


@pytest.mark.parametrize("wall", [0.00001, 0.0005, 0.005])
def test_walls_thinner_than_the_grid_do_not_leak(wall: float) -> None:
    points = [(0.0, 0.0, 0.02), (0.045, 0.0, 0.02), (0.0, 0.0, 0.1), (0.08, 0.0, 0.02), (0.0, 0.0, -0.02)]
    points += [(0.051 + 2 * wall, 0.0, 0.02), (0.0, 0.051 + 2 * wall, 0.03)]
    for clearance in (0.0, 0.005):
        found = depth(around(open_box(0.05, 0.08, wall)), points, UP, clearance)
        assert found[:2] == pytest.approx(0.06, abs=1e-6)
        assert (found[2:] == 0).all()


@settings(max_examples=30, deadline=None)
@given(st.floats(0.0, 80.0), st.floats(0.0, 360.0))
def test_a_tilted_box_spills_when_the_point_is_level_with_its_rim(tilt: float, around_it: float) -> None:
    a, b = math.radians(tilt), math.radians(around_it)
    up = np.array([math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)])
    space = around(open_box(0.05, 0.08, 0.002))
    point = np.array([0.0, 0.0, 0.03])
    # The rim is straight between its corners, so its lowest point is one of them.
    corners = np.array([(x, y, 0.08) for x in (-0.05, 0.05) for y in (-0.05, 0.05)])
    below = float((corners @ up).min() - point @ up)
    margin = BRIM_TOLERANCE * space.step
    for clearance in (0.0, 0.01):
        found = float(depth(space, point[None], up, clearance)[0])
        if below > margin + space.step:
            # A body cannot leave through the very corner, but as near to it as it comes.
            assert below - margin < found < below + margin + clearance
        elif below < -margin - clearance:
            assert found == 0.0


def test_a_closed_hollow_lets_nothing_out_whichever_way_it_lies() -> None:
    lid = Geom(type="box", size=(0.06, 0.06, 0.002), position=(0.0, 0.0, 0.08))
    space = around([*open_box(0.05, 0.08, 0.002), lid])
    for up in np.concatenate((np.eye(3), -np.eye(3))):
        for clearance in (0.0, 0.01, 0.02):
            assert depth(space, [(0.0, 0.0, 0.04)], up, clearance)[0] > 0.1


@pytest.mark.parametrize("clearance", [0.0, 0.01, 0.03])
def test_the_space_under_an_upturned_box_keeps_nothing_however_large(clearance: float) -> None:
    assert depth(around(open_box(0.05, 0.08, 0.002)), [(0.0, 0.0, 0.04)], -UP, clearance)[0] == 0.0


def test_a_ball_does_not_slip_through_a_grate_that_a_pea_slips_through() -> None:
    bars = [Geom(type="box", size=(0.06, 0.002, 0.002), position=(0.0, y, 0.002)) for y in np.arange(-5, 6) * 0.01]
    walls = [geom for geom in open_box(0.05, 0.08, 0.002) if geom.size[2] > 0.01]
    space = around([*bars, *walls])
    assert depth(space, [(0.0, 0.005, 0.03)], UP, 0.01)[0] == pytest.approx(0.05, abs=1e-6)
    assert depth(space, [(0.0, 0.005, 0.03)], UP, 0.002)[0] == 0.0


def table(length: float, thick: float, leg: float) -> list[Geom]:
    """Return a table of a length, with a top and four legs of a half-width [m], its upper surface at height 0."""
    long, wide, high = length / 2, length / 3, 0.35
    geoms = [Geom(type="box", size=(long, wide, thick / 2), position=(0.0, 0.0, -thick / 2))]
    for x, y in itertools.product((leg - long, long - leg), (leg - wide, wide - leg)):
        geoms.append(Geom(type="box", size=(leg, leg, high - thick / 2), position=(x, y, -high - thick / 2)))
    return geoms


@pytest.mark.parametrize("length", np.linspace(0.5, 1.6, 12).tolist())
def test_a_level_top_is_no_cavity_for_what_has_sunk_into_it(length: float) -> None:
    space = around(table(length, 0.03, 0.03))
    for x, y in ((0.0, 0.0), (0.013, 0.05), (-0.31 * length, 0.17 * length)):
        points = [(x, y, height) for height in (-1e-3, -3e-4, -5e-5, 1e-5, 1e-4, 1e-3, 3e-3)]
        assert (depth(space, points, UP) == 0).all()


@pytest.mark.parametrize("sunk", [-5e-4, -5e-5, 1e-5, 1e-3])
@pytest.mark.parametrize("high", [0.01, 0.02, 0.06])
def test_what_has_sunk_into_the_bottom_of_a_tray_is_still_in_it(high: float, sunk: float) -> None:
    space = around(open_box(0.2, high, 0.002))
    points = [(0.0, 0.0, 0.004 + sunk), (0.1, -0.07, 0.004 + sunk)]
    assert depth(space, points, UP) == pytest.approx(high - 0.004 - sunk, abs=1e-6)


def cylinder(radius: float, length: float, tilt: float) -> float:
    """Return what a tilted cylinder without a lid keeps [m^3]."""
    x = radius * ((np.arange(100_000) + 0.5) / 50_000 - 1)
    height = np.clip(length - (radius + x) * math.tan(tilt), 0.0, None)
    return float((2 * np.sqrt(radius**2 - x**2) * height).sum() * radius / 50_000)


def cap(radius: float, rim: float, tilt: float) -> float:
    """Return what a tilted bowl keeps that is a part of a sphere up to an angle from its lowest point [m^3]."""
    height = radius * (1 - math.cos(max(rim - tilt, 0.0)))
    return math.pi * height**2 * (3 * radius - height) / 3


def spherical(radius: float, rim: float, wall: float) -> Shape:
    """Return that bowl."""
    angles = np.linspace(0.0, rim, 50)
    arcs = [
        [(r * math.sin(a), radius + wall - r * math.cos(a)) for a in angles.tolist()] for r in (radius + wall, radius)
    ]
    return Shape(profile=(*arcs[0], *arcs[1][::-1]))


def beaker(radius: float, height: float, wall: float) -> Shape:
    """Return an upright cylinder of an inner radius and height without a lid."""
    outer, top = radius + wall, height + wall
    return Shape(profile=((0.0, 0.0), (outer, 0.0), (outer, top), (radius, top), (radius, wall), (0.0, wall)))


VESSELS: dict[str, tuple[Shape, Callable[[float], float]]] = {
    "cup": (beaker(0.035, 0.085, 0.005), lambda tilt: cylinder(0.035, 0.085, tilt)),
    "glass": (beaker(0.035, 0.085, 0.001), lambda tilt: cylinder(0.035, 0.085, tilt)),
    "bowl": (spherical(0.06, math.radians(70), 0.003), lambda tilt: cap(0.06, math.radians(70), tilt)),
    "plate": (spherical(0.15, math.radians(30), 0.003), lambda tilt: cap(0.15, math.radians(30), tilt)),
}


@pytest.mark.parametrize("name", VESSELS)
@pytest.mark.parametrize("degrees", [0.0, 7.0, 20.0, 45.0, 60.0, 75.0])
def test_a_vessel_keeps_what_geometry_says_in_whichever_frame_it_is_seen(name: str, degrees: float) -> None:
    shape, exact = VESSELS[name]
    outline = np.array(shape.profile)
    radius, top = float(outline[:, 0].max()), float(outline[:, 1].max())
    solids = solids_as_arrays(shape)
    turn = matrix(np.array(tilted(degrees)))
    corners = np.array(list(itertools.product((-radius, radius), (-radius, radius), (0.0, top)))) @ turn.T
    own = space_of(solids, np.array([-radius, -radius, 0.0]), np.array([radius, radius, top]))
    pose = np.array([0.3, -0.2, 0.7, *tilted(degrees)])
    world = space_of(shifted(solids, pose), corners.min(axis=0) + pose[:3], corners.max(axis=0) + pose[:3])
    kept, most = exact(math.radians(degrees)), exact(0.0)
    for basin in (own.basin(turn.T @ UP), world.basin(UP)):
        assert (0.0 if basin is None else basin.capacity) == pytest.approx(kept, abs=CAPACITY_TOLERANCE * most)


def test_a_basin_is_as_full_as_its_volume_says() -> None:
    shape, exact = VESSELS["cup"]
    basin = space_of(solids_as_arrays(shape), np.array([-0.04, -0.04, 0.0]), np.array([0.04, 0.04, 0.09])).basin(UP)
    assert basin is not None and basin.brim == pytest.approx(0.09, abs=1e-9)
    for part in (0.1, 0.5, 0.9):
        assert basin.level(part * exact(0.0)) == pytest.approx(0.005 + part * 0.085, abs=2e-4)
    points = np.array([(0.0, 0.0, 0.02), (0.034, 0.0, 0.02), (0.0, 0.0, 0.098), (0.046, 0.0, 0.02)])
    assert basin.within(points).tolist() == [True, True, False, False]


def test_directions_that_are_alike_are_taken_as_their_mean() -> None:
    up = np.array([(0.0, 0.0, 1.0), (0.002, 0.0, 1.0), (0.5, 0.0, 0.866), (0.0, 1e-5, 1.0), (0.0, 0.0, -1.0)])
    directions, which = alike(up)
    assert len(directions) == 3 and which[0] == which[1] == which[3] != which[2]
    assert directions[which[0]] == pytest.approx(np.array([0.002 / 3, 1e-5 / 3, 1.0]), abs=1e-6)
    assert directions[which[4]] == pytest.approx(up[4])
