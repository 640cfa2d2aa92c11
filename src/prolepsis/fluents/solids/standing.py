"""How near what stands at rest is to going over, or to sliding off: ``near_miss(toppling(a), ...)`` and ``moving(a)``.

What bears it presses in the middle below the centre of mass of all that it carries, shifted by what pushes it. Where
that point reaches the edge of what it stands on, it goes over; where it presses more along its base than friction
holds, it slides.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from prolepsis.fluents.intervals import drop_short, mask_of, runs, ticks_of, union
from prolepsis.fluents.margins import NearMiss, margin_of
from prolepsis.fluents.observation import Observation, is_loose
from prolepsis.fluents.registry import event
from prolepsis.fluents.solids.attachment import attachment_runs
from prolepsis.fluents.solids.contact import is_stuff
from prolepsis.fluents.solids.motion import moving_runs
from prolepsis.fluents.solids.support import supporters
from prolepsis.fluents.solids.tipping import tips
from prolepsis.fluents.solids.touch import UNDER_COSINE, touches
from prolepsis.geometry.rotations import rotate, rotate_back
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.geometry.solids import Solid, bounded, solid_of
from prolepsis.log.near import MARGIN, NEAR

REST = 0.1
"""Shortest rest in which something stands [s]."""
LOOK = 0.5
"""Time over which forces at rest are taken together [s]: what stands changes by what is put or poured on it."""
FLAT = 0.99
"""Cosine of the angle to their mean, 8 degrees, within which what bears a thing is one plane."""
GAP = 0.0005
"""Gap between two faces that lie on each other [m]: contacts sink in by less."""
DIRECTIONS = 24
"""Directions, evenly about, in which the edge is looked for."""
STEPS = 48
"""Points on each of them, before it is halved on to a micrometre."""
BORNE = 0.9
"""Least share of its weight [1] that its base bears: where something presses tells nothing if a liquid bears it."""
LEAST_BASE = 0.05
"""Least width of a base, as a share of the greatest radius of what stands on it [1]: less is an edge or a point."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Stand:
    """A time in which something stands at rest."""

    start: int
    """First tick."""
    end: int
    """First tick no longer."""
    overhang: float
    """How far the point at which it presses is from the middle of its base to the edge [1]: at 1 it goes over."""
    slope: float
    """How much it presses along its base, over what friction holds [1]: at 1 it slides."""


@event("toppling", "o")
def nearly_toppling(observation: Observation) -> Iterator[NearMiss]:
    """What stands at rest presses near the edge of its base."""
    over: dict[int, list[tuple[int, int]]] = {}
    for tip in observation.of(tips):
        over.setdefault(tip.standing.unit, []).append((tip.start, tip.end))
    for unit, several in observation.of(stands).items():
        margins = [stand.overhang for stand in several]
        yield from _nearly(observation, "toppling", unit, several, margins, over.get(unit, []))


@event("moving", "o")
def nearly_moving(observation: Observation) -> Iterator[NearMiss]:
    """What stands at rest is hardly held by friction."""
    moved = observation.of(moving_runs)
    for unit, several in observation.of(stands).items():
        margins = [stand.slope for stand in several]
        yield from _nearly(observation, "moving", unit, several, margins, moved[unit].tolist() if unit in moved else [])


def _nearly(
    observation: Observation,
    type: str,
    unit: int,
    several: list[Stand],
    margins: list[float],
    did: Iterable[Sequence[int]],
) -> Iterator[NearMiss]:
    """Yield the times in which it nearly goes over or slides, but those at the end of which it does."""
    ratio = np.zeros(observation.tick_count)
    for stand, margin in zip(several, margins, strict=True):
        ratio[stand.start : stand.end] = margin
    begun, brief = [each[0] for each in did], ticks_of(REST, observation.dt)
    for start, end in runs(ratio >= 1 - NEAR).tolist():
        margin = margin_of(ratio, start, end)
        if margin < 1 and not any(end - brief <= first <= end + brief for first in begun):
            what = "event", type, (observation.unit_names[unit],), (start, end)
            yield NearMiss(fact=observation.fact(*what, {MARGIN: margin}))


def stands(observation: Observation) -> dict[int, list[Stand]]:
    """Return when each unit stands at rest on a plane base, a stretch for each ``LOOK``."""
    return {unit: list(_stands(observation, unit)) for unit in observation.units}


