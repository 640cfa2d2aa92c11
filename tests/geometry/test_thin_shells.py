"""Distances to what is left of a thin shell, against places sampled all over it."""

from __future__ import annotations

import numpy as np
import pytest

from prolepsis.geometry.distances import nearest_faces
from prolepsis.geometry.shape import BoolArray, FloatArray, triple
from prolepsis.geometry.signed_distance import pieces_of
from prolepsis.geometry.thin_shells import ThinShell
from prolepsis.matter.shells.cutting import ellipsoid_points, ellipsoid_shell

MIDDLE, THICKNESS = np.array([0.0285, 0.022, 0.022]), 3.5e-4
"""Semi-axes of the middle of an eggshell, and how thick it is [m]."""
CENTRES = ellipsoid_shell(triple(MIDDLE), 30, THICKNESS).centres


def left(which: str) -> tuple[BoolArray, FloatArray]:
    """Return which pieces are there, and places all over them."""
    number = np.arange(30)
    chosen = {"one": number == 4, "half": CENTRES[:, 2] < 0, "but one": number != 4, "all": number >= 0}
    there = chosen[which]
    places = ellipsoid_points(MIDDLE, 20000)
    return there, places[there[((places[:, None] - CENTRES) ** 2).sum(axis=2).argmin(axis=1)]]


@pytest.mark.parametrize("which", ["one", "half", "but one", "all"])
def test_distances_are_those_to_the_nearest_place_of_what_is_there(which: str) -> None:
    there, places = left(which)
    shell = ThinShell(semi_axes=triple(MIDDLE), thickness=THICKNESS, centres=tuple(map(triple, CENTRES)))
    points = np.random.default_rng(0).uniform(-0.032, 0.032, (400, 3))
    apart = np.linalg.norm(points[:, None] - places, axis=2)
    expected = apart.min(axis=1) - THICKNESS / 2
    near = expected < 0.008
    found = nearest_faces(pieces_of(shell, there, np.zeros(3)), points[near], 0.02)
    # Places are 0.6 mm apart; edges are taken to be planes across, which they are not quite where the shell is far off.
    assert found[:, 0] == pytest.approx(expected[near], abs=0.0012)
    towards = points[near] - places[apart[near].argmin(axis=1)]
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    clear = expected[near] > 0.002
    along = (found[clear, 1:] * towards[clear]).sum(axis=1)
    assert along.mean() > 0.97 and along.min() > 0.7


def test_a_piece_that_is_far_is_endlessly_far() -> None:
    there, _ = left("one")
    shell = ThinShell(semi_axes=triple(MIDDLE), thickness=THICKNESS, centres=tuple(map(triple, CENTRES)))
    assert np.isinf(nearest_faces(pieces_of(shell, there, np.zeros(3)), -CENTRES[4:5], 0.005)[:, 0]).all()
