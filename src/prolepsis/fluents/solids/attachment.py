"""``attached(a, b)``: a holds b by grip, adhesion or a joint, and they move together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from prolepsis.fluents.intervals import close_gaps, debounce, mask_of, ticks_of, union
from prolepsis.fluents.kinematics import centres
from prolepsis.fluents.observation import Observation, is_held_from_outside, is_loose
from prolepsis.fluents.registry import fluent
from prolepsis.fluents.solids.contact import FLICKER, is_stuff
from prolepsis.fluents.solids.support import NOTICEABLE_SHARE, supporters
from prolepsis.fluents.solids.touch import Touch, touches
from prolepsis.geometry.rotations import rotate_back
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.timeline import Fact

SQUEEZE = 0.5
"""Least share of the pressing forces [1] that cancel out in a grip; in a groove of 45 degrees it is 0.3."""
TOGETHER_SPEED = 0.01
"""Speed of slipping [m/s] below which two things move together."""
TOGETHER_WINDOW = 0.05
"""Time over which slipping is taken [s]."""
HOLD_GAP = 0.05
"""Gap in a hold that is not noticed [s]."""
HOLD_LEAST = 0.1
"""Shortest hold [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Grip:
    """What presses on b from several sides."""

    holders: tuple[int, ...]
    """Units that press."""
    held: int
    """Unit that is pressed on."""
    force: FloatArray
    """Half the sum of the normal forces, which for two pads is the force of one [N], shape (T,)."""
    slip_speed: FloatArray
    """Speed of b's middle relative to what presses most [m/s], shape (T,)."""
    position: FloatArray
    """b's middle in the frame of what presses most [m], shape (T, 3)."""
    stretches: IntArray
    """When it holds."""


@fluent("attached", "o1", "o2")
def attached(observation: Observation) -> Iterator[Fact]:
    """o1 holds o2 by grip, adhesion or a joint and they move together; what rests on o1 is not attached."""
    names = observation.unit_names
    for grip in observation.of(grips):
        for start, end in grip.stretches:
            slip = np.linalg.norm(grip.position[end - 1] - grip.position[start])
            evidence: dict[str, float | str] = {
                "by": "grip",
                "pad_force": float(grip.force[start:end].mean()),
                "peak_force": float(grip.force[start:end].max()),
                "slip": float(slip),
                "slip_speed": float(grip.slip_speed[start:end].max()),
            }
            for holder in grip.holders:
                args = names[holder], names[grip.held]
                yield observation.fact("fluent", "attached", args, (start, end), evidence)
    for (holder, held), stretches in observation.of(joint_runs).items():
        for stretch in stretches:
            yield observation.fact("fluent", "attached", (names[holder], names[held]), stretch, {"by": "joint"})


def attachment_runs(observation: Observation) -> dict[tuple[int, int], IntArray]:
    """Return when each unit holds another: (holder, held) to runs."""
    found: dict[tuple[int, int], list[IntArray]] = {}
    for grip in observation.of(grips):
        for holder in grip.holders:
            found.setdefault((holder, grip.held), []).append(grip.stretches)
    for pair, stretches in observation.of(joint_runs).items():
        found.setdefault(pair, []).append(stretches)
    return {pair: union(several) for pair, several in found.items()}


def joint_runs(observation: Observation) -> dict[tuple[int, int], IntArray]:
    """Return when joints or adhesion hold units together: (holder, held) to runs."""
    joints = observation.log.joints
    things = observation.log.things
    found: dict[tuple[int, int], list[IntArray]] = {}
    for a, b, start, end in zip(joints.a, joints.b, joints.start, joints.end, strict=True):
        holder, held = int(observation.unit[a]), int(observation.unit[b])
        if things[held].fixed and not things[holder].fixed:
            holder, held = held, holder
        if holder != held and end > start:
            found.setdefault((holder, held), []).append(np.array([[start, end]], dtype=np.int64))
    gap = ticks_of(HOLD_GAP, observation.dt)
    return {pair: close_gaps(union(each), gap) for pair, each in found.items()}


def grips(observation: Observation) -> tuple[Grip, ...]:
    """Return every grip: opposing pressure of two bodies of one thing, or of several that are driven or mounted."""
    by_held: dict[int, list[Touch]] = {}
    for touch in observation.of(touches):
        for unit in (touch.a, touch.b):
            if is_loose(observation, unit) and not is_stuff(observation, unit):
                by_held.setdefault(unit, []).append(touch)
    found: list[Grip] = []
    for held, several in by_held.items():
        hands: list[Touch] = []
        for touch in several:
            holder = touch.a if touch.b == held else touch.b
            if _presses_from_two_bodies(observation, touch, holder):
                found += _grip(observation, held, [touch])
            elif is_held_from_outside(observation, holder) or observation.has_role(holder, "Mounted"):
                hands.append(touch)
        if len(hands) > 1:
            found += _grip(observation, held, hands)
    return tuple(found)


def _presses_from_two_bodies(observation: Observation, touch: Touch, unit: int) -> bool:
    if len(observation.bodies(unit)) < 2:
        return False
    contacts = observation.log.contacts
    side = np.where(observation.unit[contacts.a[touch.rows]] == unit, contacts.a[touch.rows], contacts.b[touch.rows])
    return bool((side != side[0]).any())


def _grip(observation: Observation, held: int, several: list[Touch]) -> list[Grip]:
    contacts, count = observation.log.contacts, observation.tick_count
    rows = np.concatenate([touch.rows for touch in several])
    mine = observation.unit[contacts.b[rows]] == held
    other = np.where(mine, contacts.a[rows], contacts.b[rows])
    press = np.abs(np.einsum("ci,ci->c", contacts.force[rows], contacts.normal[rows]))
    push = contacts.normal[rows] * (np.where(mine, 1.0, -1.0) * press)[:, None]
    total = np.bincount(contacts.tick[rows], press, count)
    sums = [np.bincount(contacts.tick[rows], push[:, k], count) for k in range(3)]
    squeeze = total - np.sqrt(sums[0] ** 2 + sums[1] ** 2 + sums[2] ** 2)
    weight = observation.mass(held) * observation.gravity
    gripping = (squeeze > NOTICEABLE_SHARE * weight) & (squeeze > SQUEEZE * total)
    if not gripping.any():
        return []
    body = int(np.argmax(np.bincount(other, press)))
    pose = observation.log.poses[:, body]
    position = rotate_back(pose[:, 3:], observation.of(centres)[held] - pose[:, :3])
    speed = _slip_speed(position, observation.dt)
    holders = tuple(sorted({touch.a if touch.b == held else touch.b for touch in several}))
    firm = mask_of(debounce(gripping, observation.dt, gap=FLICKER), count) & (speed < TOGETHER_SPEED)
    firm &= ~_carried_by_others(observation, held, holders)
    stretches = debounce(firm, observation.dt, gap=HOLD_GAP, least=HOLD_LEAST)
    if not len(stretches):
        return []
    grip = Grip(holders=holders, held=held, force=total / 2, slip_speed=speed, position=position, stretches=stretches)
    return [grip]


def _slip_speed(position: FloatArray, dt: float) -> FloatArray:
    count, half = len(position), ticks_of(TOGETHER_WINDOW / 2, dt)
    now = np.arange(count)
    first, last = np.maximum(now - half, 0), np.minimum(now + half, count - 1)
    # While the grip closes or opens one side of the window is outside it, so the steadier side counts.
    past = np.linalg.norm(position - position[first], axis=1) / (np.maximum(now - first, 1) * dt)
    future = np.linalg.norm(position[last] - position, axis=1) / (np.maximum(last - now, 1) * dt)
    past[first == now], future[last == now] = np.inf, np.inf
    return np.minimum(past, future)


def _carried_by_others(observation: Observation, held: int, holders: tuple[int, ...]) -> BoolArray:
    several = [stretches for below, stretches in observation.of(supporters).get(held, []) if below not in holders]
    return mask_of(union(several), observation.tick_count)
