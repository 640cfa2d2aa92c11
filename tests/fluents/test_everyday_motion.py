"""Thirty everyday situations, second half: what rolls, falls, tips, is pushed, carried and dropped."""

from __future__ import annotations

import math
from typing import Any

import pytest
from tests.fluents.worlds import (
    FLOOR,
    HAND,
    HAND_DRIVES,
    Control,
    at_end,
    ball,
    box,
    cup_geoms,
    drive,
    ever,
    free,
    of_type,
    ramp,
    times,
    watch,
    world,
)

from prolepsis.log.timeline import Fact, Timeline

CUP = free("cup", "0 0 .0001", cup_geoms(wall=0.008))
BRICK = box("brick", "0 0 .03", ".02 .03 .03", 0.2)


def thrown(*velocity: float) -> Control:
    """Return a control that gives the first free body a velocity (linear, then angular) at the start."""

    def control(model: Any, data: Any) -> None:
        if data.time == 0:
            data.qvel[: len(velocity)] = velocity

    return control


def facts(timeline: Timeline, type: str) -> list[Fact]:
    return list(timeline.select(type=type))


def test_a_rolling_ball_moves_and_is_supported_and_nothing_else() -> None:
    timeline = watch(world(FLOOR + ball("ball", "0 0 .03")), 0.8, thrown(0.5))
    assert ever(timeline) == {"moving(ball)", "supports(floor,ball)", "contacts(ball,floor)"}


def test_a_bounce_gives_several_collisions_and_falls() -> None:
    springy = ball("ball", "0 0 .4", more='solref="-20000 -5" priority="1"')
    timeline = watch(world(FLOOR + springy), 2.0)
    hits, falls = times(timeline, "colliding(ball,floor)"), times(timeline, "falling(ball)")
    assert len(hits) >= 3
    assert len(falls) >= len(hits)
    assert all(end - start < 0.05 for start, end in hits)
    assert not of_type(timeline, "supports")


def test_a_ball_that_rolls_off_a_table_falls_when_the_support_ends() -> None:
    table = '<body name="table" pos="0 0 .2"><geom type="box" size=".2 .2 .2"/></body>'
    timeline = watch(world(FLOOR + table + ball("ball", ".1 0 .43")), 1.2, thrown(0.5))
    ((_, lost),) = times(timeline, "supports(table,ball)")
    ((start, landed), *_) = times(timeline, "falling(ball)")
    assert start == lost
    assert times(timeline, "colliding(ball,floor)")[0][0] == landed
    assert not of_type(timeline, "attached")


def test_a_thrown_ball_falls_from_the_top_of_its_flight_only() -> None:
    timeline = watch(world(FLOOR + ball("ball", "0 0 .05")), 1.2, thrown(1, 0, 3))
    ((start, _), *_) = times(timeline, "falling(ball)")
    assert math.isclose(start, 3 / 9.81, abs_tol=0.02)
    assert times(timeline, "moving(ball)")[0][0] == 0.0


def test_a_box_that_tips_over_hits_the_floor_and_never_falls() -> None:
    timeline = watch(world(FLOOR + box("box", "0 0 .1", ".02 .05 .1", 0.5)), 1.0, thrown(0, 0, 0, 0, 9))
    assert times(timeline, "supports(floor,box)") == [(0.0, 1.0)]
    assert any(fact.evidence["speed"] > 1 for fact in facts(timeline, "colliding"))  # type: ignore[operator]
    assert not of_type(timeline, "falling")


def test_dominoes_knock_each_other_over_in_order() -> None:
    row = "".join(box(f"d{k}", f"{0.05 * k} 0 .05", ".006 .03 .05", 0.05) for k in range(4))
    timeline = watch(world(FLOOR + row), 1.2, thrown(0, 0, 0, 0, 5))
    hits = [times(timeline, f"colliding(d{k},d{k + 1})")[0][0] for k in range(3)]
    assert hits == sorted(hits)
    assert "supports(d3,d2)" in at_end(timeline)
    assert not of_type(timeline, "falling", "attached", "contains")


