"""Liquids that flow: the particle liquid moves on with the bodies, and pushes back on them with force and torque."""

from __future__ import annotations

import math

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.log.log import FREE, PARKED
from prolepsis.matter.liquids.bodies import WallBodies
from prolepsis.matter.liquids.particles import first_beyond
from prolepsis.matter.liquids.solver import LONGEST, Liquid
from prolepsis.matter.liquids.yielding import about
from prolepsis.scene.kind import Controller
from prolepsis.scene.particles import ParticleState
from prolepsis.scene.running import MAX_STEP, Running
from prolepsis.terms.errors import InvalidSimulationError

TICK = MAX_STEP
"""The liquid is looked at every tick [s]; a step of it takes several, one, or a part of one."""
LONGEST_TRAVEL = 0.5
"""Travel of the fastest wall after which a step of the liquid comes early [spacings]."""
FAR = 2.0
"""Distance from all things at the start beyond which a particle is parked [m]."""
LIGHTEST = 50.0
"""Pieces of a shell that weigh less than so many particles are no walls: they are thinner than a particle, and would be
thrown about by forces that so few cannot resolve."""
SETTLING_TIME = 0.24
"""A liquid that was filled in on a lattice settles for this long before the run begins [s]."""
SETTLING_VISCOSITY = 2.0
"""Least viscosity with which it does so, so that it is at rest [Pa s]."""


class Flowing(Controller):
    """All liquids of a running simulation."""

    def __init__(self, state: Running) -> None:
        """Fill the pools of the scene in and let them settle."""
        self.liquid = Liquid(_particles(state), state.scene.gravity)
        state.particles = self.liquid.particles
        things = state.scene.things
        positions = np.array([thing.position for thing in things if thing.shape.geoms])
        self._centre = positions.mean(axis=0) if len(positions) else np.zeros(3)
        self._far = FAR + float(np.linalg.norm(positions - self._centre, axis=1).max(initial=0.0))
        self._walls = WallBodies(state, LIGHTEST * float(self.liquid.particles.mass.mean()))
        self._force = np.zeros((len(self._walls.ids), 6))
        self._elapsed = 0
        self._ticks = 1
        self._resting = False
        self._renewed = self._bound = False
        self._settle()

    def _settle(self) -> None:
        particles = self.liquid.particles
        viscosity = particles.viscosity
        particles.viscosity = np.maximum(viscosity, SETTLING_VISCOSITY)
        position, rotation = self._walls.now()
        at_rest = self._walls.at(position, rotation, np.zeros_like(position), np.zeros_like(position))
        passed = 0.0
        while passed < SETTLING_TIME:
            self.liquid.step(LONGEST, self._walls.solids, at_rest, at_rest)
            passed += LONGEST
        particles.viscosity = viscosity
        particles.velocity[:] = 0.0

    def bind(self, state: Running) -> None:
        """Look up what it needs in a model that is new."""
        # Those of the first model are known; others are taken where a step of the liquid ends.
        self._renewed, self._bound = self._bound, True

    def end_tick(self, state: Running) -> None:
        """Move the liquid on, if a step of it has passed."""
        particles = self.liquid.particles
        if not particles.free.any():
            self._rest(state)
            return
        if self._resting:
            # Where the bodies are now, the first step begins.
            self._take_walls(state)
            self._walls.moved(state, TICK)
            self._force = np.zeros((len(self._walls.ids), 6))
            self.liquid.forget_pushes()
            self._resting = False
        self._elapsed += 1
        if self._take_walls(state):
            self.liquid.forget_pushes()
            self._force = np.zeros((len(self._walls.ids), 6))
        elif self._elapsed < self._ticks and self._walls.travel(state) < LONGEST_TRAVEL * particles.spacing:
            particles.behind = self._elapsed * TICK
            return
        self._step(state, self._elapsed * TICK)
        self._elapsed, particles.behind = 0, 0.0
        self._ticks = max(1, int(self.liquid.next_step() / TICK + 1e-9))
        self._push(state)
        self._park(state)

    def _take_walls(self, state: Running) -> bool:
        """Look the walls up in a model that is new, and return whether it was."""
        renewed, self._renewed = self._renewed, False
        if renewed:
            self._walls.take(state)
        return renewed

    def _rest(self, state: Running) -> None:
        """Do nothing while nothing flows; the first time, let go of the bodies."""
        if not self._resting:
            self._force[:] = 0.0
            state.push(self, self._walls.ids[:0], self._force[:0], passes_on=True)
            self._elapsed, self._ticks, self._resting = 0, 1, True
            self.liquid.particles.behind = 0.0

    def _step(self, state: Running, dt: float) -> None:
        position, rotation, velocity, spin = self._walls.moved(state, dt)
        end = self._walls.at(*self._walls.now(), velocity, spin)
        count = max(1, math.ceil(dt / self.liquid.next_step() - 1e-9))
        impulse = np.zeros_like(self._force)
        for k in range(count):
            begun = self._walls.at(position + velocity * (dt * k / count), rotation, velocity, spin)
            impulse += self.liquid.step(dt / count, self._walls.solids, begun, end if k == count - 1 else begun)
        force = impulse / dt
        # One that is held does not yield; if it is light against the liquid it would shake under a force that
        # answers its own last motion.
        mass = state.model.body_mass[self._walls.ids]
        free = self.liquid.particles.mass[self.liquid.particles.holder == FREE].sum()
        share = np.where(self._walls.yields, 1.0, mass / np.maximum(mass + free, 1e-12))[:, None]
        self._force += share * (force - self._force)

    def _push(self, state: Running) -> None:
        ids = self._walls.ids
        state.push(self, ids, about(state.data.xipos[ids], self._force), passes_on=True)

    def _park(self, state: Running) -> None:
        particles = self.liquid.particles
        if first_beyond(particles.position, particles.holder, self._centre, self._far) < 0:
            return
        free = np.flatnonzero(particles.free)
        away: FloatArray = np.linalg.norm(particles.position[free] - self._centre, axis=1)
        if not np.isfinite(away).all():
            lost = state.scene.things[int(particles.stuff[free[~np.isfinite(away)][0]])].name
            raise InvalidSimulationError(f"the simulation became unstable at {state.data.time:.3f} s at {lost}")
        gone = free[away > self._far]
        particles.holder[gone] = PARKED
        particles.velocity[gone] = 0.0


