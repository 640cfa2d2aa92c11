"""Absorbing: a sponge takes up the liquid that it touches, carries it, drips, and gives it off under pressure.

What it holds are particles that do not flow but move with it. It takes up no more than it has room for; pressed, or
hanging freely, it has less room, and what it cannot keep comes out again at its surface.
"""

from __future__ import annotations

import math

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.log import FREE
from prolepsis.log.things import Thing
from prolepsis.matter.sponges.carried_mass import CarriedMass
from prolepsis.matter.sponges.riding import NONE, Riding
from prolepsis.matter.sponges.sponge_law import SpongeLaw
from prolepsis.matter.sponges.sponge_surface import SpongeSurface, nearest_of
from prolepsis.scene.kind import Controller
from prolepsis.scene.nearby import distance_to, solids_of, unobstructed
from prolepsis.scene.particles import ParticleState
from prolepsis.scene.running import MAX_STEP, Running

LOOK_TICKS = 5
"""The sponge is looked at every so many ticks; at 0.2 m/s it moves by a millimetre in that time."""
TOUCH_REACH = 0.75
"""Distance of a particle's centre from the surface up to which it touches it [spacings]; at rest it is a half."""
PRESSURE_TIME = 0.05
"""Time over which the pressure is averaged, since contacts flicker [s]."""
ROOM = 0.9
"""A place is free if no particle is nearer than this [spacings], ..."""
WALL_ROOM = 0.5
"""... and no other wall nearer than this [spacings]."""
DRIP_ROOM = 1.5
"""Where nothing else is nearer than this, a drop can fall [spacings]."""