def test_sliding_down_a_slope_is_not_falling_and_no_collision() -> None:
    slope = '<geom name="slope" type="box" size=".6 .3 .02" euler="0 30 0"/>'
    slider = box("box", "-.28 0 .2422", more='friction=".2" priority="1"', turn="0 30 0")
    timeline = watch(world(slope + slider), 0.5)
    assert of_type(timeline, "falling", "colliding") == set()
    assert {"moving(box)", "supports(slope,box)"} <= at_end(timeline)


def test_sliding_on_the_floor_with_hard_contacts_does_not_collide() -> None:
    # At MuJoCo's default contact parameters a sliding box hops by 0.7 mm all the time.
    slider = box("box", "0 0 .05", more='friction=".3" priority="1"')
    timeline = watch(f"<mujoco><worldbody>{FLOOR}{slider}</worldbody></mujoco>", 0.6, thrown(1.5))
    assert not of_type(timeline, "colliding", "falling")
    assert times(timeline, "supports(floor,box)") == [(0.0, 0.6)]


def test_spinning_in_place_is_moving() -> None:
    top = box("top", "0 0 .03", ".05 .05 .03", more='friction=".1" priority="1"')
    timeline = watch(world(FLOOR + top), 0.8, thrown(0, 0, 0, 0, 0, 10))
    ((start, end),) = times(timeline, "moving(top)")
    assert (start, end < 0.8) == (0.0, True)
    assert not of_type(timeline, "falling", "colliding")


def test_what_jitters_and_is_then_struck_moves_from_the_blow_on() -> None:
    def control(model: Any, data: Any) -> None:
        data.qvel[:6] = 0.0
        data.qvel[0] = 0.8 if 0.3 <= data.time < 0.6 else 0.0
        data.qvel[5] = 0.0 if 0.3 <= data.time < 0.6 else 0.2 * math.sin(2 * math.pi * 80 * data.time)

    timeline = watch(world(FLOOR + BRICK), 0.9, control)
    ((start, _),) = times(timeline, "moving(brick)")
    assert start == pytest.approx(0.3, abs=0.005), "not a window earlier"


def test_a_ball_that_rolls_about_in_a_bowl_stays_in_it() -> None:
    bowl = free("bowl", "0 0 .0001", cup_geoms(0.1, 0.06))
    timeline = watch(world(FLOOR + bowl + ball("ball", "0 0 .0242", 0.02)), 1.2, thrown(0, 0, 0, 0, 0, 0, 0.3))
    assert times(timeline, "contains(bowl,ball)") == [(0.0, 1.2)]
    assert "moving(ball)" in ever(timeline)


def test_a_ball_dropped_into_a_cup_is_contained_once_it_has_landed() -> None:
    timeline = watch(world(FLOOR + CUP + ball("ball", "0 0 .3", 0.02)), 1.0)
    ((inside, end),) = times(timeline, "contains(cup,ball)")
    ((_, landed), *_) = times(timeline, "falling(ball)")
    assert landed <= inside < landed + 0.1
    assert end == timeline.duration


def test_what_falls_through_a_tube_was_never_contained() -> None:
    tube = f'<body name="tube" pos="0 0 .3">{cup_geoms(0.06, 0.2, bottom=False)}</body>'
    timeline = watch(world(FLOOR + tube + ball("ball", "0 0 .7", 0.02)), 0.8)
    assert not of_type(timeline, "contains")


