"""``contacts(a, b)``: two solids press on each other."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import debounce, ticks_of
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import fluent
from prolepsis.fluents.solids.touch import Touch, touches
from prolepsis.log.timeline import Fact

FLICKER = 0.03
"""Gap in a contact that is not noticed [s]: a resting body hops for some 10-20 ms at a time, a bounce that one
sees is longer."""

LEAST_PRESS = 0.01
"""What presses for no longer than a flicker, and never with this share of the lighter one's weight [1], does not touch:
shards that brush a hand press by half of it, what a solver leaves between two that part by a thousandth."""


@fluent("contacts", "o1", "o2")
def contacts(observation: Observation) -> Iterator[Fact]:
    """Two solids press on each other; the one that acts (a gripper, then a loose thing) is named first."""
    brief = ticks_of(FLICKER, observation.dt)
    for touch in observation.of(touches):
        if is_stuff(observation, touch.a) or is_stuff(observation, touch.b):
            continue
        names = pair_names(observation, touch.a, touch.b)
        for start, end in debounce(touch.mask(observation.tick_count, observation.dt), observation.dt, gap=FLICKER):
            evidence = forces_within(touch, int(start), int(end), observation.dt)
            least = LEAST_PRESS * lighter_mass(observation, touch) * observation.gravity
            if end - start <= brief and float(evidence["peak_force"]) < least:
                continue
            yield observation.fact("fluent", "contacts", names, (start, end), evidence)


def forces_within(touch: Touch, start: int, end: int, dt: float) -> dict[str, float | str]:
    """Return the peak and mean normal force [N] and the impulse [N s] of a contact over ticks ``start`` to ``end``."""
    low, high = np.searchsorted(touch.tick, (start, end))
    force = touch.force[low:high]
    return {
        "peak_force": float(touch.peak[low:high].max()),
        "mean_force": float(force.sum() / max(end - start, 1)),
        "impulse": float(force.sum() * dt),
    }


def lighter_mass(observation: Observation, touch: Touch) -> float:
    """Return the mass of the lighter one of two units of which not both are fixed [kg]."""
    things = observation.log.things
    masses = [float(observation.mass(u).max()) for u in (touch.a, touch.b) if not things[u].fixed]
    return min((mass for mass in masses if mass > 0), default=0.0)


def pair_names(observation: Observation, first: int, second: int) -> tuple[str, str]:
    """Return the names of two units in the order of a symmetric fact: robots, then loose things, then fixed ones."""

    def rank(unit: int) -> tuple[int, str]:
        order = 0 if observation.has_role(unit, "Gripper", "Driven", "Robot") else 1
        return (2 if observation.log.things[unit].fixed else order), observation.unit_names[unit]

    a, b = sorted((first, second), key=rank)
    return observation.unit_names[a], observation.unit_names[b]


def is_stuff(observation: Observation, unit: int) -> bool:
    """Return whether a unit is a part of a stuff, which is no solid."""
    return observation.has_role(unit, "Blob", "Stuff")
