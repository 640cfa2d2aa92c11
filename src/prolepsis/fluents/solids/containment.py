"""``contains(c, x)``: x is inside a depression of c, below where it would spill, and c or its contents bear it.

A liquid is one of the contents: what has come into it is contained, be it that it floats or still sinks.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from prolepsis.fluents.inside import Depths, depths_within
from prolepsis.fluents.intervals import close_gaps, debounce, drop_short, hysteresis, mask_of, runs, ticks_of, union
from prolepsis.fluents.margins import NearMiss, margin_of, nearly
from prolepsis.fluents.nesting import nesting
from prolepsis.fluents.observation import Observation, is_held_from_outside
from prolepsis.fluents.registry import fluent
from prolepsis.fluents.shapes_in_time import RigidShape, rigid_shapes
from prolepsis.fluents.solids.contact import is_stuff
from prolepsis.fluents.solids.support import support_runs, supporters
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact, Kind

NOTICEABLE_FRACTION = 0.02
"""Fraction of a stuff's mass [1] that is noticed: inside a container, on a surface, or spilled."""
CONTAINED_GAP = 0.1
"""Time outside that is not noticed [s]."""
CONTAINED_LEAST = 0.05
"""Shortest containment [s]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Content:
    """One unit inside one unit."""

    container: int
    """Unit."""
    content: int
    """Unit."""
    stretches: IntArray
    """When it is contained."""
    depths: tuple[Depths, ...]
    """How deep, as long as it was looked at."""


@fluent("contains", "o1", "o2")
def contains(observation: Observation) -> Iterator[Fact | NearMiss]:
    """o2 is inside a cavity of o1 which it could not leave at rest, and o1 or what it contains bears it."""
    names = observation.unit_names
    for item in observation.of(contents):
        if is_stuff(observation, item.content):
            continue
        for start, end in item.stretches:
            found = [depths.at(int(start), int(end)) for depths in item.depths]
            fraction, depth = max((pair for pair in found if pair is not None), default=(1.0, 0.0))
            evidence = {"fraction": fraction, "depth": depth}
            args = names[item.container], names[item.content]
            yield observation.fact("fluent", "contains", args, (start, end), evidence)
    yield from _stuffs(observation)


def _stuffs(observation: Observation) -> Iterator[Fact | NearMiss]:
    things = observation.log.things
    blobs = observation.of(blob_shares)
    for stuff in (i for i in range(len(things)) if observation.has_role(i, "Stuff")):
        within = observation.log.carrier[:, stuff]
        for body in sorted(set(within[within >= 0].tolist()) - {stuff}):
            name = observation.unit_names[observation.unit[body]]
            for stretch in runs(within == body):
                evidence = fractions(np.ones(1))
                yield observation.fact("fluent", "contains", (name, things[stuff].name), stretch, evidence)
        shares: dict[int, FloatArray] = {}
        for item in observation.of(contents):
            if item.content in blobs.get(stuff, {}):
                share = shares.setdefault(item.container, np.zeros(observation.tick_count))
                share += blobs[stuff][item.content] * mask_of(item.stretches, observation.tick_count)
        mass = things[stuff].mass or sum(things[blob].mass for blob in blobs.get(stuff, {}))
        for container, share in sorted(shares.items()):
            # The sum of all shares may fall short of a fraction by rounding, and exceed one.
            share = np.minimum(share, 1.0)
            enough = share >= NOTICEABLE_FRACTION - 1e-9
            args = observation.unit_names[container], things[stuff].name
            stretches = debounce(enough, observation.dt, gap=CONTAINED_GAP, least=CONTAINED_LEAST)
            yield from facts_of_share(observation, ("fluent", "contains", args), share, stretches, mass=share * mass)


def facts_of_share(
    observation: Observation,
    what: tuple[Kind, str, tuple[str, ...]],
    share: FloatArray,
    stretches: IntArray,
    **more: FloatArray,
) -> Iterator[Fact | NearMiss]:
    """Yield the facts about a noticeable share of a stuff, and when it nearly was one.

    Args:
        observation: The log.
        what: Kind, type and arguments.
        share: The share [1], shape (T,).
        stretches: When it is noticed.
        more: What is told besides, as the greatest of each by its name, shape (T,).
    """
    ratio, least = share / NOTICEABLE_FRACTION, ticks_of(CONTAINED_LEAST, observation.dt)
    for start, end in stretches.tolist():
        greatest = {name: float(values[start:end].max()) for name, values in more.items()}
        evidence = {**greatest, **fractions(share[start:end]), MARGIN: margin_of(ratio, start, end, least)}
        yield observation.fact(*what, (start, end), evidence)
    yield from nearly(observation, what, ratio, stretches, least)


def fractions(share: FloatArray) -> dict[str, float]:
    """Return the greatest, mean, least and last share of a stuff while a fact about it held, shape (T,)."""
    named = (("", share.max()), ("_mean", share.mean()), ("_least", share.min()), ("_at_end", share[-1]))
    return {f"fraction{name}": float(value) for name, value in named}


def blob_shares(observation: Observation) -> dict[int, dict[int, float]]:
    """Return, for each stuff that consists of blobs, the share of its mass in each blob."""
    things = observation.log.things
    index = {thing.name: i for i, thing in enumerate(things)}
    masses: dict[int, dict[int, float]] = {}
    for blob, thing in enumerate(things):
        if thing.whole is not None and thing.whole in index and observation.has_role(blob, "Blob"):
            masses.setdefault(index[thing.whole], {})[blob] = thing.mass if thing.mass > 0 else 1.0
    return {s: {b: m / sum(each.values()) for b, m in each.items()} for s, each in masses.items()}


def contents(observation: Observation) -> tuple[Content, ...]:
    """Return what is contained in what and when, blobs of stuffs one by one."""
    shapes = observation.of(rigid_shapes)
    candidates = [shape for shape in shapes if _may_be_content(observation, shape)]
    by_container: dict[int, list[RigidShape]] = {}
    for shape in shapes:
        if shape.is_hollow and not is_stuff(observation, int(observation.unit[shape.body])):
            unit = int(observation.unit[shape.body])
            by_container.setdefault(unit, []).append(shape)
    found: list[Content] = []
    for container, hollows in by_container.items():
        inside: dict[int, list[Depths]] = {}
        for hollow in hollows:
            for shape in candidates:
                unit = int(observation.unit[shape.body])
                if unit == container:
                    continue
                depths = depths_within(observation, hollow, shape, _borne_by_loose(observation, container, unit))
                if depths is not None:
                    inside.setdefault(unit, []).append(depths)
        found += _borne(observation, container, inside)
    return tuple(_of_innermost(observation, found))


def _of_innermost(observation: Observation, found: list[Content]) -> Iterator[Content]:
    """Yield the same, but nothing as in a vessel into which only dips what it is in."""
    count, by_content = observation.tick_count, dict[int, list[Content]]()
    for item in found:
        by_content.setdefault(item.content, []).append(item)
    for item in found:
        mask = mask_of(item.stretches, count)
        for other in by_content[item.content]:
            both = mask & mask_of(other.stretches, count)
            if other is not item and both.any():
                mask &= ~(both & nesting(observation, other.container, item.container).keeps)
        stretches = drop_short(runs(mask), ticks_of(CONTAINED_LEAST, observation.dt))
        if len(stretches):
            yield replace(item, stretches=stretches)


def _borne_by_loose(observation: Observation, container: int, unit: int) -> BoolArray:
    """Return when the container, or something loose that may be in it, bears a unit, shape (T,)."""
    things = observation.log.things
    borne = [
        stretches
        for below, stretches in observation.of(supporters).get(unit, [])
        if below == container or not things[below].fixed
    ]
    mask = mask_of(union(borne), observation.tick_count)
    wet = _immersed(observation, container).get(unit)
    return mask if wet is None else mask | wet


def _immersed(observation: Observation, container: int) -> Mapping[int, BoolArray]:
    """Return when units are in a liquid that a container holds, which is what bears or drowns them, shape (T,) each."""
    if not len(observation.log.particles.tick):
        return {}
    # Where liquids are found is told by groundings that know this one.
    from prolepsis.fluents.liquids.immersion import immersed_in

    return immersed_in(observation, container)


def _may_be_content(observation: Observation, shape: RigidShape) -> bool:
    unit = int(observation.unit[shape.body])
    thing = observation.log.things[shape.body]
    mounted = observation.has_role(unit, "Mounted") or is_held_from_outside(observation, unit)
    return bool(shape.solids) and shape.body == unit and not thing.fixed and not mounted


def _borne(observation: Observation, container: int, inside: dict[int, list[Depths]]) -> list[Content]:
    """Return what of all that is inside is also borne by the container or its contents, or at rest in it.

    Above a hole it must be both, and what something else bears there has left.
    """
    count = observation.tick_count
    masks = {unit: mask_of(union(d.stretches for d in each), count) for unit, each in inside.items()}
    surely = {unit: mask_of(union(d.surely for d in each), count) for unit, each in inside.items()}
    over_hole = {unit: masks[unit] & ~surely[unit] for unit in inside}
    rests = {unit: mask_of(union(d.at_rest for d in each), count) for unit, each in inside.items()}
    for unit, wet in _immersed(observation, container).items():
        if unit in inside:
            rests[unit] = rests[unit] | wet
    borne_by = [
        (below, above, mask_of(stretches, count))
        for (below, above), stretches in observation.of(support_runs).items()
        if above in inside and (below == container or below in inside)
    ]
    kept = {unit: rests[unit] & ~over_hole[unit] for unit in inside}
    changed = True
    while changed:
        changed = False
        for below, above, bears in borne_by:
            more = bears if below == container else bears & kept[below] & masks[below]
            if (more & ~kept[above]).any():
                kept[above], changed = kept[above] | more, True
    anchored = {unit: kept[unit] & (rests[unit] | ~over_hole[unit]) for unit in inside}
    for unit in inside:
        if over_hole[unit].any():
            masks[unit] &= ~over_hole[unit] | kept[unit] | ~_borne_at_all(observation, unit)
    gap, least = ticks_of(CONTAINED_GAP, observation.dt), ticks_of(CONTAINED_LEAST, observation.dt)
    found: list[Content] = []
    for unit, each in inside.items():
        # Once borne inside, a thing that hops in there stays contained until it leaves.
        held = [_from_first(run, anchored[unit]) for run in hysteresis(masks[unit], anchored[unit]).tolist()]
        stretches = drop_short(close_gaps(np.array(held, dtype=np.int64).reshape(-1, 2), gap), least)
        if len(stretches):
            found.append(Content(container=container, content=unit, stretches=stretches, depths=tuple(each)))
    return found


def _borne_at_all(observation: Observation, unit: int) -> BoolArray:
    """Return when anything bears a unit, shape (T,)."""
    known = observation.of(supporters).get(unit, [])
    return mask_of(union(stretches for _, stretches in known), observation.tick_count)


def _from_first(run: list[int], anchored: BoolArray) -> tuple[int, int]:
    return run[0] + int(np.argmax(anchored[run[0] : run[1]])), run[1]
