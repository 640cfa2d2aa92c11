"""The recorder: copies of poses, contacts and particles while the run goes on, turned into log columns at its end.

It reads the simulation and changes nothing in it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from prolepsis.engine.gaining import Surroundings
from prolepsis.engine.sinking import LEAST_LIMIT, Overlaps
from prolepsis.engine.state import State
from prolepsis.engine.stretches import Matter, Movers, Stretch
from prolepsis.engine.touching import empty_contacts
from prolepsis.geometry.rotations import matrix, multiply, rotate
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.log import Contacts, Joints, Particles
from prolepsis.log.particle_tables import rounded
from prolepsis.scene.particles import PERIOD, ParticleState
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import InputError, brief_list

NOWHERE = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
"""The pose of what is where its carrier is, or has never been seen."""
BLOW = 2.5e-4
"""So long a blow between hard things counts as lasting [s], whatever the substep that it is spent in: wood on wood,
of some tens of grams at 1 to 3 m/s, lasts 0.2 to 0.3 ms (Hertz)."""
TOGETHER = 128
"""Ticks whose poses are computed together: they fit into a processor's cache."""


@dataclass(frozen=True, kw_only=True, slots=True)
class _Version:
    """What holds while the model stays the same."""

    carrier: IntArray
    offsets: FloatArray
    body_of: IntArray
    thing_of_geom: IntArray
    matter: Matter
    bodies: Movers
    holding: tuple[tuple[int, tuple[int, int]], ...]
    """Constraints that hold bodies of things together, and which."""


