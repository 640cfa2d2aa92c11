"""Stuffs of many bodies (beads, grains) outside every container: ``spilled``, ``spilling``, and what supports them.

Each body, a blob, is judged alone, and facts name the stuff when the noticeable fraction does so.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import numpy as np

from prolepsis.fluents.evidence import ROUNDING
from prolepsis.fluents.intervals import arriving, debounce, mask_of, ticks_of, union
from prolepsis.fluents.kinematics import surface_speeds
from prolepsis.fluents.liquids.blobs_in_hollows import blobs_in_hollows
from prolepsis.fluents.margins import NearMiss, margin_of
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import event, fluent
from prolepsis.fluents.solids.contact import FLICKER, is_stuff
from prolepsis.fluents.solids.containment import NOTICEABLE_FRACTION, blob_shares, contents, facts_of_share
from prolepsis.fluents.solids.fall import falling_runs
from prolepsis.fluents.solids.motion import moving_runs
from prolepsis.fluents.solids.support import support_runs
from prolepsis.fluents.solids.touch import touches
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact

FLOWING_SPEED = 0.02
"""Speed of a blob or a particle that flows [m/s]."""
STUFF_GAP = 0.1
"""Gap in what a stuff does that is not noticed [s]."""
STUFF_LEAST = 0.05
"""Shortest time that a stuff is seen to do something [s]."""
LINGERING = 0.1
"""Time for which a blob must lie outside to be there [s]: what bounces off or brushes past is still under way."""
MOST = 0.5
"""Share of a stuff's mass [1] that must move or fall for the stuff to do so."""

BlobMasks = Mapping[int, BoolArray]


@fluent("spilled", "o")
def spilled(observation: Observation) -> Iterator[Fact | NearMiss]:
    """A noticeable fraction of the stuff rests on or flows over a surface outside every container."""
    lying = observation.of(outside_masks)
    for stuff, shares in observation.of(blob_shares).items():
        fraction = share_of(observation, shares, lying)
        mass = mass_of(observation, stuff, shares)
        what = "fluent", "spilled", (observation.log.things[stuff].name,)
        yield from facts_of_share(observation, what, fraction, _noticed(observation, fraction), mass=fraction * mass)


@event("spilling", "o")
def spilling(observation: Observation) -> Iterator[Fact]:
    """A noticeable fraction of the stuff has come to a surface outside every container, and flows there still."""
    lying, speed = observation.of(outside_masks), observation.of(surface_speeds)
    frames = min(ticks_of(LINGERING, observation.dt), observation.tick_count)
    flowing: dict[int, BoolArray] = {}
    for blob, mask in lying.items():
        flows = speed[blob] > FLOWING_SPEED
        flowing[blob] = arriving(mask[:, None], ~flows[:, None], frames)[:, 0] & flows
    for stuff, shares in observation.of(blob_shares).items():
        fraction, outside = share_of(observation, shares, flowing), share_of(observation, shares, lying)
        least = ticks_of(STUFF_LEAST, observation.dt)
        for start, end in _noticed(observation, fraction):
            before, after = float(outside[max(start - 1, 0)]), float(outside[min(end, observation.tick_count - 1)])
            evidence = {"fraction": float(fraction[start:end].max()), "spilled_before": before, "spilled_after": after}
            evidence[MARGIN] = margin_of(fraction / NOTICEABLE_FRACTION, start, end, least)
            yield observation.fact("event", "spilling", (observation.log.things[stuff].name,), (start, end), evidence)


@fluent("supports", "o1", "o2")
def supports_stuff(observation: Observation) -> Iterator[Fact | NearMiss]:
    """o1 bears at least a tenth of o2's weight through contacts that lie under o2, and o2's weight is balanced."""
    bearing = {pair: mask_of(s, observation.tick_count) for pair, s in observation.of(support_runs).items()}
    for stuff, shares in observation.of(blob_shares).items():
        surfaces = {below for below, above in bearing if above in shares and not is_stuff(observation, below)}
        mass = mass_of(observation, stuff, shares)
        for below in sorted(surfaces):
            rows = [
                (b, above, mask) for (b, above), mask in bearing.items() if above in shares and b in {below, *shares}
            ]
            fraction = share_of(observation, shares, _piled(observation, rows, {below}))
            args = observation.unit_names[below], observation.log.things[stuff].name
            what = "fluent", "supports", args
            yield from facts_of_share(
                observation, what, fraction, _noticed(observation, fraction), mass=fraction * mass
            )


@event("moving", "o")
def moving_stuff(observation: Observation) -> Iterator[Fact]:
    """The thing gets somewhere or turns, faster than 1 cm/s; jitter in place is no motion."""
    yield from _mostly(observation, "moving", moving_runs)