class Absorbing(Controller):
    """The controller of one sponge, after the liquid has moved."""

    def __init__(self, state: Running, thing: Thing) -> None:
        """Attach to a thing with a shape and the quantities of a sponge."""
        assert state.particles is not None
        particles = state.particles
        self.thing = thing
        self.index = state.scene.index(thing.name)
        self.surface = SpongeSurface(thing.shape, particles.spacing)
        size = self.surface.high - self.surface.low
        self.law = SpongeLaw.of(thing.quantities, thing.mass, float(size.min()))
        self.pressure = 0.0
        """Pressure of the solids that touch it, as far as the foam has not yet sprung back [Pa]."""
        self._outer = 0.0
        self._faces = size.prod() / size
        count = len(particles.mass)
        # Liquids that it holds come out mixed.
        self._random = state.generator(thing.name)
        self._order = self._random.permutation(count)
        self._homes = self.surface.inside(count)[self._order]
        held = self.held(particles)
        particles.home[held] = self._homes[held]
        self._body = CarriedMass(thing.name, thing.mass)
        self._riding = Riding(state.scene.things, self.index, self.surface)
        self._due = 0.0
        self._wanted = 0.0
        self._ticks = 0

    def held(self, particles: ParticleState) -> IntArray:
        """Return the particles that it holds, shape (n,)."""
        return np.flatnonzero(particles.holder == self.index)

    def bind(self, state: Running) -> None:
        """Look up what it needs in a model that is new."""
        self._body.bind()
        if state.particles is not None:
            self._set_mass(state, state.particles)

    def end_tick(self, state: Running) -> None:
        """Take liquid up, and give it off."""
        self._ticks += 1
        if self._ticks % LOOK_TICKS or state.particles is None:
            return
        dt = LOOK_TICKS * MAX_STEP
        particles = state.particles
        state.renew_poses(centres=True)
        self._feel(state, dt)
        held = float(particles.mass[self.held(particles)].sum())
        # Empty places count: what hangs at the sponge may go on hanging.
        dripping = max(held - self.law.retained, 0.0)
        pressed = max(held - self.law.capacity_under(self.pressure), 0.0)
        changed = self._give_off(state, particles, dripping, pressed, dt) if dripping or pressed else 0
        changed += self._take(state, particles, self._riding.move(state, particles, dt))
        if not pressed:
            changed += self._take_up(state, particles, held, dt)
        if changed:
            self._set_mass(state, particles)

    def _frame(self, state: Running) -> tuple[FloatArray, FloatArray]:
        body = state.data.body(self.thing.name)
        return body.xpos, body.xmat.reshape(3, 3)

    def _feel(self, state: Running, dt: float) -> None:
        """Bring the pressure up to date: along each axis, half of all that pushes on it over its face there."""
        body = state.model.body(self.thing.name).id
        _, rotation = self._frame(state)
        push = np.zeros(3)
        for contact, first, second, force in state.normal_forces():
            if body in (first, second):
                push += force * np.abs(rotation.T @ state.data.contact.frame[contact, :3])
        pressure = float((push / 2 / self._faces).sum())
        self._outer += (pressure - self._outer) * min(dt / PRESSURE_TIME, 1.0)
        self.pressure = self.law.pressure_after(self.pressure, self._outer, dt)

    def _set_mass(self, state: Running, particles: ParticleState) -> None:
        self._body.set(state, float(particles.mass[self.held(particles)].sum()))

    def _take_up(self, state: Running, particles: ParticleState, held: float, dt: float) -> int:
        """Take up free particles that touch it, and return how many."""
        law, spacing = self.law, particles.spacing
        origin, rotation = self._frame(state)
        free = np.flatnonzero(particles.free & (particles.rider == NONE))
        local = (particles.position[free] - origin) @ rotation
        touching = self.surface.touched_by(local, TOUCH_REACH * spacing)
        free, local = free[touching], local[touching]
        seen = unobstructed(state, self.index, particles.position[free])
        free, local = free[seen], local[seen]
        if len(free) and held >= law.retained:
            # What has dripped from it is not sucked back.
            hanging = self.surface.is_below(local, rotation.T @ self._up(state))
            hanging[hanging] = self._clear(state, particles.position[free[hanging]], DRIP_ROOM * spacing)
            free, local = free[~hanging], local[~hanging]
        if not len(free):
            self._wanted = 0.0
            return 0
        speed = law.front_speed(held, particles.viscosity[free], spacing)
        self._wanted = min(self._wanted + float((speed * dt / spacing).sum()), float(len(free)))
        nearest = np.argsort(self.surface.distance(local), kind="stable")[: int(self._wanted)]
        taken = self._take(state, particles, free[nearest])
        self._wanted -= taken
        return taken

    def _take(self, state: Running, particles: ParticleState, taken: IntArray) -> int:
        """Let particles become a part of it as long as it has room, and return how many."""
        room = self.law.capacity_under(self.pressure) - float(particles.mass[self.held(particles)].sum())
        taken = taken[np.cumsum(particles.mass[taken]) <= room]
        if len(taken):
            self._body.collide(state, particles.position[taken], particles.velocity[taken], particles.mass[taken])
            particles.holder[taken], particles.rider[taken] = self.index, NONE
            particles.home[taken] = self._homes[taken]
        return len(taken)

    def _give_off(self, state: Running, particles: ParticleState, dripping: float, pressed: float, dt: float) -> int:
        """Let particles come out at free places, the lowest first, and return how many."""
        spacing = particles.spacing
        origin, rotation = self._frame(state)
        positions = origin + self.surface.exits @ rotation.T
        up = self._up(state)
        below = self.surface.outward @ (rotation.T @ up) < -0.5
        drops = below.copy()
        drops[drops] = self._clear(state, positions[drops], DRIP_ROOM * spacing)
        rate = pressed / self.law.pressing_time + (dripping / self.law.dripping_time if drops.any() else 0.0)
        held = self.held(particles)
        each = float(particles.mass[held].mean())
        self._due = min(self._due + rate * dt / each, float(len(held)), max(pressed, dripping) / each)
        wanted = int(self._due)
        if not wanted:
            return 0
        open = drops if not pressed else np.ones(len(positions), dtype=np.bool_)
        open[open] = self._is_free(state, particles, positions[open])
        height = np.round(positions[open] @ up / spacing)
        chosen = np.flatnonzero(open)[np.lexsort((self._shuffled(open), height))][:wanted]
        given = held[np.argsort(self._order[held])][: len(chosen)]
        particles.holder[given] = FREE
        particles.position[given] = positions[chosen]
        particles.velocity[given] = state.velocity_at(self.thing.name, positions[chosen])
        self._due -= len(given)
        return len(given)

    def _shuffled(self, open: BoolArray) -> IntArray:
        """Return in which order equally low places come, a different one each time."""
        return self._random.permutation(len(open))[open]

    def _is_free(self, state: Running, particles: ParticleState, positions: FloatArray) -> BoolArray:
        """Return at which positions neither a wall nor another particle is in the way."""
        free = self._clear(state, positions, WALL_ROOM * particles.spacing)
        flowing = particles.position[particles.free]
        if len(flowing) and free.any():
            distance, _ = nearest_of(flowing, positions[free])
            free[free] = distance > ROOM * particles.spacing
        return free

    def _clear(self, state: Running, positions: FloatArray, room: float) -> BoolArray:
        """Return which world points are farther than ``room`` [m] from all other bodies."""
        found = np.ones(len(positions), dtype=np.bool_)
        for i in solids_of(state):
            if i != self.index and found.any():
                found[found] = distance_to(state, i, positions[found]) > room
        return found

    def _up(self, state: Running) -> FloatArray:
        gravity = np.asarray(state.scene.gravity)
        return -gravity / max(float(np.linalg.norm(gravity)), math.ulp(1.0))
