"""Striking and pressing: what a hand holds is hit against something, pressed on it, or brought over it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray, Triple
from prolepsis.log.things import Thing
from prolepsis.programs.action import HAND, HELD, ParameterSpec, action
from prolepsis.programs.actions.motion import stay, travel, travel_over
from prolepsis.programs.moving.following import follow
from prolepsis.programs.moving.grasping import as_seen
from prolepsis.programs.moving.holding import free_pose, move_held, spots
from prolepsis.programs.moving.reached import compared
from prolepsis.robots.commands import ActionFailedError, Behaviour, HandTarget, Measured, Sense
from prolepsis.scene.extent import middle, support
from prolepsis.scene.running import TICK
from prolepsis.scene.scene import Scene, reference_of
from prolepsis.terms.errors import PlanError

LEAST_WINDUP = 0.03
"""The hand comes from at least this high above what it hits [m]."""
ACCELERATION = 6.0
"""With which it gets to its speed [m/s^2]."""
TOO_DEEP = 0.03
"""A blow or a push that has met nothing by this far past the surface has missed [m]."""
TOUCH = 0.3
"""Force at which a blow has met what it hits [N]."""
BACK, BACK_SPEED = 0.04, 0.1
"""After it the hand goes back this far, so fast [m, m/s]."""
APPROACH_HEIGHT, APPROACH_SPEED = 0.004, 0.02
"""A push begins this far above what it presses on, and goes down so fast [m, m/s]."""
BRING_SPEED, BRING_ACCELERATION = 0.3, 1.0
"""With which something is brought over something else [m/s, m/s^2]."""
EASING = 0.1
"""The push gets to its speed in this time; as long again, what the servos feel is the hand's own inertia [s]."""
RATE = 16.0
"""Rate at which an error of the force fades [1/s]."""
GIVEN_WAY = 0.2
"""What resists by this share of the whole force less than it should has given way [1]."""
BLOW_TIME = 0.02
"""A force counts as its mean over this time [s]: what touches down gives a blow of some milliseconds."""
SPEED_WITHIN, PUSH_WITHIN = 0.1, 0.05
"""A blow has its speed, a push its force within this share of it [1]."""
RAMP_TIME, HOLD_TIME = 1.0, 0.5
"""A push grows to its force in this time, and is held for this time [s]."""

AGAINST = ParameterSpec(name="against", kind="object", needs="solid")
PART = ParameterSpec(name="part", kind="part", default="edge")


def _has_part(scene: Scene, *, object: Thing, against: Thing, part: str, **_: object) -> None:
    del scene
    if object.name == against.name:
        raise PlanError(f"plan: {object.name} cannot be hit against itself, nor be pressed on itself")
    spots(against, part)


@action(HAND, HELD, AGAINST, ParameterSpec(name="speed", kind="speed", default=0.25), PART, check=_has_part)
def hit(
    scene: Scene, sense: Sense, *, hand: Thing, object: Thing, against: Thing, speed: float, part: str
) -> Behaviour:
    """Hit what the hand holds from above against the edge or the top of something, at a speed; draw back at once."""
    windup = max(LEAST_WINDUP, speed * speed / ACCELERATION)
    offset, rotation = free_pose(hand, object, sense, against, part, reference_of(scene, hand), windup)
    above = (offset[0], offset[1], offset[2] + windup)
    sense = yield from move_held(hand, object, sense, above, rotation)
    sense = yield from stay(0.2, sense)
    depths = _blow(windup + TOO_DEEP, speed)
    blow = follow(
        hand, sense, np.asarray(above) - depths[:, None] * (0.0, 0.0, 1.0), np.tile(rotation, (len(depths), 1))
    )
    made = next(blow)
    while True:
        met = -sense.hands[hand.name].velocity()[2]
        try:
            sense = yield made
            if sense.pressing(object.name, against.name) > TOUCH:
                break
            made = blow.send(sense)
        except StopIteration as ended:
            sense = ended.value
            yield from travel(hand, sense, (0.0, 0.0, BACK), 2.0, BACK_SPEED)
            raise ActionFailedError("missed", f"{object.name} did not meet {against.name}") from None
    here = sense.hands[hand.name]
    sense = yield (HandTarget(hand=hand.name, offset=here.offset, rotation=here.rotation),)
    sense = yield from compared(sense, "speed", met, speed, SPEED_WITHIN, "m/s")
    sense = yield from stay(0.05, sense)
    return (yield from travel(hand, sense, (0.0, 0.0, BACK), 2.0, BACK_SPEED))


