"""``flowingOut(c, x)`` and ``flowingOnto(x, o)``: a liquid leaves a vessel, and it comes to something."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from prolepsis.fluents.intervals import close_gaps, runs, ticks_of
from prolepsis.fluents.liquids.particle_locations import Inside, ParticleLocations, particle_locations
from prolepsis.fluents.nesting import nesting
from prolepsis.fluents.observation import Observation, named
from prolepsis.fluents.registry import event
from prolepsis.fluents.solids.containment import NOTICEABLE_FRACTION
from prolepsis.geometry.rotations import rotate
from prolepsis.geometry.shape import BoolArray, IntArray
from prolepsis.log.log import FREE, PARKED
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact

STREAM_WINDOW = 0.3
"""Time over which a stream is looked at [s]: drops that follow each other within it are one stream."""
STREAM_SHARE = 0.005
"""Least share of the liquid [1] that passes within that time in a stream; what comes more slowly drips."""
BELOW_RIM = 1.0
"""A particle that leaves lower than so many spacings below the rim's lowest point came through a hole [1]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Passages:
    """Particles of one liquid that pass from one place to another."""

    frame: IntArray
    """Frame of each, ascending, shape (N,)."""
    particle: IntArray
    """Shape (N,)."""


@event("flowingOut", "o1", "o2")
def flowing_out(observation: Observation) -> Iterator[Fact]:
    """The stuff o2 streams out of a cavity of o1, over its rim or through a hole."""
    seen = observation.of(particle_locations)
    if seen is None:
        return
    from prolepsis.fluents.kernels.streams import departures

    loose = seen.particles.holder == FREE
    for inside in seen.inside:
        left = departures(inside.hollow, inside.near, loose & ~_carried(observation, seen, inside))
        for stuff in seen.stuffs():
            passages = _of_stuff(seen, left, stuff)
            for start, end, during in streams(observation, seen, passages):
                evidence = evidence_of(seen, passages, during, stuff)
                evidence |= _exit_shares(observation, seen, inside, passages, during)
                evidence |= _state(observation, seen, inside, start, end)
                names = observation.unit_names[inside.unit], observation.unit_names[stuff]
                yield observation.fact("event", "flowingOut", names, (start, end), evidence)


@event("flowingOnto", "o1", "o2")
def flowing_onto(observation: Observation) -> Iterator[Fact]:
    """The stuff o1, or more of it, comes to o2: on it, or into its cavity."""
    seen = observation.of(particle_locations)
    if seen is None:
        return
    at = _whereabouts(observation, seen)
    if (at == at[0]).all():
        return
    from prolepsis.fluents.kernels.streams import arrivals

    came = arrivals(at)
    onto = at[came[:, 0], came[:, 1]]
    units: list[int] = sorted(set(onto.tolist()))
    for unit in units:
        here = came[onto == unit]
        for stuff in seen.stuffs():
            passages = _of_stuff(seen, here[:, :2], stuff)
            whence = here[seen.particles.stuff[here[:, 1]] == stuff]
            whence = whence[np.argsort(whence[:, 0], kind="stable"), 2]
            for start, end, during in streams(observation, seen, passages):
                evidence = evidence_of(seen, passages, during, stuff)
                evidence |= _sources(observation, seen, passages, during, whence)
                args = observation.unit_names[stuff], observation.unit_names[unit]
                yield observation.fact("event", "flowingOnto", args, (start, end), evidence)


def _carried(observation: Observation, seen: ParticleLocations, outer: Inside) -> BoolArray:
    """Return which particles are in a vessel that is in another: what that carries out does not flow, (F, P)."""
    found = np.zeros_like(outer.pool)
    for inner in seen.inside:
        both = outer.hollow & inner.pool
        if inner is not outer and both.any():
            found |= both & nesting(observation, inner.unit, outer.unit).dips[seen.particles.tick][:, None]
    return found


def _whereabouts(observation: Observation, seen: ParticleLocations) -> IntArray:
    """Return the unit that each particle is in or on, -1 for none, shape (F, P); of nested vessels the innermost."""
    at = np.where(seen.manner > 0, seen.on, -1).astype(np.int64)
    holder = seen.particles.holder
    for inside in reversed(seen.inside):
        # What already touches something else within an open hollow is with that, unless it is in the pool.
        at[inside.pool | (inside.hollow & (seen.manner == 0))] = inside.unit
    at[holder >= 0] = observation.of(named)[observation.unit[holder[holder >= 0]]]
    at[holder == PARKED] = -1
    return at


def _of_stuff(seen: ParticleLocations, rows: IntArray, stuff: int) -> Passages:
    rows = rows[seen.particles.stuff[rows[:, 1]] == stuff]
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    return Passages(frame=rows[:, 0], particle=rows[:, 1])


