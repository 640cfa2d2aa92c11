"""Wetting: what touches a liquid that has come free becomes wet and dirty, and as slippery as it is when wet."""

from __future__ import annotations

from prolepsis.scene.world import friction_of
from prolepsis.state import State


class Wetting:
    """The controller of all surfaces in a scene."""

    def __init__(self, state: State) -> None:
        """Attach to a simulation."""
        self._things = state.world.scene.things
        self._names = {thing.name: i for i, thing in enumerate(self._things)}
        self._wet: set[str] = set()

    def tick(self, state: State) -> None:
        """Wet what touches a blob of a liquid."""
        data = state.data
        if not state.version or not data.ncon:
            return  # nothing has broken, so nothing has come free
        for pair, address in zip(data.contact.geom.tolist(), data.contact.efc_address.tolist(), strict=True):
            if address < 0:
                continue
            first, second = (int(state.body_thing[state.model.geom_bodyid[g]]) for g in pair)
            if first < 0 or second < 0:
                continue
            for liquid, solid in ((first, second), (second, first)):
                if self._is_liquid(liquid) and "Blob" not in self._things[solid].roles:
                    self._wetten(state, solid)

    def _is_liquid(self, index: int) -> bool:
        thing = self._things[index]
        return "Blob" in thing.roles and "Liquid" in self._things[self._names[str(thing.whole)]].roles

    def _wetten(self, state: State, index: int) -> None:
        thing = self._things[index]
        if thing.name in self._wet:
            return
        self._wet.add(thing.name)
        names = [thing.name]
        while thing.whole is not None:
            names.append(thing.whole)
            thing = self._things[self._names[thing.whole]]
        for name in names:
            state.set_attribute(name, "wet", 1.0)
            state.set_attribute(name, "dirty", 1.0)
        surface = self._things[index]
        slippery = surface.quantities.get("frictionWhenWet", friction_of(surface))
        if slippery < friction_of(surface):
            state.set_friction(index, slippery)