def test_what_is_poured_out_of_a_cup_is_no_longer_contained() -> None:
    cup = f'<body name="cup" mocap="true" pos="0 0 .3">{cup_geoms()}</body>'

    def tilt(model: Any, data: Any) -> None:
        angle = ramp(data.time, 0.3, 1.0, 2.2)
        data.mocap_quat[0] = [math.cos(angle / 2), 0, math.sin(angle / 2), 0]

    timeline = watch(world(FLOOR + cup + ball("ball", "0 0 .324", 0.02)), 1.6, tilt)
    ((start, end),) = times(timeline, "contains(cup,ball)")
    assert start < 0.05
    assert 0.5 < end < 1.1
    assert times(timeline, "falling(ball)")[0][0] > 0.5


def test_a_held_box_lifted_and_let_go_is_attached_until_it_falls() -> None:
    control = drive(lambda t: 0, lambda t: ramp(t, 0.7, 1.2, 0.15), lambda t: 10 if 0.3 < t < 1.5 else -3)
    timeline = watch(world(FLOOR + HAND + BRICK, HAND_DRIVES), 2.0, control)
    ((_, released),) = times(timeline, "attached(hand,brick)")
    ((start, _), *_) = times(timeline, "falling(brick)")
    assert start == released
    assert "supports(hand,brick)" not in ever(timeline)


def test_lowering_is_not_falling() -> None:
    control = drive(
        lambda t: 0, lambda t: ramp(t, 0.7, 1.2, 0.15) - ramp(t, 1.4, 2.0, 0.15), lambda t: 10 if 0.3 < t < 2.3 else -3
    )
    timeline = watch(world(FLOOR + HAND + BRICK, HAND_DRIVES), 2.6, control)
    assert not of_type(timeline, "falling")
    assert {"attached(hand,brick)", "moving(brick)"} <= ever(timeline)
    assert "supports(floor,brick)" in at_end(timeline)


TRAY = (
    '<body name="tray" pos=".4 0 0"><geom type="box" size=".15 .15 .005" pos="0 0 .005"/>'
    '<geom type="box" size=".005 .15 .06" pos=".145 0 .06"/><geom type="box" size=".005 .15 .06" pos="-.145 0 .06"/>'
    '<geom type="box" size=".15 .005 .06" pos="0 .145 .06"/>'
    '<geom type="box" size=".15 .005 .06" pos="0 -.145 .06"/></body>'
)


@pytest.mark.parametrize(("depth", "why"), [(0.11, "through the tray"), (0.0, "over the tray")])
def test_what_a_hand_carries_past_or_through_a_tray_is_not_contained(depth: float, why: str) -> None:
    control = drive(
        lambda t: ramp(t, 1.2, 2.8, 0.8),
        lambda t: ramp(t, 0.7, 1.1, 0.2) - ramp(t, 1.6, 2.0, depth) + ramp(t, 2.0, 2.4, depth),
        lambda t: 12 if t > 0.3 else -3,
    )
    timeline = watch(world(FLOOR + HAND + BRICK + TRAY, HAND_DRIVES), 3.0, control)
    assert not of_type(timeline, "contains"), why
    assert "attached(hand,brick)" in at_end(timeline)
    assert not of_type(timeline, "falling")


def test_what_a_hand_puts_into_a_tray_is_contained() -> None:
    control = drive(
        lambda t: ramp(t, 1.2, 2.0, 0.4),
        lambda t: ramp(t, 0.7, 1.1, 0.2) - ramp(t, 2.0, 2.6, 0.188) + ramp(t, 3.0, 3.4, 0.2),
        lambda t: 12 if 0.3 < t < 2.8 else -3,
    )
    timeline = watch(world(FLOOR + HAND + BRICK + TRAY, HAND_DRIVES), 3.6, control)
    assert {"contains(tray,brick)", "supports(tray,brick)"} <= at_end(timeline)
    assert not [fact for fact in facts(timeline, "attached") if fact.end == timeline.duration]


