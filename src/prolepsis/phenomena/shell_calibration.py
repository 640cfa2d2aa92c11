"""Bond strengths of a shell from one experiment: the force at which it breaks between two plates.

Thirty pieces do not resolve the millimetres around a contact where the real stress peaks, so a bond's
strength is an effective one. It is set such that a pinch between opposite points breaks the shell at the
same force wherever it acts, which is what the experiment shows of eggs. Nothing else is fitted: what a
drop or a grip does is a prediction.

Source: orientation independence, Commun. Phys. 2025 (s42005-025-02087-0).
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from prolepsis.phenomena.bond_graph import BondGraph
from prolepsis.shapes.egg import Shell, ellipsoid_normals, ellipsoid_points, ellipsoid_shell
from prolepsis.things import FloatArray

PINCH_COUNT = 300
"""Pinch positions over the shell: some ten for each piece."""
ROUNDS = 60
"""Rounds of equalisation; the spread of the breaking force over the positions no longer falls after these."""
PATCH = 0.6
"""Contact forces are shared over this part of the spacing of the pieces, where the spread is least."""


@lru_cache(maxsize=8)
def calibrated_graph(
    semi_axes: tuple[float, float, float],
    piece_count: int,
    thickness: float,
    youngs_modulus: float,
    poisson_ratio: float,
    mass: float,
) -> BondGraph:
    """Return the bond graph of an ellipsoidal shell that breaks between plates at 1 N on average.

    Multiply its strengths by the breaking force [N] to get those of an actual shell.

    Args:
        semi_axes: Half lengths [m].
        piece_count: Number of pieces.
        thickness: Shell thickness [m].
        youngs_modulus: Young's modulus [Pa].
        poisson_ratio: Poisson's ratio [1].
        mass: Mass of the shell with its contents [kg].
    """
    shell = ellipsoid_shell(semi_axes, piece_count, thickness)
    graph = _uncalibrated(shell, thickness, youngs_modulus, poisson_ratio, mass).assembled()
    stresses = pinch_stresses(graph, np.asarray(semi_axes))
    strengths = stresses.max(axis=0)
    for _ in range(ROUNDS):
        ratio = stresses / strengths
        weakest, greatest = ratio.argmax(axis=1), ratio.max(axis=1)
        count = np.bincount(weakest, minlength=len(strengths))
        total = np.bincount(weakest, weights=greatest, minlength=len(strengths))
        strengths = strengths * np.where(count > 0, total / np.maximum(count, 1), 1.0) ** 0.3
    breaking_forces = 1 / (stresses / strengths).max(axis=1)
    return replace(graph, strengths=strengths / breaking_forces.mean())


def pinch_stresses(graph: BondGraph, semi_axes: FloatArray) -> FloatArray:
    """Return bond stresses when 1 N presses on opposite points, shape (PINCH_COUNT, m) [Pa]."""
    points = ellipsoid_points(semi_axes, PINCH_COUNT)
    inward = -ellipsoid_normals(points, semi_axes)
    here, there = graph.wrenches_per_force(points), graph.wrenches_per_force(-points)
    wrenches = np.einsum("cij,cj->ci", here - there, inward)
    return graph.tensile((wrenches @ graph.response.T).reshape(PINCH_COUNT, -1, 6))


def _uncalibrated(
    shell: Shell, thickness: float, youngs_modulus: float, poisson_ratio: float, mass: float
) -> BondGraph:
    return BondGraph(
        nodes=np.arange(len(shell.centres)),
        centres=shell.centres,
        normals=shell.normals,
        masses=mass * shell.areas / shell.areas.sum(),
        bonds=shell.bonds,
        widths=shell.widths,
        strengths=np.ones(len(shell.bonds)),
        weakened=np.zeros(len(shell.bonds), dtype=bool),
        thickness=thickness,
        youngs_modulus=youngs_modulus,
        poisson_ratio=poisson_ratio,
        spread=PATCH * float(np.sqrt(shell.areas.mean())),
    )
