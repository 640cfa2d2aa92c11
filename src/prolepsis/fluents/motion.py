"""``moving(a)``: a goes from one place to another, or turns."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.contact import is_stuff
from prolepsis.fluents.intervals import close_gaps, runs, ticks_of, union
from prolepsis.fluents.kinematics import centres, surface_speeds, travel
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import event
from prolepsis.things import BoolArray, IntArray
from prolepsis.timeline import Fact

MOVING_SPEED = 0.01
"""Mean speed over ``MOVING_WINDOW`` of what is moving [m/s]: half a millimetre in 50 ms. A body that jitters in
place goes fast but gets nowhere."""
MOVING_WINDOW = 0.05
"""Time over which that speed is taken [s]."""
STILL_SPEED = 0.002
"""Speed within one tick below which a body has not begun to move or has stopped [m/s]; it makes ends sharp."""
PAUSE = 0.1
"""Rest that does not end a motion [s], such as the turning point of a swing."""
MOVING_LEAST = 0.02
"""Shortest motion [s]."""


@event("moving", "o")
def moving(observation: Observation) -> Iterator[Fact]:
    """The thing gets somewhere or turns, faster than 1 cm/s; jitter in place is no motion."""
    place = observation.of(centres)
    speed = observation.of(surface_speeds)
    for unit, stretches in observation.of(moving_runs).items():
        if is_stuff(observation, unit):
            continue
        for start, end in stretches:
            way = np.diff(place[unit, start : min(end + 1, observation.tick_count)], axis=0)
            evidence = {
                "distance": float(np.linalg.norm(way, axis=1).sum()),
                "speed": float(speed[unit, start:end].max()),
            }
            yield observation.fact("event", "moving", (observation.unit_names[unit],), (start, end), evidence)


def moving_runs(observation: Observation) -> dict[int, IntArray]:
    """Return when each unit moves, parts of stuffs included. A hand's fingers do not count as the hand."""
    masks = observation.of(moving_masks)
    things = observation.log.things
    gap, least = ticks_of(PAUSE, observation.dt), ticks_of(MOVING_LEAST, observation.dt)
    found: dict[int, IntArray] = {}
    for unit in observation.units:
        parts = [unit] if observation.has_role(unit, "Gripper") else observation.bodies(unit)
        exists = observation.exists(unit)
        several = [runs(masks[part] & exists) for part in parts if not things[part].fixed and masks[part].any()]
        stretches = close_gaps(union(several), gap)
        stretches = stretches[stretches[:, 1] - stretches[:, 0] >= least]
        if len(stretches):
            found[unit] = stretches
    return found


def moving_masks(observation: Observation) -> BoolArray:
    """Return whether each thing gets somewhere at each tick, shape (n, T)."""
    half = ticks_of(MOVING_WINDOW / 2, observation.dt)
    return (travel(observation, half, half) > MOVING_SPEED) & (observation.of(surface_speeds) > STILL_SPEED)
