"""``absorbing(s, x)``, ``dripping(s, x)`` and ``wiping(s, o)``: what a sponge does with a liquid."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.liquids.flowing import Passages, evidence_of, streams
from prolepsis.fluents.liquids.particle_locations import particle_locations
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import event
from prolepsis.fluents.solids.touch import touches
from prolepsis.geometry.shape import BoolArray
from prolepsis.log.log import FREE
from prolepsis.log.timeline import Fact

WIPE = "wipe"
"""The action that strokes its ``object`` over its ``surface``."""


@event("absorbing", "o1", "o2")
def absorbing(observation: Observation) -> Iterator[Fact]:
    """o1 takes up the stuff o2."""
    yield from _exchanged(observation, "absorbing", into=True)


@event("dripping", "o1", "o2")
def dripping(observation: Observation) -> Iterator[Fact]:
    """The stuff o2, that o1 had taken up, leaves it again."""
    yield from _exchanged(observation, "dripping", into=False)


@event("wiping", "o1", "o2", action=WIPE)
def wiping(observation: Observation) -> Iterator[Fact]:
    """A robot wipes o2 with o1, which touches it; or it should, and the outcome says why it did not."""
    for done in observation.log.actions:
        if done.term.functor != WIPE or not {"object", "surface"} <= done.arguments.keys():
            continue
        names = str(done.arguments["object"]), str(done.arguments["surface"])
        start, end = done.start, max(done.end, done.start + 1)
        if done.outcome != "done" or _touch(observation, *names, start, end):
            evidence: dict[str, float | str] = {"outcome": done.outcome, **done.evidence}
            yield observation.fact("event", "wiping", names, (start, end), evidence)


def _exchanged(observation: Observation, type: str, *, into: bool) -> Iterator[Fact]:
    """Yield the streams of particles into or out of what holds them within itself."""
    seen = observation.of(particle_locations)
    if seen is None:
        return
    holder = seen.particles.holder
    was, becomes = holder[:-1], holder[1:]
    taken: BoolArray = (was == FREE) & (becomes >= 0)
    changed, other = (taken, becomes) if into else ((was >= 0) & (becomes == FREE), was)
    things: list[int] = sorted(set(other[changed].tolist()))
    for thing in things:
        frame, particle = np.nonzero(changed & (other == thing))
        for stuff in seen.stuffs():
            if observation.unit[stuff] == observation.unit[thing]:
                continue
            chosen = seen.particles.stuff[particle] == stuff
            passages = Passages(frame=frame[chosen] + 1, particle=particle[chosen])
            for start, end, during in streams(observation, seen, passages):
                evidence = evidence_of(seen, passages, during, stuff)
                evidence["mass"] = float(evidence["fraction"]) * seen.mass(stuff)
                holder_name = observation.unit_names[int(observation.unit[thing])]
                names = holder_name, observation.unit_names[stuff]
                yield observation.fact("event", type, names, (start, end), evidence)


def _touch(observation: Observation, one: str, other: str, start: int, end: int) -> bool:
    """Return whether two units touch between two ticks."""
    for touch in observation.of(touches):
        if {observation.unit_names[touch.a], observation.unit_names[touch.b]} == {one, other}:
            low, high = np.searchsorted(touch.tick, (start, end))
            return bool(high > low)
    return False
