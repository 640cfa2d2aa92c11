"""Ordinary solids are hard: a few rows of the laws in ``tests/laws/test_solids.py``, and what went wrong on the way."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.laws.rest_scenes import FLOOR, TABLE, ball, block
from tests.laws.solid_scenes import overhanging, passes, rebound, slide, topples
from tests.scenes import run


def test_a_block_topples_within_a_third_of_a_degree_of_where_it_should() -> None:
    angle = math.degrees(math.atan(0.3))
    assert not topples(0.03, 0.1, angle - 0.3)
    assert topples(0.03, 0.1, angle + 0.3)


def test_small_bricks_hang_over_within_a_hundredth_of_what_is_possible() -> None:
    assert not overhanging(4, (0.05, 0.03, 0.015), 0.99)
    assert overhanging(4, (0.05, 0.03, 0.015), 1.01)


@pytest.mark.parametrize(
    ("material", "expected"),
    [
        ("", 0.55),
        (":restitution 0.83 ; :youngsModulus 3.0e6", 0.83),
        (":restitution 0.94 ; :youngsModulus 70.0e9", 0.612),
    ],
    ids=["wood", "rubber", "glass"],
)
def test_a_ball_rebounds_from_wood_as_the_softer_one_allows(material: str, expected: float) -> None:
    assert rebound(0.5, material or ":density 600.0", ":friction 0.3") == pytest.approx(expected, abs=0.02)


def test_what_slides_presses_as_its_weight_and_does_not_hop() -> None:
    found = slide(0.3, 2.0)
    assert found.rise < 2e-5
    assert found.force == pytest.approx((1.0, 1.0), abs=0.05)


@pytest.mark.parametrize("pitch", [0.0, 20.0])
def test_a_fast_cube_does_not_go_through_a_plate(pitch: float) -> None:
    assert not passes(20.0, pitch, 0.0)


def test_a_ball_that_is_hit_obliquely_takes_up_spin_by_friction_alone() -> None:
    # An impulse J upwards goes with one of at most mu J along the floor, and with r mu J of spin.
    log = run(
        FLOOR + ball("b", 0.03, ":z 0.3 ; :friction 0.1"), duration=0.3, thrown={"b": (2.0, 0.0, 0.0, 0.0, 0.0, 0.0)}
    )
    velocity = np.diff(log.poses[:, log.index("b"), :3], axis=0) / log.dt
    hit = int(np.flatnonzero(velocity[:, 2] > 0.0)[0])
    lost = velocity[hit - 5, 0] - velocity[hit + 5, 0]
    assert lost == pytest.approx(0.1 * (velocity[hit + 5, 2] - velocity[hit - 5, 2]), rel=0.03)


def test_what_is_struck_between_two_others_gains_no_energy() -> None:
    # A plank end that goes to and fro between floor and weight parts from the one as it hits the other.
    turtle = (
        FLOOR
        + block("a", (0.03, 0.1, 0.03), ":on :floor ; :density 2000.0")
        + block("plank", (0.6, 0.06, 0.01), ":z 0.0355 ; :density 600.0")
        + block("heavy", (0.05, 0.05, 0.05), ":x 0.26 ; :z 0.3 ; :mass 3.0")
    )
    log = run(turtle, duration=0.6)
    assert log.poses[:, log.index("plank"), 2].max() < 0.2


def test_a_stack_at_rest_stays_at_rest() -> None:
    size, turtle = (0.05, 0.03, 0.015), TABLE
    for k, over in enumerate((0.006, 0.008, 0.012, 0.024)):
        x = 0.375 + over if k == 0 else over
        turtle += block(f"b{k}", size, f":on :{'table1' if k == 0 else f'b{k - 1}'} ; :x {x!r} ; :density 2000.0")
    log = run(turtle, duration=1.0)
    height = log.poses[-500:, [log.index(f"b{k}") for k in range(4)], 2]
    assert np.ptp(height, axis=0).max() < 1e-7


def test_the_force_of_a_blow_hangs_on_no_substep() -> None:
    # Momentum over the time that a blow lasts; a substep is shorter the higher the ball falls from.
    for height in (0.2, 1.0):
        log = run(FLOOR + ball("b", 0.03, f":z {0.03 + height!r}"), duration=math.sqrt(2.0 * height / 9.81) + 0.02)
        impulse = log.things[log.index("b")].mass * math.sqrt(2.0 * 9.81 * height) * 1.557
        assert log.contacts.peak.max() == pytest.approx(impulse / 2.5e-4, rel=0.02)


def test_what_is_whole_bounces_and_stands_beside_a_broken_egg_as_without_it() -> None:
    others = (
        ball("a", 0.03, ":z 0.53")
        + ball("b", 0.03, ":z 2.03 ; :x -0.5")
        + block("c", (0.1, 0.1, 0.1), ":on :floor ; :x -1.0")
    )
    alone = run(FLOOR + others, duration=1.2)
    beside = run(FLOOR + ":egg1 a :Egg ; :x 0.9 ; :z 0.3 ." + others, duration=1.2)
    assert len(beside.detachments.tick)
    for name in ("a", "b", "c"):
        heights = (log.poses[:, log.index(name), 2] for log in (alone, beside))
        assert np.abs(np.subtract(*heights)).max() < 1e-3
