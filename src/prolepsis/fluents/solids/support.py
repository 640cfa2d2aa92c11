"""When one thing bears another: a noticeable share of its weight, from below, while that is balanced."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import close_gaps, debounce, drop_short, mask_of, one_sided_means, ticks_of
from prolepsis.fluents.kinematics import BALANCE_WINDOW, balanced
from prolepsis.fluents.margins import NearMiss, nearly
from prolepsis.fluents.observation import Observation, is_held_from_outside, named
from prolepsis.fluents.solids.contact import FLICKER, is_stuff
from prolepsis.fluents.solids.touch import touches
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray

NOTICEABLE_SHARE = 0.1
"""Share of b's weight [1] that a must bear."""
LEAST_WEIGHT = 1.0e-12
"""Where nothing weighs anything, all that touches at rest is supported [N]."""
SUPPORT_GAP = 0.05
"""Gap in a support that is not noticed [s]; within it a thing would fall by 12 mm."""
SUPPORT_LEAST = 0.05
"""Shortest support [s]; what touches for less is an impact."""

Pair = tuple[int, int]


def support_runs(observation: Observation) -> dict[Pair, IntArray]:
    """Return when each unit, blobs included, and each stuff as one bears which unit: (below, above) to runs."""
    return observation.of(judged_supports)[0]


def judged_supports(observation: Observation) -> tuple[dict[Pair, IntArray], list[NearMiss]]:
    """Return when each unit bears which unit, and what nearly bore what."""
    dt, count = observation.dt, observation.tick_count
    at_rest = observation.of(balanced)
    found: dict[Pair, IntArray] = {}
    missed: list[NearMiss] = []
    for (below, above), bearing, touching in _bearing(observation):
        ratio = np.where(touching & at_rest[above], bearing_ratio(observation, above, bearing), 0.0)
        # Blows that come soon after each other are no support, but bounces.
        pressed = debounce(ratio > 1.0, dt, gap=FLICKER, least=min(FLICKER, count * dt))
        stretches = drop_short(close_gaps(pressed, ticks_of(SUPPORT_GAP, dt)), min(ticks_of(SUPPORT_LEAST, dt), count))
        if len(stretches):
            found[below, above] = stretches
        if not observation.has_role(below, "Blob") and not is_stuff(observation, above):
            names = observation.unit_names[below], observation.unit_names[above]
            missed += nearly(observation, ("fluent", "supports", names), ratio, stretches)
    return found, missed


def bearing_ratio(observation: Observation, above: int, bearing: FloatArray) -> FloatArray:
    """Return how much of a unit's weight a force [N] bears, over what is noticed [1], shape (T,)."""
    past, future = one_sided_means(bearing, ticks_of(BALANCE_WINDOW, observation.dt))
    noticed = NOTICEABLE_SHARE * observation.mass(above) * observation.gravity
    ratio = np.maximum(past, future) / np.maximum(noticed, LEAST_WEIGHT)
    # A piece weighs nothing before it has come free, and is not borne yet.
    return np.where(observation.exists(above), ratio, 0.0)


def bearing_forces(observation: Observation) -> dict[Pair, FloatArray]:
    """Return the upward force of each unit on each one it supports [N], at each tick: (below, above) to (T,)."""
    known = observation.of(support_runs)
    return {pair: bearing for pair, bearing, _ in _bearing(observation) if pair in known}


def _bearing(observation: Observation) -> Iterator[tuple[Pair, FloatArray, BoolArray]]:
    """Yield what presses on what from below, with which force [N], and when they touch, shape (T,) each."""
    dt, count, naming = observation.dt, observation.tick_count, observation.of(named)
    together: dict[Pair, tuple[FloatArray, BoolArray]] = {}
    for touch in observation.of(touches):
        for below, above, bearing in ((touch.a, touch.b, touch.bears_b), (touch.b, touch.a, touch.bears_a)):
            if not (bearing > 0).any() or not _has_weight(observation, above):
                continue
            series = touch.series(bearing, count)
            touching = mask_of(debounce(touch.mask(count, dt), dt, gap=FLICKER), count)
            yield (below, above), series, touching
            stuff = int(naming[below])
            if stuff != below and not is_stuff(observation, above):
                force, when = together.get((stuff, above), (np.zeros(count), np.zeros(count, dtype=np.bool_)))
                together[stuff, above] = force + series, when | touching
    for pair, (force, when) in together.items():
        yield pair, force, when


def bearing_in_all(observation: Observation) -> dict[int, FloatArray]:
    """Return the upward force of all contacts on each unit that is supported [N], at each tick, shape (T,) each."""
    borne = {above: np.zeros(observation.tick_count) for _, above in observation.of(support_runs)}
    for touch in observation.of(touches):
        for unit, bears, lifts in ((touch.a, touch.bears_a, -touch.lifts_b), (touch.b, touch.bears_b, touch.lifts_b)):
            if unit in borne:
                borne[unit][touch.tick] += np.maximum(np.maximum(bears, lifts), 0.0)
    return borne


def supporters(observation: Observation) -> dict[int, list[tuple[int, IntArray]]]:
    """Return, for each unit that is borne, by whom and when."""
    found: dict[int, list[tuple[int, IntArray]]] = {}
    for (below, above), stretches in observation.of(support_runs).items():
        found.setdefault(above, []).append((below, stretches))
    return found


def _has_weight(observation: Observation, unit: int) -> bool:
    thing = observation.log.things[unit]
    return not thing.fixed and not is_held_from_outside(observation, unit) and thing.mass > 0
