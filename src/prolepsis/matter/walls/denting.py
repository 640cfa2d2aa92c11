"""Denting: a panel of a wall springs back from where it was, until its moment is too great; then it gives way for good.

Elastic and perfectly plastic: beyond its greatest moment, the place to which a panel springs back goes along.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from prolepsis.scene.kind import Controller
from prolepsis.scene.parts import Panel
from prolepsis.scene.running import Running


class Denting(Controller):
    """The controller of one vessel's wall."""

    def __init__(self, name: str, panels: Sequence[Panel]) -> None:
        """Look after the ``panels`` of the vessel called ``name``."""
        self._vessel = name
        self._names = [panel.name for panel in panels]
        self._lever = np.array([panel.lever for panel in panels])
        self._most = np.array([panel.moment / panel.stiffness for panel in panels])
        self.rest = np.zeros(len(panels))
        """Angle to which each panel springs back, outwards [rad]."""

    def bind(self, state: Running) -> None:
        """Look up what it needs in a model that is new."""
        self._places = np.array([int(state.model.joint(name).qposadr[0]) for name in self._names])

    def act(self, state: Running) -> None:
        """Let the panels that bear too great a moment give way."""
        angle = state.data.qpos[self._places]
        rest = np.clip(self.rest, angle - self._most, angle + self._most)
        for k in np.flatnonzero(rest != self.rest):
            # The spec too, for a model that is rebuilt because something breaks is made from that.
            state.spec.joint(self._names[k]).springref = float(rest[k])
        self.rest = rest
        state.model.qpos_spring[self._places] = rest

    def end_tick(self, state: Running) -> None:
        """Tell how deep the greatest dent is."""
        state.set_attribute(self._vessel, "dent", float(np.abs(self.rest * self._lever).max()))
