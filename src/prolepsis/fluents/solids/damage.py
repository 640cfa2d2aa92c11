"""``breaking(a)`` and ``broken(a)``: bonds of a detach, and it stays so."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import debounce
from prolepsis.fluents.margins import NearMiss, nearly
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import event, fluent
from prolepsis.geometry.shape import IntArray
from prolepsis.log.timeline import Fact

BURST = 0.01
"""Time between two detachments within one burst of breaking [s]: a crack runs through a shell in far less."""


@event("breaking", "o")
def breaking(observation: Observation) -> Iterator[Fact]:
    """Bonds of the thing detach; each burst of them is one event, named by the topmost whole."""
    detachments = observation.log.detachments
    for whole, rows in observation.of(detached_rows).items():
        mask = np.zeros(observation.tick_count, dtype=np.bool_)
        mask[detachments.tick[rows]] = True
        for start, end in debounce(mask, observation.dt, gap=BURST):
            here = rows[(detachments.tick[rows] >= start) & (detachments.tick[rows] < end)]
            evidence = {"bonds": float(len(here)), "force": float(detachments.force[here].max())}
            name = observation.log.things[whole].name
            yield observation.fact("event", "breaking", (name,), (start, end), evidence)


def _parts(observation: Observation, whole: int) -> dict[str, float]:
    """Return into how many parts a shell has fallen at the end, and the two largest as shares of its mass."""
    log, tops = observation.log, observation.of(_tops)
    pieces = [i for i, thing in enumerate(log.things) if "Piece" in thing.roles and tops[i] == whole]
    mass = np.array([log.things[i].mass for i in pieces])
    if not mass.sum() > 0:
        return {}
    _, part = np.unique(log.carrier[-1, pieces], return_inverse=True)
    shares = np.sort(np.bincount(part, mass))[::-1] / mass.sum()
    return {"parts": float(len(shares)), "largest": float(shares[0]), "second": float(shares[1:2].sum())}


@fluent("broken", "o")
def broken(observation: Observation) -> Iterator[Fact | NearMiss]:
    """A bond of the thing has detached; true from then on."""
    detachments = observation.log.detachments
    for whole, rows in observation.of(detached_rows).items():
        stretch = int(detachments.tick[rows].min()), observation.tick_count
        evidence = {"bonds": float(len(rows)), "force": float(detachments.force[rows].max())}
        evidence |= _parts(observation, whole)
        yield observation.fact("fluent", "broken", (observation.log.things[whole].name,), stretch, evidence)
    yield from _nearly_broken(observation)


def _nearly_broken(observation: Observation) -> Iterator[NearMiss]:
    """Yield when the load of a whole's bonds came near their strength before one detached."""
    log, tops, broke = observation.log, observation.of(_tops), observation.of(detached_rows)
    for i, thing in enumerate(log.things):
        load = log.channels.get(f"{thing.name}.load")
        if load is None:
            continue
        first = int(log.detachments.tick[broke[tops[i]]].min()) if tops[i] in broke else observation.tick_count
        whole = np.array([[first, observation.tick_count]], dtype=np.int64)
        yield from nearly(observation, ("fluent", "broken", (log.things[tops[i]].name,)), load, whole)


def detached_rows(observation: Observation) -> dict[int, IntArray]:
    """Return the rows of the log's detachments for each topmost whole, or stuff."""
    tops = observation.of(_tops)
    found: dict[int, list[int]] = {}
    for row, detached in enumerate(observation.log.detachments.thing.tolist()):
        found.setdefault(tops[int(detached)], []).append(row)
    return {whole: np.array(rows, dtype=np.int64) for whole, rows in found.items()}


def _tops(observation: Observation) -> list[int]:
    """Return the topmost whole that each thing is a part of; a stuff, as a yolk, is its own."""
    things = observation.log.things
    index = {each.name: i for i, each in enumerate(things)}

    def top(thing: int) -> int:
        whole = things[thing].whole
        if whole is None or whole not in index or "Stuff" in things[thing].roles:
            return thing
        return top(index[whole])

    return [top(i) for i in range(len(things))]
