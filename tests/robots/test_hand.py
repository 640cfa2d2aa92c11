"""The hand delivers the force it is told, and rigid bodies obey the textbook."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.comparing import Compare
from tests.scenes import run, scene

from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.programs.program import Program
from prolepsis.robots.commands import Behaviour, OpenGripper, Sense

BLOCK_IN_HAND = (
    ":floor a :Floor . :table1 a :Table . "
    ':block1 a :Block ; :on :table1 ; :length 0.04 ; :width 0.04 ; :height 0.04 ; :friction 0.7 ; :mass "50 g" . '
    ":hand1 a :Gripper ; :pitch 90.0 ; :z 0.72 ; :opening 0.05 ."
)


@pytest.mark.parametrize("force", [2.0, 5.0, 10.0, 20.0, 40.0])
def test_the_commanded_pad_force_arrives(compare: Compare, force: float) -> None:
    log = run(BLOCK_IN_HAND, f"sequence([close(hand1, {force}), hold(hand1, 0.3)])")
    pads = log.channels["hand1.pad_force"]
    closed = log.actions[0].end
    compare("force of the pads on a block", pads[closed:].mean(), force, by="as told", share=0.01, unit="N")
    assert pads.max() < 1.05 * force


@pytest.mark.parametrize("force", [2.0, 40.0])
def test_the_commanded_pad_force_arrives_on_an_egg_too(compare: Compare, force: float) -> None:
    from tests.scenes import EGG_IN_HAND

    log = run(
        EGG_IN_HAND,
        f"sequence([close(hand1, {force}), hold(hand1, 0.3)])",
        values={"eggshell1.breakingForce": 100.0},
    )
    pads = log.channels["hand1.pad_force"]
    found = pads[log.actions[0].end :].mean()
    compare("force of the pads on an egg", found, force, by="as told", share=0.01, unit="N")
    assert pads.max() < 1.05 * force


@pytest.mark.parametrize(("share", "held"), [(0.8, False), (1.25, True)])
def test_a_block_is_held_iff_friction_bears_its_weight(compare: Compare, share: float, held: bool) -> None:
    # 2 mu N >= m (g + a), with the greatest acceleration of the lift.
    force = share * 0.05 * (9.81 + 1.0) / (2 * 0.7)
    log = run(BLOCK_IN_HAND, f"sequence([close(hand1, {force!r}), lift(hand1, 0.1), hold(hand1, 0.3)])")
    risen = log.poses[-1, log.index("block1"), 2] - log.poses[0, log.index("block1"), 2]
    what, by = "a grip holds a block that is lifted (80 and 125 % of the least)", "`2 mu N = m (g + a)`"
    compare(what, risen > 0.095, held, by=by)


@pytest.mark.parametrize(("slope", "slides"), [(14.0, False), (20.0, True)])
def test_a_block_slides_iff_the_slope_exceeds_the_friction_angle(slope: float, slides: bool) -> None:
    # The block's wood and the board: 0.301, so atan 16.7 degrees.
    tilt = math.radians(slope)
    x, z = 0.06 * math.sin(tilt), 0.3 + 0.06 * math.cos(tilt) + 1e-4
    situation = (
        f":floor a :Floor . :board1 a :Wall ; :length 1.0 ; :width 0.5 ; :height 0.02 ; :z 0.3 ; :pitch {slope} ; "
        f":friction 0.301 . :block1 a :Block ; :x {x!r} ; :z {z!r} ; :pitch {slope} ."
    )
    log = run(situation, duration=0.6)
    path = log.poses[:, log.index("block1"), :3]
    moved = float(np.linalg.norm(path[-1] - path[100]))
    if slides:
        pull = 9.81 * (math.sin(tilt) - 0.301 * math.cos(tilt))
        assert moved == pytest.approx(0.5 * pull * (0.6**2 - 0.1**2), rel=0.1)
    else:
        assert moved < 1e-4


def test_a_ball_falls_freely(compare: Compare) -> None:
    log = run(":floor a :Floor . :ball1 a :Ball ; :z 2.0 .", duration=0.5)
    drop = log.poses[0, log.index("ball1"), 2] - log.poses[400, log.index("ball1"), 2]
    compare("a ball falls for 0.4 s", drop, 0.5 * 9.81 * 0.4**2, by="`g t^2 / 2`", share=0.01, unit="m")


def test_the_more_slippery_surface_decides() -> None:
    """A wet hand's block slips at a force at which a dry hand holds it."""
    plan = "sequence([close(hand1, 0.6), lift(hand1, 0.05), hold(hand1, 0.2)])"
    dry = run(BLOCK_IN_HAND, plan)
    wet = run(BLOCK_IN_HAND + " :hand1 :wet true .", plan)
    heights = [float(log.poses[-1, log.index("block1"), 2]) for log in (dry, wet)]
    assert heights[0] - heights[1] > 0.04


def test_what_presses_on_both_fingers_from_outside_is_not_between_the_pads() -> None:
    wall = ":wall{0} a :Obstacle ; :on :table1 ; :y {1} ; :length 0.1 ; :width 0.04 ; :height 0.15 . "
    walls = wall.format(1, 0.05) + wall.format(2, -0.05)
    between = scene(
        ":floor a :Floor . :table1 a :Table . " + walls + ":hand1 a :Gripper ; :pitch 90.0 ; :z 0.8 ; :opening 0.02 ."
    )
    held: set[str] = set()
    touched: set[str] = set()

    def opening(sense: Sense) -> Behaviour:
        sense = yield (OpenGripper(hand="hand1", width=0.08, speed=0.2),)
        for _ in range(400):
            sense = yield ()
            here = sense.hands["hand1"]
            held.update(here.held())
            touched.update(here.fingers())
        return sense

    simulate(compile_world(between), Program(term="opening", begin=opening), duration=0.4)
    assert touched == {"wall1", "wall2"}
    assert not held
