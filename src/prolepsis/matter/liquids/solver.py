"""One step of the liquid: neighbours, walls, attraction, viscosity, pressure, motion, and what the walls get back."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field

import numpy as np

from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.matter.liquids.calming import calm
from prolepsis.matter.liquids.gaps import Gaps
from prolepsis.matter.liquids.kernel import SUPPORT, pair_table, wall_tables
from prolepsis.matter.liquids.neighbours import find_neighbours, no_neighbours, row_order
from prolepsis.matter.liquids.particles import greatest_speed, pressure_wave, put
from prolepsis.matter.liquids.pressure import apply_impulses, solve_pressure
from prolepsis.matter.liquids.reaction import add_adhesion, add_drag, add_pressure, pin_edges
from prolepsis.matter.liquids.surface import add_tension, complete_density
from prolepsis.matter.liquids.viscosity import solve_viscosity
from prolepsis.matter.liquids.walls import SEEN, Bodies, Walls, empty_contacts, find_walls, keep_outside
from prolepsis.matter.liquids.yielding import about, response
from prolepsis.scene.particles import ParticleState

COURANT = 1.0
"""Share of a spacing that the fastest particle may go in one step [1]."""
PACKING = 0.75
"""Share of a spacing that a wave at the speed ``sqrt(p / rho)`` may go in one step: what is under pressure is a packing
that springs back, and from 0.87 on thin liquids collapse, by a sixth of their volume [1]."""
RIPPLE = 0.4
"""Share of the period of the shortest ripple that a step may take [1]."""
LONGEST, SHORTEST = 4.0e-3, 1.0e-4
"""Longest and shortest step [s]."""
ROOM = 40
"""Room for neighbours per particle in the mean, doubled when it does not suffice."""
PRESSURE_TOLERANCE = 0.25
"""Mean rate of compression that a step may leave [1/s]."""
PRESSURE_SWEEPS = (2, 40)
"""Least and greatest number of sweeps of the pressure solver."""
CALMING_SPEED = 0.05
"""Speed with which jitter is passed on from neighbour to neighbour [m/s]."""
CALMING_SHARE = 0.1
"""Share of the jitter that is worth a look at the flow around each particle [1]."""
VISCOUS_TOLERANCE = 3.0e-3
"""Residual over right-hand side at which the viscous solver ends [1]."""
VISCOUS_ITERATIONS = 100
"""Greatest number of iterations of the viscous solver."""


@dataclass(kw_only=True, slots=True)
class Effort:
    """What the steps of a run took."""

    steps: int = 0
    """Number of steps."""
    sweeps: int = 0
    """Sweeps of the pressure solver."""
    iterations: int = 0
    """Iterations of the viscous solver."""
    error: float = 0.0
    """Sum over steps of the mean compression that was left [1]."""
    seconds: dict[str, float] = field(default_factory=dict[str, float])
    """Time of each part [s]."""


class Liquid:
    """The solver for all free particles of a running simulation."""

    def __init__(self, particles: ParticleState, gravity: tuple[float, float, float]) -> None:
        """Take over the particles, under a gravitational acceleration [m/s^2]."""
        self.particles = particles
        self.effort = Effort()
        self._gravity = np.array(gravity)
        self._fall = float(np.linalg.norm(gravity)) * LONGEST
        count = len(particles.mass)
        # Those of pressure, and those that take compressions back.
        self._impulse, self._correction = np.zeros(count), np.zeros(count)
        self._viscous, self._pressed = np.zeros((count, 3)), np.zeros((count, 3))
        self._last, self._jitter = 1.0e-3, 0.0
        self._grow(ROOM)
        self._contacts = empty_contacts(count)
        self._gaps = Gaps(particles.spacing)
        # The shortest ripple of the lightest liquid must be seen (Brackbill et al. 1992).
        lightness = (particles.tension / particles.mass).max(initial=1e-12)
        self._ripple = RIPPLE / math.sqrt(2 * math.pi * lightness)

    def _grow(self, room: int) -> None:
        self._room = room
        self._neighbours = no_neighbours(len(self.particles.mass), room * len(self.particles.mass))

    def next_step(self) -> float:
        """Return the longest step that the free particles allow, by their speed and their pressure [s]."""
        p = self.particles
        by_speed = COURANT * p.spacing / max(greatest_speed(p.velocity, p.holder) + self._fall, 1e-9)
        return max(min(by_speed, self.packed_step(), self._ripple), SHORTEST)

    def packed_step(self) -> float:
        """Return the longest step that the packing of the particles allows under its pressure [s]."""
        p = self.particles
        wave = pressure_wave(self._impulse, p.mass, p.holder, self._last)
        return max(min(PACKING * p.spacing / max(wave, 1e-9), LONGEST), SHORTEST)

    def step(self, dt: float, walls: Walls, bodies: Bodies, after: Bodies) -> FloatArray:
        """Move the free particles on by ``dt`` [s].

        Args:
            dt: Length of the step [s].
            walls: The walls.
            bodies: The bodies that they belong to when the step begins, with their mean velocity in it.
            after: The same when the step ends.

        Returns:
            Impulse [N s] on each body and its moment about the world's origin [N m s], shape (B, 6).
        """
        p, spacing = self.particles, self.particles.spacing
        reaction = np.zeros((len(bodies.position), 6))
        free: IntArray = np.flatnonzero(p.free)
        if not len(free):
            return reaction
        clock, tables = _Clock(self.effort), wall_tables()
        order, rows, layer = row_order(p.position.take(free, axis=0), SUPPORT * spacing)
        ids = free[order]
        n = len(ids)
        x, v, mass = p.position.take(ids, axis=0), p.velocity.take(ids, axis=0), p.mass[ids]
        tension, rider = p.tension[ids], p.rider[ids].astype(np.int64)
        strength = tension * spacing / tables.surface_energy
        wetting, viscosity = p.wetting[ids], p.viscosity[ids]
        density, steepness = np.empty(n), np.empty((n, 3))
        side = np.zeros((n, 4))
        contacts = self._contacts
        find_walls(x, rider, spacing, walls, bodies, tables.share, tables.share_slope, contacts, side)
        clock.lap("walls")
        while not find_neighbours(x, rows, layer, spacing, side, pair_table(), self._neighbours, density, steepness):
            self._grow(2 * self._room)
        clock.lap("neighbours")
        near, inverse_mass = self._neighbours, 1.0 / mass
        alone = density.copy()
        edges, force = np.empty(n), np.zeros((n, 3))
        complete_density(contacts, density, steepness, tables.air, -tables.share_slope[0], spacing, edges)
        held = tension * spacing / tables.parting_energy
        add_adhesion(contacts, held, edges, wetting, tables.pull, spacing, force)
        add_tension(near, strength, edges, spacing, force)
        v += dt * (self._gravity + force / mass[:, None])
        self._jitter += CALMING_SPEED * dt / spacing
        if self._jitter >= CALMING_SHARE:
            calm(x, v, mass, near, min(self._jitter, 0.5))
            self._jitter = 0.0
        clock.lap("attraction")
        # What a shorter step had to stop needs no more than that in a longer one.
        longer = min(dt / self._last, 1.0)
        impulse = self._impulse[ids] * longer
        # Before viscosity, or what the last pressures do wrong at single particles would never be damped.
        push = np.zeros((n, SEEN))
        pressed = self._pressed.take(ids, axis=0) * longer
        apply_impulses(impulse, pressed, v, inverse_mass, near, steepness, contacts, spacing, push)
        guess = self._viscous.take(ids, axis=0) * longer
        slip = np.zeros((n, SEEN))
        mobility, yielded = bodies.mobility, np.zeros_like(reaction)
        if mobility.any():
            guessed = np.zeros_like(reaction)
            add_pressure(contacts, impulse, push, held, edges, wetting, tables.pull, spacing, dt, x, guessed)
            volume = p.volume[ids]
            weight = (mass / volume)[:, None] * self._gravity
            pressure = impulse / (volume * longer * self._last)
            between = dt * self._gaps.forces(x, pressure, weight, contacts, walls, bodies, dt)
            guessed += between
            reaction += between
            yielded = response(mobility, about(bodies.centre, guessed))
        self.effort.iterations += solve_viscosity(
            v, guess, mass, viscosity, near, contacts, tables.drag, spacing, dt, VISCOUS_TOLERANCE,
            VISCOUS_ITERATIONS, slip, bodies.inertia, yielded,
        )  # fmt: skip
        add_drag(contacts, v, slip, yielded, x, reaction)
        put(self._viscous, ids, guess)
        clock.lap("viscosity")
        sweeps, error = solve_pressure(
            v, inverse_mass, near, steepness, density, contacts, impulse, push, pressed, mobility, yielded, False,
            spacing, dt, PRESSURE_TOLERANCE * dt, *PRESSURE_SWEEPS,
        )  # fmt: skip
        self._impulse[ids] = impulse
        put(self._pressed, ids, pressed)
        self.effort.sweeps += sweeps
        self.effort.error += error
        clock.lap("pressure")
        pin_edges(contacts, v, mass, tension, p.pinning[ids], alone, x, spacing, dt, reaction)
        before = reaction.copy()
        add_pressure(contacts, impulse, push, held, edges, wetting, tables.pull, spacing, dt, x, reaction)
        self._gaps.pushed = (reaction - before) / dt
        going, push, pressed = v.copy(), np.zeros((n, SEEN)), np.zeros((n, 3))
        impulse = self._correction[ids] * longer
        apply_impulses(impulse, pressed, going, inverse_mass, near, steepness, contacts, spacing, push)
        sweeps, _ = solve_pressure(
            going, inverse_mass, near, steepness, density, contacts, impulse, push, pressed, mobility, yielded, True,
            spacing, dt, PRESSURE_TOLERANCE * dt, *PRESSURE_SWEEPS,
        )  # fmt: skip
        self._correction[ids] = impulse
        self.effort.sweeps += sweeps
        clock.lap("pressure")
        x += dt * going
        keep_outside(x, rider, going, contacts, spacing, walls.faces, after, dt)
        put(p.position, ids, x)
        put(p.velocity, ids, v)
        self._last = dt
        self.effort.steps += 1
        clock.lap("walls")
        return reaction


class _Clock:
    """Adds the time between laps to an effort."""

    def __init__(self, effort: Effort) -> None:
        self._seconds = effort.seconds
        self._then = time.perf_counter()

    def lap(self, part: str) -> None:
        now = time.perf_counter()
        self._seconds[part] = self._seconds.get(part, 0.0) + now - self._then
        self._then = now
