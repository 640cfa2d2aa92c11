"""Laws of the elastic graph that a shell is: equilibrium, linearity, and its calibration between plates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from prolepsis.geometry.shape import FloatArray
from prolepsis.matter.shells.bond_graph import BondGraph
from prolepsis.matter.shells.calibration import calibrated_graph
from prolepsis.matter.shells.cutting import ellipsoid_normals, ellipsoid_points, ellipsoid_shell
from prolepsis.matter.shells.fragment import Fragment
from prolepsis.terms.errors import KnowledgeError

AXES = (0.0285, 0.022, 0.022)


def egg_graph(breaking_force: float = 45.0) -> BondGraph:
    return calibrated_graph(
        AXES,
        30,
        thickness=0.35e-3,
        youngs_modulus=40e9,
        poisson_ratio=0.345,
        fracture_strain=0.0073,
        mass=0.059,
        breaking_force=breaking_force,
    )


def pinch(graph: BondGraph, point: FloatArray, inward: FloatArray, force: float) -> float:
    return float(graph.loads(np.stack([point, -point]), force * np.stack([inward, -inward])).max())


def test_the_pieces_cover_the_shell_once() -> None:
    shell = ellipsoid_shell(AXES, 30, 0.35e-3)
    # Surface of a prolate spheroid in closed form.
    a, b = AXES[0], AXES[1]
    e = np.sqrt(1 - (b / a) ** 2)
    surface = 2 * np.pi * b**2 * (1 + a / (b * e) * np.arcsin(e))
    assert shell.areas.sum() == pytest.approx(surface, rel=0.012)
    assert len(shell.centres) == 30
    assert shell.areas.std() < 0.15 * shell.areas.mean()


def test_every_piece_is_joined_to_its_neighbours() -> None:
    shell = ellipsoid_shell(AXES, 30, 0.35e-3)
    degree = np.bincount(shell.bonds.ravel(), minlength=30)
    assert degree.min() >= 4
    # A closed triangulated surface has at most 3 n - 6 edges.
    assert len(shell.bonds) <= 3 * 30 - 6
    assert len(egg_graph().fragments()) == 1


def test_a_push_through_the_centre_loads_like_its_mirror_image() -> None:
    graph = egg_graph()
    force = np.array([[0.0, 0.0, 10.0]])
    point = np.array([[0.0, 0.0, -0.022]])
    assert graph.loads(point, force).max() > 0
    doubled = graph.loads(point, 2 * force)
    assert np.allclose(doubled, 2 * graph.loads(point, force), rtol=1e-9)


def test_a_force_on_every_piece_like_gravity_loads_no_bond() -> None:
    graph = egg_graph()
    wrench = np.zeros((len(graph.nodes), 6))
    wrench[:, 2] = -9.81 * graph.masses
    loaded = graph.response @ wrench.ravel()
    pushed = graph.response @ graph.wrenches_per_force(graph.centres[:1])[0] @ np.array([0.0, 0.0, 0.579])
    # Free fall strains nothing: what is left is rounding, a millionth of what the same force on one piece does.
    assert np.abs(loaded).max() < 1e-6 * np.abs(pushed).max()


def test_between_plates_the_shell_breaks_at_its_force_in_every_orientation() -> None:
    graph = egg_graph(45.0)
    points = ellipsoid_points(np.asarray(AXES), 211)  # other points than the calibration's
    normals = ellipsoid_normals(points, np.asarray(AXES))
    forces = np.array([45.0 / pinch(graph, p, -n, 45.0) for p, n in zip(points, normals, strict=True)])
    assert forces.mean() == pytest.approx(45.0, rel=0.02)
    # What presses on the other side changes it a little; eggs differ by 15 %.
    assert forces.std() < 0.04 * 45.0


def test_what_presses_alone_breaks_the_shell_at_one_force_wherever_it_presses() -> None:
    graph = egg_graph(45.0)
    points = ellipsoid_points(np.asarray(AXES), 97)
    normals = ellipsoid_normals(points, np.asarray(AXES))
    loads = [graph.loads(p[None], -45.0 * n[None]).max() for p, n in zip(points, normals, strict=True)]
    assert np.ptp(loads) < 1e-9
    # Between plates the weaker of two sides breaks.
    assert loads[0] == pytest.approx(0.97, abs=0.03)


def test_bonds_next_to_a_crack_weaken_once() -> None:
    graph = egg_graph()
    broken = np.zeros(len(graph.bonds), dtype=bool)
    broken[0] = True
    once = graph.after_breaking(broken, 0.5)
    kept = graph.strengths[1:]
    ratio = once.strengths / kept
    assert set(np.round(ratio, 12)) == {0.5, 1.0}
    second = int(np.flatnonzero(ratio == 0.5)[0])
    again = np.zeros(len(once.bonds), dtype=bool)
    again[second] = True
    twice = once.after_breaking(again, 0.5)
    assert set(np.round(twice.strengths / np.delete(kept, second), 12)) == {0.5, 1.0}


def test_a_graph_cut_in_two_has_two_parts() -> None:
    graph = egg_graph()
    side = graph.centres[:, 0] > 0
    crossing = side[graph.bonds[:, 0]] != side[graph.bonds[:, 1]]
    parts = graph.without(crossing).fragments()
    assert sorted(len(part.nodes) for part in parts) == sorted([int(side.sum()), int((~side).sum())])
    assert sorted(int(k) for part in parts for k in part.nodes) == list(range(30))


def test_a_shell_that_cannot_bear_its_force_is_refused() -> None:
    with pytest.raises(KnowledgeError, match="cannot bear 100000 N between plates"):
        egg_graph(1e5)


def test_a_membrane_holds_a_cracked_bond_until_it_is_pulled_too_hard() -> None:
    graph = replace(egg_graph(), membrane_strength=100.0, membrane_stretch=2e-3)
    side = graph.centres[:, 0] > 0
    ring = side[graph.bonds[:, 0]] != side[graph.bonds[:, 1]]
    cracked = graph.after_breaking(ring, 1.0)
    assert len(cracked.fragments()) == 1
    ends = np.array([[0.0285, 0.0, 0.0], [-0.0285, 0.0, 0.0]])
    away = np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    # A pull along the axis is shared by the cracks round the middle, each with its width.
    borne = 100.0 * graph.widths[ring].sum()
    for pull, gives_way in ((0.3 * borne, False), (1.5 * borne, True)):
        opened = cracked.settled(ends, pull * away)
        load = float(opened.loads(ends, pull * away)[opened.cracked].max())
        assert load == pytest.approx(pull / borne, rel=0.15)
        assert (load >= 1) is gives_way
    # Pressed together, closed cracks bear.
    pressed = cracked.settled(ends, -10.0 * away)
    assert pressed.loads(ends, -10.0 * away)[pressed.cracked].max() < 1
    assert len(graph.after_breaking(ring, 1.0).after_breaking(ring, 1.0).fragments()) == 2


def test_no_force_below_the_screen_can_break_a_bond_and_one_not_far_above_can() -> None:
    graph = egg_graph()
    egg = Fragment(body="egg1", graph=graph, origin=np.zeros(3), calm=0.0)
    egg.set([graph])
    random = np.random.default_rng(1)
    where, pull = (each / np.linalg.norm(each, axis=1, keepdims=True) for each in random.normal(size=(2, 300, 3)))
    loads = [
        float(graph.loads(point[None], egg.calm * force[None]).max())
        for point, force in zip(where * AXES, pull, strict=True)
    ]
    assert 0.5 < max(loads) < 1.0
