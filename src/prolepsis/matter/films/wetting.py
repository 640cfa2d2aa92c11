"""Wetting: what touches a liquid that has come free becomes wet and dirty, and as slippery as it is when wet.

A film stays where the liquid was, also once that has run off, until something absorbent passes over it. What is told
to be wet or dirty from the start is so nowhere in particular, and stays so.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.happenings import DROP, FILM_LEFT, film, film_area
from prolepsis.log.things import friction_of
from prolepsis.matter.films.covering import NOWHERE, Film
from prolepsis.scene.kind import Controller
from prolepsis.scene.nearby import distance_to, solids_of, touching, unobstructed
from prolepsis.scene.running import Running

LOOK_TICKS = 50
"""Surfaces are looked at every so many ticks, and in the first one."""
SELDOM = 4
"""Of surfaces that nothing can dry, so many looks are left out but for one: their films only grow."""
TOUCH_REACH = 0.75
"""Distance of a particle's centre from a surface that it wets [spacings]; at rest on it, it is a half."""


class Wetting(Controller):
    """The controller of all surfaces in a scene."""

    def __init__(self, state: Running) -> None:
        """Attach to a simulation."""
        self._things = state.scene.things
        self._names = {thing.name: i for i, thing in enumerate(self._things)}
        self._absorbent = [i for i, t in enumerate(self._things) if "Absorbent" in t.roles and t.is_body]
        self._wet: dict[int, Film] = {}
        """Where the film of each thing is."""
        self._most: dict[int, float] = {}
        """The greatest area of each [m^2] ..."""
        self._told: dict[int, float] = {}
        """... and the one that the log was told of."""
        self._ticks = 0

    def end_tick(self, state: Running) -> None:
        """Wet what touches a liquid, and dry what has been wiped."""
        self._ticks += 1
        particles = state.particles
        if particles is None or (self._ticks % LOOK_TICKS and self._ticks > 1):
            return
        free = np.flatnonzero(particles.free)
        if not len(free) and not (self._wet and self._absorbent):
            return
        for index in self._absorbent:
            held = particles.stuff[particles.holder == index]
            if len(held) and index not in self._wet:
                self._wetten(state, index, int(held[0]), NOWHERE)
        positions = particles.position[free]
        for index in solids_of(state):
            keeps = not self._absorbent or index in self._absorbent
            if index in self._wet and keeps and self._ticks % (SELDOM * LOOK_TICKS):
                continue
            near = touching(state, index, positions, TOUCH_REACH * particles.spacing)
            # What something rides on lies within that.
            near = near[unobstructed(state, index, positions[near]) | (particles.rider[free[near]] >= 0)]
            if index in self._wet:
                self._wipe(state, index, particles.spacing, positions[near], keeps)
            elif len(near) and float(particles.volume[free[near]].sum()) >= DROP:
                begun = self._grown(state, index, particles.spacing, NOWHERE, positions[near])
                self._wetten(state, index, int(particles.stuff[free[near[0]]]), begun)
            if index in self._wet and self._wet[index].area != self._told.get(index, 0.0):
                self._told[index] = self._wet[index].area
                state.report(film_area(index, self._told[index]))

    def _wipe(self, state: Running, index: int, spacing: float, positions: FloatArray, keeps: bool) -> None:
        """Let the film grow to where liquid is, and take it away where something absorbent is now and no liquid."""
        known = self._wet[index]
        pose = state.pose(self._things[index].name)
        world = pose[:3] + known.positions @ matrix(pose[3:]).T
        left = np.ones(len(known.cells), dtype=np.bool_)
        for absorbent in () if keeps else self._absorbent:
            # Where in its cell the liquid was besides is not known.
            left &= distance_to(state, absorbent, world) > (TOUCH_REACH + 0.5) * spacing
        self._wet[index] = self._grown(state, index, spacing, known if left.all() else known.only(left), positions)
        self._most[index] = max(self._most[index], self._wet[index].area)
        if not keeps and not len(positions) and self._wet[index].area <= FILM_LEFT * self._most[index]:
            self._dry(state, index)

    def _grown(self, state: Running, index: int, spacing: float, film: Film, positions: FloatArray) -> Film:
        if not len(positions):
            return film
        pose = state.pose(self._things[index].name)
        return film.grown(self._things[index].shape, spacing, (positions - pose[:3]) @ matrix(pose[3:]))

    def _wetten(self, state: Running, index: int, stuff: int, begun: Film) -> None:
        surface = self._things[index]
        self._wet[index], self._most[index] = begun, begun.area
        for name in (surface.name, *self._wholes(index)):
            state.set_attribute(name, "wet", 1.0)
            state.set_attribute(name, "dirty", 1.0)
        state.report(film(index, stuff, wet=True))
        slippery = surface.quantities.get("frictionWhenWet", friction_of(surface))
        if slippery < friction_of(surface):
            state.set_friction(index, slippery)

    def _dry(self, state: Running, index: int) -> None:
        del self._wet[index], self._most[index]
        self._told.pop(index, None)
        surface = self._things[index]
        state.report(film(index, index, wet=False))
        if not surface.quantities.get("wet"):
            state.set_friction(index, friction_of(surface))
        for attribute in ("wet", "dirty"):
            told = {name for name, i in self._names.items() if self._things[i].quantities.get(attribute)}
            still = told.union(*({self._things[i].name, *self._wholes(i)} for i in self._wet))
            for name in {surface.name, *self._wholes(index)} - still:
                state.set_attribute(name, attribute, 0.0)

    def _wholes(self, index: int) -> Iterator[str]:
        """Yield the names of all that a thing is a part of."""
        thing = self._things[index]
        while thing.whole is not None:
            yield thing.whole
            thing = self._things[self._names[thing.whole]]
