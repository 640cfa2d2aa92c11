"""The particles of a log at any tick: where the free ones are, and how wet what holds the others is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.log import FREE, Log
from prolepsis.log.things import falling_apart
from prolepsis.report.liquid import Look, look_of

FAR = 0.6
"""Particles farther than this from the middle of their liquid do not draw the camera [m]."""


class Wet(NamedTuple):
    """What is to be painted."""

    positions: FloatArray
    """Centres of the free particles in the world [m], shape (n, 3)."""
    kinds: IntArray
    """Index of each particle's look, shape (n,)."""
    looks: list[Look]
    spacing: float
    """Distance of neighbours in the liquid [m]."""


class Droplets:
    """The particles of one log."""

    def __init__(self, log: Log) -> None:
        """Take the particles of ``log``."""
        self._log = log
        self._particles = log.particles
        self._falling_apart = falling_apart(log.things)
        stuffs, self._kinds = np.unique(self._particles.stuff, return_inverse=True)
        self._looks = [look_of(log.things[int(stuff)]) for stuff in stuffs]
        self.present = len(self._particles.tick) > 0 and len(self._particles.stuff) > 0
        """Whether the scene has any liquid."""

    def at(self, tick: int) -> Wet | None:
        """Return the free particles at ``tick``, between two frames on the straight line, or None if there are none."""
        if not self.present:
            return None
        positions, free = self._positions(tick)
        if not free.any():
            return None
        return Wet(positions[free], self._kinds[free], self._looks, self._particles.spacing)

    def _positions(self, tick: int) -> tuple[FloatArray, BoolArray]:
        frames, particles = self._particles.tick, self._particles
        before = max(int(np.searchsorted(frames, tick, side="right")) - 1, 0)
        after = min(before + 1, len(frames) - 1)
        width = int(frames[after] - frames[before])
        share = min((tick - int(frames[before])) / width, 1.0) if width else 0.0
        first, second = (particles.position[k].astype(np.float64) for k in (before, after))
        # Who is taken up or released between two frames is shown as in the first.
        stays = (particles.holder[before] == FREE) & (particles.holder[after] == FREE)
        positions = first + (share * stays)[:, None] * (second - first)
        return positions, particles.holder[before] == FREE

    def held_share(self, tick: int) -> FloatArray:
        """Return the liquid's share of the mass of each thing that is soaked with some, shape (n,) [1]."""
        things = self._log.things
        share = np.zeros(len(things))
        if not self.present:
            return share
        frame = max(int(np.searchsorted(self._particles.tick, tick, side="right")) - 1, 0)
        holder = self._particles.holder[frame]
        for i in np.unique(holder[holder >= 0]):
            if things[int(i)].name not in self._falling_apart:
                held = float(self._particles.mass[holder == i].sum())
                share[i] = held / (held + things[int(i)].mass)
        return share

    def at_large(self, ticks: list[int]) -> list[FloatArray]:
        """Return where free particles are at ``ticks``, each (m, 3) [m]: what the camera should have in its frame."""
        if not self.present:
            return []
        shown: list[FloatArray] = []
        for tick in ticks:
            positions, free = self._positions(tick)
            if free.any():
                near = np.linalg.norm(positions[free] - np.median(positions[free], axis=0), axis=1) < FAR
                shown.append(positions[free][near])
        return shown
