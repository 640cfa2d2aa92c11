"""Wiping: strokes of what the hand holds over a surface, pressed on with a force."""

from __future__ import annotations

from prolepsis.geometry.shape import Triple
from prolepsis.log.things import Thing
from prolepsis.programs.action import HAND, HELD, ParameterSpec, action
from prolepsis.programs.actions.motion import TICK, line, travel
from prolepsis.programs.moving.holding import holding
from prolepsis.programs.moving.reached import arrived, compared
from prolepsis.robots.commands import Behaviour, HandTarget, Measured, Sense
from prolepsis.scene.scene import Scene

ACCELERATION = 2.0
"""Of the strokes [m/s^2]."""
SETTLING = 0.4
"""Time in which the hand finds the surface and presses [s]."""
RATE = 20.0
"""Rate at which an error of the force fades [1/s]: slow against the servo, fast against a stroke."""
FORCE_WITHIN = 0.2
"""The mean force of the strokes is what it should be within this share of it [1]: it lags by 2 to 7 % as they turn."""
LIFT_SPEED = 0.05
"""With which the hand lets go of the surface [m/s]."""


@action(
    HAND,
    HELD,
    ParameterSpec(name="surface", kind="object", needs="solid"),
    ParameterSpec(name="displacement", kind="displacement"),
    ParameterSpec(name="strokes", kind="count", default=2.0),
    ParameterSpec(name="force", kind="push", default=1.0),
    ParameterSpec(name="speed", kind="speed", default=0.15),
)
def wipe(
    scene: Scene,
    sense: Sense,
    *,
    hand: Thing,
    object: Thing,
    surface: Thing,
    displacement: Triple,
    strokes: float,
    force: float,
    speed: float,
) -> Behaviour:
    """Stroke what the hand holds over the surface, by a displacement and back in turn, pressed on with a force."""
    del scene, surface
    start = holding(hand, object, sense)
    resting = start.load()[2]
    still: list[tuple[Triple, Triple]] = [((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))] * round(SETTLING / TICK)
    here, depth, ticks, total = start.offset, 0.0, 0, 0.0
    x, y, z = displacement
    for stroke in range(round(strokes) + 1):
        along = (x, y, z) if stroke % 2 else (-x, -y, -z)
        for step, velocity in still if stroke == 0 else line(along, ACCELERATION, speed):
            pressed = resting - sense.hands[hand.name].load()[2]
            # The hand is a spring: commanded deeper, it presses more.
            depth += (force - pressed) / start.stiffness * RATE * TICK
            offset = (here[0] + step[0], here[1] + step[1], here[2] + step[2] - depth)
            sense = yield (HandTarget(hand=hand.name, offset=offset, velocity=velocity, rotation=start.rotation),)
            if stroke:
                ticks, total = ticks + 1, total + pressed
        if stroke:
            sense = yield from arrived(hand, sense)
            here = (here[0] + along[0], here[1] + along[1], here[2] + along[2])
    # What presses on nothing feels a little of either sign.
    mean = max(total / ticks, 0.0)
    sense = yield (Measured(evidence={"force": mean}),)
    sense = yield from compared(sense, "force", mean, force, FORCE_WITHIN, "N")
    return (yield from travel(hand, sense, (0.0, 0.0, depth), ACCELERATION, LIFT_SPEED))