@event("falling", "o")
def falling_stuff(observation: Observation) -> Iterator[Fact]:
    """Nothing bears the thing and it goes down freely, from the loss of its support until it lands."""
    yield from _mostly(observation, "falling", falling_runs)


def uncontained_masks(observation: Observation) -> dict[int, BoolArray]:
    """Return whether each blob is free and in no container, shape (T,) each."""
    count = observation.tick_count
    held: dict[int, list[IntArray]] = {}
    for item in observation.of(contents):
        held.setdefault(item.content, []).append(item.stretches)
    blobs = [blob for shares in observation.of(blob_shares).values() for blob in shares]
    return {b: observation.exists(b) & ~mask_of(union(held.get(b, [])), count) for b in blobs}


def outside_masks(observation: Observation) -> dict[int, BoolArray]:
    """Return whether each blob lies on a surface, or on others that do, outside every container, shape (T,) each."""
    free, count, dt = observation.of(uncontained_masks), observation.tick_count, observation.dt
    rows: list[tuple[int, int, BoolArray]] = []
    for touch in observation.of(touches):
        if touch.a not in free and touch.b not in free:
            continue
        mask = mask_of(debounce(touch.mask(count, dt), dt, gap=FLICKER), count)
        for below, above, bearing in ((touch.a, touch.b, touch.bears_b), (touch.b, touch.a, touch.bears_a)):
            if above in free and (bearing > 0).any():
                rows.append((below, above, mask))
    found = _piled(observation, rows, {below for below, _, _ in rows if below not in free})
    least = min(LINGERING, count * dt)
    return {blob: mask_of(debounce(mask, dt, gap=FLICKER, least=least), count) for blob, mask in found.items()}


def _piled(
    observation: Observation, bearing: list[tuple[int, int, BoolArray]], surfaces: set[int]
) -> dict[int, BoolArray]:
    """Return whether each blob lies on one of some surfaces, or on others that do, uncontained, shape (T,) each.

    Args:
        observation: The log.
        bearing: What bears which blob, and when, shape (T,).
        surfaces: Units that are no blobs. What runs along the inner wall of a vessel is not on it, but leaving it.
    """
    free, leaving = observation.of(uncontained_masks), observation.of(blobs_in_hollows)
    found = {blob: np.zeros(observation.tick_count, dtype=np.bool_) for blob in free}
    among: list[tuple[int, int, BoolArray]] = []
    for below, above, mask in bearing:
        within = leaving.get(above, {})
        if below in surfaces:
            found[above] |= mask & free[above] & ~within.get(below, np.False_)
        elif below in free:
            lying = mask & free[above]
            for inside in within.values():
                lying &= ~inside
            among.append((below, above, lying))
    changed = True
    while changed:
        changed = False
        for below, above, mask in among:
            more = found[below] & mask & ~found[above]
            if more.any():
                found[above], changed = found[above] | more, True
    return found


def mass_of(observation: Observation, stuff: int, shares: Mapping[int, float]) -> float:
    """Return the mass of a stuff [kg]."""
    things = observation.log.things
    return things[stuff].mass or sum(things[blob].mass for blob in shares)


def share_of(observation: Observation, shares: Mapping[int, float], masks: BlobMasks) -> FloatArray:
    """Return the share of a stuff's mass in the blobs of which the masks are true, shape (T,)."""
    total = np.zeros(observation.tick_count)
    for blob, share in shares.items():
        if blob in masks:
            total += share * masks[blob]
    return total


def _noticed(observation: Observation, fraction: FloatArray) -> IntArray:
    # The sum of all shares may fall short of a fraction by rounding, here and below.
    return debounce(fraction >= NOTICEABLE_FRACTION - ROUNDING, observation.dt, gap=STUFF_GAP, least=STUFF_LEAST)


def _mostly(observation: Observation, type: str, find: Callable[[Observation], dict[int, IntArray]]) -> Iterator[Fact]:
    masks = {unit: mask_of(stretches, observation.tick_count) for unit, stretches in observation.of(find).items()}
    for stuff, shares in observation.of(blob_shares).items():
        fraction = share_of(observation, shares, masks)
        for start, end in debounce(fraction >= MOST - ROUNDING, observation.dt, gap=STUFF_GAP, least=STUFF_LEAST):
            margin = margin_of(fraction / MOST, start, end, ticks_of(STUFF_LEAST, observation.dt))
            evidence = {"fraction": float(fraction[start:end].max()), MARGIN: margin}
            yield observation.fact("event", type, (observation.log.things[stuff].name,), (start, end), evidence)
