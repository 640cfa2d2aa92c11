"""Where each particle of a liquid is in each frame: in whose cavity, on which surface, held by what, or in the air.

All that is said of liquids follows from this. Particles in a cavity are looked at in the frame of its container, so
what is carried along stays inside; all others are looked at for the surfaces that they touch.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from prolepsis.fluents.hollows import NEAR, covered, hollows_of, stopped_levels
from prolepsis.fluents.intervals import ticks_of
from prolepsis.fluents.kernels.matter import assembled
from prolepsis.fluents.nesting import nesting
from prolepsis.fluents.observation import Observation, is_held_from_outside, named
from prolepsis.fluents.shapes_in_time import Part, RigidShape, rigid_shapes
from prolepsis.fluents.solids.contact import is_stuff
from prolepsis.geometry.hollows import BLOCKED, Space
from prolepsis.geometry.rotations import rotate, rotate_back
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.geometry.spreading import spread
from prolepsis.log.log import FREE, Particles

SURFACE_TOLERANCE = 0.75
"""How far above the spill level the centre of a particle may be whose foot is in the pool [spacings]: half a particle,
and a quarter for the bulge of a brimful surface."""
TOUCH_REACH = 0.75
"""Greatest distance of a particle's centre from a surface that it touches [spacings]; at rest it is a half."""
LEVEL_COSINE = 0.7
"""Least upward part of a surface's normal [1] for what touches it to lie on it: up to 45 degrees of slope. Down a
steeper wall it runs."""
RESTING_SPEED = 0.1
"""Speed relative to a surface [m/s] below which a liquid rests on it: a puddle that still spreads slowly does, a sheet
that runs off does not."""
STAYING_WINDOW = 0.1
"""Time over which a particle above a hole must move no faster than ``RESTING_SPEED`` relative to the vessel to stay in
it [s]: the level of a cup that leaks sinks by some 1-3 cm/s, what falls through a funnel is faster."""
NEIGHBOURS = 1.2
"""Greatest distance of neighbours in a liquid [spacings]."""