def test_a_pushed_box_moves_with_its_support_and_is_not_attached() -> None:
    pusher = (
        '<body name="pusher" pos="-.1 0 .05"><joint name="p" type="slide" axis="1 0 0"/>'
        '<geom type="box" size=".02 .05 .03" mass=".3"/></body>'
    )
    drives = '<actuator><position joint="p" kp="500" kv="50"/></actuator>'

    def push(model: Any, data: Any) -> None:
        data.ctrl[0] = ramp(data.time, 0.2, 1.0, 0.2)

    timeline = watch(world(FLOOR + pusher + box("box", "0 0 .04", ".04 .04 .04", 0.3), drives), 1.4, push)
    assert times(timeline, "supports(floor,box)") == [(0.0, timeline.duration)]
    assert {"moving(box)", "moving(pusher)"} <= ever(timeline)
    assert not of_type(timeline, "attached", "falling", "contains")


def test_a_brushed_box_stays_where_it_is() -> None:
    stick = '<body name="stick" mocap="true" pos="-.2 .0448 .05"><geom type="sphere" size=".005"/></body>'

    def pass_by(model: Any, data: Any) -> None:
        data.mocap_pos[0, 0] = -0.2 + 0.3 * data.time

    timeline = watch(world(FLOOR + box("box", "0 0 .04", ".04 .04 .04", 2) + stick), 1.2, pass_by)
    assert "contacts(stick,box)" in ever(timeline)
    assert of_type(timeline, "moving") == {"moving(stick)"}
    assert not of_type(timeline, "attached", "falling")


def test_a_flap_that_gives_way_lets_a_box_fall() -> None:
    flap = (
        '<body name="flap" pos="0 0 .5"><joint name="hinge" type="hinge" axis="0 1 0"/>'
        '<geom type="box" size=".1 .1 .005" pos=".1 0 0" mass=".2"/></body>'
    )

    def unlatch(model: Any, data: Any) -> None:
        data.eq_active[0] = data.time < 0.5

    latch = '<equality><joint joint1="hinge"/></equality>'
    timeline = watch(world(FLOOR + flap + box("box", ".1 0 .535", ".03 .03 .03", 0.1), latch), 1.2, unlatch)
    ((start, lost),) = times(timeline, "supports(flap,box)")
    ((falls, _), *_) = times(timeline, "falling(box)")
    assert (start, falls) == (0.0, lost)
    assert times(timeline, "colliding(box,floor)")[0][0] > lost
    assert of_type(timeline, "falling") == {"falling(box)"}


def test_a_weld_that_opens_lets_its_load_fall_at_once() -> None:
    hook = '<body name="hook" pos="0 0 .5"><geom type="box" size=".02 .02 .02"/></body>'

    def open_weld(model: Any, data: Any) -> None:
        data.eq_active[0] = data.time < 0.3

    weld = '<equality><weld body1="hook" body2="box"/></equality>'
    timeline = watch(world(FLOOR + hook + box("box", "0 0 .4"), weld), 0.8, open_weld)
    ((_, opened),) = times(timeline, "attached(hook,box)")
    assert times(timeline, "falling(box)")[0][0] == opened


def test_a_suction_cup_lifts_by_adhesion_and_lets_go() -> None:
    cup = (
        '<body name="suction" pos="0 0 .16"><joint name="z" type="slide"/>'
        '<geom type="cylinder" size=".02 .02" mass=".2"/></body>'
    )
    drives = (
        '<actuator><position joint="z" kp="1000" kv="60"/>'
        '<adhesion body="suction" ctrlrange="0 1" gain="20"/></actuator>'
    )

    def lift(model: Any, data: Any) -> None:
        data.ctrl[:] = [-0.042 + ramp(data.time, 0.6, 1.0, 0.2), 0.3 < data.time < 1.4]

    timeline = watch(world(FLOOR + cup + box("box", "0 0 .05", ".05 .05 .05", 0.3), drives), 1.8, lift)
    ((_, released),) = times(timeline, "attached(suction,box)")
    ((start, _), *_) = times(timeline, "falling(box)")
    assert start == released
    assert "supports(box,suction)" not in ever(timeline)