@dataclass(kw_only=True)
class Recorder:
    """Raw copies, in the order of time."""

    versions: list[_Version] = field(default_factory=list["_Version"])
    poses: list[tuple[int, FloatArray, FloatArray]] = field(default_factory=list[tuple[int, FloatArray, FloatArray]])
    contacts: list[tuple[int, int, float, IntArray, IntArray, FloatArray, FloatArray, FloatArray, float]] = field(
        default_factory=list[tuple[int, int, float, IntArray, IntArray, FloatArray, FloatArray, FloatArray, float]]
    )
    deep: list[tuple[int, int, IntArray, FloatArray]] = field(
        default_factory=list[tuple[int, int, IntArray, FloatArray]]
    )
    """Geoms and distances [m] of contacts in which solids overlap more than contacts usually do."""
    joints: dict[tuple[int, int], list[tuple[int, int]]] = field(
        default_factory=dict[tuple[int, int], list[tuple[int, int]]]
    )
    """What stuck to what, from which tick to before which."""
    held: dict[tuple[int, int], list[tuple[int, int]]] = field(
        default_factory=dict[tuple[int, int], list[tuple[int, int]]]
    )
    """What joints at points held to what, told or not, likewise."""
    wet: list[tuple[BoolArray, FloatArray]] = field(default_factory=list["tuple[BoolArray, FloatArray]"])
    """Whether a liquid pushes each body, and what each weighs [kg], at each tick of a run with liquids."""
    driven: dict[int, BoolArray] = field(default_factory=dict[int, BoolArray])
    """Which bodies a kind pushes that may add to their energy, by tick."""
    _seen: int = -1

    def note_version(self, state: State) -> None:
        """Keep the maps of a model that is new."""
        if self._seen == state.version:
            return
        self._seen = state.version
        body_of = np.zeros(len(state.carrier), dtype=np.int64)
        for body, thing in enumerate(state.body_thing):
            if thing >= 0:
                body_of[thing] = body
        self.versions.append(
            _Version(
                carrier=state.carrier.copy(),
                offsets=state.offsets.copy(),
                body_of=body_of,
                thing_of_geom=state.body_thing[state.model.geom_bodyid],
                matter=Matter.of(state.model, state.world.scene.things),
                bodies=Movers.of(state.model, body_of),
                holding=_holding(state),
            )
        )

    def substep(self, state: State, tick: int, step: float, *, blows: bool = False) -> None:
        """Copy the contacts of one substep of length ``step`` [s], in which ``blows`` may be spent whole."""
        data = state.data
        if data.ncon:
            contact, version = data.contact, len(self.versions) - 1
            geom, distance = contact.geom, contact.dist
            self.contacts.append(
                (
                    tick,
                    version,
                    step,
                    geom.copy(),
                    contact.efc_address.copy(),
                    contact.frame.copy(),
                    contact.pos.copy(),
                    data.efc_force.copy(),
                    min(1.0, step / BLOW) if blows else 1.0,
                )
            )
            # Of few numbers, Python's is the faster minimum.
            if min(distance.tolist()) < -LEAST_LIMIT:
                chosen = distance < -LEAST_LIMIT
                self.deep.append((tick, version, geom[chosen], distance[chosen]))

    def tick(self, state: State) -> None:
        """Copy the poses at the start of a tick."""
        state.renew_poses()
        if state.joints:
            _go_on(self.joints, state.joints, len(self.poses))
        version = self.versions[-1]
        if version.holding:
            active = state.data.eq_active.tolist()
            held = sorted({pair for number, pair in version.holding if active[number]})
            _go_on(self.held, held, len(self.poses))
        if state.particles is not None:
            self.wet.append((state.pushes.on(state.model.nbody, passes_on=True), state.model.body_mass.copy()))
        if state.pushes.drive:
            self.driven[len(self.poses)] = state.pushes.on(state.model.nbody, passes_on=False)
        self.poses.append((len(self.versions) - 1, state.data.xpos.copy(), state.data.xquat.copy()))

    def stretches(self) -> list[Stretch]:
        """Return from when to when the model stayed the same, and what could touch something then."""
        return [stretch for stretch, _ in self._stretches()]

    def _stretches(self) -> Iterator[tuple[Stretch, _Version]]:
        begins = np.searchsorted([row[0] for row in self.poses], np.arange(len(self.versions) + 1)).tolist()
        for version, start, end in zip(self.versions, begins, begins[1:], strict=False):
            if start < end:
                yield Stretch(start=start, end=end, matter=version.matter, bodies=version.bodies), version

    def matters(self) -> list[Matter]:
        """Return what could touch something in each model."""
        return [version.matter for version in self.versions]

    def overlaps(self) -> Overlaps:
        """Return the contacts in which solids overlapped deeply, one row each."""
        count = [len(row[2]) for row in self.deep]
        solids = [row[2] for row in self.deep]
        return Overlaps(
            tick=np.repeat(np.array([row[0] for row in self.deep], dtype=np.int64), count),
            version=np.repeat(np.array([row[1] for row in self.deep], dtype=np.int64), count),
            geoms=np.concatenate([np.zeros((0, 2), dtype=np.int64), *solids]),
            depth=-np.concatenate([np.zeros(0), *(row[3] for row in self.deep)]),
        )

    def surroundings(self, contacts: Contacts, particles: Particles) -> Surroundings:
        """Return what touched what, contacts and liquids being given."""
        shape = len(self.wet), len(self.versions[0].carrier)
        wet, mass = np.zeros(shape, dtype=np.bool_), np.zeros(shape)
        for tick, (pushed, heavy) in enumerate(self.wet):
            body_of = self.versions[self.poses[tick][0]].body_of
            wet[tick], mass[tick] = pushed[body_of], heavy[body_of]
        driven = np.zeros((len(self.poses) if self.driven else 0, shape[1]), dtype=np.bool_)
        for tick, pushed in self.driven.items():
            driven[tick] = pushed[self.versions[self.poses[tick][0]].body_of]
        return Surroundings(
            contacts=contacts,
            joints=(_joints(self.joints), _joints(self.held)),
            wet=wet,
            driven=driven,
            mass=mass,
            particles=particles,
        )

    def pose_columns(self) -> tuple[FloatArray, IntArray]:
        """Return poses, shape (T, n, 7), and carriers, shape (T, n)."""
        count = len(self.versions[0].carrier)
        poses = np.zeros((len(self.poses), count, 7))
        carriers = np.zeros((len(self.poses), count), dtype=np.int64)
        last = np.tile(NOWHERE, (count, 1))
        for stretch, version in self._stretches():
            carried = version.carrier >= 0
            apart = carried & (version.offsets != NOWHERE).any(axis=1)
            itself = carried & ~apart
            body = version.body_of[version.carrier]
            inner_p, inner_q = version.offsets[apart, :3], version.offsets[apart, 3:]
            for start in range(stretch.start, stretch.end, TOGETHER):
                ticks = slice(start, min(start + TOGETHER, stretch.end))
                position = np.array([row[1] for row in self.poses[ticks]])
                orientation = np.array([row[2] for row in self.poses[ticks]])
                block = poses[ticks]
                # Zeros have no sign.
                block[:, itself, :3] = position[:, body[itself]] + 0.0
                block[:, itself, 3:] = orientation[:, body[itself]] + 0.0
                outer_p, outer_q = position[:, body[apart]], orientation[:, body[apart]]
                block[:, apart, :3] = outer_p + rotate(outer_q, inner_p)
                block[:, apart, 3:] = multiply(outer_q, inner_q)
            # What is no body of its own keeps the pose at which it was last seen.
            poses[stretch.start : stretch.end, ~carried] = last[~carried]
            carriers[stretch.start : stretch.end] = version.carrier
            last = poses[stretch.end - 1]
        return poses, carriers

    def joint_columns(self) -> Joints:
        """Return one row for each time that two things stuck together."""
        return _joints(self.joints)

    def contact_columns(self, dt: float) -> Contacts:
        """Return one row for each pair of geoms and tick: forces averaged over the tick of length ``dt`` [s]."""
        if not self.contacts:
            return empty_contacts()
        counts = np.array([len(row[4]) for row in self.contacts])
        tick = np.repeat(np.array([row[0] for row in self.contacts]), counts)
        version = np.repeat(np.array([row[1] for row in self.contacts]), counts)
        step = np.repeat(np.array([row[2] for row in self.contacts]), counts)
        base = np.repeat(np.cumsum([0, *(len(row[7]) for row in self.contacts[:-1])]), counts)
        geoms = np.concatenate([row[3] for row in self.contacts])
        address = np.concatenate([row[4] for row in self.contacts])
        frame = np.concatenate([row[5] for row in self.contacts]).reshape(-1, 3, 3)
        point = np.concatenate([row[6] for row in self.contacts])
        efc = np.concatenate([row[7] for row in self.contacts])
        active = address >= 0
        tick, version, step = tick[active], version[active], step[active]
        geoms, frame, point = geoms[active], frame[active], point[active]
        local = efc[(base + address)[active][:, None] + np.arange(3)]
        force = np.einsum("cij,ci->cj", frame, local)
        normal_force = local[:, 0]
        things = np.zeros_like(geoms)
        for number, kept in enumerate(self.versions):
            chosen = version == number
            things[chosen] = kept.thing_of_geom[geoms[chosen]]
        flipped = things[:, 0] > things[:, 1]
        sign = np.where(flipped, -1.0, 1.0)
        low = np.where(flipped, things[:, 1], things[:, 0])
        high = np.where(flipped, things[:, 0], things[:, 1])
        keep = (normal_force > 0) & (low >= 0) & (low != high)
        first, second = np.where(flipped, geoms[:, 1], geoms[:, 0]), np.where(flipped, geoms[:, 0], geoms[:, 1])
        span = int(geoms.max(initial=0)) + 1
        key = ((tick * len(self.versions) + version) * span + first) * span + second
        # In one sort, in which substeps stay in their order; two calls of numpy's unique take three times as long.
        order = np.argsort(key[keep], kind="stable")
        begins = np.diff(key[keep][order], prepend=-1) != 0
        group = np.empty(len(order), dtype=np.int64)
        group[order] = np.cumsum(begins) - 1
        rows = np.stack([tick[keep], low[keep], high[keep]], axis=1)[order[begins]]
        size = len(rows)
        weight = (normal_force * step)[keep]
        total = np.bincount(group, weights=weight, minlength=size)

        def summed(values: FloatArray, factor: FloatArray) -> FloatArray:
            columns = [np.bincount(group, weights=values[:, k] * factor, minlength=size) for k in range(3)]
            return np.stack(columns, axis=1).astype(np.float64)

        normal = summed((frame[:, 0] * sign[:, None])[keep], weight)
        length = np.linalg.norm(normal, axis=1, keepdims=True)
        # The peak is that of the pair at one substep, so contact points of the same substep add up first.
        substep = np.repeat(np.arange(len(self.contacts)), counts)[active][keep]
        moments = begins | (np.diff(substep[order], prepend=-1) != 0)
        share = np.repeat(np.array([row[8] for row in self.contacts]), counts)[active]
        at_once = np.bincount(np.cumsum(moments) - 1, weights=(normal_force * share)[keep][order])
        peak = np.maximum.reduceat(at_once, np.flatnonzero(begins[moments])) if size else np.zeros(0)
        if (share < 1.0).any():
            peak = np.maximum(peak, total / dt)
        return Contacts(
            tick=rows[:, 0],
            a=rows[:, 1],
            b=rows[:, 2],
            force=summed((force * sign[:, None])[keep], step[keep]) / dt,
            normal=normal / np.where(length > 0, length, 1),
            point=summed(point[keep], weight) / total[:, None],
            peak=peak,
        )


