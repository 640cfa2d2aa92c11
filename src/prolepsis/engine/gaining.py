"""Gaining: what moves with more energy than it had and than anything can have given to it.

Contacts and liquids only pass energy on. So what nobody holds or drives has, at any time, at most what it had in its
last flight, or when it was let go, and what the things that it was among have lost since. A liquid passes on what it
came with: no faster than twice as fast, which is how a wall that moves meets what rests.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from prolepsis.engine.stretches import Stretch
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.log import FREE, Contacts, Joints, Particles
from prolepsis.log.things import Thing

HEIGHT = 0.01
"""Energy counts as gained from so much on, as a height to which it lifts [m]: things may overlap by half a millimetre
at the start, and contacts give way by some millimetres and spring back."""
SHARE = 0.05
"""And from this share of what it had above the lowest place since [1]."""
FLIGHT = 0.02
"""What touches nothing for so long flies [s]."""
RELEASE = 0.05
"""A hand that lets go has an effect for so long [s]: what it pressed springs back."""
TWICE = 4.0
"""Greatest energy that what moves passes on to something light, over its own and for each kilogram [1]: what a wall
meets leaves it twice as fast. What is light goes up in water with at most 2 g, which is less."""
RETURNED = 0.5
"""What falls into a liquid leaves it again with at most this share of its energy, upwards [1]: the water that it must
move takes the rest. It skips over water with more, but not upwards."""
MOVES = 0.005
"""What stays within so much stays where it is [m], though it sinks in as it is put down."""

SETTLES = 0.001
"""So far what is put down sinks in [m], which stirs no liquid."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Gain:
    """One thing that has more energy than it can have."""

    tick: int
    """When it is found."""
    thing: int
    """Index of the thing."""
    height: float
    """What it has too much, as a height [m]."""
    returned: bool = False
    """Whether a liquid threw it back."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Surroundings:
    """What touched what, T ticks and n things."""

    contacts: Contacts
    """Between things."""
    joints: Sequence[Joints]
    """What was told to stick to what, and what joints held."""
    wet: BoolArray
    """Whether a liquid pushed each, shape (T, n); of no rows without liquids."""
    driven: BoolArray
    """Whether a kind pushed each that may add to its energy, shape (T, n); of no rows if none did."""
    mass: FloatArray
    """What each weighs [kg], with what it has absorbed, shape (T, n); of no rows without liquids."""
    particles: Particles
    """The liquids."""


class _Run:
    """A run in which gains are sought."""

    def __init__(
        self,
        things: Sequence[Thing],
        poses: FloatArray,
        around: Surroundings,
        stretches: Sequence[Stretch],
        gravity: FloatArray,
        dt: float,
    ) -> None:
        """Find out what touches what, and what is held or driven."""
        self.poses, self.around, self.stretches, self.gravity, self.dt = poses, around, stretches, gravity, dt
        self.ticks, self.count = poses.shape[:2]
        self.small = np.array([thing.emerges for thing in things])
        self.pairs = _pairs(around)
        moving = np.zeros(self.count, dtype=np.bool_)
        for stretch in stretches:
            moving |= stretch.bodies.free | stretch.bodies.driven
        self.between = self.pairs[moving[self.pairs[:, 1:]].all(axis=1)]
        """Those of the pairs in which both may move: what is fixed passes nothing on."""
        self.held = self._held()
        self._energy: dict[int, FloatArray] = {}

    def gains(self) -> Iterator[Gain]:
        """Yield the first gain of each thing."""
        free = np.zeros(self.count, dtype=np.bool_)
        for stretch in self.stretches:
            free |= stretch.bodies.free
        for thing in np.flatnonzero(free & ~self.small).tolist():
            found = min(self._of(thing), key=lambda gain: gain.tick, default=None)
            if found is not None:
                yield found

    def _held(self) -> BoolArray:
        """Return what is driven, or touches what is, shape (T, n); or a liquid that something driven has touched."""
        held = np.zeros((self.ticks, self.count), dtype=np.bool_)
        for stretch in self.stretches:
            held[stretch.start : stretch.end] = stretch.bodies.driven
        if len(self.around.driven):
            held |= self.around.driven
        if not held.any():
            return held
        tick, a, b = self.between.T
        wet, driven = self.around.wet, held.copy()
        before = -1
        while (now := int(held.sum())) != before:
            before = now
            chosen = held[tick, a] | held[tick, b]
            held[tick[chosen], a[chosen]] = held[tick[chosen], b[chosen]] = True
            if len(wet) and (stirred := (held & wet).any(axis=1)).any():
                held[int(stirred.argmax()) :] |= wet[int(stirred.argmax()) :]
        # For a while after it was let go, too.
        steps = round(RELEASE / self.dt)
        ticks: IntArray = np.arange(self.ticks, dtype=np.int64)[:, None]
        latest: IntArray = np.maximum.accumulate(np.where(held, ticks, -steps - 1), axis=0)
        return (ticks - latest <= steps) | driven

    def energy(self, thing: int) -> FloatArray:
        """Return a thing's energy over its mass [J/kg] in each tick, NaN while it is no free body, shape (T,)."""
        if thing not in self._energy:
            found = np.full(self.ticks, np.nan)
            for stretch in self.stretches:
                end = min(stretch.end, self.ticks - 1)
                if stretch.bodies.free[thing] and end > stretch.start:
                    part = self.poses[stretch.start : end + 1, thing]
                    found[stretch.start : end] = stretch.bodies.energy(thing, part, self.gravity, self.dt)
            self._energy[thing] = found
        return self._energy[thing]

    def _of(self, thing: int) -> Iterator[Gain]:
        """Yield the gains of one thing."""
        energy = self.energy(thing)
        touched = np.zeros(self.ticks, dtype=np.bool_)
        touched[self.pairs[(self.pairs[:, 1:] == thing).any(axis=1), 0]] = True
        if len(self.around.wet):
            touched |= self.around.wet[:, thing]
        alone = np.isfinite(energy) & ~self.held[:, thing]
        for begin, end in _runs(alone):
            flights = [(a, b) for a, b in _runs(~touched[begin:end]) if b - a >= FLIGHT / self.dt]
            starts = [(begin, begin + 1), *((begin + a, begin + b) for a, b in flights)]
            ends = [*starts[1:], (end, end)]
            for number, (before, after) in enumerate(zip(starts, ends, strict=True)):
                gain = self._between(thing, energy, *before, after[1])
                if gain is None and number and after[1] > after[0]:
                    gain = self._thrown_back(thing, energy, before, after)
                if gain is not None:
                    yield gain
                    return

    def _between(self, thing: int, energy: FloatArray, first: int, last: int, until: int) -> Gain | None:
        """Return the gain of a thing from a flight, or its start, to the end of the next flight."""
        g = float(np.linalg.norm(self.gravity))
        had = float(energy[first:last].max())
        later = energy[last:until]
        if not len(later):
            return None
        heights = -(self.poses[first:until, thing, :3] @ self.gravity)
        allowed = had + HEIGHT * g + SHARE * max(had - float(heights.min()), 0.0)
        if not (later > allowed).any():
            return None
        given = self._given(thing, first, last, until)
        if given is None:
            return None
        beyond = np.flatnonzero(later > allowed + given)
        if not len(beyond):
            return None
        return Gain(tick=last + int(beyond[0]), thing=thing, height=float((later - had - given).max()) / g)

    def _thrown_back(
        self, thing: int, energy: FloatArray, before: tuple[int, int], after: tuple[int, int]
    ) -> Gain | None:
        """Return how much too high a liquid alone throws a thing between two flights."""
        between = slice(before[1], after[0])
        touching = self.pairs[slice(*np.searchsorted(self.pairs[:, 0], (before[1], after[0])))]
        if not len(self.around.wet) or not self.around.wet[between, thing].any() or (touching[:, 1:] == thing).any():
            return None
        g = float(np.linalg.norm(self.gravity))
        heights = -(self.poses[:, thing, :3] @ self.gravity)
        surface = float(heights[before[1]])
        rising = np.diff(heights[after[0] : after[0] + 2])[0] / self.dt / g
        out = 0.5 * rising**2 + float(heights[after[0]]) - surface
        came = float(energy[before[0] : before[1]].max()) - surface
        if out <= RETURNED * came + HEIGHT * g:
            return None
        given = self._given(thing, before[0], before[1], after[0] + 1)
        too_much = 0.0 if given is None else out - RETURNED * came - float(given[-1])
        return Gain(tick=after[0], thing=thing, height=too_much / g, returned=True) if too_much > HEIGHT * g else None

    def _given(self, thing: int, first: int, last: int, until: int) -> FloatArray | None:
        """Return what others can have given to a thing [J/kg] from a tick on, None if that is not known."""
        rows = slice(*np.searchsorted(self.between[:, 0], (first, until)))
        wet = self.around.wet[first:until]
        pairs = np.unique(self.between[rows, 1:], axis=0)
        solid = _joined(thing, pairs)
        among = set(solid)
        soaked = np.flatnonzero(wet.any(axis=0)).tolist() if len(wet) else []
        if among & set(soaked):
            for each in soaked:
                among |= _joined(each, pairs)
        among.discard(thing)
        if any(self.small[each] for each in among):
            return None
        given = np.zeros(until - last)
        own, g = self._mass(thing, last, until), float(np.linalg.norm(self.gravity))
        for each in sorted(among):
            energy = self.energy(each)[first:until]
            if self.held[first:until, each].any():
                return None
            if np.isfinite(energy).all():
                lost = np.maximum.accumulate(energy) - energy
                if each not in solid:
                    lost = np.maximum(lost - SETTLES * g, 0.0)
                given += lost[last - first :] * self._mass(each, last, until) / own
        if thing in soaked:
            when = first + int(wet[:, thing].argmax())
            height = -float(self.poses[when, thing, :3] @ self.gravity)
            given += TWICE * max(_head(self.around.particles, when, self.gravity, self.dt) - height, 0.0)
        travel = np.ptp(self.poses[first:until, :, :3], axis=0).max(axis=1)
        if any(each != thing and each in solid and travel[each] > MOVES for each in soaked):
            given += _loss(self.around.particles, first, until, self.gravity, self.dt) / own
        return given

    def _mass(self, thing: int, begin: int, end: int) -> FloatArray:
        if len(self.around.mass):
            return np.maximum(self.around.mass[begin:end, thing], 1e-12)
        stretch = next(each for each in self.stretches if each.start <= begin < each.end)
        return np.full(end - begin, max(float(stretch.bodies.mass[thing]), 1e-12))


