"""``tipping(a)``: what stood turns about an edge; ``toppling(a)``: its centre of mass is beyond that edge."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from prolepsis.fluents.intervals import close_gaps, mask_of, runs, ticks_of, union
from prolepsis.fluents.kinematics import climb_speeds
from prolepsis.fluents.margins import NearMiss
from prolepsis.fluents.observation import Observation, is_loose
from prolepsis.fluents.registry import event
from prolepsis.fluents.solids.attachment import attachment_runs
from prolepsis.fluents.solids.burden import laden_centre
from prolepsis.fluents.solids.contact import is_stuff
from prolepsis.fluents.solids.edges import ROLLING, Standing, standings
from prolepsis.fluents.solids.support import supporters
from prolepsis.geometry.rotations import rotate_back
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.geometry.solids import bounded
from prolepsis.log.near import MARGIN, NEAR
from prolepsis.log.timeline import Evidence, Fact

LEAST_ANGLE = float(np.radians(1.0))
"""Least angle of tipping [rad]: what slides rocks by a tenth of a degree."""
TURNING_SPEED = 0.02
"""Speed from which something turns [rad/s]: what starts from its edge is as fast after half a degree."""
STILL_SPEED = 0.004
"""Speed within one tick from which it does [rad/s]; it makes ends sharp."""
PAUSE = 0.1
"""Rest that does not end it [s], such as the turning point of what rocks."""
STOOD = 0.05
"""Time for which it has stood before [s], or been set down ..."""
SET_DOWN = 0.2
"""... that is, sunk no faster than this [m/s], as after a fall of 2 mm: what lands on an edge and slaps down does not
tip."""
ROLLED = 0.5
"""What turns so far without an edge [rad] before it rests has rolled."""
MOSTLY = 0.5
"""Share of its turning beyond half of its angle [1] that is about an edge."""
FACES = 2.5
"""What turns by more than so many times the angle between two of its faces rolls [1]: a hexagonal pencil, but no
brick."""
OUTER = 0.2
"""Corners that are nearer to the edge, as a share of the furthest [1], do not tell how its face lies ..."""
FAR = 0.5
"""... and some that are further than this lie in it, too [1]."""
DOWN = 0.8
"""What has turned by this share of its greatest angle [1] when something else begins to bear it is down."""
FURTHEST = 100.0
"""Margin of what is beyond its edge at once, as it is pushed over one [1]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Tip:
    """One time in which something tips."""

    standing: Standing
    """What does, and on what."""
    start: int
    """First tick."""
    end: int
    """First tick no longer."""
    angle: FloatArray
    """By how much it is turned from how it stood [rad], shape (T,); it is known within the time."""
    share: FloatArray
    """That over the angle at which its centre of mass is above the edge [1], shape (T,)."""

    @property
    def greatest(self) -> float:
        """The greatest angle [rad]."""
        return float(self.angle[self.start : self.end].max())

    @property
    def margin(self) -> float:
        """The greatest share [1]; of what goes over, its greatest angle over that at which it does."""
        share, angle = self.share[self.start : self.end], self.angle[self.start : self.end]
        if share.max() < 1:
            return float(share.max())
        # Of what is round, or is pushed on, the point at which it is borne moves, and with it the angle of balance.
        passes = float(angle[int(np.argmax(share >= 1))] / share[share >= 1][0])
        return max(1.0, self.greatest / max(passes, self.greatest / FURTHEST))

    @property
    def result(self) -> str:
        """Whether it went ``over``, came ``back``, is left ``leaning``, or came ``off`` the edge; or ``unfinished``."""
        angles = self.angle[self.start : self.end]
        if self.margin >= 1 and angles[-1] > angles.max() / 2:
            return "over"
        stands = bool(self.standing.touching[min(self.end, len(self.angle) - 1)])
        if stands and angles[int(np.argmax(angles)) :].min() <= angles.max() / 2:
            return "back"
        if self.end >= len(self.angle) - 1:
            return "unfinished"
        return "leaning" if stands else "off"


