"""``breaking(a)`` and ``broken(a)``: bonds of a detach, and it stays so."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from prolepsis.fluents.intervals import debounce
from prolepsis.fluents.margins import NearMiss, nearly
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import event, fluent
from prolepsis.fluents.solids.strain import margin_at
from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact

BURST = 0.01
"""Time between two detachments within one burst of breaking [s]: a crack runs through a shell in far less."""

LOADS = ("load", "membrane_load")
"""Channels that are 1 where something breaks."""


@event("breaking", "o")
def breaking(observation: Observation) -> Iterator[Fact]:
    """Bonds of the thing detach; each burst of them is one event, named by the topmost whole."""
    detachments = observation.log.detachments
    for whole, rows in observation.of(detached_rows).items():
        mask = np.zeros(observation.tick_count, dtype=np.bool_)
        mask[detachments.tick[rows]] = True
        bursts = debounce(mask, observation.dt, gap=BURST).tolist()
        for start, end in bursts:
            here = rows[(detachments.tick[rows] >= start) & (detachments.tick[rows] < end)]
            evidence = {"bonds": float(len(here)), "force": float(detachments.force[here].max())}
            if start == bursts[0][0]:
                evidence |= strength_margin(observation, whole)
            name = observation.log.things[whole].name
            yield observation.fact("event", "breaking", (name,), (start, end), evidence)


@dataclass(frozen=True, kw_only=True, slots=True)
class Parts:
    """What a whole that consists of pieces is in, for each segment of the observation."""

    shares: tuple[FloatArray, ...]
    """Mass of each part over that of all, the largest first [1]."""

    @property
    def count(self) -> IntArray:
        """Number of parts [1], shape (S,)."""
        return np.array([len(shares) for shares in self.shares])

    @property
    def equal(self) -> FloatArray:
        """Number of equal parts of the same fineness [1], shape (S,): that of parts of one mass is their number, and
        crumbs hardly count."""
        return np.array([1 / (shares @ shares) for shares in self.shares])

    def at_end(self) -> dict[str, float]:
        """Return the number of parts when the log ends, how fine they are, and the two largest as shares."""
        last = self.shares[-1]
        named = {"parts": float(len(last)), "equal_parts": float(self.equal[-1])}
        return named | {"largest": float(last[0]), "second": float(last[1:2].sum())}


def parts_of(observation: Observation) -> dict[int, Parts]:
    """Return what each whole of pieces that breaks is in."""
    log, tops, found = observation.log, observation.of(_tops), dict[int, Parts]()
    for whole in observation.of(detached_rows):
        pieces = [i for i, thing in enumerate(log.things) if "Piece" in thing.roles and tops[i] == whole]
        mass = np.array([log.things[i].mass for i in pieces])
        if mass.sum() > 0:
            carriers = log.carrier[observation.segments][:, pieces]
            found[whole] = Parts(shares=tuple(_shares(row, mass) for row in carriers))
    return found


def _shares(carrier: IntArray, mass: FloatArray) -> FloatArray:
    """Return the mass of each part over that of all, the largest first."""
    _, part = np.unique(carrier, return_inverse=True)
    return np.sort(np.bincount(part, mass))[::-1] / mass.sum()


@fluent("broken", "o")
def broken(observation: Observation) -> Iterator[Fact | NearMiss]:
    """A bond of the thing has detached; true from then on."""
    detachments = observation.log.detachments
    for whole, rows in observation.of(detached_rows).items():
        stretch = int(detachments.tick[rows].min()), observation.tick_count
        evidence = {"bonds": float(len(rows)), "force": float(detachments.force[rows].max())}
        parts = observation.of(parts_of).get(whole)
        evidence |= {} if parts is None else parts.at_end()
        evidence |= strength_margin(observation, whole)
        yield observation.fact("fluent", "broken", (observation.log.things[whole].name,), stretch, evidence)
    yield from _nearly_broken(observation)


def strength_margin(observation: Observation, whole: int) -> dict[str, float]:
    """Return how far beyond the strength of a whole that breaks was what broke it, as evidence if that is known."""
    detachments, rows = observation.log.detachments, observation.of(detached_rows)[whole]
    first = int(detachments.tick[rows].min())
    force = float(detachments.force[rows][detachments.tick[rows] == first].max())
    parts = members(observation, whole)
    margin = max(margin_at(observation, whole, parts, channel, first, force) for channel in LOADS)
    return {MARGIN: margin} if margin else {}


def _nearly_broken(observation: Observation) -> Iterator[NearMiss]:
    """Yield when the load of a whole's bonds came near their strength before one detached."""
    log, tops, broke = observation.log, observation.of(_tops), observation.of(detached_rows)
    for i, thing in enumerate(log.things):
        loads = [log.channels.get(f"{thing.name}.{channel}") for channel in LOADS]
        load = next((each for each in loads if each is not None), None)
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


def members(observation: Observation, whole: int) -> list[int]:
    """Return a topmost whole with all its parts."""
    return [i for i, top in enumerate(observation.of(_tops)) if top == whole]


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