Bits = npt.NDArray[np.uint8]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Rim:
    """Up to which height one rigid shape would keep a liquid in each frame, its holes stopped; found when asked for."""

    space: Space
    """The free space in and round the shape, holes stopped that are known."""
    plug: float
    """Gaps that leave no more than this on either side count as holes, too [m]."""
    up: FloatArray
    """Directions up that are told apart, in the shape's frame, shape (K, 3)."""
    which: IntArray
    """The direction in each frame, shape (F,)."""
    during: BoolArray
    """The frames in which the unit is this shape, shape (F,)."""
    base: FloatArray
    """Height of the shape's origin in each frame [m], world frame, shape (F,)."""
    levels: dict[int, float]
    """Spill levels that are known, by direction [m], in the shape's frame; minus infinity where nothing would stay."""

    def brim(self, frames: IntArray) -> FloatArray:
        """Return the height of the spill level in some frames [m], world frame, shape (N,); NaN where there is none."""
        found = np.full(len(frames), np.nan)
        during, which = self.during[frames], self.which[frames]
        for direction in np.unique(which[during]).tolist():
            if direction not in self.levels:
                self.levels[direction] = float(self.space.pools(self.up[direction], self.plug).max())
            if self.levels[direction] > -np.inf:
                at = during & (which == direction)
                found[at] = self.levels[direction] + self.base[frames[at]]
        return found

    def capacity(self, frame: int) -> float:
        """Return the volume up to the spill level in a frame [m^3]."""
        basin = self.space.basin(self.up[self.which[frame]], self.plug) if self.during[frame] else None
        return 0.0 if basin is None else basin.capacity


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Inside:
    """Which particles are in the cavities of one unit."""

    unit: int
    """The container."""
    pool: BoolArray
    """Below the spill level, so that they could not leave at rest, or staying below that with the holes stopped, shape
    (F, P)."""
    hollow: BoolArray
    """Within the hollow, be it that they run along its wall or fall through its air, or in the pool, shape (F, P)."""
    near: BoolArray
    """In the hollow or so near that they have not left it yet, shape (F, P)."""
    depth: npt.NDArray[np.float32]
    """How far below the spill level those of the pool are [m], shape (F, P)."""
    rims: tuple[Rim, ...]
    """Of the rigid shapes that the unit was."""

    def brim(self, frames: IntArray) -> FloatArray:
        """Return the height of the spill level in some frames, holes stopped [m], shape (N,); NaN where none is."""
        found = self.rims[0].brim(frames)
        for rim in self.rims[1:]:
            found = np.fmax(found, rim.brim(frames))
        return found

    def capacity(self, frame: int) -> float:
        """Return the volume up to the spill level in a frame, holes stopped [m^3]."""
        return max(rim.capacity(frame) for rim in self.rims)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ParticleLocations:
    """All particles in all frames."""

    particles: Particles
    """As logged."""
    share: FloatArray
    """Share of each particle in the mass of its stuff [1], shape (P,)."""
    inside: tuple[Inside, ...]
    """Containers, the smallest first."""
    manner: Bits
    """How particles that are in no pool touch a surface: 0 not at all, 1 beside a wall, 2 on top, 3 resting; (F, P)."""
    on: npt.NDArray[np.int16]
    """Which unit they touch so, or which stuff of bodies, shape (F, P)."""

    def over_rim(self) -> BoolArray:
        """Return which particles touch nothing but the rim of a vessel, shape (F, P)."""
        found = np.zeros(self.manner.shape, dtype=np.bool_)
        for each in self.inside:
            found |= each.near & (self.on == each.unit)
        return found

    def stuffs(self) -> list[int]:
        """Return the indices of the liquids."""
        return sorted(set(self.particles.stuff.tolist()))

    def fraction(self, mask: npt.NDArray[Any], stuff: int) -> FloatArray:
        """Return the share of a stuff's mass that a mask or weight, shape (F, P), covers in each frame, shape (F,)."""
        chosen = self.particles.stuff == stuff
        share = self.share[chosen]
        shown = mask if chosen.all() else mask[:, chosen]
        if shown.dtype == np.bool_ and (share == share[0]).all():
            found = np.count_nonzero(shown, axis=1) * float(share[0])
        else:
            found = shown @ share
        # A sum of all shares may exceed one by rounding.
        return np.minimum(found, 1.0)

    def volume(self, stuff: int) -> float:
        """Return the volume of all of a stuff [m^3]."""
        return float(self.particles.volume[self.particles.stuff == stuff].sum())

    def mass(self, stuff: int) -> float:
        """Return the mass of all of a stuff [kg]."""
        return float(self.particles.mass[self.particles.stuff == stuff].sum())

    def at_ticks(self, series: FloatArray, tick_count: int) -> FloatArray:
        """Return values given for each frame at each tick: a frame speaks until the next one."""
        frame = np.searchsorted(self.particles.tick, np.arange(tick_count), side="right") - 1
        return series[np.maximum(frame, 0)]


def particle_locations(observation: Observation) -> ParticleLocations | None:
    """Return where the particles of a log are, or None if it has none."""
    particles = observation.log.particles
    if not len(particles.tick) or not len(particles.stuff):
        return None
    mass = np.zeros(len(observation.log.things))
    np.add.at(mass, particles.stuff, particles.mass)
    share = particles.mass / np.maximum(mass[particles.stuff], 1e-300)
    loose = particles.holder == FREE
    if not loose.any():
        # What stays within an egg or a sponge touches nothing: no compiled loop is needed.
        manner, on = np.zeros(loose.shape, dtype=np.uint8), np.full(loose.shape, -1, dtype=np.int16)
        return ParticleLocations(particles=particles, share=share, inside=(), manner=manner, on=on)
    inside = _of_innermost(observation, particles, _inside(observation, particles, loose))
    manner, on = _touching(observation, particles, loose, inside)
    return ParticleLocations(particles=particles, share=share, inside=inside, manner=manner, on=on)