Bearer = tuple[Standing, BoolArray]
"""How a unit stands on something, and when that bears it, shape (T,)."""


@event("tipping", "o")
def tipping(observation: Observation) -> Iterator[Fact]:
    """What stood turns about an edge, until it has fallen over, is back, or rests on the edge."""
    for tip in observation.of(tips):
        name = observation.unit_names[tip.standing.unit]
        stretch = tip.start, tip.end
        yield observation.fact("event", "tipping", (name,), stretch, _evidence(observation, tip))


@event("toppling", "o")
def toppling(observation: Observation) -> Iterator[Fact | NearMiss]:
    """What tips has its centre of mass beyond the edge, and goes over."""
    for tip in observation.of(tips):
        what = "event", "toppling", (observation.unit_names[tip.standing.unit],)
        evidence = _evidence(observation, tip)
        over = tip.share[tip.start : tip.end] >= 1.0
        if tip.result == "over":
            yield observation.fact(*what, (tip.start + int(np.argmax(over)), tip.end), evidence)
        elif 1.0 - NEAR <= tip.margin < 1.0:
            close = np.flatnonzero(tip.share[tip.start : tip.end] >= 1.0 - NEAR)
            stretch = tip.start + int(close[0]), tip.start + int(close[-1]) + 1
            yield NearMiss(fact=observation.fact(*what, stretch, {MARGIN: tip.margin}))


def _evidence(observation: Observation, tip: Tip) -> Evidence:
    standing = tip.standing
    evidence: dict[str, float | str] = {
        "edge": observation.unit_names[observation.unit[standing.below]],
        "result": tip.result,
        "angle": tip.greatest,
        MARGIN: tip.margin,
    }
    return evidence


def tips(observation: Observation) -> tuple[Tip, ...]:
    """Return whenever something tips, by thing and time."""
    found: list[Tip] = []
    for unit in observation.units:
        if is_loose(observation, unit) and not is_stuff(observation, unit) and _tilts(observation, unit):
            bearers = _bearers(observation, unit)
            found += _apart([tip for bearer in bearers for tip in _tips(observation, bearer, bearers)])
    return tuple(found)


def _bearers(observation: Observation, unit: int) -> list[Bearer]:
    """Return what ever bears a noticeable share of a unit's weight: what only lies against it is no edge."""
    known, count = dict(observation.of(supporters).get(unit, [])), observation.tick_count
    several = [(standing, int(observation.unit[standing.below])) for standing in standings(observation, unit)]
    return [(standing, mask_of(known[base], count)) for standing, base in several if base in known]


def _tilts(observation: Observation, unit: int) -> bool:
    """Return whether a unit is ever turned by as much as counts."""
    up = rotate_back(observation.log.poses[:, unit, 3:], observation.up)
    return bool(np.ptp(up, axis=0).max() > LEAST_ANGLE / 2)


def _apart(several: list[Tip]) -> list[Tip]:
    """Return the tips in order; of those at the same time, about edges of several things, the longest."""
    kept: list[Tip] = []
    for tip in sorted(several, key=lambda each: each.start - each.end):
        if all(tip.end <= other.start or other.end <= tip.start for other in kept):
            kept.append(tip)
    return sorted(kept, key=lambda each: each.start)