def _holding(state: State) -> tuple[tuple[int, tuple[int, int]], ...]:
    """Return the constraints that hold bodies together when they are active, told or not, and the two things."""
    model = state.model
    chosen = np.flatnonzero(model.eq_objtype == int(mujoco.mjtObj.mjOBJ_BODY))
    things = state.body_thing[np.stack([model.eq_obj1id[chosen], model.eq_obj2id[chosen]], axis=1)]
    return tuple((k, (a, b)) for k, (a, b) in zip(chosen.tolist(), things.tolist(), strict=True) if a >= 0 and b >= 0)


def _go_on(known: dict[tuple[int, int], list[tuple[int, int]]], pairs: Iterable[tuple[int, int]], now: int) -> None:
    """Note the pairs of a tick: those of the tick before go on."""
    for pair in pairs:
        runs = known.setdefault(pair, [])
        start = runs.pop()[0] if runs and runs[-1][1] == now else now
        runs.append((start, now + 1))


def _joints(known: dict[tuple[int, int], list[tuple[int, int]]]) -> Joints:
    rows = sorted((start, end, *pair) for pair, runs in known.items() for start, end in runs)
    start, end, a, b = np.array(rows, dtype=np.int64).reshape(-1, 4).T
    return Joints(a=a, b=b, start=start, end=end)


