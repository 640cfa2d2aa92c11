"""Small logs made by hand: an egg that falls from a flap and breaks, and a liquid beside it, without any simulator."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from prolepsis.geometry.shape import FloatArray, Geom, Hole, Shape, Surface
from prolepsis.log.log import FREE, PARKED, Action, Contacts, Detachments, Log, Particles
from prolepsis.log.particle_tables import rounded
from prolepsis.log.things import FIXED, WITHIN, Thing
from prolepsis.terms.terms import Term

DT = 0.001
TICKS = 800
FALL, LAND = 200, 500
"""Ticks at which the egg loses its support and reaches the floor."""


def egg_things() -> tuple[Thing, ...]:
    """Return a floor, an egg with shell, yolk, two pieces and a blob, and a flap."""
    egg = Shape(geoms=(Geom(type="ellipsoid", size=(0.022, 0.022, 0.0285)),), colour=(0.9, 0.8, 0.7, 1.0))
    cap = tuple((0.02 * np.cos(i), 0.02 * np.sin(i), 0.01 * (i % 3)) for i in range(9))
    piece = Shape(geoms=(Geom(type="mesh", vertices=cap),))
    blob = Shape(geoms=(Geom(type="sphere", size=(0.01, 0.0, 0.0)),), colour=(0.9, 0.7, 0.1, 1.0))
    box = Shape(geoms=(Geom(type="box", size=(0.1, 0.1, 0.005)),))
    floor = Shape(geoms=(Geom(type="plane", size=(2.0, 2.0, 0.1)),))
    return (
        Thing(name="floor", kind="Floor", shape=floor, mount=FIXED, roles=frozenset({"Floor"})),
        Thing(
            name="egg1",
            kind="Egg",
            shape=egg,
            mass=0.058,
            roles=frozenset({"Egg", "Breakable"}),
            quantities={"friction": 0.4, "breakingForce": 37.0},
        ),
        Thing(name="eggshell1", kind="EggShell", whole="egg1", mass=0.006, roles=frozenset({"EggShell"})),
        Thing(name="yolk1", kind="Yolk", whole="egg1", mass=0.018, roles=frozenset({"Stuff"})),
        Thing(
            name="eggshell1/piece0",
            kind="Piece",
            shape=piece,
            whole="eggshell1",
            mount=WITHIN,
            roles=frozenset({"Piece"}),
        ),
        Thing(
            name="eggshell1/piece1",
            kind="Piece",
            shape=piece,
            whole="eggshell1",
            mount=WITHIN,
            roles=frozenset({"Piece"}),
        ),
        Thing(name="yolk1/blob0", kind="Blob", shape=blob, whole="yolk1", mount=WITHIN, roles=frozenset({"Blob"})),
        Thing(name="flap1", kind="Flap", shape=box, position=(0.0, 0.0, 0.5), roles=frozenset({"Table"})),
    )


def egg_drop_log() -> Log:
    """Return the log of an egg that rests on a flap, falls, and breaks on the floor."""
    things = egg_things()
    n = len(things)
    time: FloatArray = np.arange(TICKS, dtype=np.float64) * DT
    poses = np.zeros((TICKS, n, 7))
    poses[:, :, 3] = 1.0
    start = 0.505 + 0.0285
    fallen = np.clip(np.arange(TICKS) - FALL, 0, LAND - FALL) * DT
    height = np.maximum(start - 0.5 * 9.81 * fallen**2, 0.0285)
    poses[:, 1:7, 2] = height[:, None]
    # Afterwards the pieces and the yolk lie apart.
    poses[LAND:, 4, :3] = (0.03, 0.0, 0.0)
    poses[LAND:, 5, :3] = (-0.03, 0.01, 0.0)
    poses[LAND:, 6, :3] = (0.0, 0.0, 0.01)
    poses[:, 7, 2] = np.where(np.arange(TICKS) < FALL, 0.5, 0.1)
    poses[FALL:, 7, 0] = 0.4
    carrier = np.empty((TICKS, n), dtype=np.int64)
    carrier[:] = (0, 1, 1, 1, 1, 1, 1, 7)
    carrier[LAND:] = (0, -1, -1, -1, 4, 5, 6, 7)
    return Log(
        dt=DT,
        things=things,
        time=time,
        poses=poses,
        carrier=carrier,
        contacts=_contacts(),
        happenings=Detachments(
            tick=np.array([LAND]), thing=np.array([1]), a=np.array([4]), b=np.array([5]), force=np.array([38.5])
        ).happenings(),
        channels={"egg1.load": np.where(np.arange(TICKS) == LAND, 1.0, 0.1)},
        actions=(
            Action(term=Term("wait", (0.8,)), arguments={"duration": 0.8}, start=0, end=TICKS, evidence={"asked": 0.8}),
        ),
    )


def _contacts() -> Contacts:
    weight = 0.058 * 9.81
    resting = np.arange(FALL)
    after = np.arange(LAND + 1, TICKS)
    tick = np.concatenate([resting, [LAND], np.repeat(after, 3)]).astype(np.int64)
    count = len(tick)
    a = np.zeros(count, dtype=np.int64)
    b = np.concatenate([np.full(FALL, 7), [1], np.tile([4, 5, 6], len(after))]).astype(np.int64)
    # The row's first thing has the lower number, so on the flap the egg is `a` and presses the flap down.
    a[:FALL] = 1
    up = np.ones(count)
    up[:FALL] = -1.0
    size: FloatArray = np.zeros(count)
    size[:FALL], size[FALL], size[FALL + 1 :] = weight, 38.5, weight / 3
    force = np.zeros((count, 3))
    force[:, 2] = up * size
    normal = np.zeros((count, 3))
    normal[:, 2] = up
    point = np.zeros((count, 3))
    point[:FALL, 2] = 0.505
    return Contacts(tick=tick, a=a, b=b, force=force, normal=normal, point=point, peak=size)


def wet_log() -> Log:
    """Return the log of a dropped egg beside which a liquid falls past a cup with a hole and a mesh."""
    cup = Shape(
        profile=((0.0, 0.0), (0.03, 0.0), (0.03, 0.05), (0.0275, 0.05), (0.0275, 0.003), (0.0, 0.003)),
        holes=(Hole(position=(0.03, 0.0, 0.02), direction=(-1.0, 0.0, 0.0), radius=0.004),),
    )
    corners = ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    mesh = Shape(surface=Surface(vertices=corners, triangles=((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))))
    dry = egg_drop_log()
    more = (
        Thing(name="cup1", kind="Cup", shape=cup),
        Thing(name="vase1", kind="Vase", shape=mesh),
        Thing(name="liq1", kind="Water", mass=0.003, roles=frozenset({"Stuff", "Liquid"})),
    )
    still = np.zeros((dry.tick_count, len(more), 7))
    still[:, :, 3] = 1.0
    carriers = np.tile(np.array([8, 9, -1]), (dry.tick_count, 1))
    return replace(
        dry,
        things=(*dry.things, *more),
        poses=np.concatenate((dry.poses, still), axis=1),
        carrier=np.concatenate((dry.carrier, carriers), axis=1),
        particles=particles(),
    )


def particles(*, frames: int = 40, count: int = 30) -> Particles:
    """Return particles of one liquid that fall, a third of which are absorbed and a few parked."""
    random = np.random.default_rng(5)
    time = np.arange(frames)[:, None] * 0.02
    position = random.random((1, count, 3)) * np.array([0.1, 0.1, 0.5]) - 0.5 * 9.81 * time[..., None] ** 2
    holder = np.full((frames, count), FREE, dtype=np.int16)
    holder[30:, : count // 3] = 7
    holder[35:, -3:] = PARKED
    return Particles(
        tick=np.arange(frames) * 20,
        position=rounded(position),
        holder=holder,
        stuff=np.full(count, 10),
        mass=np.full(count, 1e-4),
        volume=np.full(count, 1e-7),
        spacing=0.00464,
    )
