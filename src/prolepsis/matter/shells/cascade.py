"""A cascade: what contact forces overload gives way, the rest is loaded anew at once, until it bears or falls apart."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.matter.shells.bond_graph import BondGraph

TOGETHER = 0.9
"""Bonds within this fraction of the most overloaded one give way with it, which keeps a cascade short."""
RELIEF_STEP = 0.9
"""By this factor at a time the force on what is crushed is lowered [1]."""
HALVINGS = 30
"""In which the forces are found under which a bond gives way: to rounding."""
ALMOST = 1.001
"""What is pressed in by just the force that it bears stays [1]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Pressing:
    """What presses on a fragment; c contacts."""

    numbers: IntArray
    """Their numbers, shape (c,)."""
    points: FloatArray
    """In the shell's frame [m], shape (c, 3)."""
    forces: FloatArray
    """On the fragment, in the same frame, as far as they load it as between plates [N], shape (c, 3)."""
    normal: FloatArray
    """Normal forces [N], shape (c,)."""

    def loads(self, graph: BondGraph, shares: FloatArray) -> FloatArray:
        """Return load over strength of each bond [1], shape (m,), under shares of the forces, shape (c,)."""
        return graph.loads(self.points, shares[:, None] * self.forces)


@dataclass(frozen=True, kw_only=True, slots=True)
class Cracking:
    """How a shell gives way."""

    weakening: float
    """Factor on the strength of bonds next to a broken one [1]."""
    bears: float
    """Force on a piece with nothing but cracks round it at which it comes loose [N]."""
    most_relief: float
    """Share of that to which the force falls before cracks run on [1]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Cascade:
    """What has come of a shell under contact forces."""

    parts: tuple[BondGraph, ...]
    """What is left of it, one graph if it has not fallen apart."""
    load: float
    """Greatest load over strength at the end [1]."""
    worst: float
    """Greatest load over strength at all [1]."""
    changed: bool
    """Whether anything has given way."""
    broken: tuple[tuple[int, int], ...]
    """Pieces, by their numbers in the shell, whose bond was whole before."""
    shares: FloatArray
    """Share of each contact force that is left at the end [1], shape (c,)."""


def cascade(
    graph: BondGraph, pressing: Pressing, cracking: Cracking, shares: FloatArray, ease: Callable[[float], FloatArray]
) -> Cascade:
    """Let the bonds of an assembled graph give way to contact forces.

    Args:
        graph: A connected part of a shell.
        pressing: The contact forces.
        cracking: How it gives way.
        shares: Share of each force that is really exerted [1], shape (c,).
        ease: Returns that once something has given way, for a relief between 1 and the most.
    """
    load, worst = 0.0, 0.0
    broken: list[tuple[int, int]] = []
    parts, changed, relief = (graph,), False, 1.0
    while len(graph.bonds) and len(parts) == 1:
        ratio = pressing.loads(graph, shares)
        load = float(ratio.max())
        worst = max(worst, load)
        gone = ratio >= max(1.0, TOGETHER * load)
        if graph.cracked.any():
            gone |= graph.round_pieces(_pressed_out(graph, pressing, shares, cracking.bears))
        if not gone.any():
            break
        broken += graph.joined(gone & ~graph.cracked)
        changed = True
        graph = graph.after_breaking(gone, cracking.weakening)
        parts = graph.fragments()
        if len(parts) == 1:
            shares = ease(relief)
            graph = graph.settled(pressing.points, shares[:, None] * pressing.forces)
            parts = (graph,)
            # What is crushed gives way before the cracks run on.
            while relief > cracking.most_relief and float(pressing.loads(graph, shares).max()) >= 1:
                relief = max(RELIEF_STEP * relief, cracking.most_relief)
                shares = ease(relief)
    return Cascade(parts=parts, load=load, worst=worst, changed=changed, broken=tuple(broken), shares=shares)


def onset(
    graph: BondGraph,
    pressing: Pressing,
    before: FloatArray,
    now: FloatArray,
    bears: Callable[[FloatArray, float], bool],
) -> tuple[FloatArray, float]:
    """Return the shares of the contact forces under which the first bond gives way [1], shape (c,), and when [1].

    In a substep the forces go from what they were to what they are, and a crack runs as soon as a bond is overloaded.
    How much is overloaded at the end hangs on the substep.

    Args:
        graph: An assembled graph.
        pressing: The contact forces at the end.
        before: Share of them at the beginning [1], shape (c,).
        now: Share of them at the end [1], shape (c,).
        bears: Tells whether all bonds bear the loads, shape (m,), to which they have come in a part of the substep [1].
    """
    if bears(pressing.loads(graph, now), 1.0):
        return now, 1.0
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        borne = bears(pressing.loads(graph, before + middle * (now - before)), middle)
        low, high = (middle, high) if borne else (low, middle)
    return before + high * (now - before), high


def _pressed_out(graph: BondGraph, pressing: Pressing, shares: FloatArray, bears: float) -> IntArray:
    """Return the pieces, as positions in the graph, that are pressed harder than the cracks all round them bear."""
    nearest = np.linalg.norm(graph.centres - pressing.points[:, None], axis=2).argmin(axis=1)
    pressed = np.bincount(nearest, shares * pressing.normal, len(graph.nodes))
    held = np.zeros(len(graph.nodes), dtype=bool)
    held[graph.bonds[~graph.cracked].ravel()] = True
    return np.flatnonzero((pressed > ALMOST * bears) & ~held)
