"""Denting: a panel of a wall springs back from where it was, until its moment is too great; then it gives way for good.

Elastic and perfectly plastic: beyond its greatest moment, the place to which a panel springs back goes along.
"""

from __future__ import annotations

import numpy as np

from prolepsis.log.things import Thing
from prolepsis.matter.phenomenon import Detachment, Draw, Phenomenon
from prolepsis.matter.walls.yielding_bowl import PANEL
from prolepsis.scene.running import Running


class Denting(Phenomenon):
    """The controller of one vessel's wall."""

    def __init__(self, state: Running, bowl: Thing, parts: tuple[Thing, ...]) -> None:
        """Attach to a vessel with panels."""
        self._bowl = bowl
        self._names = [part.name for part in parts]
        self._lever, self._moment, self._stiffness = (
            np.array([part.quantities[name] for part in parts]) for name in ("lever", "moment", "stiffness")
        )
        self.rest = np.zeros(len(parts))
        """Angle to which each panel springs back, outwards [rad]."""
        self._version = -1
        self._bind(state)

    def _bind(self, state: Running) -> None:
        if self._version == state.version:
            return
        self._version = state.version
        self._places = np.array([int(state.model.joint(name).qposadr[0]) for name in self._names])

    def act(self, state: Running) -> list[Detachment]:
        """Let the panels that bear too great a moment give way."""
        self._bind(state)
        angle = state.data.qpos[self._places]
        most = self._moment / self._stiffness
        rest = np.clip(self.rest, angle - most, angle + most)
        for k in np.flatnonzero(rest != self.rest):
            # The spec too, for a model that is rebuilt because something breaks is made from that.
            state.spec.joint(self._names[k]).springref = float(rest[k])
        self.rest = rest
        state.model.qpos_spring[self._places] = rest
        return []

    def tick(self, state: Running) -> None:
        """Tell how deep the greatest dent is."""
        state.set_attribute(self._bowl.name, "dent", float(np.abs(self.rest * self._lever).max()))


def attach(state: Running, draw: Draw) -> list[Denting]:
    """Return a controller for each vessel whose wall gives way."""
    del draw
    scene = state.scene
    made: list[Denting] = []
    for thing in scene.things:
        parts = tuple(part for part in scene.parts(thing.name) if PANEL in part.roles)
        if parts:
            made.append(Denting(state, thing, parts))
    return made
