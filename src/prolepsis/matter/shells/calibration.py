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

from prolepsis.geometry.shape import FloatArray
from prolepsis.matter.shells.bond_graph import BondGraph
from prolepsis.matter.shells.cutting import ellipsoid_normals, ellipsoid_points, ellipsoid_shell
from prolepsis.terms.errors import KnowledgeError

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
    *,
    thickness: float,
    youngs_modulus: float,
    poisson_ratio: float,
    fracture_strain: float,
    mass: float,
    breaking_force: float,
    membrane_strength: float = 0.0,
    membrane_stretch: float = 1.0,
) -> BondGraph:
    """Return the bond graph of an ellipsoidal shell that breaks between plates at a given force.

    Args:
        semi_axes: Half lengths [m].
        piece_count: Number of pieces.
        thickness: Shell thickness [m].
        youngs_modulus: Young's modulus [Pa].
        poisson_ratio: Poisson's ratio [1].
        fracture_strain: Tensile strain at which the material breaks [1].
        mass: Mass of the shell with its contents [kg].
        breaking_force: Mean over all orientations of the force between plates at which it breaks [N].
        membrane_strength: Pull that the membrane inside bears for each length of a crack [N/m]; 0 without one.
        membrane_stretch: How far that stretches until it tears [m].
    """
    shell = ellipsoid_shell(semi_axes, piece_count, thickness)
    graph = BondGraph(
        nodes=np.arange(len(shell.centres)),
        centres=shell.centres,
        normals=shell.normals,
        masses=mass * shell.areas / shell.areas.sum(),
        bonds=shell.bonds,
        widths=shell.widths,
        strengths=np.ones(len(shell.bonds)),
        bending_strength=youngs_modulus * fracture_strain,
        weakened=np.zeros(len(shell.bonds), dtype=bool),
        membrane_strength=membrane_strength,
        membrane_stretch=membrane_stretch,
        cracked=np.zeros(len(shell.bonds), dtype=bool),
        opened=np.zeros(len(shell.bonds), dtype=bool),
        thickness=thickness,
        youngs_modulus=youngs_modulus,
        poisson_ratio=poisson_ratio,
        semi_axes=semi_axes,
        spread=PATCH * float(np.sqrt(shell.areas.mean())),
    ).assembled()
    membrane, bending = pinch_stresses(graph, np.asarray(semi_axes), breaking_force)
    rest = 1 - bending / graph.bending_strength
    if rest.min() <= 0:
        raise KnowledgeError(
            f"a shell of {thickness * 1000:g} mm whose material breaks at {graph.bending_strength / 1e6:.0f} MPa "
            f"cannot bear {breaking_force:g} N between plates"
        )
    # Membrane stress over what bending leaves of the strength: a bond gives way when this reaches its strength.
    demand = membrane / rest
    strengths = demand.max(axis=0)
    for _ in range(ROUNDS):
        ratio = demand / strengths
        weakest, greatest = ratio.argmax(axis=1), ratio.max(axis=1)
        count = np.bincount(weakest, minlength=len(strengths))
        total = np.bincount(weakest, weights=greatest, minlength=len(strengths))
        strengths = strengths * np.where(count > 0, total / np.maximum(count, 1), 1.0) ** 0.3
    for _ in range(ROUNDS):
        loads = (membrane / strengths + bending / graph.bending_strength).max(axis=1)
        strengths = strengths * loads.mean()
    even = replace(graph, strengths=strengths, evened=1.0)
    return replace(even, evened=1.0 / (breaking_force * np.mean(pinch_loads(even, np.asarray(semi_axes)))))


def pinch_loads(graph: BondGraph, semi_axes: FloatArray) -> FloatArray:
    """Return the greatest load of a bond by each newton that presses on opposite points [1/N], (PINCH_COUNT,)."""
    points = ellipsoid_points(semi_axes, PINCH_COUNT)
    inward = -ellipsoid_normals(points, semi_axes)
    pairs = zip(points, inward, strict=True)
    return np.array([graph.loads(np.stack([p, -p]), np.stack([n, -n])).max() for p, n in pairs])


def pinch_stresses(graph: BondGraph, semi_axes: FloatArray, force: float) -> tuple[FloatArray, FloatArray]:
    """Return membrane and bending stresses when a force presses on opposite points [Pa], each (PINCH_COUNT, m)."""
    points = ellipsoid_points(semi_axes, PINCH_COUNT)
    inward = -force * ellipsoid_normals(points, semi_axes)
    here, there = graph.wrenches_per_force(points), graph.wrenches_per_force(-points)
    wrenches = np.einsum("cij,cj->ci", here - there, inward)
    return graph.stresses((wrenches @ graph.response.T).reshape(PINCH_COUNT, -1, 6))