def _tips(observation: Observation, bearer: Bearer, bearers: list[Bearer]) -> Iterator[Tip]:
    (standing, borne), dt, count = bearer, observation.dt, observation.tick_count
    base = int(observation.unit[standing.below])
    held = [stretches for (_, unit), stretches in observation.of(attachment_runs).items() if unit == standing.unit]
    free = standing.touching & observation.exists(standing.unit) & ~mask_of(union(held), count)
    turning = (standing.speed(dt) > TURNING_SPEED) & (standing.step() > STILL_SPEED * dt)
    slow = standing.touching | (observation.of(climb_speeds)[standing.unit] > -SET_DOWN)
    on_edge = standing.on_edge(dt)
    about = standing.about_edge(on_edge)
    several = close_gaps(runs(turning & free), ticks_of(PAUSE, dt))
    # What has come to lie on something else has fallen over.
    others = [stretches for below, stretches in observation.of(supporters).get(standing.unit, []) if below != base]
    alone = ~mask_of(union(others), count)
    for start, end in _held_up(standing, several, free & about & alone).tolist():
        for first, last in _about_one(standing, start, end, on_edge):
            if borne[first:last].any() and _stood(slow & ~turning, first, dt):
                tip = _landed(_measured(observation, standing, bearers, (first, last), on_edge, about), ~alone)
                turned = float(tip.angle[start:end].max())
                if tip.margin > 0 and tip.greatest >= LEAST_ANGLE and not _rolls(tip, turned, on_edge):
                    yield tip


def _landed(tip: Tip, others: BoolArray) -> Tip:
    """Return what goes over until something else begins to bear it: it may well creep on from there."""
    begins = [tick for tick in (runs(others[tip.start : tip.end])[:, 0] + tip.start).tolist() if tick > tip.start]
    down = [tick for tick in begins if tip.angle[tick] >= DOWN * tip.greatest]
    return replace(tip, end=down[0]) if tip.margin >= 1 and down else tip


def _about_one(standing: Standing, start: int, end: int, on_edge: BoolArray) -> Iterator[tuple[int, int]]:
    """Yield the times within a run of turning in which it turns about an edge, without how it rolls up to it and on.

    The jolts of its setting out and of its landing belong to it.
    """
    stretches: list[list[int]] = []
    for first, last in (runs(on_edge[start:end]) + start).tolist():
        if stretches and _rotation(standing, stretches[-1][1] - 1, first) < ROLLED:
            stretches[-1][1] = last
        else:
            stretches.append([first, last])
    for first, last in stretches:
        sets_out, lands = _rotation(standing, start, first) < ROLLED, _rotation(standing, last - 1, end - 1) < ROLLED
        yield start if sets_out else first, end if lands else last


def _held_up(standing: Standing, several: IntArray, about: BoolArray) -> IntArray:
    """Return the runs of turning, those as one between which it rests on its edge, as a finger holds it up."""
    joined: list[list[int]] = []
    for start, end in several.tolist():
        if joined:
            first, last = joined[-1]
            angles = _angles(standing.upright[first:start], standing.upright[first])
            if about[last:start].all() and angles[-1] > max(LEAST_ANGLE, float(angles.max()) / 2):
                joined[-1][1] = end
                continue
        joined.append([start, end])
    return np.array(joined, dtype=np.int64).reshape(-1, 2)


def _rotation(standing: Standing, first: int, last: int) -> float:
    return float(_angles(standing.upright[last], standing.upright[first]))


def _stood(still: BoolArray, start: int, dt: float) -> bool:
    """Return whether it did not turn before it began to, or does at the beginning of the log."""
    before = ticks_of(STOOD, dt)
    return start <= before // 2 or bool(still[max(start - before, 0) : start].mean() > 0.9)


def _measured(
    observation: Observation,
    standing: Standing,
    bearers: list[Bearer],
    stretch: tuple[int, int],
    on_edge: BoolArray,
    about: BoolArray,
) -> Tip:
    start, end = stretch
    flat = _flat(observation, standing, start + int(np.argmax(on_edge[start:end])), end)
    angle = _angles(standing.upright, flat)
    # On which side, seen from the edge, its centre of mass was: there its face is down.
    side = _unit(_beside(standing.upright - np.cos(angle)[:, None] * flat, standing.up))
    centre = laden_centre(observation, standing.unit, start)
    inside = _inside(centre - standing.point, side, standing.up)
    # It does not go over before its centre of mass is beyond all that bears it.
    for other, borne in bearers:
        further = np.maximum(inside, _inside(centre - other.point, side, standing.up))
        inside = np.where(borne & other.touching, further, inside)
    balance = np.maximum(angle + inside, angle / FURTHEST)
    # What is below may turn under what lies still.
    own = _angles(standing.up, standing.up[start]) + _angles(standing.upright[start], flat)
    turned = np.minimum(angle, own)
    share = np.where(about & standing.pressing & (turned >= LEAST_ANGLE / 2), turned / np.maximum(balance, 1e-12), 0.0)
    return Tip(standing=standing, start=start, end=end, angle=turned, share=share)


