"""Walls that yield: bowls of paper and clay, whose wall is panels that give way for good when pushed too hard."""

from __future__ import annotations

from collections.abc import Sequence
from types import MappingProxyType

import numpy as np

from prolepsis.log.things import Thing
from prolepsis.matter.walls.panels import NEEDED
from prolepsis.matter.walls.yielding_bowl import bowl_parts, hinge_panels
from prolepsis.scene.kind import Building, Channel, Controller, Individuals, Kind, Made
from prolepsis.scene.parts import Panel
from prolepsis.scene.running import Running


class Denting(Controller):
    """The controller of one vessel's wall: a panel springs back from where it was, until its moment is too great.

    Elastic and perfectly plastic: beyond its greatest moment, the angle to which a panel springs back goes along.
    """

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
        self._addresses = np.array([int(state.model.joint(name).qposadr[0]) for name in self._names])

    def act(self, state: Running) -> None:
        """Let the panels that bear too great a moment give way."""
        angle = state.data.qpos[self._addresses]
        rest = np.clip(self.rest, angle - self._most, angle + self._most)
        for k in np.flatnonzero(rest != self.rest):
            # The spec too, for a model that is rebuilt because something breaks is made from that.
            state.spec.joint(self._names[k]).springref = float(rest[k])
        self.rest = rest
        state.model.qpos_spring[self._addresses] = rest

    def end_tick(self, state: Running) -> None:
        """Tell how deep the greatest dent is."""
        state.set_attribute(self._vessel, "dent", float(np.abs(self.rest * self._lever).max()))


class YieldingWalls(Kind):
    """The kind of vessels whose wall gives way."""

    order = 30
    claims = "YieldingBowl"
    roles = frozenset({"YieldingBowl", *NEEDED})
    quantities = MappingProxyType(
        dict.fromkeys(("panelCount", "bucklingForce", "bucklingDisplacement", "yieldStress"), "YieldingBowl")
    )
    channels = (
        Channel(
            name="dent",
            doc="how far its rim stays out of place where it has given way most [m]",
            role="YieldingBowl",
            default=True,
        ),
    )

    def parts(self, individuals: Individuals, whole: Thing) -> Made:
        """Return it with its parts."""
        return bowl_parts(whole)

    def edit(self, building: Building) -> None:
        """Give the bodies of its things what rigid bodies alone have not."""
        scene = building.scene
        for name in dict.fromkeys(panel.whole for panel in scene.each(Panel)):
            panels = tuple(panel for panel in scene.each(Panel) if panel.whole == name)
            hinge_panels(building, scene.thing(name), panels)

    def start(self, state: Running) -> Sequence[Controller]:
        """Return its controllers in one run."""
        panels = state.scene.each(Panel)
        wholes = dict.fromkeys(panel.whole for panel in panels)
        return [Denting(name, [panel for panel in panels if panel.whole == name]) for name in wholes]


KIND = YieldingWalls()
