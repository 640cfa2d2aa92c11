"""Two hands carry a tray by its ends: each holds it, both pick it up; if one goes up, what stands on it slides off."""

from __future__ import annotations

import pytest
from tests.scenes import run

from prolepsis.fluents import recognize
from prolepsis.log.timeline import Timeline

TRAY = """:floor a :Floor . :table1 a :Table .
:stand1 a :Obstacle ; :on :table1 ; :length 0.1 ; :width 0.1 ; :height 0.08 .
:tray1 a :Block ; :on :stand1 ; :length 0.2 ; :width 0.4 ; :height 0.012 ; :mass 0.6 .
:block1 a :Block ; :on :tray1 ; :y 0.06 ; :length 0.05 ; :width 0.05 ; :height 0.05 ; :mass 0.1 .
:handL a :Gripper ; :y 0.19 ; :z 0.786 ; :yaw -90 ; :roll 90 ; :opening 0.03 .
:handR a :Gripper ; :y -0.19 ; :z 0.786 ; :yaw 90 ; :roll 90 ; :opening 0.03 .
"""
PLAN = """sequence([together([grasp(handL, tray1, 40), grasp(handR, tray1, 40)]),
                    together([lift(handL, 0.1), lift(handR, 0.1)]), lift(handL, 0.16), wait(0.5)])"""


@pytest.fixture(scope="module")
def carried() -> Timeline:
    return recognize(run(TRAY, PLAN))


def test_each_hand_gets_hold_of_its_end_which_is_longer_than_its_fingers(carried: Timeline) -> None:
    assert {fact.evidence["outcome"] for fact in carried.facts if "outcome" in fact.evidence} == {"done"}
    assert not carried.ask("holds(contacts(H, block1), S-_), instance_of(H, 'Gripper'), S < 2.9")


def test_both_hold_it_at_once_and_both_pick_it_up(carried: Timeline) -> None:
    assert carried.ask(
        "holds(attached(handL, tray1), T), holds(attached(handR, tray1), 2.9), T = S-E, S < 2.9, E > 2.9"
    )
    assert {a["H"] for a in carried.ask("occurs(picking_up(H, tray1), _)")} == {"handL", "handR"}
    assert carried.ask("holds(supports(tray1, block1), 2.9), \\+ holds(supports(stand1, tray1), 2.9)")


def test_what_stands_on_it_slides_off_when_one_goes_up(carried: Timeline) -> None:
    assert carried.ask("occurs(lifting(handL, 0.16), L), occurs(moving(block1), T), after(T, L)")
    assert not carried.ask("holds(supports(tray1, block1), 4.8)")
