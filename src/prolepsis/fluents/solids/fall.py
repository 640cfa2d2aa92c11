"""``falling(a)``: nothing bears a any more, and its weight pulls it down until it lands."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from prolepsis.fluents.intervals import hysteresis, mask_of, ticks_of, union
from prolepsis.fluents.kinematics import climb_accelerations, climb_speeds, heights
from prolepsis.fluents.margins import NearMiss
from prolepsis.fluents.observation import Observation, is_loose
from prolepsis.fluents.registry import event
from prolepsis.fluents.solids.attachment import attachment_runs, joint_runs
from prolepsis.fluents.solids.contact import is_stuff
from prolepsis.fluents.solids.support import supporters
from prolepsis.fluents.solids.touch import touches
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.near import MARGIN, NEAR
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
"""Contact during a fall that does not end it [s] ..."""
KEPT = 0.5
"""... if it goes on down by this share of its speed [1] all the while: what rebounds or is stopped has landed."""
SAME_MOMENT = 0.03
"""A fall begins when the last hold or support is lost, if that is within this time [s]."""


@event("falling", "o")
def falling(observation: Observation) -> Iterator[Fact | NearMiss]:
    """Nothing bears the thing and it goes down freely, from the loss of its support until it lands or rebounds."""
    climb = observation.of(climb_speeds)
    for unit, stretches in observation.of(ways_down).items():
        if is_stuff(observation, unit):
            continue
        fallen = _fallen(observation, unit, stretches)
        for (start, end), height in zip(stretches.tolist(), fallen.tolist(), strict=True):
            what = "event", "falling", (observation.unit_names[unit],), (start, end)
            margin = height / FALLING_HEIGHT
            if margin >= 1:
                speed = float(-climb[unit, start:end].min())
                yield observation.fact(*what, {"height": height, "speed": speed, MARGIN: margin})
            elif margin >= 1 - NEAR:
                yield NearMiss(fact=observation.fact(*what, {MARGIN: margin}))


def falling_runs(observation: Observation) -> dict[int, IntArray]:
    """Return when each unit falls, parts of stuffs included."""
    found: dict[int, IntArray] = {}
    for unit, stretches in observation.of(ways_down).items():
        high = stretches[_fallen(observation, unit, stretches) >= FALLING_HEIGHT]
        if len(high):
            found[unit] = high
    return found


def ways_down(observation: Observation) -> dict[int, IntArray]:
    """Return when each unit goes down freely, by however little, parts of stuffs included."""
    steepest = np.minimum(*climb_accelerations(observation, FALL_WINDOW)) / max(observation.gravity, 1e-9)
    climb = observation.of(climb_speeds)
    sinking = (steepest <= -GIVING_WAY) & (climb < 0)
    lifts = observation.of(lifting_forces)
    found: dict[int, IntArray] = {}
    for unit in observation.units:
        if not is_loose(observation, unit) or not (sinking[unit] & (steepest[unit] <= -FREE_FALL)).any():
            continue
        mask = sinking[unit] & observation.exists(unit) & ~_held(observation, unit)
        if unit in lifts:
            mask &= lifts[unit] < BRAKED * observation.mass(unit) * observation.gravity
        stretches = _brushing(hysteresis(mask, steepest[unit] <= -FREE_FALL), climb[unit], observation.dt)
        if len(stretches):
            found[unit] = _from_loss(observation, unit, stretches)
    return found


def _brushing(stretches: IntArray, climb: FloatArray, dt: float) -> IntArray:
    """Return the stretches, those as one between which it only brushes something on its way down."""
    joined: list[list[int]] = []
    for start, end in stretches.tolist():
        last = joined[-1][1] if joined else -1
        if joined and start - last <= ticks_of(BRUSH, dt) and (climb[last:start] <= KEPT * climb[last - 1]).all():
            joined[-1][1] = end
        else:
            joined.append([start, end])
    return np.array(joined, dtype=np.int64).reshape(-1, 2)


def _fallen(observation: Observation, unit: int, stretches: IntArray) -> FloatArray:
    """Return by how much a unit goes down in each of the stretches [m]."""
    height = observation.of(heights)[unit]
    return height[stretches[:, 0]] - height[np.minimum(stretches[:, 1], observation.tick_count - 1)]


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