def _stands(observation: Observation, unit: int) -> Iterator[Stand]:
    solids = bounded(observation.log.things[unit].shape)
    known = observation.of(supporters).get(unit, [])
    if not known or not solids or not is_loose(observation, unit) or is_stuff(observation, unit):
        return
    log, contacts = observation.log, observation.log.contacts
    several = [touch.rows for touch in observation.of(touches) if unit in (touch.a, touch.b)]
    rows = np.sort(np.concatenate(several))
    above = observation.unit[contacts.b[rows]] == unit
    normal = np.where(above[:, None], contacts.normal[rows], -contacts.normal[rows])
    bearing = normal @ observation.up >= UNDER_COSINE
    rows, normal = rows[bearing], normal[bearing]
    other = np.where(above[bearing], contacts.a[rows], contacts.b[rows])
    press = np.einsum("ci,ci->c", contacts.force[rows], contacts.normal[rows])
    along = contacts.force[rows] - press[:, None] * contacts.normal[rows]
    press = np.abs(press)
    # Of a model that others made it may not be known.
    friction = np.array([thing.quantities.get("friction", np.inf) for thing in log.things])
    last: tuple[FloatArray, float] | None = None
    for start, end in _looks(observation, unit, [stretches for _, stretches in known]):
        here = slice(*np.searchsorted(contacts.tick[rows], (start, end)).tolist())
        weight = press[here]
        own = float(observation.mass(unit)[start]) * observation.gravity * (end - start)
        borne = float(np.abs(contacts.force[rows[here]] @ observation.up).sum())
        if borne < max(BORNE * own, 1e-12):
            continue
        mean = weight @ normal[here] / weight.sum()
        mean /= max(float(np.linalg.norm(mean)), 1e-12)
        if float((normal[here] @ mean).min()) < FLAT:
            continue
        holds = np.minimum(friction[unit], friction[other[here]])
        slides = float(np.linalg.norm(along[here].sum(axis=0)) / max(float(weight @ holds), 1e-12))
        pose = log.poses[start, unit]
        point = rotate_back(pose[3:], weight @ contacts.point[rows[here]] / weight.sum() - pose[:3])
        if last is None or np.linalg.norm(point - last[0]) > GAP / 10:
            below = [(pose, solids), *_bodies(observation, np.unique(other[here]), start)]
            last = point, _overhang(point, rotate_back(pose[3:], mean), below)
        yield Stand(start=start, end=end, overhang=last[1], slope=slides)


def _looks(observation: Observation, unit: int, borne: list[IntArray]) -> Iterator[tuple[int, int]]:
    """Yield the stretches in which a unit rests on something and on nothing's edge, and nothing holds it."""
    count, dt = observation.tick_count, observation.dt
    busy = [stretches for (_, held), stretches in observation.of(attachment_runs).items() if held == unit]
    busy += [observation.of(moving_runs).get(unit, np.zeros((0, 2), dtype=np.int64))]
    busy += [np.array([[tip.start, tip.end]]) for tip in observation.of(tips) if tip.standing.unit == unit]
    at_rest = mask_of(union(borne), count) & ~mask_of(union(busy), count) & observation.exists(unit)
    step = ticks_of(LOOK, dt)
    for start, end in drop_short(runs(at_rest), ticks_of(REST, dt)).tolist():
        for first in range(start, end, step):
            yield first, min(first + step, end)


Body = tuple[FloatArray, tuple[Solid, ...]]
"""The pose of a thing, shape (7,), and its solids."""


def _bodies(observation: Observation, things: IntArray, tick: int) -> Iterator[Body]:
    for thing in map(int, things):
        solids = tuple(solid_of(geom) for geom in observation.log.things[thing].shape.geoms)
        if solids:  # Of what has an outline alone it is not looked for.
            yield observation.log.poses[tick, thing], solids


def _overhang(point: FloatArray, normal: FloatArray, bodies: list[Body]) -> float:
    """Return how far a point is from the middle of a base to its edge, where it is nearest to that [1].

    Args:
        point: Where something presses, in its frame [m], shape (3,).
        normal: Unit normal of its base, in its frame, shape (3,).
        bodies: It and all that bears it; its base is where it touches one of these.
    """
    solids = bodies[0][1]
    reach = 2 * max(radius_of(solids), float(np.linalg.norm(point)))
    first = np.linalg.svd(normal[None])[2][1]
    angles = np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS)
    directions = np.cos(angles)[:, None] * first + np.sin(angles)[:, None] * np.cross(normal, first)
    far = np.linspace(0.0, reach, STEPS + 1)
    touching = _touching(point + far[None, :, None] * directions[:, None], bodies)
    # The base is as wide as its outermost points, be it hollow between them.
    reached = touching.any(axis=1)
    low = np.where(reached, far[STEPS - np.argmax(touching[:, ::-1], axis=1)], 0.0)
    high = low + reach / STEPS
    while float((high - low).max()) > 1e-6:
        middle = (low + high) / 2
        inside = _touching(point + middle[:, None] * directions, bodies)
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    width = low + np.roll(low, DIRECTIONS // 2)
    wide = width >= LEAST_BASE * reach / 2
    return float((1 - 2 * low / np.maximum(width, 1e-12))[wide].max()) if wide.all() else 0.0


def radius_of(solids: tuple[Solid, ...]) -> float:
    """Return the greatest distance of solids from the origin of their frame [m]."""
    return max(float(np.abs(np.concatenate(solid.bounds())).max()) for solid in solids)


def _touching(points: FloatArray, bodies: list[Body]) -> BoolArray:
    """Return which points, in the frame of the first body, are at the surface of it and of another, shape (...)."""
    pose = bodies[0][0]
    flat = points.reshape(-1, 3)
    mine = np.min([solid.distance(flat) for solid in bodies[0][1]], axis=0) <= GAP
    world = rotate(pose[3:], flat) + pose[:3]
    theirs = np.zeros(len(flat), dtype=np.bool_)
    for there, solids in bodies[1:]:
        local = rotate_back(there[3:], world - there[:3])
        theirs |= np.min([solid.distance(local) for solid in solids], axis=0) <= GAP
    return (mine & theirs).reshape(points.shape[:-1])
