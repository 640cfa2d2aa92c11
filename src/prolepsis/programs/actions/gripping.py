"""Gripping: grasp an object with a force, close, release."""

from __future__ import annotations

import numpy as np

from prolepsis.log.things import Thing
from prolepsis.programs.action import FORCE, HAND, HELD, ParameterSpec, action
from prolepsis.programs.actions.motion import HEIGHT, SHORT, open_to, stay, within_workspace
from prolepsis.programs.moving.grasping import CLEARANCE, grasp_as_turned
from prolepsis.programs.moving.holding import holding
from prolepsis.programs.moving.reached import compared
from prolepsis.programs.nesting import nested
from prolepsis.robots.commands import ActionFailedError, Behaviour, CloseGripper, HandSense, Measured, Sense
from prolepsis.scene.scene import Scene

SLOWEST, FASTEST = 0.002, 0.006
"""Guarded closing speeds of a finger [m/s]: touching down at v sqrt(k m) adds 0.3 to 0.8 N."""
SPEED_PER_FORCE = 0.003
"""Guarded speed for each newton commanded [m/s/N], between those two: a weak grasp touches more gently."""
TIMEOUT = 8.0
"""A closing that has not ended by then has nothing to hold on to [s]."""
FORCE_WITHIN = 0.1
"""The pads have got to their force within this share of it [1]."""


def close_from(hand: Thing, width: float, force: float, sense: Sense) -> Behaviour:
    """Close quickly to ``width`` [m], slowly until contact, then raise the force to ``force`` [N]."""
    deadline = sense.time + TIMEOUT
    speed = min(max(SPEED_PER_FORCE * force, SLOWEST), FASTEST)
    sense = yield (CloseGripper(hand=hand.name, force=force, width=width, speed=speed),)
    while sense.hands[hand.name].motion != 0 and sense.time < deadline:
        sense = yield ()
    return sense


def felt(hand: Thing, force: float, sense: Sense, object: Thing | None = None) -> Behaviour:
    """Say what lies between the pads once they have closed, and whether they have got to the force [N].

    Raises:
        ActionFailedError: If they hold something, but have not come to rest; or not what they should.
    """
    here = sense.hands[hand.name]
    held = here.held()
    sense = yield (Measured(evidence={"between": " and ".join(held) or "nothing"}),)
    if object is not None and object.name not in held:
        between = " and ".join(held) or "nothing"
        raise ActionFailedError(
            "missed", f"between the pads of {hand.name} is {between}, not {object.name}{_pressed_on(here)}"
        )
    if not held:
        return sense
    if here.motion != 0:
        raise ActionFailedError("timed_out", f"{hand.name} does not come to rest on {' and '.join(held)}")
    return (yield from compared(sense, "pad_force", here.pad_force, force, FORCE_WITHIN, "N"))


def _pressed_on(here: HandSense) -> str:
    """Return what the fingers press on, if they hold nothing: both may do so from the same side."""
    against = () if here.held() else sorted(here.fingers())
    return f"; its fingers are pressed against {' and '.join(against)}" if against else ""


@action(HAND, FORCE)
def close(scene: Scene, sense: Sense, *, hand: Thing, force: float) -> Behaviour:
    """Close the gripper slowly until contact, then raise the force to the given one."""
    del scene
    sense = yield from close_from(hand, hand.quantities["maxOpening"], force, sense)
    if not sense.hands[hand.name].held():
        # What it should hold has not been said: a fist may be what is wanted, so that the plan goes on.
        reason = f"between the pads of {hand.name} is nothing{_pressed_on(sense.hands[hand.name])}"
        yield (Measured(evidence={"reason": reason}, outcome="missed"),)
    return (yield from felt(hand, force, sense))


@action(HAND, HELD, FORCE, HEIGHT, SHORT, check=within_workspace)
def grasp(
    scene: Scene, sense: Sense, *, hand: Thing, object: Thing, force: float, height: float, short: float
) -> Behaviour:
    """Reach for the object's middle, a height above or short of it, unless the hand is there; close with a force."""
    pose = grasp_as_turned(hand, object, sense, height, short)
    here = sense.hands[hand.name]
    displacement = np.subtract(pose.offset, here.offset)
    if np.abs(displacement).max() > CLEARANCE or here.opening < pose.width:
        aside = {name: value for name, value in (("height", height), ("short", short)) if value}
        sense = yield from nested("reach", scene, sense, hand=hand, object=object, **aside)
        pose = grasp_as_turned(hand, object, sense, height, short)
    sense = yield from close_from(hand, pose.width + CLEARANCE, force, sense)
    return (yield from felt(hand, force, sense, object))


@action(HAND, HELD, FORCE, ParameterSpec(name="duration", kind="duration", default=1.0))
def squeeze(scene: Scene, sense: Sense, *, hand: Thing, object: Thing, force: float, duration: float) -> Behaviour:
    """Press what the hand holds with the given force for a while, then hold it as before."""
    del scene
    before = holding(hand, object, sense).grip
    sense = yield from close_from(hand, hand.quantities["maxOpening"], force, sense)
    sense = yield from felt(hand, force, sense)
    sense = yield from stay(duration, sense)
    if before > 0.0:
        sense = yield from close_from(hand, hand.quantities["maxOpening"], before, sense)
    return sense


@action(HAND)
def release(scene: Scene, sense: Sense, *, hand: Thing) -> Behaviour:
    """Open the gripper fully."""
    del scene
    return (yield from open_to(hand, hand.quantities["maxOpening"], sense))
