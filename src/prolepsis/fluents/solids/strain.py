"""How far beyond what a thing bears was what broke it: where a bond gives way the load is its strength, whatever came.

A blow would have come to more, which the engine tells in the tick after; a hand was told to press with more.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.observation import Observation


def margin_at(observation: Observation, whole: int, parts: list[int], channel: str, tick: int, force: float) -> float:
    """Return the margin of something that gave way [1]; 0 if nothing tells it.

    Args:
        observation: The log.
        whole: Index of what gave way.
        parts: Indices of the things that belong to it.
        channel: Which of their series is 1 where it gives way.
        tick: When it did.
        force: Under which force [N].
    """
    log = observation.log
    series = [log.channels.get(f"{log.things[i].name}.{channel}") for i in parts]
    reached = [float(each[tick : tick + 2].max()) for each in series if each is not None]
    told = [command / force for command in _commanded(observation, whole, tick)] if force > 0 else []
    return max([each for each in (*reached, *told) if each >= 1], default=0.0)


def _commanded(observation: Observation, whole: int, tick: int) -> Iterator[float]:
    """Yield the forces with which hands that touch a thing, and actions that name it, should press [N]."""
    log = observation.log
    now = np.flatnonzero(np.abs(log.contacts.tick - tick) <= 1)
    pairs = {(int(observation.unit[log.contacts.a[k]]), int(observation.unit[log.contacts.b[k]])) for k in now}
    touching = {observation.unit_names[unit] for pair in pairs if whole in pair for unit in pair}
    for name in touching:
        command = log.channels.get(f"{name}.command")
        if command is not None:
            yield float(command[tick])
    for action in log.actions:
        force = action.arguments.get("force")
        named = log.things[whole].name in action.arguments.values()
        if named and action.start <= tick < action.end and isinstance(force, int | float):
            yield float(force)
