"""The crack that an edge makes in a shell: how far it runs, and which pull and which bending open it all round."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.matter.test_bond_graph import AXES, egg_graph
from tests.matter.test_breaking import came_of, fallen
from tests.scenes import EGG_IN_HAND, run

from prolepsis.geometry.shape import FloatArray
from prolepsis.matter.shells.seam import BULGE, Seam, arc_after, edge_along, patch_round, seam_along

TOUGHNESS = math.sqrt(40e9 * 2.25)
"""Of eggshell [Pa m^0.5]."""
RADIUS, THICKNESS = AXES[1], 0.35e-3


def girdle(arc: float) -> Seam:
    """Return a seam round the middle of an egg, below, that reaches so far to either side [rad]."""
    seam = seam_along(np.array(AXES), np.array([0.0, 0.0, -AXES[2]]), np.array([0.0, 1.0, 0.0]))
    seam.arc = arc
    return seam


def intensity(force: float, moment: float, arc: float) -> float:
    """Return the stress intensity of such a crack under a pull [N] and a moment [N m] in closed form [Pa m^0.5]."""
    wall, half = math.pi * RADIUS * THICKNESS, RADIUS * arc
    bulge = math.sqrt(1 + BULGE * half**2 / (RADIUS * THICKNESS))
    return (force / (2 * wall) + moment / (wall * RADIUS)) * math.sqrt(math.pi * half) * bulge


@pytest.mark.parametrize("arc", [0.4, 0.8, 1.4])
def test_a_pull_along_the_axis_opens_it_as_in_closed_form(arc: float) -> None:
    ends = np.array([[AXES[0], 0.0, 0.0], [-AXES[0], 0.0, 0.0]])
    pull = 5.0 * np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    found = girdle(arc).opens(egg_graph(), ends, pull, TOUGHNESS)
    assert found == pytest.approx(intensity(5.0, 0.0, arc) / TOUGHNESS, rel=0.01)
    assert girdle(arc).opens(egg_graph(), ends, -pull, TOUGHNESS) < 0


def test_bending_opens_it_only_on_its_own_side() -> None:
    x, z = 0.02, AXES[2] * math.sqrt(1 - (0.02 / AXES[0]) ** 2)
    points = np.array([[x, 0.0, -z], [x, 0.0, z], [-x, 0.0, -z], [-x, 0.0, z]])
    apart_below = 3.0 * np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    found = girdle(0.8).opens(egg_graph(), points, apart_below, TOUGHNESS)
    assert found == pytest.approx(intensity(0.0, 3.0 * 2 * z, 0.8) / TOUGHNESS, rel=0.01)
    assert girdle(0.8).opens(egg_graph(), points, -apart_below, TOUGHNESS) == pytest.approx(-found)


def test_a_pinch_or_a_fall_does_not_open_it() -> None:
    sides = np.array([[0.01, 0.02, 0.0], [0.01, -0.02, 0.0]])
    pinch = 20.0 * np.array([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]])
    assert girdle(0.8).opens(egg_graph(), sides, pinch, TOUGHNESS) == pytest.approx(0.0, abs=1e-6)
    assert girdle(0.8).opens(egg_graph(), sides[:1], 0 * pinch[:1], TOUGHNESS) == 0.0


def test_what_presses_on_the_seam_itself_draws_neither_side() -> None:
    below = np.array([[0.0, 0.0, -AXES[2]]])
    rubbed = girdle(0.8).opens(egg_graph(), below, np.array([[4.0, 0.0, 0.0]]), TOUGHNESS)
    # On one side alone it would be 1.6.
    assert abs(rubbed) < 0.1


def test_it_runs_farther_the_harder_the_blow_and_is_held_near_it() -> None:
    arcs = [arc_after(force, RADIUS, THICKNESS, 0.345, TOUGHNESS) for force in (5.0, 20.0, 35.0, 56.0)]
    assert arcs == sorted(arcs) and arcs[0] < 0.2 < arcs[1]
    # Where it stops the crack is just borne: two cracks in a stress that falls as 1 / s^2, in closed form.
    closed: float = 2.047 * math.sqrt(RADIUS * THICKNESS) / (12 * (1 - 0.345**2)) ** 0.25
    end = RADIUS * arcs[2]
    drawn = 35.0 * RADIUS / (2 * math.pi * THICKNESS)
    away: FloatArray = np.linspace(closed, end, 200_001)[1:-1]
    weighted: FloatArray = drawn / away**2 * np.sqrt((away - closed) / (end - away))
    found = float(np.trapezoid(weighted, away)) / math.sqrt(math.pi * (end - closed) / 2)
    assert found == pytest.approx(TOUGHNESS, rel=0.03)


def distances(points: FloatArray, along: FloatArray | None) -> FloatArray:
    """Return how far points are above a plane, or a thin bar in some direction, that touches the egg below [m]."""
    height = points[:, 2] + AXES[2]
    if along is None:
        return height
    across = points[:, :2] - (points[:, :2] @ along[:2])[:, None] * along[:2]
    return np.hypot(np.maximum(np.linalg.norm(across, axis=1) - 0.001, 0.0), height)


@pytest.mark.parametrize("angle", [0.0, 0.5, 1.5])
def test_an_edge_is_told_from_a_floor(angle: float) -> None:
    patch = patch_round(np.array(AXES), np.array([0.0, 0.0, -AXES[2]]))
    assert edge_along(patch, distances(patch, None)) is None
    along = np.array([math.cos(angle), math.sin(angle), 0.0])
    found = edge_along(patch, distances(patch, along))
    assert found is not None and abs(found @ along) > 0.98


def test_a_rim_leaves_a_longer_crack_than_a_floor() -> None:
    floor, rim = came_of(fallen("lying", 0.8)), came_of(fallen("rim", 0.8))
    assert floor[1] == rim[1] == 1 and rim[0] > floor[0]


def test_what_is_held_beside_its_middle_does_not_creep() -> None:
    held = EGG_IN_HAND.replace(":egg1 a :Egg", ":egg1 a :Egg ; :x 0.008")
    assert held != EGG_IN_HAND
    log = run(held, "sequence([close(hand1, 5), hold(hand1, 4.0)])", duration=5.0)
    egg = log.poses[:, log.index("egg1")]
    assert np.abs(egg[-1, :3] - egg[1500, :3]).max() < 1e-4
    assert np.abs(egg[-1, 3:] - egg[1500, 3:]).max() < 1e-2
