"""A rigid part of a shell, intact or broken: its bonds, and when they need no look."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.matter.shells.bond_graph import BondGraph
from prolepsis.matter.shells.cascade import Pressing, onset
from prolepsis.matter.shells.seam import Seam
from prolepsis.matter.shells.slow_cracks import SlowCracks

BETWEEN_SAMPLES = 0.9
"""Margin of the screen for contacts between its sampled points [1]."""
SLIDING = 1.3
"""In that time a contact that slides at 0.3 m/s moves by a sixth of its spread; loads rise by less than this [1]."""
ROUNDING = 1.0e-9
"""What is loaded with just what it bears gives way [1]."""


@dataclass(kw_only=True, slots=True)
class Fragment:
    """A rigid part of a broken or intact shell."""

    body: str
    """Name of the rigid body."""
    graph: BondGraph
    """Its pieces and bonds."""
    origin: FloatArray
    """Place of the body's frame in the shell's frame [m], shape (3,)."""
    calm: float
    """Contact forces may add up to this before a bond can break [N]."""
    load: float = 0.0
    """Greatest bond load over strength at the last full check [1]."""
    total: float = 0.0
    """Sum of the normal forces when it was last looked at [N]."""
    parts: Sequence[BondGraph] = ()
    """What it has just fallen apart into."""
    rows: FloatArray | None = None
    """All contact forces in the scene at the last full check [N], as MuJoCo lists them."""
    slow: SlowCracks = field(default_factory=SlowCracks)
    """What its bonds have borne."""
    seam: Seam | None = None
    """The crack that an edge has made."""
    whole: float = 0.0
    """Greatest load of a bond that has not cracked, when it was last looked at [1]."""

    def set(self, parts: Sequence[BondGraph]) -> None:
        """Go on as what is left: one graph, or several if it has fallen apart."""
        self.slow.renew()
        self.whole = 0.0
        slow = [replace(part, hardening=1.0) for part in parts]
        if len(slow) > 1:
            self.parts = slow
        else:
            self.graph, self.calm = slow[0], calm_force(slow[0])

    def is_steady(self, rows: FloatArray) -> bool:
        """Return whether the contact forces are so near those last checked that no bond can have come to break."""
        if self.rows is None or self.rows.shape != rows.shape:
            return False
        return SLIDING * self.load + float(np.abs(rows - self.rows).sum()) / self.calm < 1

    def stays(self, elapsed: float) -> float:
        """Return the load over what its bonds bear [1] when the loads have stayed the same for a time [s]."""
        if not self.whole:
            return self.load
        self.slow.bear(self.whole, self.whole, elapsed)
        return self.slow.share(self.whole)

    def borne(
        self, pressing: Pressing, before: FloatArray, now: FloatArray, elapsed: float
    ) -> tuple[FloatArray, BondGraph]:
        """Return the shares of contact forces that its bonds have come to bear, and the graph as hard as then.

        Args:
            pressing: The contact forces.
            before: Share of them when last looked at [1], shape (c,).
            now: Share of them now [1], shape (c,).
            elapsed: Time between these [s].
        """
        whole = ~self.graph.cracked
        first = self.whole or _greatest(pressing.loads(self.graph, before)[whole])

        def bears(loads: FloatArray, part: float) -> bool:
            share = self.slow.share_after(first, _greatest(loads[whole]), part * elapsed)
            return max(share, _greatest(loads[~whole])) < 1

        shares, part = onset(self.graph, pressing, before, now, bears)
        self.whole = _greatest(pressing.loads(self.graph, shares)[whole])
        self.slow.bear(first, self.whole, part * elapsed)
        share = self.slow.share(self.whole)
        hardening = (1 - ROUNDING) * self.whole / share if share > 0 else 1.0
        return shares, replace(self.graph, hardening=hardening)


def calm_force(graph: BondGraph) -> float:
    """Return a contact force below which no bond can break, wherever it acts: the screen before the full check [N].

    The stress under several forces is at most the sum of the stresses under each alone, in whatever direction it
    pulls, so the greatest stress under a unit force at sampled points bounds them all.
    """
    if not len(graph.bonds):
        return math.inf
    points = np.concatenate([graph.centres, graph.centres[graph.bonds].mean(axis=1)])
    wrenches = np.moveaxis(graph.wrenches_per_force(points), 0, 1).reshape(6 * len(graph.nodes), -1)
    components = (graph.response @ wrenches).reshape(len(graph.bonds), 6, len(points), 3)
    far = float(graph.ratios(np.linalg.norm(components, axis=3).transpose(2, 0, 1)).max())
    return BETWEEN_SAMPLES / (far + graph.local_peak)


def _greatest(loads: FloatArray) -> float:
    return float(loads.max()) if len(loads) else 0.0