@dataclass(kw_only=True)
class Frames:
    """Copies of the particles, in the order of time."""

    ticks: list[int] = field(default_factory=list[int])
    positions: list[npt.NDArray[np.float32]] = field(default_factory=list["npt.NDArray[np.float32]"])
    columns: list[dict[str, npt.NDArray[np.float32]]] = field(
        default_factory=list["dict[str, npt.NDArray[np.float32]]"]
    )
    holders: list[npt.NDArray[np.int16]] = field(default_factory=list["npt.NDArray[np.int16]"])

    def tick(self, state: State, tick: int) -> None:
        """Copy the particles, if it is time.

        Raises:
            InputError: If a kind has given them columns that are none.
        """
        if state.particles is None or tick % PERIOD:
            return
        self.ticks.append(tick)
        self.positions.append(rounded(_positions(state, state.particles)))
        self.holders.append(state.particles.holder.copy())
        columns, count = state.particles.columns, len(state.particles.mass)
        for name, column in columns.items():
            if column.shape != (count,):
                raise InputError(f"particles: {name} is of shape {column.shape}; needed: {(count,)}, one for each")
        if self.columns and {*columns} != {*self.columns[0]}:
            raise InputError(
                f"particles: at tick {tick} their columns are {brief_list(columns)}, at the start "
                f"{brief_list(self.columns[0])}; a kind adds its own when it starts, and keeps it"
            )
        self.columns.append({name: column.astype(np.float32) for name, column in columns.items()})

    def table(self, state: State) -> Particles:
        """Return the frames as columns of the log."""
        particles = state.particles
        if particles is None or not self.ticks:
            return Particles()
        return Particles(
            tick=np.array(self.ticks),
            position=np.stack(self.positions),
            holder=np.stack(self.holders),
            stuff=particles.stuff.copy(),
            mass=particles.mass.copy(),
            volume=particles.volume.copy(),
            columns={name: np.stack([row[name] for row in self.columns]) for name in self.columns[0]},
            spacing=particles.spacing,
        )


def _positions(state: State, particles: ParticleState) -> FloatArray:
    """Return where all particles are by now [m], shape (P, 3): those that are held are where what holds them is."""
    positions = particles.now()
    holders: list[int] = np.flatnonzero(np.bincount(particles.holder[particles.holder >= 0])).tolist()
    for holder in holders:
        pose, held = state.pose(state.scene.things[holder].name), particles.holder == holder
        positions[held] = pose[:3] + particles.home[held] @ matrix(pose[3:]).T
    return positions
