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
from prolepsis.fluents.solids.base import GAP, Bearer, overhang, radius_of
from prolepsis.fluents.solids.contact import is_stuff
from prolepsis.fluents.solids.motion import moving_runs
from prolepsis.fluents.solids.support import supporters
from prolepsis.fluents.solids.tipping import tips
from prolepsis.fluents.solids.touch import UNDER_COSINE, touches
from prolepsis.geometry.rotations import rotate_back
from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.geometry.solids import bounded, solid_of
from prolepsis.log.near import MARGIN, NEAR

REST = 0.1
"""Shortest rest in which something stands [s]."""
LOOK = 0.5
"""Time over which forces at rest are taken together [s]: what stands changes by what is put or poured on it."""
FLAT = 0.99
"""Cosine of the angle to their mean, 8 degrees, within which what bears a thing is one plane."""
MOVED = 5.0e-5
"""What presses within this distance of where it did [m] does so still."""
BARELY = 0.01
"""Share of all that bears a thing [1] below which one that touches it does not tell how high its base is."""
BORNE = 0.9
"""Least share of its weight [1] that its base bears: where something presses tells nothing if a liquid bears it."""


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
        if observation.has_role(unit, "Piece"):
            continue  # What lies about in shards rocks at most.
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
        pose = log.poses[end - 1, unit]
        point = rotate_back(pose[3:], weight @ contacts.point[rows[here]] / weight.sum() - pose[:3])
        if last is None or np.linalg.norm(point - last[0]) > MOVED:
            now = other[here], weight, contacts.point[rows[here]]
            below = _bearers(observation, unit, end - 1, now)
            last = point, overhang(point, rotate_back(pose[3:], mean), (pose, solids), below) if below else 0.0
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


def _bearers(
    observation: Observation, unit: int, tick: int, contacts: tuple[IntArray, FloatArray, FloatArray]
) -> list[Bearer]:
    """Return what bears a unit, or would as soon as it leans that way, and where.

    Args:
        observation: The log.
        unit: What stands.
        tick: When.
        contacts: With what it is in contact, by which force, and where in the world.
    """
    below, weight, points = contacts
    pose, found = observation.log.poses[tick, unit], list[Bearer]()
    for thing in map(int, _near(observation, unit, tick)):
        own = below == thing
        if weight[own].sum() < BARELY * weight.sum():
            own[:] = True
        middle = weight[own] @ points[own] / weight[own].sum()
        solids = tuple(solid_of(geom) for geom in observation.log.things[thing].shape.geoms)
        found.append(
            Bearer(body=(observation.log.poses[tick, thing], solids), point=rotate_back(pose[3:], middle - pose[:3]))
        )
    return found


def _near(observation: Observation, unit: int, tick: int) -> IntArray:
    """Return the other bodies that a unit may touch. Of what has an outline alone it is not looked for."""
    reach, where = observation.of(reaches), observation.log.poses[tick, :, :3]
    apart = np.linalg.norm(where - where[unit], axis=1) - reach
    own = observation.unit == unit
    carried = observation.log.carrier[tick] != np.arange(len(own))
    return np.flatnonzero((apart <= reach[unit] + GAP) & ~own & ~carried & (reach >= 0))


def reaches(observation: Observation) -> FloatArray:
    """Return how far each solid thing reaches from the origin of its frame [m]; -1 for others, shape (N,)."""
    found = np.full(len(observation.log.things), -1.0)
    for i, thing in enumerate(observation.log.things):
        if thing.shape.geoms and not is_stuff(observation, int(observation.unit[i])):
            solids = bounded(thing.shape)
            found[i] = np.sqrt(3) * radius_of(solids) if len(solids) == len(thing.shape.geoms) else np.inf
    return found
