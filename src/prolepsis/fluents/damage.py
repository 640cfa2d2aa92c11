"""``breaking(a)`` and ``broken(a)``: bonds of a detach, and it stays so."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import debounce
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import event, fluent
from prolepsis.things import IntArray
from prolepsis.timeline import Fact

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


@fluent("broken", "o")
def broken(observation: Observation) -> Iterator[Fact]:
    """A bond of the thing has detached; true from then on."""
    detachments = observation.log.detachments
    for whole, rows in observation.of(detached_rows).items():
        stretch = int(detachments.tick[rows].min()), observation.tick_count
        evidence = {"bonds": float(len(rows)), "force": float(detachments.force[rows].max())}
        yield observation.fact("fluent", "broken", (observation.log.things[whole].name,), stretch, evidence)


def detached_rows(observation: Observation) -> dict[int, IntArray]:
    """Return the rows of the log's detachments for each topmost whole, or stuff."""
    things = observation.log.things
    index = {thing.name: i for i, thing in enumerate(things)}
    found: dict[int, list[int]] = {}
    for row, detached in enumerate(observation.log.detachments.thing.tolist()):
        thing = int(detached)
        whole = things[thing].whole
        # A yolk breaks for itself.
        while whole is not None and whole in index and "Stuff" not in things[thing].roles:
            thing = index[whole]
            whole = things[thing].whole
        found.setdefault(thing, []).append(row)
    return {whole: np.array(rows, dtype=np.int64) for whole, rows in found.items()}