def streams(
    observation: Observation, seen: ParticleLocations, passages: Passages
) -> Iterator[tuple[int, int, BoolArray]]:
    """Yield the streams among passages: first tick, first tick no longer, and which passages belong to it."""
    if not len(passages.frame):
        return
    tick = seen.particles.tick
    frame_count = len(tick)
    passed = np.zeros(frame_count + 1)
    np.add.at(passed, passages.frame + 1, seen.share[passages.particle])
    total = np.cumsum(passed)
    window = ticks_of(STREAM_WINDOW, observation.dt)
    before = np.searchsorted(tick, tick - window, side="right")
    after = np.minimum(np.searchsorted(tick, tick + window), frame_count)
    now = np.arange(frame_count)
    # A stream begins and ends sharply: one side of the frame is in it.
    lately, soon = total[now + 1] - total[np.minimum(before, now)], total[after] - total[now]
    strong = (np.maximum(lately, soon) >= STREAM_SHARE) & (passed[1:] > 0)
    longest = max(1, int(np.searchsorted(tick, window)))
    for first, last in close_gaps(runs(strong), longest).tolist():
        during = (passages.frame >= first) & (passages.frame < last)
        if seen.share[passages.particle[during]].sum() < NOTICEABLE_FRACTION - 1e-9:
            continue
        end = int(tick[last]) if last < frame_count else observation.tick_count
        yield int(tick[first]), end, during


def evidence_of(seen: ParticleLocations, passages: Passages, during: BoolArray, stuff: int) -> dict[str, float | str]:
    # A particle that splashes to and fro counts once.
    particles = np.unique(passages.particle[during])
    fraction = min(float(seen.share[particles].sum()), 1.0)
    passed = float(seen.share[passages.particle[during]].sum())
    return {"fraction": fraction, "volume": fraction * seen.volume(stuff), MARGIN: passed / NOTICEABLE_FRACTION}


def _exit_shares(
    observation: Observation, seen: ParticleLocations, inside: Inside, passages: Passages, during: BoolArray
) -> dict[str, float | str]:
    """Return the shares of what leaves over the rim and through holes.

    What leaves fast is deep in the hollow in one frame and far above the rim in the next, so its whole way counts.
    """
    frame, particle = passages.frame[during], passages.particle[during]
    through = np.ones(len(frame), dtype=np.bool_)
    at, going = frame.copy(), np.arange(len(frame))
    while len(going):
        now, who = at[going], particle[going]
        # Without a spill level nothing is kept, and whatever leaves runs out over the rim.
        rim = np.nan_to_num(inside.brim(now), nan=-np.inf) - BELOW_RIM * seen.particles.spacing
        through[going] &= seen.particles.position[now, who].astype(np.float64) @ observation.up < rim
        going = going[through[going] & ((now == frame[going]) | inside.near[now, who])]
        at[going] += 1
    share = seen.share[particle]
    holes = float(share[through].sum() / share.sum())
    return {"over_rim": 1.0 - holes, "through_holes": holes}


def _state(
    observation: Observation, seen: ParticleLocations, inside: Inside, start: int, end: int
) -> dict[str, float | str]:
    """Return how a vessel stands and how full it is.

    Returns:
        Greatest tilt [rad], tilt at the beginning [rad], greatest fill [1] of what could keep anything as it stands.
    """
    poses = observation.log.poses[start:end, inside.unit, 3:]
    axis = rotate(poses, np.array([0.0, 0.0, 1.0])) @ observation.up
    tilt = np.arccos(np.clip(axis, -1.0, 1.0))
    first, last = np.searchsorted(seen.particles.tick, (start, end))
    held = inside.hollow[first:last] @ seen.particles.volume
    fullest = int(np.argmax(held)) + int(first)
    capacity = inside.capacity(fullest)
    evidence: dict[str, float | str] = {"tilt": float(tilt.max()), "tilt_before": float(tilt[0])}
    if capacity > 0:
        # A liquid bulges over the rim of what is full to the brim.
        evidence["fill"] = float(held.max()) / max(capacity, float(held.max()))
    return evidence


def _sources(
    observation: Observation, seen: ParticleLocations, passages: Passages, during: BoolArray, whence: IntArray
) -> dict[str, float | str]:
    """Return from where most of what arrives came."""
    share: dict[int, float] = {}
    for source in sorted(set(whence[during].tolist())):
        share[source] = float(seen.share[passages.particle[during]][whence[during] == source].sum())
    best = max(share, key=lambda source: share[source])
    return {"source": observation.unit_names[best]} if best >= 0 else {}
