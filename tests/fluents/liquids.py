"""Logs of liquids made by hand: vessels of a turned outline or of a mesh, and particles put where they shall be."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from tests.fluents.logs import Draft

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import IDENTITY, FloatArray, Geom, Hole, Quaternion, Shape, Surface, Triple
from prolepsis.log.log import FREE, Action, Log, Particles
from prolepsis.log.things import FIXED, Thing
from prolepsis.log.timeline import Timeline

DT = 0.01
EVERY = 2
"""Ticks from frame to frame."""
D = 0.004
"""Spacing of the particles [m]."""
RADIUS, HEIGHT, WALL = 0.04, 0.09, 0.003
"""Outer radius, height and wall of a cup [m]."""
INNER = RADIUS - WALL
Profile = tuple[tuple[float, float], ...]
CUP: Profile = ((0.0, 0.0), (RADIUS, 0.0), (RADIUS, HEIGHT), (INNER, HEIGHT), (INNER, WALL), (0.0, WALL))
LIDDED: Profile = (
    (0.0, 0.0), (RADIUS, 0.0), (RADIUS, HEIGHT), (0.0, HEIGHT),
    (0.0, HEIGHT - WALL), (INNER, HEIGHT - WALL), (INNER, WALL), (0.0, WALL),
)  # fmt: skip
HOOP: Profile = ((INNER, 0.0), (RADIUS, 0.0), (RADIUS, HEIGHT), (INNER, HEIGHT))
DISH: Profile = ((0.0, 0.0), (0.1, 0.0), (0.1, 0.04), (0.097, 0.04), (0.097, 0.003), (0.0, 0.003))


def tilted(degrees: float) -> Quaternion:
    """Return a turn about the x axis."""
    half = math.radians(degrees) / 2
    return (math.cos(half), math.sin(half), 0.0, 0.0)


def vessel(
    name: str = "cup1",
    at: Triple = (0.0, 0.0, 0.0),
    *,
    profile: Profile = CUP,
    holes: Sequence[Hole] = (),
    turn: Quaternion = IDENTITY,
    mesh: bool = False,
) -> Thing:
    """Return a vessel whose shape is a profile, or the mesh of one."""
    shape = Shape(surface=lathe(profile)) if mesh else Shape(profile=profile, holes=tuple(holes))
    return Thing(name=name, kind="Cup", shape=shape, mass=0.1, position=at, orientation=turn)


def upturned(name: str = "cup1", at: Triple = (0.0, 0.0, HEIGHT), *, mesh: bool = False) -> Thing:
    """Return a cup that stands on its rim."""
    return vessel(name, at, turn=tilted(180.0), mesh=mesh)


def lathe(profile: Profile, sides: int = 32) -> Surface:
    """Return the closed surface of a profile turned round the z axis, of flat triangles."""
    vertices: list[Triple] = []
    rings: list[list[int]] = []
    for r, z in profile:
        count = 1 if r == 0.0 else sides
        rings.append(list(range(len(vertices), len(vertices) + count)))
        angles = [2 * math.pi * s / sides for s in range(count)]
        vertices += [(r * math.cos(a), r * math.sin(a), z) for a in angles]
    triangles: list[tuple[int, int, int]] = []
    for one, two in zip(rings, [*rings[1:], rings[0]], strict=True):
        for s in range(sides):
            a, b = one[s % len(one)], one[(s + 1) % len(one)]
            c, d = two[s % len(two)], two[(s + 1) % len(two)]
            triangles += [t for t in ((a, b, d), (a, d, c)) if len(set(t)) == 3]
    return Surface(vertices=tuple(vertices), triangles=tuple(triangles))


def table() -> Thing:
    """Return a table whose top is at zero."""
    shape = Shape(geoms=(Geom(type="box", size=(0.5, 0.5, 0.02)),))
    return Thing(name="table1", kind="Table", shape=shape, position=(0.0, 0.0, -0.02), mount=FIXED)


def liquid(name: str = "liq1") -> Thing:
    """Return a liquid."""
    return Thing(name=name, kind="Water", mass=0.1, roles=frozenset({"Stuff", "Liquid"}))


def block(low: Triple, high: Triple) -> FloatArray:
    """Return particles on a lattice between two corners [m], the first half a spacing from the lower one."""
    sides = [np.arange(a + D / 2, b - D / 2 + 1e-9, D) for a, b in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 3)


def poured(low: float = WALL, high: float = HEIGHT, *, radius: float = INNER) -> FloatArray:
    """Return the particles that fill a cylinder round the z axis between two heights, in its own frame."""
    return within(block((-radius, -radius, low), (radius, radius, high)), radius)


def within(points: FloatArray, radius: float) -> FloatArray:
    """Return the points whose particles do not reach beyond a radius."""
    return points[np.hypot(points[:, 0], points[:, 1]) <= radius - D / 2 + 1e-9]


def puddle(x: float = 0.2, y: float = 0.0, *, half: float = 0.02, z: float = 0.0, layers: int = 1) -> FloatArray:
    """Return particles that lie on a plane."""
    return block((x - half, y - half, z), (x + half, y + half, z + layers * D))


def placed(points: FloatArray, thing: Thing) -> FloatArray:
    """Return points of a thing's frame in the world."""
    w, *v = thing.orientation
    axis = np.array(v)
    twice = 2 * np.cross(axis, points)
    return points + w * twice + np.cross(axis, twice) + np.array(thing.position)


