"""``inFlight(s)``: a noticeable part of a stuff is in the air, on its way from one thing to another."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import debounce, mask_of
from prolepsis.fluents.liquids.blobs_in_hollows import blobs_in_hollows
from prolepsis.fluents.liquids.particle_locations import ParticleLocations, particle_locations, stays
from prolepsis.fluents.liquids.stuff import STUFF_GAP, STUFF_LEAST, mass_of, outside_masks, share_of, uncontained_masks
from prolepsis.fluents.margins import NearMiss
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import event
from prolepsis.fluents.solids.contact import FLICKER
from prolepsis.fluents.solids.containment import NOTICEABLE_FRACTION, blob_shares, facts_of_share
from prolepsis.fluents.solids.touch import touches
from prolepsis.geometry.shape import BoolArray, FloatArray
from prolepsis.log.log import FREE
from prolepsis.log.timeline import Fact


@event("inFlight", "o")
def in_flight(observation: Observation) -> Iterator[Fact | NearMiss]:
    """A noticeable fraction of the stuff is in no hollow, touches nothing and moves: it falls, streams or splashes."""
    seen = observation.of(particle_locations)
    if seen is not None:
        away = (seen.manner == 0) & (seen.particles.holder == FREE)
        for inside in seen.inside:
            away &= ~inside.hollow
        if away.any():
            away &= ~_staying(observation, seen)
        for stuff in seen.stuffs():
            fraction = seen.at_ticks(seen.fraction(away, stuff), observation.tick_count)
            yield from _facts(observation, stuff, fraction, seen.mass(stuff))
    masks = observation.of(blobs_in_air)
    for stuff, shares in observation.of(blob_shares).items():
        fraction = share_of(observation, shares, masks)
        yield from _facts(observation, stuff, fraction, mass_of(observation, stuff, shares))


def _staying(observation: Observation, seen: ParticleLocations) -> BoolArray:
    """Return which particles hardly move in the world or along with what they are near, as what fills a gap, (F, P)."""
    at_home = np.tile(np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]), (len(seen.particles.tick), 1))
    found = stays(observation, seen.particles, at_home)
    for inside in seen.inside:
        for body in observation.bodies(inside.unit):
            poses = observation.log.poses[seen.particles.tick, body]
            found |= inside.near & stays(observation, seen.particles, poses)
    return found


def _facts(observation: Observation, stuff: int, fraction: FloatArray, mass: float) -> Iterator[Fact | NearMiss]:
    enough = fraction >= NOTICEABLE_FRACTION - 1e-9
    stretches = debounce(enough, observation.dt, gap=STUFF_GAP, least=STUFF_LEAST)
    what = "event", "inFlight", (observation.log.things[stuff].name,)
    yield from facts_of_share(observation, what, fraction, stretches, mass=fraction * mass)


def blobs_in_air(observation: Observation) -> dict[int, BoolArray]:
    """Return when each blob touches nothing and is in no hollow, shape (T,) each."""
    count, dt = observation.tick_count, observation.dt
    touching: dict[int, BoolArray] = {}
    for touch in observation.of(touches):
        for unit in (touch.a, touch.b):
            touching[unit] = touching.get(unit, np.zeros(count, dtype=np.bool_)) | touch.mask(count, dt)
    lying, hollows = observation.of(outside_masks), observation.of(blobs_in_hollows)
    found: dict[int, BoolArray] = {}
    for blob, free in observation.of(uncontained_masks).items():
        away = free & ~lying.get(blob, np.zeros(count, dtype=np.bool_))
        if blob in touching:
            away &= ~mask_of(debounce(touching[blob], dt, gap=FLICKER), count)
        for inside in hollows.get(blob, {}).values():
            away &= ~inside
        found[blob] = away
    return found