def _blow(length: float, speed: float) -> FloatArray:
    """Return how deep a blow has come at each tick [m]: it gets to its speed, goes ``length`` [m], and slows down."""
    time_up = min(2 * speed / ACCELERATION, length / speed)
    full = length / speed - time_up / 2
    ticks = np.arange(1, round((full + 2 * time_up) / TICK) + 1) * TICK

    def risen(time: Any) -> Any:
        # The integral of a smooth step up to the speed.
        share = np.clip(time / time_up, 0.0, 1.0)
        return speed * time_up * (share**3 - share**4 / 2) + speed * np.maximum(time - time_up, 0.0)

    return risen(ticks) - risen(ticks - time_up - full)


@action(
    HAND,
    HELD,
    AGAINST,
    ParameterSpec(name="force", kind="push"),
    ParameterSpec(name="part", kind="part", default="top"),
    ParameterSpec(name="duration", kind="duration", default=HOLD_TIME),
    check=_has_part,
)
def press(
    scene: Scene,
    sense: Sense,
    *,
    hand: Thing,
    object: Thing,
    against: Thing,
    force: float,
    part: str,
    duration: float,
) -> Behaviour:
    """Press what the hand holds from above on something with a force, for a while, and draw back."""
    offset, rotation = free_pose(hand, object, sense, against, part, reference_of(scene, hand), APPROACH_HEIGHT)
    above = (offset[0], offset[1], offset[2] + APPROACH_HEIGHT)
    sense = yield from move_held(hand, object, sense, above, rotation)
    sense = yield from stay(0.2, sense)
    sense = yield from push_down(hand, sense, force, duration, lambda now: now.pressing(object.name, against.name))
    return (yield from travel(hand, sense, (0.0, 0.0, BACK), 2.0, BACK_SPEED))


@action(
    HAND,
    ParameterSpec(name="target", kind="object", needs="solid"),
    ParameterSpec(name="height", kind="length", default=0.08),
)
def bring(scene: Scene, sense: Sense, *, hand: Thing, target: Thing, height: float) -> Behaviour:
    """Move the hand, turned as it is and with what it holds, to a height over the middle of something's top."""
    del scene
    here = sense.hands[hand.name]
    if here.grip and target.name in here.held():
        raise ActionFailedError("unreachable", f"{hand.name} holds {target.name}, which goes where the hand goes")
    seen = as_seen(target, sense)
    x, y, _ = np.asarray(seen.position) + middle(seen)
    top = seen.position[2] + support(seen, np.array([0.0, 0.0, 1.0]))
    displacement = np.subtract((x, y, top + height), here.position)
    return (yield from travel_over(hand, sense, displacement, BRING_ACCELERATION, BRING_SPEED))


def push_down(
    hand: Thing, sense: Sense, force: float, duration: float, pressing: Callable[[Sense], float] | None = None
) -> Behaviour:
    """Go down until something resists, raise the force to ``force`` [N], and keep it for ``duration`` [s].

    The force is steered by the joints' efforts, against what they were before; whether it was reached is told by what
    is ``pressing`` [N], if that is given: a finger may come to bear the rest.
    """
    start = sense.hands[hand.name]
    begin, resting = sense.time, start.load()[2]
    depth, elapsed, touched, greatest, creeping, borne = 0.0, 0.0, False, 0.0, 0.0, 0.0
    while elapsed < RAMP_TIME + duration and depth < TOO_DEEP:
        felt, since = resting - sense.hands[hand.name].load()[2], sense.time - begin
        touched = touched or (felt > TOUCH and since > 2 * EASING)
        if touched:
            borne += ((felt if pressing is None else pressing(sense)) - borne) * TICK / BLOW_TIME
            greatest = max(greatest, borne)
            elapsed += TICK
            wanted = force * min(elapsed / RAMP_TIME, 1.0)
            growing = force / RAMP_TIME / start.stiffness if elapsed < RAMP_TIME else 0.0
            error = (wanted - felt) / start.stiffness * RATE
            # What is held creeps in the hand in proportion to the force: the hand must go on sinking to keep that up,
            # but not when what it presses on has given way.
            creeping = max(creeping + error * RATE / 4 * TICK, 0.0) if felt > wanted - GIVEN_WAY * force else 0.0
            sinking = growing + error + creeping
        else:
            sinking = APPROACH_SPEED * min((since + TICK) / EASING, 1.0)
        depth += sinking * TICK
        position: Triple = (start.offset[0], start.offset[1], start.offset[2] - depth)
        target = HandTarget(hand=hand.name, offset=position, velocity=(0.0, 0.0, -sinking), rotation=start.rotation)
        sense = yield (target, Measured(evidence={"force": greatest}))
    return (yield from compared(sense, "force", greatest, force, PUSH_WITHIN, "N"))
