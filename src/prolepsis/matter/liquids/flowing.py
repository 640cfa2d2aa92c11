"""Liquids that flow: the particle liquid moves on with the bodies, and pushes back on them with force and torque."""

from __future__ import annotations

import math

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.log.log import FREE, PARKED
from prolepsis.matter.liquids.bodies import WallBodies
from prolepsis.matter.liquids.holes import note_narrow
from prolepsis.matter.liquids.particles import first_beyond
from prolepsis.matter.liquids.solver import Liquid
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
LIGHTEST = 3.0
"""Pieces of a shell that weigh less than so many particles are no walls: splinters, narrower than what would flow round
them. All that is larger is one, with its edges, and a light one yields to what flows within a step."""
GREATEST_GROWTH = 1.5
"""Factor by which a step may be longer than the last one, in which what that gave to the bodies acts [1]."""
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
        largest = max(len(pool.position) for pool in state.scene.pools)
        note_narrow(state.scene.things, self.liquid.particles.spacing, largest)
        things = state.scene.things
        positions = np.array([thing.position for thing in things if thing.shape.geoms])
        self._centre = positions.mean(axis=0) if len(positions) else np.zeros(3)
        self._far = FAR + float(np.linalg.norm(positions - self._centre, axis=1).max(initial=0.0))
        particles = self.liquid.particles
        self._walls = WallBodies(state, particles.spacing, LIGHTEST * float(particles.mass.mean()))
        self._force = np.zeros((len(self._walls.ids), 6))
        self._owed = np.zeros_like(self._force)
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
        # What stands there stands: a vessel that gave way would let the liquid sink into its bottom.
        none = np.zeros_like(at_rest.mobility)
        at_rest = at_rest._replace(mobility=none, inertia=none)
        # What is in a vessel stays there until the run begins.
        walls, passed = self._walls.stopped(), 0.0
        while passed < SETTLING_TIME:
            dt = self.liquid.packed_step()
            self.liquid.step(dt, walls, at_rest, at_rest)
            passed += dt
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
        renewed = self._take_walls(state)
        if self._resting or renewed:
            self._force = np.zeros((len(self._walls.ids), 6))
            self._owed = np.zeros_like(self._force)
        if self._resting:
            # Where the bodies are now, the first step begins.
            self._walls.moved(state, TICK, self._owed)
            self._resting = False
        self._elapsed += 1
        far = LONGEST_TRAVEL * particles.spacing
        travel = self._walls.travel(state)
        if not renewed and self._elapsed < self._ticks and travel < far:
            particles.behind = self._elapsed * TICK
            return
        self._step(state, self._elapsed * TICK)
        longest = min(self.liquid.next_step() / TICK, GREATEST_GROWTH * self._elapsed + 0.5)
        longest = min(longest, self._elapsed * far / max(travel, 1e-12))
        self._elapsed, particles.behind = 0, 0.0
        self._ticks = max(1, int(longest + 1e-9))
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
        ids, pushed = self._walls.ids, self._force * dt
        self._owed -= pushed
        position, rotation, velocity, spin = self._walls.moved(state, dt, pushed)
        ended = self._walls.now()
        going = np.concatenate([velocity, spin], axis=1) + self._walls.answer(self._owed)
        count = max(1, math.ceil(dt / self.liquid.next_step() - 1e-9))
        impulse = np.zeros_like(self._force)
        for k in range(count):
            velocity, spin = going[:, :3].copy(), going[:, 3:].copy()
            begun = self._walls.at(position + velocity * (dt * k / count), rotation, velocity, spin)
            after = self._walls.at(*ended, velocity, spin) if k == count - 1 else begun
            given = self.liquid.step(dt / count, self._walls.walls, begun, after)
            going += self._walls.answer(given)
            impulse += given
        # One that is held does not yield; if it is light against the liquid it would shake under a force that
        # answers its own last motion.
        mass = state.model.body_mass[ids]
        free = self.liquid.particles.mass[self.liquid.particles.holder == FREE].sum()
        share = (mass / np.maximum(mass + free, 1e-12))[:, None]
        self._force += share * (impulse / dt - self._force)
        self._owed = np.where(self._walls.yields[:, None], self._owed + impulse, 0.0)

    def _push(self, state: Running) -> None:
        """Push the bodies until the next step; by then one that yields is given all that it is owed."""
        ids = self._walls.ids
        self._force = np.where(self._walls.yields[:, None], self._owed / (self._ticks * TICK), self._force)
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
