"""Laws of cavities: spill levels are least passes, walls do not leak, and tilting spills when geometry says so."""

from __future__ import annotations

import heapq
import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from prolepsis.geometry.cavity import cavity_of, spill_levels
from prolepsis.geometry.shape import BoolArray, FloatArray, Geom
from prolepsis.geometry.solids import Solid, solid_of

NEIGHBOURS = [step for step in itertools.product((-1, 0, 1), repeat=3) if sum(map(abs, step)) == 1]


def flood(heights: FloatArray, blocked: BoolArray) -> FloatArray:
    """Return the same as ``spill_levels`` by the textbook's priority flood, a node at a time."""
    levels = np.full_like(heights, np.inf)
    queue: list[tuple[float, tuple[int, ...]]] = []
    for node in np.ndindex(*heights.shape):
        if not blocked[node] and any(i in (0, n - 1) for i, n in zip(node, heights.shape, strict=True)):
            levels[node] = heights[node]
            heapq.heappush(queue, (float(heights[node]), node))
    while queue:
        level, node = heapq.heappop(queue)
        for step in NEIGHBOURS:
            near = tuple(a + b for a, b in zip(node, step, strict=True))
            if any(not 0 <= i < n for i, n in zip(near, heights.shape, strict=True)) or blocked[near]:
                continue
            over = max(level, float(heights[near]))
            if over < levels[near]:
                levels[near] = over
                heapq.heappush(queue, (over, near))
    return levels


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 0.8))
def test_spill_levels_are_those_of_a_priority_flood(seed: int, density: float) -> None:
    random = np.random.default_rng(seed)
    shape = tuple(random.integers(2, 8, 3).tolist())
    heights, blocked = random.normal(size=shape), random.random(shape) < density
    assert (spill_levels(heights, blocked) == flood(heights, blocked)).all()


def open_box(half: float, height: float, wall: float) -> tuple[Solid, ...]:
    """Return a square box without a lid on the origin, of inner half-width ``half`` [m]."""
    flat = (half + 2 * wall, half + 2 * wall, wall)
    geoms = [Geom(type="box", size=flat, position=(0.0, 0.0, wall))]
    for side in (-1, 1):
        place = side * (half + wall)
        geoms.append(Geom(type="box", size=(wall, half + 2 * wall, height / 2), position=(place, 0.0, height / 2)))
        geoms.append(Geom(type="box", size=(half + 2 * wall, wall, height / 2), position=(0.0, place, height / 2)))
    return tuple(solid_of(geom) for geom in geoms)


@pytest.mark.parametrize("wall", [0.00001, 0.0005, 0.005])
def test_walls_thinner_than_the_grid_do_not_leak(wall: float) -> None:
    cavity = cavity_of(open_box(0.05, 0.08, wall))
    up = np.array([0.0, 0.0, 1.0])
    points = np.array([(0.0, 0.0, 0.02), (0.045, 0.0, 0.02), (0.0, 0.0, 0.1), (0.08, 0.0, 0.02), (0.0, 0.0, -0.02)])
    depth = cavity.depth(points, up, 0.002)
    assert np.allclose(depth[:2], 0.06, atol=1.5 * cavity.step)
    assert (depth[2:] == 0).all()


@settings(max_examples=30, deadline=None)
@given(st.floats(0.0, 80.0), st.floats(0.0, 360.0))
def test_a_tilted_box_spills_when_the_point_is_level_with_its_rim(tilt: float, around: float) -> None:
    a, b = math.radians(tilt), math.radians(around)
    up = np.array([math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)])
    cavity = cavity_of(open_box(0.05, 0.08, 0.002))
    point = np.array([0.0, 0.0, 0.03])
    corners = np.array([(x, y, 0.08) for x in (-0.052, 0.052) for y in (-0.052, 0.052)])
    # The rim is straight between its corners, so its lowest point is one of them.
    below = (corners @ up).min() - point @ up
    margin = 3 * cavity.step + 0.06 * 0.07
    found = float(cavity.depth(point[None], up, 0.002)[0])
    if below > margin:
        assert found == pytest.approx(below, abs=margin)  # type: ignore[reportUnknownMemberType]
    elif below < -margin:
        assert found == 0.0


def test_a_closed_hollow_lets_nothing_out_whichever_way_it_lies() -> None:
    lid = solid_of(Geom(type="box", size=(0.06, 0.06, 0.002), position=(0.0, 0.0, 0.08)))
    cavity = cavity_of((*open_box(0.05, 0.08, 0.002), lid))
    for up in np.concatenate((np.eye(3), -np.eye(3))):
        assert cavity.depth(np.array([[0.0, 0.0, 0.04]]), up, 0.002)[0] > 0.1


def table(length: float, thick: float, leg: float) -> tuple[Solid, ...]:
    """Return a table of a length, with a top and four legs of a half-width [m], its upper surface at height 0."""
    long, wide, high = length / 2, length / 3, 0.35
    geoms = [Geom(type="box", size=(long, wide, thick / 2), position=(0.0, 0.0, -thick / 2))]
    for x, y in itertools.product((leg - long, long - leg), (leg - wide, wide - leg)):
        geoms.append(Geom(type="box", size=(leg, leg, high - thick / 2), position=(x, y, -high - thick / 2)))
    return tuple(solid_of(geom) for geom in geoms)


@pytest.mark.parametrize("length", np.linspace(0.5, 1.6, 12).tolist())
def test_a_level_top_is_no_cavity_for_what_has_sunk_into_it(length: float) -> None:
    cavity = cavity_of(table(length, 0.03, 0.03))
    heights = np.array([-1e-3, -3e-4, -5e-5, 1e-5, 1e-4, 1e-3, 3e-3])
    for x, y in ((0.0, 0.0), (0.013, 0.05), (-0.31 * length, 0.17 * length)):
        points = np.column_stack([np.full(len(heights), x), np.full(len(heights), y), heights])
        assert (cavity.depth(points, np.array([0.0, 0.0, 1.0]), 0.00025) == 0).all()


@pytest.mark.parametrize("sunk", [-5e-4, -5e-5, 1e-5, 1e-3])
@pytest.mark.parametrize("steps", [3.0, 5.0, 20.0])
def test_what_has_sunk_into_the_bottom_of_a_tray_is_still_in_it(steps: float, sunk: float) -> None:
    wide = cavity_of(open_box(0.2, 0.02, 0.002)).step
    cavity = cavity_of(open_box(0.2, steps * wide, 0.002))
    points = np.array([(0.0, 0.0, 0.004 + sunk), (0.1, -0.07, 0.004 + sunk)])
    depth = cavity.depth(points, np.array([0.0, 0.0, 1.0]), 0.00025)
    assert np.allclose(depth, steps * wide - 0.004 - sunk, atol=1.5 * cavity.step)
