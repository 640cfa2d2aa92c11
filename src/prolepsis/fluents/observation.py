"""A log as recognition sees it: units that have a name in facts, from when to when they exist, what they weigh.

A unit is what a fact may name as a solid: a topmost whole with all its parts, a piece that came free, or one
blob of a stuff (which facts name by its stuff).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar, cast

import numpy as np

from prolepsis.fluents.evidence import possible
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.log import Log
from prolepsis.log.timeline import Argument, Evidence, Fact

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True, slots=True)
class Observation:
    """One log with what groundings need of it. Groundings read it and change nothing."""

    log: Log
    """The log."""
    unit: IntArray
    """Index of the unit that each thing belongs to, shape (n,)."""
    unit_names: tuple[str, ...]
    """Name in facts of the unit that is thing i, for each thing."""
    units: tuple[int, ...]
    """Indices of the things that are units, ascending."""
    up: FloatArray
    """Unit vector against gravity, shape (3,)."""
    gravity: float
    """Gravitational acceleration [m/s^2]."""
    segments: IntArray
    """First ticks of the stretches over which carriers stay the same, shape (S,)."""
    _known: dict[Callable[[Any], Any], Any] = field(default_factory=dict[Callable[[Any], Any], Any])

    @property
    def tick_count(self) -> int:
        """Number of ticks T."""
        return self.log.tick_count

    @property
    def dt(self) -> float:
        """Tick [s]."""
        return self.log.dt

    def of(self, derive: Callable[[Observation], T]) -> T:
        """Return ``derive(self)``, computed once."""
        if derive not in self._known:
            self._known[derive] = derive(self)
        return cast(T, self._known[derive])

    def has_role(self, thing: int, *roles: str) -> bool:
        """Return whether a thing has one of the roles, or is of a kind with that name."""
        record = self.log.things[thing]
        return any(role in record.roles or role == record.kind for role in roles)

    def bodies(self, unit: int) -> list[int]:
        """Return the things of a unit, itself included, that are rigid bodies at some tick."""
        return [int(i) for i in np.flatnonzero(self.unit == unit) if self.carried[:, i].any()]

    @property
    def carried(self) -> BoolArray:
        """Whether each thing is a rigid body of its own in each segment, shape (S, n)."""
        return self.of(_own_bodies)

    def exists(self, unit: int) -> BoolArray:
        """Return whether a unit has a rigid body, at each tick, shape (T,)."""
        present = self.carried[:, self.unit == unit].any(axis=1)
        return self.spread(present)

    def mass(self, unit: int) -> FloatArray:
        """Return the mass of a unit [kg] at each tick, shape (T,): of a fragment, that of its pieces.

        What a sponge has soaked up weighs with it.
        """
        if not self.has_role(unit, "Piece"):
            soaked = self.of(_soaked_masses).get(unit)
            own = np.full(self.tick_count, self.log.things[unit].mass)
            return own if soaked is None else own + soaked
        pieces = self.of(_piece_masses)
        together = [pieces[self.log.carrier[tick] == unit].sum() for tick in self.segments]
        return self.spread(np.array(together))

    def spread(self, by_segment: Any) -> Any:
        """Return values given for each segment at each tick."""
        lengths = np.diff(np.append(self.segments, self.tick_count))
        return np.repeat(by_segment, lengths, axis=0)

    def time(self, tick: int) -> float:
        """Return the instant of a tick [s], the same float everywhere."""
        return int(tick) * self.dt

    def fact(
        self, kind: Any, type: str, args: tuple[Argument, ...], stretch: Any, evidence: Evidence | None = None
    ) -> Fact:
        """Return the fact that holds over a run of ticks ``(start, end)``.

        Raises:
            InvalidSimulationError: If the evidence is none that physics allows.
        """
        start, end = int(stretch[0]), int(stretch[1])
        made = Fact(kind=kind, type=type, args=args, start=start * self.dt, end=end * self.dt)
        return replace(made, evidence=possible(f"{made.term} from {made.start:.3f} s", evidence or {}))


def observe(log: Log) -> Observation:
    """Return ``log`` as recognition sees it."""
    index = {thing.name: i for i, thing in enumerate(log.things)}
    unit = np.array([_unit(log, index, i) for i in range(len(log.things))], dtype=np.int64)
    names = tuple(_report_name(log, i) for i in range(len(log.things)))
    gravity = np.array(log.gravity, dtype=np.float64)
    strength = float(np.linalg.norm(gravity))
    up = -gravity / strength if strength > 0 else np.array([0.0, 0.0, 1.0])
    changed = np.flatnonzero((log.carrier[1:] != log.carrier[:-1]).any(axis=1)) + 1
    return Observation(
        log=log,
        unit=unit,
        unit_names=names,
        units=tuple(sorted(set(unit.tolist()))),
        up=up,
        gravity=strength,
        segments=np.concatenate(([0], changed)).astype(np.int64),
    )


def named(observation: Observation) -> IntArray:
    """Return for each thing that is a unit the thing that facts name for it, for a blob its stuff, shape (n,)."""
    index = {thing.name: i for i, thing in enumerate(observation.log.things)}
    return np.array([index.get(name, i) for i, name in enumerate(observation.unit_names)], dtype=np.int64)


def is_loose(observation: Observation, unit: int) -> bool:
    """Return whether a unit is neither fixed nor moved or held by a robot or a mount, so that weight can move it."""
    fixed = observation.log.things[unit].fixed
    return not fixed and not observation.has_role(unit, "Gripper", "Driven", "Robot", "Mounted")


def is_held_from_outside(observation: Observation, unit: int) -> bool:
    """Return whether actuators carry the unit, so that nothing need support it."""
    return observation.has_role(unit, "Gripper", "Driven", "Robot")


def _unit(log: Log, index: dict[str, int], thing: int) -> int:
    while True:
        record = log.things[thing]
        if record.whole is None or record.whole not in index or {"Piece", "Blob"} & (record.roles | {record.kind}):
            return thing
        thing = index[record.whole]


def _report_name(log: Log, thing: int) -> str:
    record = log.things[thing]
    if record.whole is not None and "Blob" in record.roles | {record.kind}:
        return record.whole
    return record.name


def _own_bodies(observation: Observation) -> BoolArray:
    carrier: IntArray = observation.log.carrier[observation.segments]
    things: IntArray = np.arange(len(observation.log.things), dtype=np.int64)
    return carrier == things


def _soaked_masses(observation: Observation) -> dict[int, FloatArray]:
    """Return the mass of what each unit holds of stuffs that are no parts of it [kg] at each tick, shape (T,) each."""
    particles = observation.log.particles
    found: dict[int, FloatArray] = {}
    frame = np.searchsorted(particles.tick, np.arange(observation.tick_count), side="right") - 1
    for holder in np.unique(particles.holder[particles.holder >= 0]).tolist():
        unit = int(observation.unit[holder])
        foreign = observation.unit[particles.stuff] != unit
        if foreign.any():
            mass = (particles.holder == holder) @ np.where(foreign, particles.mass, 0.0)
            if mass.any():
                found[unit] = found.get(unit, np.zeros(observation.tick_count)) + mass[frame]
    return found


def _piece_masses(observation: Observation) -> FloatArray:
    things = observation.log.things
    return np.array([t.mass if observation.has_role(i, "Piece") else 0.0 for i, t in enumerate(things)])
