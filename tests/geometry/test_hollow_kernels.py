"""The compiled loops behind pools and hollows, each against a plain way of finding the same."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Callable
from typing import Any, cast

import numpy as np
import pytest
from scipy import ndimage  # pyright: ignore[reportMissingTypeStubs]

from prolepsis.geometry.distances import nearest_faces, node_distances
from prolepsis.geometry.shape import BoolArray, FloatArray, Geom, Hole, IntArray, Shape
from prolepsis.geometry.signed_distance import Field, solids_as_arrays, union_of
from prolepsis.geometry.spilling import FINENESS, pool_levels
from prolepsis.geometry.spreading import regions, spread

STEPS = [step for step in itertools.product((-1, 0, 1), repeat=3) if sum(map(abs, step)) == 1]
UPS = [(0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (0.6, 0.0, -0.8), (-0.48, 0.6, 0.64)]


NOTHING = np.zeros(0, dtype=np.int64), np.zeros(0)


def passes(free: BoolArray, height: FloatArray) -> FloatArray:
    """Return the least possible greatest height on a way to the edge, by a priority flood, a node at a time."""
    level = np.full(free.shape, np.inf)
    queue: list[tuple[float, tuple[int, ...]]] = []
    for node in np.ndindex(*free.shape):
        if any(i in (0, n - 1) for i, n in zip(node, free.shape, strict=True)):
            level[node] = height[node]
            heapq.heappush(queue, (float(height[node]), node))
    while queue:
        here, node = heapq.heappop(queue)
        for step in STEPS:
            near = tuple(a + b for a, b in zip(node, step, strict=True))
            if all(0 <= i < n for i, n in zip(near, free.shape, strict=True)) and free[near]:
                over = max(here, float(height[near]))
                if over < level[near]:
                    level[near] = over
                    heapq.heappush(queue, (over, near))
    return level


def scattered(random: np.random.Generator, density: float) -> BoolArray:
    """Return a small grid in which a share of the nodes within is blocked."""
    free = np.ones(tuple(random.integers(3, 12, 3).tolist()), dtype=np.bool_)
    free[1:-1, 1:-1, 1:-1] = random.random(free[1:-1, 1:-1, 1:-1].shape) >= density
    return free


@pytest.mark.parametrize("up", UPS)
@pytest.mark.parametrize("density", [0.1, 0.4, 0.7])
def test_a_liquid_stands_as_high_as_the_lowest_way_out(up: tuple[float, float, float], density: float) -> None:
    random = np.random.default_rng(3)
    for _ in range(8):
        free = scattered(random, density)
        across, base = 0.01 * np.array(up), 0.3
        i, j, k = np.indices(free.shape)
        height = base + i * across[0] + j * across[1] + k * across[2]
        level = passes(free, height)
        expected = np.where(free & (level > height), level, -np.inf)
        found = pool_levels(free, *NOTHING, base, across, 0.0)
        plain = np.abs(level - height) > 0.01 / FINENESS
        assert found[plain] == pytest.approx(expected[plain], abs=0.01 / FINENESS)


def test_a_way_is_as_high_as_the_matter_that_it_passes() -> None:
    free = np.ones((9, 9, 9), dtype=np.bool_)
    free[2:7, 2:7, 2:6] = False
    free[3:6, 3:6, 3:6] = True
    rim = np.argwhere(np.ones_like(free))
    rim = rim[(rim[:, 2] == 6) & (rim[:, :2] >= 1).all(axis=1) & (rim[:, :2] < 8).all(axis=1)]
    near: IntArray = np.array(np.ravel_multi_index(tuple(rim.T), free.shape))
    pool = pool_levels(free, near, np.full(len(near), 0.007), 0.0, np.array([0.0, 0.0, 0.01]), 0.0)
    assert pool[4, 4, 3] == pytest.approx(0.06 - 0.007)
    assert (pool > -np.inf).sum() == 27


def test_a_shallow_pool_is_an_artefact() -> None:
    free = np.ones((7, 7, 7), dtype=np.bool_)
    free[2:5, 2:5, 2:4] = False
    free[3, 3, 3] = True
    up = np.array([0.0, 0.0, 0.01])
    assert pool_levels(free, *NOTHING, 0.0, up, 0.009)[3, 3, 3] == pytest.approx(0.04)
    assert pool_levels(free, *NOTHING, 0.0, up, 0.011)[3, 3, 3] == -np.inf


def test_distances_at_nodes_are_those_at_points() -> None:
    cup = ((0.0, 0.0), (0.03, 0.0), (0.035, 0.08), (0.032, 0.08), (0.027, 0.003), (0.0, 0.003))
    hole = Hole(position=(0.0, 0.0, 0.02), direction=(1.0, 0.0, 0.0), radius=0.004)
    random = np.random.default_rng(5)
    pieces = tuple(
        Geom(type="mesh", size=(0, 0, 0), position=tuple(place), vertices=tuple(map(tuple, corners.tolist())))
        for place, corners in zip(
            random.normal(0, 0.02, (6, 3)).tolist(), random.normal(0, 0.01, (6, 9, 3)), strict=True
        )
    )
    others = (
        Geom(type="ellipsoid", size=(0.03, 0.02, 0.02), position=(0.03, 0.0, 0.0)),
        Geom(type="box", size=(0.01, 0.02, 0.001), orientation=(0.8, 0.6, 0.0, 0.0)),
    )
    solids = union_of(
        [solids_as_arrays(Shape(profile=cup, holes=(hole,))), solids_as_arrays(Shape(geoms=(*pieces, *others)))]
    )
    origin, step, shape = np.array([-0.05, -0.06, -0.05]), 0.0045, np.array([23, 27, 31])
    indices = np.moveaxis(np.indices(tuple(shape.tolist()), dtype=np.float64), 0, -1)
    nodes: FloatArray = origin + step * indices.reshape(-1, 3)
    expected = Field(solids=solids).distance(nodes).reshape(shape)
    assert np.array_equal(node_distances(solids, origin, step, shape), expected)
    faces = nearest_faces(solids, nodes, np.inf)
    assert np.array_equal(faces[:, 0].reshape(shape), expected)
    # But for the edge of the hole.
    assert (np.abs(np.linalg.norm(faces[:, 1:], axis=1) - 1.0) < 1e-9).mean() > 0.999


def test_nodes_spread_along_free_ways_only() -> None:
    free = np.ones((9, 5, 5), dtype=np.bool_)
    free[4] = False
    free[4, 0, 0] = True
    nodes = np.zeros_like(free)
    nodes[2, 2, 2] = True
    assert np.array_equal(spread(nodes, free, 1), nodes | (np.abs(np.indices(free.shape) - 2).max(axis=0) <= 1))
    assert not spread(nodes, free, 2)[5:].any()
    assert spread(nodes, free, 3)[5].sum() == 4


@pytest.mark.parametrize("density", [0.2, 0.5, 0.8])
def test_regions_are_numbered_by_their_first_nodes(density: float) -> None:
    random = np.random.default_rng(4)
    label = cast("Callable[[BoolArray], tuple[IntArray, int]]", cast(Any, ndimage).label)
    for _ in range(20):
        nodes = random.random(tuple(random.integers(1, 12, 3).tolist())) < density
        assert np.array_equal(regions(nodes), label(nodes)[0])
