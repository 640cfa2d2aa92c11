"""Wetting: what touches a liquid that has come free becomes wet and dirty, and as slippery as it is when wet."""

from __future__ import annotations

import numpy as np

from prolepsis.phenomena.phenomenon import Draw, Phenomenon
from prolepsis.scene.world import friction_of
from prolepsis.state import State


class Wetting(Phenomenon):
    """The controller of all surfaces in a scene."""

    def __init__(self, state: State) -> None:
        """Attach to a simulation."""
        self._things = state.world.scene.things
        self._names = {thing.name: i for i, thing in enumerate(self._things)}
        liquids = {thing.name for thing in self._things if "Liquid" in thing.roles}
        self._liquid = np.array([thing.whole in liquids and "Blob" in thing.roles for thing in self._things])
        self._wet = np.array(["Blob" in thing.roles for thing in self._things])

    def tick(self, state: State) -> None:
        """Wet what touches a blob of a liquid."""
        if not state.version or not state.data.ncon:
            return  # nothing has broken, so nothing has come free
        contact = state.data.contact
        pairs = state.body_thing[state.model.geom_bodyid[contact.geom[contact.efc_address >= 0]]]
        pairs = pairs[(pairs >= 0).all(axis=1)]
        touching = self._liquid[pairs] & ~self._wet[pairs[:, ::-1]]
        for index in set(pairs[:, ::-1][touching].tolist()):
            self._wetten(state, index)

    def _wetten(self, state: State, index: int) -> None:
        thing = self._things[index]
        self._wet[index] = True
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


def attach(state: State, draw: Draw) -> list[Wetting]:
    """Return the one controller of a scene in which there is a liquid."""
    del draw
    return [Wetting(state)] if any("Liquid" in thing.roles for thing in state.world.scene.things) else []
