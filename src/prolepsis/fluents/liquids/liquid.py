"""Liquids made of particles: what contains, supports and absorbs a noticeable fraction of them, and what is spilled."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import arriving, debounce, opened, ticks_of
from prolepsis.fluents.liquids.liquid_motion import FLOWING_SPEED, particle_speeds
from prolepsis.fluents.liquids.particle_locations import ParticleLocations, particle_locations
from prolepsis.fluents.margins import NearMiss, margin_of
from prolepsis.fluents.observation import Observation, named
from prolepsis.fluents.registry import event, fluent
from prolepsis.fluents.solids.containment import CONTAINED_GAP, CONTAINED_LEAST, NOTICEABLE_FRACTION, facts_of_share
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.log import PARKED
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact

RESIDUE_FRACTION = 0.05
"""Fraction of a stuff [1] up to which what still clings to a vessel that was emptied is its residue: it may gather at
the bottom again and is not said to be contained."""
OUTSIDE_GAP = 0.1
"""Gap in what a liquid does outside that is not noticed [s]."""
OUTSIDE_LEAST = 0.05
"""Shortest time that a liquid is seen to do something outside [s]."""
LINGERING = 0.1
"""Time for which a particle must touch surfaces outside to lie or flow there [s]: what leaps over the lip of a jug,
bounces off or brushes past in falling is still under way."""


@fluent("contains", "o1", "o2")
def contains_liquid(observation: Observation) -> Iterator[Fact | NearMiss]:
    """o2 is inside a cavity of o1 which it could not leave at rest, and o1 or what it contains bears it."""
    seen = observation.of(particle_locations)
    if seen is None:
        return
    for stuff in seen.stuffs():
        for inside in seen.inside:
            fraction = seen.fraction(inside.pool, stuff)
            deep = seen.fraction(inside.pool * inside.depth, stuff) / np.maximum(fraction, 1e-12)
            series = {"fraction": fraction, "volume": fraction * seen.volume(stuff), "depth": deep}
            stretches = _noticed(observation, seen, fraction, gap=CONTAINED_GAP, least=CONTAINED_LEAST)
            stretches = _without_residue(observation, seen, fraction, stretches)
            yield from _facts(observation, seen, ("contains", inside.unit, stuff), stretches, series)
        for holder, fraction in _held(observation, seen, stuff).items():
            if _encloses(observation, holder, stuff):
                series = {"fraction": fraction, "volume": fraction * seen.volume(stuff)}
                stretches = _noticed(observation, seen, fraction, gap=CONTAINED_GAP, least=CONTAINED_LEAST)
                yield from _facts(observation, seen, ("contains", holder, stuff), stretches, series)


@fluent("supports", "o1", "o2")
def supports_liquid(observation: Observation) -> Iterator[Fact | NearMiss]:
    """o1 bears at least a tenth of o2's weight through contacts that lie under o2, and o2's weight is balanced."""
    seen = observation.of(particle_locations)
    if seen is None:
        return
    from prolepsis.fluents.kernels.locations import RESTING

    resting = (seen.manner == RESTING) & ~observation.of(passing_rims)
    for stuff in seen.stuffs():
        for below in sorted(set(seen.on[resting].tolist())):
            fraction = seen.fraction(resting & (seen.on == below), stuff)
            series = {"fraction": fraction, "volume": fraction * seen.volume(stuff)}
            stretches = _noticed(observation, seen, fraction)
            yield from _facts(observation, seen, ("supports", below, stuff), stretches, series)


@fluent("spilled", "o")
def spilled_liquid(observation: Observation) -> Iterator[Fact | NearMiss]:
    """A noticeable fraction of the stuff rests on or flows over a surface outside every container."""
    seen = observation.of(particle_locations)
    if seen is None:
        return
    lying = observation.of(spilled_masks)
    for stuff in seen.stuffs():
        fraction = seen.fraction(lying, stuff)
        series = {
            "fraction": fraction,
            "volume": fraction * seen.volume(stuff),
            "mass": fraction * seen.mass(stuff),
        }
        yield from _facts(observation, seen, ("spilled", None, stuff), _noticed(observation, seen, fraction), series)


@event("spilling", "o")
def spilling_liquid(observation: Observation) -> Iterator[Fact]:
    """A noticeable fraction of the stuff has come to a surface outside every container, and flows there still."""
    seen = observation.of(particle_locations)
    if seen is None:
        return
    lying = observation.of(spilled_masks)
    flows = observation.of(particle_speeds) > FLOWING_SPEED
    frames = lasting_frames(observation, seen)
    flowing = arriving(lying, ~flows, frames) & flows & (seen.particles.holder != PARKED)
    for stuff in seen.stuffs():
        fraction = seen.fraction(flowing, stuff)
        outside = seen.at_ticks(seen.fraction(lying, stuff), observation.tick_count)
        shown = seen.at_ticks(fraction, observation.tick_count)
        least = ticks_of(OUTSIDE_LEAST, observation.dt)
        for start, end in _noticed(observation, seen, fraction):
            before, after = float(outside[max(start - 1, 0)]), float(outside[min(end, observation.tick_count - 1)])
            evidence = {"fraction": float(shown[start:end].max()), "spilled_before": before, "spilled_after": after}
            evidence[MARGIN] = margin_of(shown / NOTICEABLE_FRACTION, start, end, least)
            yield observation.fact("event", "spilling", (observation.unit_names[stuff],), (start, end), evidence)


@fluent("absorbs", "o1", "o2")
def absorbs(observation: Observation) -> Iterator[Fact | NearMiss]:
    """o1 has taken up a noticeable fraction of the stuff o2, which moves with it."""
    seen = observation.of(particle_locations)
    if seen is None:
        return
    for stuff in seen.stuffs():
        for holder, fraction in _held(observation, seen, stuff).items():
            if not _encloses(observation, holder, stuff):
                series = {
                    "fraction": fraction,
                    "volume": fraction * seen.volume(stuff),
                    "mass": fraction * seen.mass(stuff),
                }
                stretches = _noticed(observation, seen, fraction)
                yield from _facts(observation, seen, ("absorbs", holder, stuff), stretches, series)


def spilled_masks(observation: Observation) -> BoolArray:
    """Return which particles lie on or flow over a surface outside every container, or have left the scene, (F, P).

    What a fragment still carries of what was in the whole is not spilled.
    """
    seen = observation.of(particle_locations)
    assert seen is not None  # asked for by groundings that have looked
    carried = np.array([observation.has_role(i, "Piece") for i in range(len(observation.log.things))])
    lying = opened(
        (seen.manner > 0) & ~carried[seen.on] & ~observation.of(passing_rims), lasting_frames(observation, seen)
    )
    return lying | (seen.particles.holder == PARKED)


def passing_rims(observation: Observation) -> BoolArray:
    """Return which particles flow over the rim of the vessel that they are about to leave, shape (F, P)."""
    seen = observation.of(particle_locations)
    assert seen is not None  # asked for by groundings that have looked
    return seen.over_rim() & (observation.of(particle_speeds) > FLOWING_SPEED)


def lasting_frames(observation: Observation, seen: ParticleLocations) -> int:
    """Return how many frames ``LINGERING`` lasts, at most all."""
    tick = seen.particles.tick
    step = float(np.diff(tick).mean()) * observation.dt if len(tick) > 1 else 1.0
    return min(max(1, round(LINGERING / step)), len(tick))


def _held(observation: Observation, seen: ParticleLocations, stuff: int) -> dict[int, FloatArray]:
    """Return the share of a stuff that each unit holds within itself in each frame."""
    naming = observation.of(named)
    chosen = seen.particles.stuff == stuff
    holder = seen.particles.holder[:, chosen]
    units: dict[int, FloatArray] = {}
    for thing in sorted(set(holder[holder >= 0].tolist())):
        unit = int(naming[observation.unit[thing]])
        units[unit] = units.get(unit, np.zeros(len(holder))) + (holder == thing) @ seen.share[chosen]
    return units


def _encloses(observation: Observation, holder: int, stuff: int) -> bool:
    """Return whether a stuff is a part of the unit that holds it, as a yolk of its egg."""
    return bool(observation.unit[stuff] == holder)


def _noticed(
    observation: Observation,
    seen: ParticleLocations,
    fraction: FloatArray,
    *,
    gap: float = OUTSIDE_GAP,
    least: float = OUTSIDE_LEAST,
) -> IntArray:
    # The sum of all shares may fall short of a fraction by rounding.
    enough = seen.at_ticks(fraction, observation.tick_count) >= NOTICEABLE_FRACTION - 1e-9
    return debounce(enough, observation.dt, gap=gap, least=min(least, observation.tick_count * observation.dt))


def _without_residue(
    observation: Observation, seen: ParticleLocations, fraction: FloatArray, stretches: IntArray
) -> IntArray:
    """Return the stretches without those in which a vessel that held more has no more than its residue."""
    shown = seen.at_ticks(fraction, observation.tick_count)
    kept: list[IntArray] = []
    held_more = False
    for row in stretches:
        more = bool(shown[row[0] : row[1]].max() > RESIDUE_FRACTION)
        if more or not held_more:
            kept.append(row)
        held_more |= more
    return np.array(kept, dtype=np.int64).reshape(-1, 2)


def _facts(
    observation: Observation,
    seen: ParticleLocations,
    what: tuple[str, int | None, int],
    stretches: IntArray,
    series: dict[str, FloatArray],
) -> Iterator[Fact | NearMiss]:
    type, first, stuff = what
    names = (observation.unit_names[stuff],)
    args = names if first is None else (observation.unit_names[first], *names)
    shown = {name: seen.at_ticks(values, observation.tick_count) for name, values in series.items()}
    fraction = shown.pop("fraction")
    yield from facts_of_share(observation, ("fluent", type, args), fraction, stretches, **shown)