def gains(
    things: Sequence[Thing],
    poses: FloatArray,
    around: Surroundings,
    stretches: Sequence[Stretch],
    gravity: FloatArray,
    dt: float,
) -> Iterator[Gain]:
    """Yield the first gain of each thing that nobody holds.

    What comes free of a broken whole is left out, and so is what touches it: shards are born pressed to each other.

    Args:
        things: The things of the run.
        poses: Of each thing at each tick, shape (T, n, 7).
        around: What touched what.
        stretches: What the bodies were when.
        gravity: [m/s^2], shape (3,).
        dt: Tick [s].
    """
    if len(poses) > 1 and np.linalg.norm(gravity) > 0.0:
        yield from _Run(things, poses, around, stretches, gravity, dt).gains()


def _pairs(around: Surroundings) -> IntArray:
    """Return tick and both things of what touches or sticks, by ticks, shape (R, 3)."""
    contacts = around.contacts
    table = [np.stack([contacts.tick, contacts.a, contacts.b], axis=1)]
    rows = np.concatenate([np.stack([each.a, each.b, each.start, each.end], axis=1) for each in around.joints])
    for a, b, start, end in rows.tolist():
        table.append(np.array([(tick, a, b) for tick in range(start, end)], dtype=np.int64).reshape(-1, 3))
    found = np.concatenate(table)
    return found[np.argsort(found[:, 0], kind="stable")]


