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
from prolepsis.terms.errors import PlanError

ACCELERATION = 2.0
"""Of the strokes [m/s^2]."""
APPROACH_SPEED, EASING = 0.01, 0.1
"""The hand goes down so fast until what it holds touches the surface, and gets to that in this time [m/s, s]."""
TOO_DEEP = 0.03
"""What has not touched the surface by so far below has nothing to wipe [m], as with a push."""
SETTLING = 0.4
"""Time for which it touches the surface, and the force grows, before the strokes begin [s]."""
TOO_LONG = 2.0
"""The hand gives up when this takes so much longer than it should [s]."""
RATE = 20.0
"""Rate at which an error of the force fades [1/s]: slow against the servo, fast against a stroke."""
FORCE_WITHIN = 0.2
"""The mean force of the strokes is what it should be within this share of it [1]: it lags by 2 to 7 % as they turn."""
LIFT_SPEED = 0.05
"""With which the hand lets go of the surface [m/s]."""


def _can_wipe(scene: Scene, *, object: Thing, surface: Thing, displacement: Triple, **_: object) -> None:
    del scene
    if object.name == surface.name:
        raise PlanError(f"plan: {object.name} cannot be wiped over itself")
    if not any(displacement[:2]):
        raise PlanError(f"plan: a stroke of wipe goes along the surface, not only up or down by {displacement[2]:g} m")


@action(
    HAND,
    HELD,
    ParameterSpec(name="surface", kind="object", needs="solid"),
    ParameterSpec(name="displacement", kind="displacement"),
    ParameterSpec(name="strokes", kind="count", default=2.0),
    ParameterSpec(name="force", kind="push", default=1.0),
    ParameterSpec(name="speed", kind="speed", default=0.15),
    check=_can_wipe,
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
    del scene
    start = holding(hand, object, sense)
    resting = start.load()[2]
    deadline = sense.time + TOO_DEEP / APPROACH_SPEED + SETTLING + TOO_LONG
    here, depth, sinking, settled, ticks, total = start.offset, 0.0, 0.0, 0.0, 0, 0.0

    def at(step: Triple, velocity: Triple) -> HandTarget:
        offset = (here[0] + step[0], here[1] + step[1], here[2] + step[2] - depth)
        return HandTarget(hand=hand.name, offset=offset, velocity=velocity, rotation=start.rotation)

    while settled < SETTLING:
        if depth > TOO_DEEP or sense.time > deadline:
            reason = f"{object.name} is not pressed on {surface.name} {depth * 1000:.0f} mm farther down"
            sense = yield (Measured(evidence={"force": 0.0, "reason": reason}, outcome="not_reached"),)
            return (yield from travel(hand, sense, (0.0, 0.0, depth), ACCELERATION, LIFT_SPEED))
        touches = sense.pressing(object.name, surface.name) > 0.0
        settled += TICK * touches
        growing = (force - resting + sense.hands[hand.name].load()[2]) / start.stiffness * RATE
        approaching = min(APPROACH_SPEED, sinking + APPROACH_SPEED / EASING * TICK)
        sinking = growing if touches or growing < 0.0 else approaching
        depth += sinking * TICK
        sense = yield (at((0.0, 0.0, 0.0), (0.0, 0.0, -sinking)),)
    x, y, z = displacement
    for stroke in range(1, round(strokes) + 1):
        along = (x, y, z) if stroke % 2 else (-x, -y, -z)
        for step, velocity in line(along, ACCELERATION, speed):
            pressed = resting - sense.hands[hand.name].load()[2]
            # The hand is a spring: commanded deeper, it presses more.
            depth += (force - pressed) / start.stiffness * RATE * TICK
            sense = yield (at(step, velocity),)
            ticks, total = ticks + 1, total + pressed
        sense = yield from arrived(hand, sense)
        here = (here[0] + along[0], here[1] + along[1], here[2] + along[2])
    # What presses on nothing feels a little of either sign.
    mean = max(total / ticks, 0.0)
    sense = yield from compared(sense, "force", mean, force, FORCE_WITHIN, "N")
    return (yield from travel(hand, sense, (0.0, 0.0, depth), ACCELERATION, LIFT_SPEED))