def _inside(arm: FloatArray, side: FloatArray, up: FloatArray) -> FloatArray:
    """Return by which angle what is at the end of an arm is on one side of where that begins [rad], shape (T,)."""
    return np.arctan2(_dots(arm, side), _dots(arm, up))


def _rolls(tip: Tip, turned: float, on_edge: BoolArray) -> bool:
    """Return whether it does not turn about one edge, but, by as much as it ``turned`` [rad], about ever another."""
    during = slice(tip.start, tip.end)
    angle, upright, point = tip.angle[during], tip.standing.upright[during], tip.standing.point[during]
    high = angle >= angle.max() / 2
    step = _angles(upright[1:], upright[:-1])
    if step[high[1:] & on_edge[during][1:]].sum() < MOSTLY * step[high[1:]].sum():
        return True
    arm = np.linalg.norm(tip.standing.centre - point, axis=1)
    # Where it comes to the next edge.
    corners = np.flatnonzero(np.linalg.norm(np.diff(point, axis=0), axis=1) > ROLLING * arm[1:]) + 1
    bounds = [0, *corners.tolist(), len(angle)]
    longest = max(float(np.ptp(angle[a:b])) for a, b in itertools.pairwise(bounds) if b > a)
    return turned > FACES * longest


def _flat(observation: Observation, standing: Standing, start: int, end: int) -> FloatArray:
    """Return what would be up in the body if the face that is nearest to what is below lay on it, shape (3,)."""
    upright, normal = standing.upright[start], standing.normal[start]
    most = start + int(np.argmax(_angles(standing.upright[start:end], upright)))
    direction = _unit(_beside(standing.upright[most], upright))
    solids = bounded(observation.log.things[standing.unit].shape)
    corners = np.concatenate([solid.corners @ solid.rotation.T + solid.position for solid in solids])
    away = corners - standing.point[start]
    raised: list[tuple[float, FloatArray]] = []
    for side in (direction, -direction):
        ahead = away @ _unit(_beside(side, normal))
        furthest = np.linalg.norm(away, axis=1).max()
        angles = np.arctan2(away @ normal, ahead)
        near, far = ahead > OUTER * furthest, ahead > FAR * furthest
        # Of what is round, as an egg, the further corners lie the higher: it has no face.
        if far.any() and angles[far].min() < angles[near].min() + LEAST_ANGLE:
            raised.append((float(angles[near].min()), side))
    angle, side = min(raised, key=lambda each: each[0], default=(0.0, direction))
    if angle < LEAST_ANGLE / 2:
        return upright
    return np.cos(angle) * upright - np.sin(angle) * side


def _dots(first: FloatArray, second: FloatArray) -> FloatArray:
    return np.einsum("...c,...c->...", first, second)


def _unit(vectors: FloatArray) -> FloatArray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)


def _beside(vectors: FloatArray, axis: FloatArray) -> FloatArray:
    """Return what of vectors is square to unit vectors."""
    return vectors - _dots(vectors, axis)[..., None] * axis


def _angles(directions: FloatArray, other: FloatArray) -> FloatArray:
    """Return the angles of unit vectors to another [rad], shape (...)."""
    half = np.linalg.norm(directions - other, axis=-1) / 2.0
    return 2.0 * np.arcsin(np.minimum(half, 1.0))