def level_in(thing: Thing, height: float, *, profile_radius: float = INNER, depth: float = HEIGHT) -> FloatArray:
    """Return the particles of a cup's inside that lie below a height in the world."""
    points = placed(poured(WALL, depth, radius=profile_radius), thing)
    return points[points[:, 2] <= height - D / 2 + 1e-9]


def wet(
    things: Sequence[Thing],
    liquids: Mapping[str, FloatArray],
    *,
    ticks: int = 50,
    holders: Mapping[str, FloatArray] | None = None,
    poses: Mapping[str, FloatArray] | None = None,
    actions: tuple[Action, ...] = (),
    lifts: Mapping[tuple[str, str], float] | None = None,
) -> Log:
    """Return the log of liquids whose particles stay, shape (n, 3), or go, shape (F, n, 3), as said.

    Args:
        things: The solids.
        liquids: Positions by the liquid's name.
        ticks: Length of the log.
        holders: Index of the thing that holds each particle by liquid, shape (F, n), where some is held.
        poses: Poses of the things that move, shape (T, 7).
        actions: What a robot did.
        lifts: Upward force [N] of one thing on another, all the time.
    """
    frames = -(-ticks // EVERY)
    every = [*things, *(liquid(name) for name in liquids)]
    draft = Draft(ticks, every)
    for name, moved in (poses or {}).items():
        draft.poses[:, draft.index(name)] = moved
    for (below, above), force in (lifts or {}).items():
        draft.rest(below, above, 0, ticks, force)
    position: list[FloatArray] = []
    stuff: list[int] = []
    holder: list[FloatArray] = []
    for name, points in liquids.items():
        there = np.broadcast_to(points, (frames, *points.shape[-2:]))
        position.append(there)
        stuff += [draft.index(name)] * there.shape[1]
        holder.append((holders or {}).get(name, np.full(there.shape[:2], FREE)))
    count = len(stuff)
    particles = Particles(
        tick=np.arange(frames) * EVERY,
        position=np.concatenate(position, axis=1).astype(np.float32),
        holder=np.concatenate(holder, axis=1).astype(np.int16),
        stuff=np.array(stuff, dtype=np.int64),
        mass=np.full(count, 1000 * D**3),
        volume=np.full(count, D**3),
        spacing=D,
    )
    log = draft.log(actions=actions)
    carrier = log.carrier.copy()
    carrier[:, len(things) :] = -1
    return replace(log, dt=DT, time=np.arange(ticks) * DT, particles=particles, carrier=carrier)


def says(timeline: Timeline, *types: str) -> set[str]:
    """Return the terms of the facts of some types; without types, of the fluents of liquids."""
    wanted = types or ("contains", "supports", "spilled", "absorbs")
    return {str(fact.term) for fact in timeline.facts if fact.type in wanted}


def judged(things: Sequence[Thing], liquids: Mapping[str, FloatArray]) -> set[str]:
    """Return what is said of liquids that stay where they are."""
    return {fact for fact in says(recognize(wet(things, liquids))) if "liq" in fact}
