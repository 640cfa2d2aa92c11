"""Riding: a soft thing that slides over a thick liquid rides up on it, rather than to plough it away.

What is under it is a film, thinner than a particle, for which particles stand by their volume: they flow on between
the surface and the face that rides on them, are drawn into its pores, or come out behind it. Where it is lifted off,
half of the film goes with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.things import Thing
from prolepsis.matter.sponges.riding_law import SPLIT, RidingLaw, mixed
from prolepsis.matter.sponges.sponge_surface import SpongeSurface, nearest_of
from prolepsis.scene.particles import ParticleState
from prolepsis.scene.running import Running

NONE = -1
"""Of a particle on which nothing rides."""
TOUCH_REACH = 0.75
"""Distance of a particle's centre from the leading edge up to which it touches that [spacings]; at rest a half."""
LOWEST = 1.0
"""Greatest height of a centre over the surface of what belongs to the lowest layer [spacings]; at rest it is a half."""
CLEAR = 0.5
"""Distance from which on a particle is beside it and no longer under it [spacings]."""
FACING = 0.5
"""Least cosine between where a face looks and a direction [1] for it to look there."""
SLOW = 2.0e-3
"""What slides more slowly does not tell on what it lies [m/s]: fingers that hold it slip so."""
LOAD_TIME = 0.05
"""Time over which load and speed are averaged, since contacts flicker [s]."""


@dataclass(kw_only=True, slots=True)
class Film:
    """What is known of one liquid under it; what is due has not yet come to a particle."""

    height: float = 0.0
    """As it was when it last rode [m]."""
    area: float = 0.0
    """The greatest area of the face on which it was [m^2]."""
    under: float = 0.0
    """Due to go under it [m^3]."""
    drawn: float = 0.0
    """Due to go into its pores [m^3]."""
    lifted: float = 0.0
    """Due to go up with it [particles]."""


@dataclass(kw_only=True, slots=True)
class Sliding:
    """How it slides on a surface, world frame."""

    body: int = NONE
    """The MuJoCo body with the surface, the last one if it slides on none."""
    outward: FloatArray = field(default_factory=lambda: np.zeros(3))
    """Normal of its face there, shape (3,)."""
    point: FloatArray = field(default_factory=lambda: np.zeros(3))
    """On the surface [m], shape (3,)."""
    velocity: FloatArray = field(default_factory=lambda: np.zeros(3))
    """Along the surface [m/s], shape (3,)."""
    load: float = 0.0
    """[N]"""