def _inside(observation: Observation, particles: Particles, loose: BoolArray) -> tuple[Inside, ...]:
    found: dict[int, tuple[float, Inside]] = {}
    for shape in observation.of(rigid_shapes):
        unit = int(observation.unit[shape.body])
        if not shape.is_hollow or is_held_from_outside(observation, unit) or is_stuff(observation, unit):
            continue
        low, high = shape.bounds()
        frames = shape.during[particles.tick]
        if not frames.any() or not _comes_near(observation, particles, loose, shape, low, high):
            continue
        seen = _seen_inside(observation, particles, loose, shape)
        if seen is None:
            continue
        size = float(np.prod(high - low))
        known = found.get(unit)
        found[unit] = (size, seen) if known is None else (max(size, known[0]), _joined(known[1], seen))
    return tuple(inside for _, inside in sorted(found.values(), key=lambda pair: pair[0]))


def _of_innermost(observation: Observation, particles: Particles, inside: tuple[Inside, ...]) -> tuple[Inside, ...]:
    """Return the same without what is in a vessel that only dips into another from the pool of that."""
    found: list[Inside] = []
    for outer in inside:
        pool = outer.pool
        for inner in inside:
            both = outer.pool & inner.pool
            if inner is not outer and both.any():
                keeps = nesting(observation, inner.unit, outer.unit).keeps[particles.tick]
                pool = pool & ~(both & keeps[:, None])
        found.append(outer if pool is outer.pool else replace(outer, pool=pool))
    return tuple(found)


def _joined(one: Inside, other: Inside) -> Inside:
    return Inside(
        unit=one.unit,
        pool=one.pool | other.pool,
        hollow=one.hollow | other.hollow,
        near=one.near | other.near,
        depth=np.maximum(one.depth, other.depth),
        rims=one.rims + other.rims,
    )


def _comes_near(
    observation: Observation,
    particles: Particles,
    loose: BoolArray,
    shape: RigidShape,
    low: FloatArray,
    high: FloatArray,
) -> bool:
    """Return whether a particle that flows is ever within the ball round a shape."""
    pose = observation.log.poses[particles.tick, shape.body]
    middle = (pose[:, :3] + rotate(pose[:, 3:], (low + high) / 2)).astype(np.float32)
    offset = particles.position - middle[:, None]
    near = np.einsum("fpc,fpc->fp", offset, offset) < 0.25 * float(np.square(high - low).sum())
    return bool((near & loose).any())


def _seen_inside(observation: Observation, particles: Particles, loose: BoolArray, shape: RigidShape) -> Inside | None:
    # Imported here: logs without particles are recognized without compiled loops.
    from prolepsis.fluents.kernels.locations import HOLLOW, POOL, ROUND, pool_bits

    spacing = particles.spacing
    hollows = hollows_of(observation, shape)
    space, which = hollows.space, hollows.which[particles.tick]
    poses = np.ascontiguousarray(observation.log.poses[particles.tick, shape.body])
    during = shape.during[particles.tick]
    rim = Rim(
        space=hollows.whole, plug=hollows.plug, up=hollows.up, which=which, during=during,
        base=poses[:, :3] @ observation.up, levels={},
    )  # fmt: skip
    within = rim.space.hollow(rim.plug)
    if not within.any():
        return None
    free = rim.space.distance >= BLOCKED * space.step
    near = spread(within, free, max(1, round(NEAR * spacing / space.step)))
    bits, over_holes = np.zeros(loose.shape, dtype=np.uint8), np.zeros(loose.shape, dtype=np.uint8)
    depth = np.zeros(loose.shape, dtype=np.float32)
    has_holes = hollows.has_holes
    for direction in np.unique(which[during]).tolist():
        up = hollows.up[direction]
        frames = np.flatnonzero(during & (which == direction))
        pool = space.pools(up)
        if not hollows.has_holes:
            rim.levels[direction] = float(pool.max())
        pool = covered(space, up, pool)
        if has_holes:
            pool_bits(
                particles.position, frames, loose, poses, up, space.origin, space.step, rim.space.distance,
                stopped_levels(hollows, up, rim.plug), within, near, spacing, SURFACE_TOLERANCE * spacing, over_holes,
                depth,
            )  # fmt: skip
        pool_bits(
            particles.position, frames, loose, poses, up, space.origin,
            space.step, space.distance, pool, within, near, spacing, SURFACE_TOLERANCE * spacing, bits, depth,
        )  # fmt: skip
    pool = (bits & POOL) > 0
    doubtful = ((over_holes & POOL) > 0) & ~pool
    if doubtful.any():
        pool |= doubtful & stays(observation, particles, poses)
    hollow = pool | ((bits & HOLLOW) > 0)
    near = hollow | ((bits & ROUND) > 0)
    unit = int(observation.unit[shape.body])
    return Inside(unit=unit, pool=pool, hollow=hollow, near=near, depth=depth, rims=(rim,))


