"""Walls that yield: bowls of paper and clay, whose wall is panels that give way for good when pushed too hard."""

from __future__ import annotations

from collections.abc import Sequence
from types import MappingProxyType

from prolepsis.log.things import Thing
from prolepsis.matter.walls.yielding_bowl import bowl_parts, hinge_panels
from prolepsis.scene.kind import Building, Channel, Controller, Individuals, Kind, Made
from prolepsis.scene.parts import Panel
from prolepsis.scene.running import Running


class YieldingWalls(Kind):
    """The kind of vessels whose wall gives way."""

    order = 30
    claims = "YieldingBowl"
    roles = frozenset({"YieldingBowl"})
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
        from prolepsis.matter.walls.denting import Denting

        panels = state.scene.each(Panel)
        wholes = dict.fromkeys(panel.whole for panel in panels)
        return [Denting(name, [panel for panel in panels if panel.whole == name]) for name in wholes]


KIND = YieldingWalls()
