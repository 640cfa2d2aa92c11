"""``attached(a, b)``: a holds b by grip, adhesion or a joint, and they move together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from prolepsis.fluents.intervals import close_gaps, debounce, hysteresis, mask_of, one_sided_means, ticks_of, union
from prolepsis.fluents.kinematics import centres, point_velocities
from prolepsis.fluents.observation import Observation, is_held_from_outside, is_loose
from prolepsis.fluents.registry import fluent
from prolepsis.fluents.solids.contact import FLICKER, is_stuff
from prolepsis.fluents.solids.support import NOTICEABLE_SHARE, supporters
from prolepsis.fluents.solids.touch import Touch, touches
from prolepsis.geometry.rotations import rotate_back
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.near import MARGIN
from prolepsis.log.timeline import Fact

SQUEEZE = 0.5
"""Least share of the pressing forces [1] that cancel out in a grip; in a groove of 45 degrees it is 0.3."""
TOGETHER_SPEED = 0.01
"""Speed of slipping [m/s] below which two things move together."""
LOST_SPEED = 0.05
"""Speed of slipping [m/s] up to which a grip that began keeps what it holds: what swings in a pinch creeps by
2 cm/s, what slips faster is out of a pad of 2 cm within half a second."""
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
    """Speed of b where it is pressed relative to what presses there [m/s], shape (T,)."""
    position: FloatArray
    """How far b has got on there, in the frame of what presses most [m], shape (T, 3)."""
    stretches: IntArray
    """When it holds."""


@fluent("attached", "o1", "o2")
def attached(observation: Observation) -> Iterator[Fact]:
    """o1 holds o2 by grip, adhesion or a joint and they move together; what rests on o1 is not attached."""
    names = observation.unit_names
    for grip in observation.of(grips):
        for start, end in grip.stretches:
            slip = np.linalg.norm(grip.position[end - 1] - grip.position[start])
            # In the middle of a gap of a hold it is not known.
            speed = grip.slip_speed[start:end]
            speed = speed[np.isfinite(speed)]
            evidence: dict[str, float | str] = {
                "by": "grip",
                "pad_force": float(grip.force[start:end].mean()),
                "peak_force": float(grip.force[start:end].max()),
                "slip": float(slip),
                "slip_speed": float(speed.max()),
                # A hold that ends in slipping always comes to the limit, so its firmest moment counts.
                MARGIN: float(speed.min()) / TOGETHER_SPEED,
            }
            for holder in grip.holders:
                args = names[holder], names[grip.held]
                yield observation.fact("fluent", "attached", args, (start, end), evidence)
    for (holder, held), stretches in observation.of(joint_runs).items():
        if is_stuff(observation, holder) or is_stuff(observation, held):
            continue
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
        pressing: list[Grip] = []
        hands: list[Touch] = []
        for touch in several:
            holder = touch.a if touch.b == held else touch.b
            if _presses_from_two_bodies(observation, touch, holder):
                pressing += _pressing(observation, held, [touch])
            elif is_held_from_outside(observation, holder) or observation.has_role(holder, "Mounted"):
                hands.append(touch)
        if len(hands) > 1:
            pressing += _pressing(observation, held, hands)
        found += [kept for grip in pressing for kept in _keeping(observation, grip, pressing)]
    return tuple(found)


def _presses_from_two_bodies(observation: Observation, touch: Touch, unit: int) -> bool:
    if len(observation.bodies(unit)) < 2:
        return False
    contacts = observation.log.contacts
    side = np.where(observation.unit[contacts.a[touch.rows]] == unit, contacts.a[touch.rows], contacts.b[touch.rows])
    return bool((side != side[0]).any())


def _pressing(observation: Observation, held: int, several: list[Touch]) -> list[Grip]:
    """Return a grip whose stretches are when it presses so, whether or not it keeps what it presses on; or none."""
    contacts, count = observation.log.contacts, observation.tick_count
    rows = np.concatenate([touch.rows for touch in several])
    mine = observation.unit[contacts.b[rows]] == held
    other = np.where(mine, contacts.a[rows], contacts.b[rows])
    press = np.abs(np.einsum("ci,ci->c", contacts.force[rows], contacts.normal[rows]))
    push = contacts.normal[rows] * (np.where(mine, 1.0, -1.0) * press)[:, None]
    weight = observation.mass(held) * observation.gravity
    gripping, force = _squeezed(contacts.tick[rows], press, push, weight)
    bodies, holds = sorted(set(other.tolist())), gripping[contacts.tick[rows]]
    # Two pads hold a thing even if a palm, against which something else pushes it, presses more.
    for pair in combinations(bodies, 2) if len(bodies) > 2 else ():
        of_pair = np.isin(other, pair)
        more, between = _squeezed(contacts.tick[rows[of_pair]], press[of_pair], push[of_pair], weight)
        force = np.where(more & ~gripping, between, force)
        gripping |= more
        holds |= of_pair & more[contacts.tick[rows]]
    if not gripping.any():
        return []
    body = int(np.argmax(np.bincount(other, press)))
    known = np.bincount(contacts.tick[rows[holds]], minlength=count) > 0
    own = np.where(mine, contacts.b[rows], contacts.a[rows])
    slipping = _slipping(observation, rows[holds], own[holds], other[holds], press[holds])
    velocity = rotate_back(observation.log.poses[:, body, 3:], slipping)
    holders = tuple(sorted({touch.a if touch.b == held else touch.b for touch in several}))
    grip = Grip(
        holders=holders,
        held=held,
        force=force,
        slip_speed=_slip_speed(velocity, observation.dt, known),
        position=np.cumsum(velocity, axis=0) * observation.dt,
        stretches=debounce(gripping, observation.dt, gap=FLICKER),
    )
    return [grip]


def _squeezed(tick: IntArray, press: FloatArray, push: FloatArray, weight: FloatArray) -> tuple[BoolArray, FloatArray]:
    """Return when pressing forces cancel out enough to hold a weight, and half their sum [N], each of shape (T,).

    Args:
        tick: When each presses, shape (R,).
        press: How much it does [N], shape (R,).
        push: The same as a vector [N], shape (R, 3).
        weight: What is to be held [N], shape (T,).
    """
    total = np.bincount(tick, press, len(weight))
    sums = [np.bincount(tick, push[:, k], len(weight)) for k in range(3)]
    squeeze = total - np.sqrt(sums[0] ** 2 + sums[1] ** 2 + sums[2] ** 2)
    enough: BoolArray = (squeeze > NOTICEABLE_SHARE * weight) & (squeeze > SQUEEZE * total)
    return enough, total / 2


def _slipping(
    observation: Observation, rows: IntArray, held: IntArray, other: IntArray, press: FloatArray
) -> FloatArray:
    """Return how fast what is held gets on where it is pressed [m/s], relative to what presses there, shape (T, 3).

    What swings between two pads turns about where they press, and does not get on there.
    """
    contacts, count = observation.log.contacts, observation.tick_count
    found = np.zeros((count, 3))
    if count < 2:
        return found
    tick, point = np.minimum(contacts.tick[rows], count - 2), contacts.point[rows]
    relative = point_velocities(observation, held, tick, point) - point_velocities(observation, other, tick, point)
    total = np.maximum(np.bincount(contacts.tick[rows], press, count), 1e-12)
    for axis in range(3):
        found[:, axis] = np.bincount(contacts.tick[rows], press * relative[:, axis], count) / total
    return found


def _keeping(observation: Observation, grip: Grip, several: list[Grip]) -> list[Grip]:
    """Return the grip with the stretches in which it keeps what it holds, if there are any."""
    count = observation.tick_count
    firm = mask_of(grip.stretches, count) & (grip.slip_speed < LOST_SPEED)
    begun = grip.slip_speed < TOGETHER_SPEED
    for below, stretches in observation.of(supporters).get(grip.held, []):
        if below in grip.holders:
            continue
        carried = mask_of(stretches, count)
        for other in several:
            if below in other.holders:
                # A pad that lies under a thing bears it, too, and each of two hands holds what both grip.
                carried &= ~mask_of(other.stretches, count)
        begun &= ~carried | _dragged(observation, below, grip.held)
    # What is set down is still held until it is let go of.
    firm = _since(firm, begun)
    stretches = debounce(firm, observation.dt, gap=HOLD_GAP, least=HOLD_LEAST)
    return [replace(grip, stretches=stretches)] if len(stretches) else []


def _since(mask: BoolArray, begun: BoolArray) -> BoolArray:
    """Return ``mask`` without what comes, in each of its runs, before something has begun, shape (T,)."""
    found = np.zeros_like(mask)
    for start, end in hysteresis(mask, begun).tolist():
        found[start + int(np.argmax(begun[start:end])) : end] = True
    return found


def _dragged(observation: Observation, below: int, held: int) -> BoolArray:
    """Return when a thing gets on over what bears it, shape (T,)."""
    pose = observation.log.poses[:, below]
    position = rotate_back(pose[:, 3:], observation.of(centres)[held] - pose[:, :3])
    velocity = np.diff(position, axis=0, append=position[-1:]) / observation.dt
    every = np.ones(observation.tick_count, dtype=np.bool_)
    return _slip_speed(velocity, observation.dt, every) > TOGETHER_SPEED


def _slip_speed(velocity: FloatArray, dt: float, known: BoolArray) -> FloatArray:
    """Return how fast something gets on over half a window before or after each tick [m/s], shape (T,).

    Args:
        velocity: During each tick [m/s], shape (T, 3).
        dt: Tick [s].
        known: The ticks in which the velocity is known, shape (T,).
    """
    half = ticks_of(TOGETHER_WINDOW / 2, dt)
    sides = [one_sided_means(velocity[:, axis], half) for axis in range(3)]
    shares = one_sided_means(known.astype(np.float64), half)
    found = np.full(len(velocity), np.inf)
    for k in range(2):
        # While the grip closes or opens one side of the window is outside it, so the steadier side counts.
        path = np.sqrt(sides[0][k] ** 2 + sides[1][k] ** 2 + sides[2][k] ** 2)
        found = np.minimum(found, np.where(shares[k] > 0, path / np.maximum(shares[k], 1e-12), np.inf))
    return found