def _joined(thing: int, pairs: IntArray) -> set[int]:
    """Return what a thing touches, and what that touches, and so on, with itself."""
    found, new = {thing}, {thing}
    while new:
        touching = pairs[np.isin(pairs, sorted(new)).any(axis=1)]
        new = set(touching.ravel().tolist()) - found
        found |= new
    return found


def _head(particles: Particles, tick: int, gravity: FloatArray, dt: float) -> float:
    """Return the greatest energy over mass of flowing particles up to a tick [J/kg]."""
    last = max(int(np.searchsorted(particles.tick, tick, side="right")), 1)
    position = particles.position[:last].astype(np.float64)
    energy = -(position @ gravity)
    if last > 1:
        time = np.diff(particles.tick[:last]) * dt
        energy[1:] += 0.5 * np.square(np.diff(position, axis=0) / time[:, None, None]).sum(axis=2)
    return float(np.where(particles.holder[:last] == FREE, energy, -np.inf).max())


def _loss(particles: Particles, begin: int, end: int, gravity: FloatArray, dt: float) -> float:
    """Return how much energy liquids lost at most in some ticks [J]."""
    first, last = np.searchsorted(particles.tick, (begin, end))
    position = particles.position[max(first - 1, 0) : last + 1].astype(np.float64)
    time = np.diff(particles.tick[max(first - 1, 0) : last + 1]) * dt
    energy = -((position[1:] + position[:-1]) / 2 @ gravity)
    energy += 0.5 * np.square(np.diff(position, axis=0) / time[:, None, None]).sum(axis=2)
    total = energy @ particles.mass
    return float((np.maximum.accumulate(total) - total).max(initial=0.0))


def _runs(mask: BoolArray) -> list[tuple[int, int]]:
    """Return first ticks and first ticks no longer of the stretches of a mask."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(np.int8)))
    return [(int(start), int(end)) for start, end in edges.reshape(-1, 2)]
