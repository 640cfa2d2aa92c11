"""``dented(b)`` and ``buckled(b)``: a part of b's wall has given way for good."""

from __future__ import annotations

from collections.abc import Iterator

from prolepsis.fluents.intervals import debounce
from prolepsis.fluents.margins import NearMiss, margin_of, nearly
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import fluent
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact

NOTICEABLE_DENT = 1.0e-3
"""A dent is noticed when the rim stays out of place by this [m]."""
STEADY = 0.02
"""Shortest dent [s]."""


@fluent("dented", "o")
def dented(observation: Observation) -> Iterator[Fact | NearMiss]:
    """A part of the thing's wall has yielded, so that it stays out of place."""
    yield from _gave_way(observation, "dented", "DentingBowl")


@fluent("buckled", "o")
def buckled(observation: Observation) -> Iterator[Fact | NearMiss]:
    """A part of the thing's thin wall has folded, so that it stays out of place."""
    yield from _gave_way(observation, "buckled", "BucklingBowl")


def _gave_way(observation: Observation, name: str, role: str) -> Iterator[Fact | NearMiss]:
    for thing in observation.log.things:
        depth = observation.log.channels.get(f"{thing.name}.dent")
        if depth is None or role not in thing.roles:
            continue
        ratio, stretches = (
            depth / NOTICEABLE_DENT,
            debounce(depth > NOTICEABLE_DENT, observation.dt, gap=STEADY, least=STEADY),
        )
        for start, end in stretches.tolist():
            evidence = {"depth": float(depth[start:end].max()), MARGIN: margin_of(ratio, start, end)}
            yield observation.fact("fluent", name, (thing.name,), (start, end), evidence)
        yield from nearly(observation, ("fluent", name, (thing.name,)), ratio, stretches)
