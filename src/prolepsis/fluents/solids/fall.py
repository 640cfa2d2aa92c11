"""``falling(a)``: nothing bears a any more, and its weight pulls it down until it lands."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import close_gaps, hysteresis, mask_of, ticks_of, union
from prolepsis.fluents.kinematics import climb_accelerations, climb_speeds, heights
from prolepsis.fluents.observation import Observation, is_loose
from prolepsis.fluents.registry import event
from prolepsis.fluents.solids.attachment import attachment_runs, joint_runs
from prolepsis.fluents.solids.contact import is_stuff
from prolepsis.fluents.solids.support import supporters
from prolepsis.fluents.solids.touch import touches
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact

FREE_FALL = 0.9
"""Downward acceleration that every fall reaches, as a share of gravity [1]: a flap that swings down on its hinge
stays below 0.75, and so does what slides down all but the steepest slope."""
FALL_WINDOW = 0.02
"""Time over which that is taken [s]: the shortest fall that counts lasts 32 ms."""
GIVING_WAY = 0.4
"""Downward acceleration from which it may begin [1]: a support that gives way still brakes a little."""
BRAKED = 0.5
"""Share of the weight [1] that contacts may still bear then."""
FALLING_HEIGHT = 0.005
"""Least height of a fall [m]: a thing that hops or settles does not fall."""
BRUSH = 0.03
"""Contact during a fall that does not end it [s]."""
SAME_MOMENT = 0.03
"""A fall begins when the last hold or support is lost, if that is within this time [s]."""


@event("falling", "o")
def falling(observation: Observation) -> Iterator[Fact]:
    """Nothing bears the thing and it goes down freely, from the loss of its support until it lands."""
    height, climb = observation.of(heights), observation.of(climb_speeds)
    for unit, stretches in observation.of(falling_runs).items():
        if is_stuff(observation, unit):
            continue
        for start, end in stretches:
            landed = min(int(end), observation.tick_count - 1)
            fallen = float(height[unit, start] - height[unit, landed])
            speed = float(-climb[unit, start:end].min())
            evidence = {"height": fallen, "speed": speed, MARGIN: fallen / FALLING_HEIGHT}
            yield observation.fact("event", "falling", (observation.unit_names[unit],), (start, end), evidence)


def falling_runs(observation: Observation) -> dict[int, IntArray]:
    """Return when each unit falls, parts of stuffs included."""
    steepest = np.minimum(*climb_accelerations(observation, FALL_WINDOW)) / max(observation.gravity, 1e-9)
    sinking = (steepest <= -GIVING_WAY) & (observation.of(climb_speeds) < 0)
    lifts = observation.of(lifting_forces)
    height = observation.of(heights)
    found: dict[int, IntArray] = {}
    for unit in observation.units:
        if not is_loose(observation, unit) or not (sinking[unit] & (steepest[unit] <= -FREE_FALL)).any():
            continue
        mask = sinking[unit] & observation.exists(unit) & ~_held(observation, unit)
        if unit in lifts:
            mask &= lifts[unit] < BRAKED * observation.mass(unit) * observation.gravity
        gap = ticks_of(BRUSH, observation.dt)
        stretches = close_gaps(hysteresis(mask, steepest[unit] <= -FREE_FALL), gap)
        landed = np.minimum(stretches[:, 1], observation.tick_count - 1)
        stretches = stretches[height[unit, stretches[:, 0]] - height[unit, landed] >= FALLING_HEIGHT]
        if len(stretches):
            found[unit] = _from_loss(observation, unit, stretches)
    return found


def lifting_forces(observation: Observation) -> dict[int, FloatArray]:
    """Return the upward force of all contacts on each unit that ever touches something [N], shape (T,) each."""
    count = observation.tick_count
    found: dict[int, FloatArray] = {}
    for touch in observation.of(touches):
        for unit, sign in ((touch.b, 1.0), (touch.a, -1.0)):
            if not observation.log.things[unit].fixed:
                found.setdefault(unit, np.zeros(count))[touch.tick] += sign * touch.lifts_b
    return found


def _held(observation: Observation, unit: int) -> BoolArray:
    """Return whether something supports, grips or is joined to a unit, at each tick, shape (T,)."""
    several = [stretches for _, stretches in observation.of(supporters).get(unit, [])]
    several += [stretches for pair, stretches in observation.of(joint_runs).items() if unit in pair]
    several += [stretches for (_, held), stretches in observation.of(attachment_runs).items() if held == unit]
    return mask_of(union(several), observation.tick_count)


def _from_loss(observation: Observation, unit: int, stretches: IntArray) -> IntArray:
    """Return the falls, each from the moment at which the last support or hold was lost."""
    held = [runs for _, runs in observation.of(supporters).get(unit, [])]
    held += [runs for (_, b), runs in observation.of(attachment_runs).items() if b == unit]
    if not held:
        return stretches
    losses = np.sort(np.concatenate([runs[:, 1] for runs in held]))
    near = ticks_of(SAME_MOMENT, observation.dt)
    moved = stretches.copy()
    for row, (start, end) in enumerate(stretches.tolist()):
        candidates = losses[(np.abs(losses - start) <= near) & (losses < end)]
        if len(candidates) and (row == 0 or candidates[-1] >= moved[row - 1, 1]):
            moved[row, 0] = candidates[-1]
    return moved