def _particles(state: Running) -> ParticleState:
    scene = state.scene
    names = {thing.name: i for i, thing in enumerate(scene.things)}
    columns: list[FloatArray] = []
    positions: list[FloatArray] = []
    for pool in scene.pools:
        thing, count = scene.thing(pool.stuff), len(pool.position)
        q = thing.quantities
        volume = q["volume"] / count
        holder = names[pool.holder] if pool.holder is not None else FREE
        advancing = q.get("contactAngle", math.pi / 2)
        receding = min(q.get("recedingAngle", advancing), advancing)
        row = [
            names[pool.stuff],
            holder,
            volume * q["density"],
            volume,
            q["viscosity"],
            q.get("surfaceTension", 0.0),
            math.cos(advancing),
            math.cos(receding) - math.cos(advancing),
        ]
        columns.append(np.tile(np.array(row), (count, 1)))
        positions.append(np.asarray(pool.position, dtype=np.float64).reshape(-1, 3))
    table = np.concatenate(columns)
    position = np.concatenate(positions)
    return ParticleState(
        position=position,
        velocity=np.zeros_like(position),
        home=np.zeros_like(position),
        holder=table[:, 1].astype(np.int16),
        stuff=table[:, 0].astype(np.int64),
        mass=table[:, 2].copy(),
        volume=table[:, 3].copy(),
        viscosity=table[:, 4].copy(),
        tension=table[:, 5].copy(),
        wetting=table[:, 6].copy(),
        pinning=table[:, 7].copy(),
        spacing=scene.pools[0].spacing,
    )
