"""Wetting: what touches a liquid that has come free becomes wet and dirty, and as slippery as it is when wet."""

from __future__ import annotations

from prolepsis.log.things import friction_of
from prolepsis.scene.kind import Controller
from prolepsis.scene.nearby import solids_of, touched
from prolepsis.scene.running import Running

LOOK_TICKS = 50
"""Surfaces are looked at every so many ticks."""
TOUCH_REACH = 0.75
"""Distance of a particle's centre from a surface that it wets [spacings]; at rest on it, it is a half."""


class Wetting(Controller):
    """The controller of all surfaces in a scene."""

    def __init__(self, state: Running) -> None:
        """Attach to a simulation."""
        self._things = state.scene.things
        self._names = {thing.name: i for i, thing in enumerate(self._things)}
        self._wet: set[int] = set()
        self._ticks = 0

    def end_tick(self, state: Running) -> None:
        """Wet what touches a liquid."""
        self._ticks += 1
        particles = state.particles
        if particles is None or self._ticks % LOOK_TICKS or not particles.free.any():
            return
        positions = particles.position[particles.free]
        for index in solids_of(state):
            if index in self._wet:
                continue
            if touched(state, index, positions, TOUCH_REACH * particles.spacing):
                self._wetten(state, index)

    def _wetten(self, state: Running, index: int) -> None:
        thing = self._things[index]
        self._wet.add(index)
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
