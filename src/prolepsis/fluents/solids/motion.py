"""``moving(a)``: a goes from one place to another, or turns."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import close_gaps, runs, ticks_of
from prolepsis.fluents.kinematics import centres, surface_speeds, travel
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import event
from prolepsis.fluents.solids.contact import is_stuff
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact

MOVING_SPEED = 0.01
"""Mean speed over ``MOVING_WINDOW`` of what is moving [m/s]: half a millimetre in 50 ms. A body that jitters in
place goes fast but gets nowhere."""
MOVING_WINDOW = 0.05
"""Time over which that speed is taken [s]."""
STILL_SPEED = 0.002
"""Speed within one tick below which a body has not begun to move or has stopped [m/s]; it makes ends sharp."""
MOMENT = 0.003
"""Time over which what is struck is seen to set out, and what strikes to stop [s] ..."""
ONSET_SHARE = 0.1
"""... that is, to go at least by this share as fast as in half a window after, or before, that [1]: else it jitters
until it is struck. What falls goes by 0.12 as fast in its first 3 ms as in its first 25."""
PAUSE = 0.1
"""Rest that does not end a motion [s], such as the turning point of a swing."""
LEAST_PATH = 0.002
"""Shortest path of a motion, of the outermost point [m]: a thing put down sinks in by up to a millimetre."""


@event("moving", "o")
def moving(observation: Observation) -> Iterator[Fact]:
    """The thing gets somewhere or turns, faster than 1 cm/s; jitter in place is no motion."""
    position = observation.of(centres)
    speed = observation.of(surface_speeds)
    for unit, stretches in observation.of(moving_runs).items():
        if is_stuff(observation, unit):
            continue
        parts = _moving_parts(observation, unit)
        gone = _gone(observation, parts)
        for start, end in stretches.tolist():
            path = np.diff(position[parts, start : min(end + 1, observation.tick_count)], axis=1)
            evidence = {
                "distance": float(np.sqrt(np.square(path).sum(axis=2)).sum(axis=1).max()),
                "speed": float(speed[parts, start:end].max()),
                MARGIN: _margin(gone[start : end + 1], observation.dt),
            }
            yield observation.fact("event", "moving", (observation.unit_names[unit],), (start, end), evidence)


def moving_runs(observation: Observation) -> dict[int, IntArray]:
    """Return when each unit moves, parts of stuffs included. A hand's fingers do not count as the hand."""
    masks = observation.of(moving_masks)
    gap = ticks_of(PAUSE, observation.dt)
    found: dict[int, IntArray] = {}
    for unit in observation.units:
        parts = _moving_parts(observation, unit)
        if not masks[parts].any():
            continue
        stretches = close_gaps(runs(masks[parts].any(axis=0) & observation.exists(unit)), gap)
        path = _gone(observation, parts)
        stretches = stretches[path[stretches[:, 1]] - path[stretches[:, 0]] >= LEAST_PATH]
        if len(stretches):
            found[unit] = stretches
    return found


def _gone(observation: Observation, parts: list[int]) -> FloatArray:
    """Return how far the outermost point of some things has gone before each tick [m], shape (T + 1,)."""
    speed = observation.of(surface_speeds)
    return np.concatenate(([0.0], np.cumsum(speed[parts].max(axis=0)) * observation.dt))


def _margin(gone: FloatArray, dt: float) -> float:
    """Return the lesser of path and greatest mean speed over what a motion has at least [1]."""
    window = min(ticks_of(MOVING_WINDOW, dt), len(gone) - 1)
    fastest = float((gone[window:] - gone[:-window]).max()) / (window * dt)
    return min(float(gone[-1] - gone[0]) / LEAST_PATH, fastest / MOVING_SPEED)


def _moving_parts(observation: Observation, unit: int) -> list[int]:
    """Return the things whose motion is the unit's; what is fixed does not move anyway."""
    bodies = observation.bodies(unit) or [unit]
    # Of a gripper it is the base's: itself, or its first part, the palm.
    return [unit if unit in bodies else bodies[0]] if observation.has_role(unit, "Gripper") else bodies


def moving_masks(observation: Observation) -> BoolArray:
    """Return whether each thing gets somewhere at each tick, shape (n, T)."""
    half, moment = (max(ticks_of(time, observation.dt), 1) for time in (MOVING_WINDOW / 2, MOMENT))
    goes = (travel(observation, half, half) > MOVING_SPEED) & (observation.of(surface_speeds) > STILL_SPEED)
    begun = travel(observation, 0, moment) >= ONSET_SHARE * travel(observation, 0, half)
    lasts = travel(observation, moment, 0) >= ONSET_SHARE * travel(observation, half, 0)
    return goes & begun & lasts
