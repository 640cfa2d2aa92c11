"""``moving`` and ``falling`` of liquids made of particles: when most of the mass does so."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.evidence import ROUNDING
from prolepsis.fluents.intervals import debounce, ticks_of
from prolepsis.fluents.liquids.particle_locations import ParticleLocations, particle_locations
from prolepsis.fluents.liquids.stuff import FLOWING_SPEED, MOST, STUFF_GAP, STUFF_LEAST
from prolepsis.fluents.margins import margin_of
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import event
from prolepsis.geometry.shape import BoolArray, FloatArray
from prolepsis.log.log import FREE, PARKED
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact

FLOWING_WINDOW = 0.1
"""Time over which that speed is taken [s]; what jitters in place gets nowhere."""
FALLING_SPEED = 0.3
"""Downward speed of a particle that falls and touches nothing [m/s], that after 5 mm."""


@event("moving", "o")
def moving_liquid(observation: Observation) -> Iterator[Fact]:
    """The thing gets somewhere or turns, faster than 1 cm/s; jitter in place is no motion."""
    seen = observation.of(particle_locations)
    if seen is not None:
        moving = observation.of(particle_speeds) > FLOWING_SPEED
        yield from _mostly(observation, seen, "moving", moving & (seen.particles.holder != PARKED))


@event("falling", "o")
def falling_liquid(observation: Observation) -> Iterator[Fact]:
    """Nothing bears the thing and it goes down freely, from the loss of its support until it lands."""
    seen = observation.of(particle_locations)
    if seen is not None:
        in_air = (seen.manner == 0) & (seen.particles.holder == FREE)
        for inside in seen.inside:
            in_air &= ~inside.hollow
        sinking = -observation.of(particle_climbs) > FALLING_SPEED
        yield from _mostly(observation, seen, "falling", in_air & sinking)


def particle_speeds(observation: Observation) -> FloatArray:
    """Return how fast each particle gets on over ``FLOWING_WINDOW`` round each frame [m/s], shape (F, P)."""
    displacement, time = _displacements(observation)
    return np.sqrt(np.einsum("fpc,fpc->fp", displacement, displacement)) / time[:, None]


def particle_climbs(observation: Observation) -> FloatArray:
    """Return how fast each particle rises over ``FLOWING_WINDOW`` round each frame [m/s], shape (F, P)."""
    displacement, time = _displacements(observation)
    return (displacement @ observation.up) / time[:, None]


def _displacements(observation: Observation) -> tuple[FloatArray, FloatArray]:
    particles = observation.log.particles
    tick, position = particles.tick, particles.position
    half = ticks_of(FLOWING_WINDOW / 2, observation.dt)
    first = np.maximum(np.searchsorted(tick, tick - half, side="right") - 1, 0)
    last = np.minimum(np.searchsorted(tick, tick + half), len(tick) - 1)
    time = np.maximum((tick[last] - tick[first]) * observation.dt, 1e-9)
    displacement = (position[last] - position[first]).astype(np.float64)
    return displacement, time


def _mostly(observation: Observation, seen: ParticleLocations, type: str, mask: BoolArray) -> Iterator[Fact]:
    for stuff in seen.stuffs():
        fraction = seen.at_ticks(seen.fraction(mask, stuff), observation.tick_count)
        for start, end in debounce(fraction >= MOST - ROUNDING, observation.dt, gap=STUFF_GAP, least=STUFF_LEAST):
            margin = margin_of(fraction / MOST, start, end, ticks_of(STUFF_LEAST, observation.dt))
            evidence = {"fraction": float(fraction[start:end].max()), MARGIN: margin}
            yield observation.fact("event", type, (observation.unit_names[stuff],), (start, end), evidence)