def stays(observation: Observation, particles: Particles, poses: FloatArray) -> BoolArray:
    """Return which particles hardly move in the frame of a body with some poses, shape (F, P)."""
    local = rotate_back(poses[:, None, 3:], particles.position - poses[:, None, :3])
    tick, half = particles.tick, ticks_of(STAYING_WINDOW / 2, observation.dt)
    first = np.maximum(np.searchsorted(tick, tick - half, side="right") - 1, 0)
    last = np.minimum(np.searchsorted(tick, tick + half), len(tick) - 1)
    time = np.maximum((tick[last] - tick[first]) * observation.dt, 1e-9)
    path = local[last] - local[first]
    stays: BoolArray = np.einsum("fpc,fpc->fp", path, path) < np.square(RESTING_SPEED * time)[:, None]
    return stays


def _touching(
    observation: Observation, particles: Particles, loose: BoolArray, inside: tuple[Inside, ...]
) -> tuple[Bits, npt.NDArray[np.int16]]:
    from prolepsis.fluents.kernels.locations import touch_surfaces
    from prolepsis.fluents.kernels.piles import pile_up

    spacing = particles.spacing
    manner = np.zeros(loose.shape, dtype=np.uint8)
    on = np.full(loose.shape, -1, dtype=np.int16)
    gap = np.full(loose.shape, np.inf, dtype=np.float32)
    own, naming = {each.unit: each.hollow for each in inside}, observation.of(named)
    free, in_hollow = loose.copy(), np.zeros_like(loose)
    for each in inside:
        free &= ~each.pool
        in_hollow |= each.hollow
    for shape in (*observation.of(rigid_shapes), *_planes(observation)):
        unit = int(observation.unit[shape.body])
        # A film on the inner wall of a vessel is not on it, but in it.
        look = free & ~own[unit] if unit in own else free.copy()
        if not shape.during.all():
            look &= shape.during[particles.tick][:, None]
        low, high = np.full(3, -np.inf), np.full(3, np.inf)
        if not any(geom.type == "plane" for part in shape.parts for geom in part.shape.geoms):
            low, high = shape.bounds()
        poses = np.ascontiguousarray(observation.log.poses[particles.tick, shape.body])
        touch_surfaces(
            particles.position, particles.tick, observation.dt, look, poses, observation.up, assembled(shape.parts),
            low, high, TOUCH_REACH * spacing, LEVEL_COSINE, RESTING_SPEED, int(naming[unit]), manner, on, gap,
        )  # fmt: skip
    free &= (manner > 0) | ~in_hollow
    pile_up(
        particles.position, particles.tick, observation.dt, free, observation.up, NEIGHBOURS * spacing, RESTING_SPEED,
        manner, on,
    )  # fmt: skip
    return manner, on


def _planes(observation: Observation) -> list[RigidShape]:
    """Return the shapes that consist of planes only, which end nowhere."""
    every = np.ones(observation.tick_count, dtype=np.bool_)
    found: list[RigidShape] = []
    for i, thing in enumerate(observation.log.things):
        if thing.shape.geoms and all(geom.type == "plane" for geom in thing.shape.geoms):
            part = Part(shape=thing.shape, displacement=np.zeros(3), rotation=np.eye(3), solids=())
            found.append(RigidShape(body=i, solids=(), parts=(part,), during=every))
    return found