class Riding:
    """One soft thing with pores, and the films on which it rides."""

    def __init__(self, things: Sequence[Thing], index: int, surface: SpongeSurface) -> None:
        """Attach to one of the things of a scene, with the quantities of what absorbs."""
        thing = things[index]
        self._mass = np.array([each.quantities.get("relativeMolecularMass", 0.0) for each in things])
        self._thing, self._index, self._surface = thing, index, surface
        size = surface.high - surface.low
        faces = size.prod() / size
        self._laws = [
            RidingLaw.of(thing.quantities, float(size.min()), float(size[k]), float(faces[k])) for k in range(3)
        ]
        self._law = self._laws[int(np.argmin(size))]
        self._sliding = Sliding()
        self._films: dict[int, Film] = {}

    def move(self, state: Running, particles: ParticleState, dt: float) -> IntArray:
        """Let particles go under it and come out again, and return those that it takes up, shape (n,)."""
        if self._law is None or not particles.free.any():
            return np.zeros(0, dtype=np.int64)
        body = state.data.body(self._thing.name)
        frame = body.xmat.reshape(3, 3)
        self._slide(state, frame, dt)
        near = np.flatnonzero(particles.free & ((particles.rider == NONE) | (particles.rider == self._index)))
        local = (particles.position[near] - body.xpos) @ frame
        touching = self._surface.touched_by(local, TOUCH_REACH * particles.spacing)
        touching |= particles.rider[near] == self._index
        near, local = near[touching], local[touching]
        if not len(near):
            return near
        outward = self._surface.outward[nearest_of(self._surface.exits, local)[1]] @ frame.T
        distance = self._surface.distance(local)
        under = particles.rider[near] == self._index
        ahead = self._is_ahead(particles, near, outward)
        # What has just begun to go under it is still before its edge.
        out = under & (distance >= np.where(ahead, TOUCH_REACH, CLEAR) * particles.spacing)
        particles.rider[near[out]] = NONE
        torn = near[out & (outward @ self._sliding.outward > FACING)]
        lying = near[under & ~out]
        taken = [self._tear(particles, group, self._film(stuff)) for stuff, group in _by_stuff(particles, torn)]
        for stuff, group in _by_stuff(particles, near[ahead]):
            self._go_under(particles, group, self._film(stuff), dt)
        taken += [self._draw_in(particles, group, stuff, dt) for stuff, group in _by_stuff(particles, lying)]
        return np.concatenate(taken) if taken else near[:0]

    def _film(self, stuff: int) -> Film:
        return self._films.setdefault(stuff, Film())

    def _slide(self, state: Running, frame: FloatArray, dt: float) -> None:
        """Bring up to date on which of its faces it slides, how fast, and how it is pressed on there."""
        own = state.model.body(self._thing.name).id
        found: dict[int, tuple[float, FloatArray, FloatArray]] = {}
        for contact, first, second, force in state.normal_forces():
            if own in (first, second):
                other, sign = (second, 1.0) if first == own else (first, -1.0)
                load, push, point = found.get(other, (0.0, np.zeros(3), np.zeros(3)))
                normal = sign * force * state.data.contact.frame[contact, :3]
                found[other] = load + force, push + normal, point + force * state.data.contact.pos[contact]
        now = Sliding(body=self._sliding.body, outward=self._sliding.outward, point=self._sliding.point)
        fastest = SLOW
        for other, (load, push, point) in found.items():
            if load <= 0.0 or not push.any():
                continue
            outward, point = push / np.linalg.norm(push), point / load
            velocity = state.velocity_at(self._thing.name, point)
            velocity = velocity - state.velocity_at(state.model.body(other).name, point)
            velocity -= velocity @ outward * outward
            speed = float(np.linalg.norm(velocity))
            if speed > fastest or (other == now.body and fastest <= SLOW):
                fastest = max(fastest, speed)
                now = Sliding(body=other, outward=outward, point=point, velocity=velocity, load=load)
        if now.body != self._sliding.body:
            self._law = self._laws[int(np.argmax(np.abs(frame.T @ now.outward)))]
        share = min(dt / LOAD_TIME, 1.0)
        now.velocity = self._sliding.velocity + share * (now.velocity - self._sliding.velocity)
        now.load = self._sliding.load + share * (now.load - self._sliding.load)
        self._sliding = now

    def _is_ahead(self, particles: ParticleState, near: IntArray, outward: FloatArray) -> BoolArray:
        """Return which particles are of the lowest layer and before a leading edge."""
        speed = float(np.linalg.norm(self._sliding.velocity))
        height = (self._sliding.point - particles.position[near]) @ self._sliding.outward
        ahead = outward @ self._sliding.velocity > FACING * speed
        return ahead & (height < LOWEST * particles.spacing) & (speed > 0.0)

    def _go_under(self, particles: ParticleState, ahead: IntArray, film: Film, dt: float) -> None:
        """Let particles of one liquid go under it: as much as it drags under it, a film of half its speed."""
        assert self._law is not None
        speed = float(np.linalg.norm(self._sliding.velocity))
        height = self._law.height(float(particles.viscosity[ahead[0]]), speed, self._sliding.load)
        if height <= 0.0:
            return
        film.height = height
        film.under += height * speed / 2 * self._width(particles, ahead) * dt
        volume, still = float(particles.volume[ahead[0]]), ahead[particles.rider[ahead] == NONE]
        count = min(int(film.under / volume), len(still))
        particles.rider[still[:count]] = self._index
        film.under = min(film.under - count * volume, volume)

    def _width(self, particles: ParticleState, ahead: IntArray) -> float:
        """Return along how much of the leading edge particles lie, also those that have begun to go under it [m]."""
        across = np.cross(self._sliding.outward, self._sliding.velocity)
        along = particles.position[ahead] @ across / np.linalg.norm(across)
        return len(np.unique(np.round(along / particles.spacing))) * particles.spacing

    def _draw_in(self, particles: ParticleState, lying: IntArray, stuff: int, dt: float) -> IntArray:
        """Return which particles of one liquid under it go into its pores, in which other liquids thin it."""
        law, film = self._law, self._film(stuff)
        assert law is not None
        if film.height <= 0.0:
            return lying[:0]
        wet = min(float(particles.volume[lying].sum()) / film.height, law.face)
        film.area = max(film.area, wet)
        held = particles.holder == self._index
        own, others = held & (particles.stuff == stuff), np.flatnonzero(held & (particles.stuff != stuff))
        share = min(float(particles.volume[others].sum()) / law.pores, 1.0)
        room = law.porosity * (1 - share)
        if room <= 0.0:
            return lying[:0]
        viscosity = self._thinned(particles, int(lying[0]), others, (1 - share) * law.pores)
        depth = float(particles.volume[own].sum() + film.drawn) / (film.area * room)
        pressure = min(self._sliding.load / law.face + law.stiffness * film.height, self._sliding.load / wet)
        film.drawn += wet * room * (law.depth_after(depth, viscosity, pressure, dt) - depth)
        volume = float(particles.volume[lying[0]])
        count = min(int(film.drawn / volume), len(lying))
        film.drawn = min(film.drawn - count * volume, volume)
        return lying[:count]

    def _thinned(self, particles: ParticleState, one: int, others: IntArray, volume: float) -> float:
        """Return the viscosity of a liquid that fills a volume of its pores [m^3], mixed with others that are there."""
        others = others[self._mass[particles.stuff[others]] > 0.0]
        among = np.append(others, one)
        mass = particles.mass[among].copy()
        mass[-1] *= volume / particles.volume[one]
        molecules = self._mass[particles.stuff[among]]
        if molecules[-1] <= 0.0:
            return float(particles.viscosity[one])
        return mixed(mass / molecules, particles.viscosity[among])

    def _tear(self, particles: ParticleState, torn: IntArray, film: Film) -> IntArray:
        """Return which particles go with it, of those from which it was lifted off."""
        film.lifted += SPLIT * len(torn)
        count = int(film.lifted)
        film.lifted -= count
        return torn[:count]


def _by_stuff(particles: ParticleState, chosen: IntArray) -> list[tuple[int, IntArray]]:
    """Return some particles by their stuff."""
    stuffs = particles.stuff[chosen]
    return [(stuff, chosen[stuffs == stuff]) for stuff in np.unique(stuffs).tolist()]
