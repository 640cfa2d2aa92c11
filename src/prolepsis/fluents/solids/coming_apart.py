"""``cracked(a)``, ``open(a)``, ``crushed(a)``: how far what is broken has come apart.

Cracked, it is one body still; open, it is not; crushed, it is in many parts. So ``cracked`` and ``open`` exclude each
other, and what is crushed is open.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import ticks_of
from prolepsis.fluents.margins import NearMiss, margin_of, nearly
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import fluent
from prolepsis.fluents.solids.damage import BURST, Parts, detached_rows, members, parts_of, strength_margin
from prolepsis.fluents.solids.strain import margin_at
from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Evidence, Fact

DEPTH = "pressed_in"
"""Series: how deep a cracked thing is pressed in, over how deep it is when it opens [1]."""
CRUSHED = 3.0
"""What is in as small parts as so many equal ones is crushed [1]: two halves with some crumbs, as a cook makes them,
are not, nor a shell with a hole."""


@fluent("cracked", "o")
def cracked(observation: Observation) -> Iterator[Fact]:
    """Bonds of the thing have given way, but it is one body still: what is inside stays there."""
    for whole, rows in observation.of(detached_rows).items():
        parts = observation.of(parts_of).get(whole)
        if parts is None:
            continue
        tick = observation.log.detachments.tick[rows]
        start, end = int(tick.min()), _opened(observation, parts)
        # What opens within the burst that cracked it has never been only cracked.
        if end - start > ticks_of(BURST, observation.dt):
            here = rows[tick < end]
            evidence = {"bonds": float(len(here)), "force": float(observation.log.detachments.force[here].max())}
            evidence |= strength_margin(observation, whole)
            yield _fact(observation, "cracked", whole, (start, end), evidence)


@fluent("open", "o")
def open_(observation: Observation) -> Iterator[Fact | NearMiss]:
    """The thing has fallen apart: what is inside can get out."""
    for whole, parts in observation.of(parts_of).items():
        start = _opened(observation, parts)
        if start < observation.tick_count:
            evidence = parts.at_end() | _opening_margin(observation, whole, start)
            yield _fact(observation, "open", whole, (start, observation.tick_count), evidence)
        for member in members(observation, whole):
            name = observation.log.things[member].name
            depth = observation.log.channels.get(f"{name}.{DEPTH}")
            if depth is not None:
                stretches: IntArray = np.array([[start, observation.tick_count]], dtype=np.int64)
                yield from nearly(observation, ("fluent", "open", (name,)), depth, stretches)


def _opening_margin(observation: Observation, whole: int, start: int) -> dict[str, float]:
    """Return how far beyond what opens it was what opened a whole, as evidence if that is known."""
    detachments, rows = observation.log.detachments, observation.of(detached_rows)[whole]
    burst = rows[np.abs(detachments.tick[rows] - start) <= ticks_of(BURST, observation.dt)]
    force = float(detachments.force[burst].max()) if len(burst) else 0.0
    margin = margin_at(observation, whole, members(observation, whole), DEPTH, start - 1, force)
    if margin:
        return {MARGIN: margin}
    # What has no lining opens as it breaks.
    at_once = start - int(detachments.tick[rows].min()) <= ticks_of(BURST, observation.dt)
    return strength_margin(observation, whole) if at_once else {}


@fluent("crushed", "o")
def crushed(observation: Observation) -> Iterator[Fact | NearMiss]:
    """The thing is in many parts: in as small ones as three that are equal, or smaller."""
    for whole, parts in observation.of(parts_of).items():
        ratio: FloatArray = observation.spread(parts.equal) / CRUSHED
        start = int(np.argmax(ratio >= 1)) if ratio[-1] >= 1 else observation.tick_count
        stretches: IntArray = np.array([[start, observation.tick_count]], dtype=np.int64)
        if start < observation.tick_count:
            evidence = parts.at_end() | {MARGIN: margin_of(ratio, start, observation.tick_count)}
            yield _fact(observation, "crushed", whole, (start, observation.tick_count), evidence)
        name = observation.log.things[whole].name
        yield from nearly(observation, ("fluent", "crushed", (name,)), ratio, stretches)


def _opened(observation: Observation, parts: Parts) -> int:
    """Return the tick from which it is in more than one part, or that at which the log ends."""
    apart = np.flatnonzero(parts.count > 1)
    return int(observation.segments[apart[0]]) if len(apart) else observation.tick_count


def _fact(observation: Observation, type: str, whole: int, stretch: tuple[int, int], evidence: Evidence) -> Fact:
    return observation.fact("fluent", type, (observation.log.things[whole].name,), stretch, evidence)
