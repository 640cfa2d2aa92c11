"""What stands tips about an edge: it goes over or comes back, and nothing that rolls, slides or is held does."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tests.fluents.logs import Draft
from tests.fluents.worlds import (
    FLOOR,
    HAND,
    HAND_DRIVES,
    Control,
    ball,
    box,
    cup_geoms,
    drive,
    free,
    of_type,
    ramp,
    times,
    watch,
    world,
)
from tests.laws.rest_scenes import FLOOR as FLOOR_TURTLE
from tests.laws.rest_scenes import block
from tests.scenes import run

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import Geom, Shape
from prolepsis.log.near import is_near
from prolepsis.log.things import FIXED, FREE, Mount, Thing
from prolepsis.log.timeline import Evidence, Timeline

BOX = box("box", "0 0 .1", ".03 .05 .1", 0.5)
BALANCE = math.atan2(0.03, 0.1)
"""Angle at which the middle of that box is above its edge [rad]."""
TABLE = '<body name="table" pos="0 0 .2"><geom type="box" size=".2 .2 .2"/></body>'


def thrown(*velocity: float) -> Control:
    """Return a control that gives the first free body a velocity (linear, then angular) at the start."""

    def control(model: Any, data: Any) -> None:
        if data.time == 0:
            data.qvel[: len(velocity)] = velocity

    return control


def finger(height: float, near: float = -0.1) -> str:
    """Return a finger that can be moved, at a place before the box."""
    return f'<body name="finger" mocap="true" pos="{near} 0 {height}"><geom type="box" size=".01 .05 .01"/></body>'


def pushing(share: float) -> Control:
    """Return a control that pushes until the box, the first free body, is tilted by a share of its balance [1].

    It does so ever more slowly, lest the box swing on.
    """
    state = {"back": False}

    def control(model: Any, data: Any) -> None:
        x, y = data.qpos[4:6]
        tilt = math.acos(min(1.0, 1 - 2 * (x * x + y * y)))
        state["back"] |= tilt >= share * BALANCE
        speed = -0.2 if state["back"] else 0.06 * max(1 - tilt / (share * BALANCE), 0.1)
        step = speed * model.opt.timestep
        data.mocap_pos[0, 0] = max(data.mocap_pos[0, 0] + step, -0.2)

    return control


def the(timeline: Timeline, term: str) -> Evidence:
    (fact,) = [fact for fact in timeline.facts if str(fact.term) == term]
    return fact.evidence


def test_a_box_pushed_to_97_percent_of_its_balance_comes_back_and_nearly_toppled() -> None:
    timeline = watch(world(FLOOR + BOX + finger(0.18, -0.05)), 6.0, pushing(0.97))
    told = the(timeline, "tipping(box)")
    assert (told["edge"], told["result"]) == ("floor", "back")
    assert told["margin"] == pytest.approx(0.97, abs=0.02)
    assert told["angle"] == pytest.approx(0.97 * BALANCE, rel=0.03)
    assert is_near(told)
    assert not of_type(timeline, "toppling", "falling")
    (near,) = [fact for fact in timeline.near_misses if fact.type == "toppling"]
    assert near.evidence["margin"] == told["margin"]
    assert timeline.ask("near_miss(toppling(box), T, M), M > 0.95")
    ((start, end),) = times(timeline, "tipping(box)")
    assert start < near.start < near.end < end
    assert times(timeline, "supports(floor,box)") == [(0.0, timeline.duration)]


def test_half_way_is_no_near_miss() -> None:
    timeline = watch(world(FLOOR + BOX + finger(0.18, -0.05)), 4.0, pushing(0.5))
    assert the(timeline, "tipping(box)")["margin"] == pytest.approx(0.5, abs=0.03)
    assert not [fact for fact in timeline.near_misses if fact.type == "toppling"]


def test_a_box_pushed_over_topples_from_its_balance_on_until_it_lies() -> None:
    timeline = watch(world(FLOOR + BOX + finger(0.18, -0.05)), 5.0, pushing(1.1))
    told = the(timeline, "tipping(box)")
    assert told["result"] == "over"
    assert told["angle"] == pytest.approx(math.pi / 2, abs=0.03)
    ((start, end),), ((beyond, over),) = times(timeline, "tipping(box)"), times(timeline, "toppling(box)")
    ((slam, _),) = [(a, b) for a, b in times(timeline, "colliding(box,floor)") if b - a > 0.01]
    assert start < beyond < slam < end == over < slam + 0.15
    assert timeline.ask("occurs(tipping(X), T), evidence(tipping(X), T, result, over)")
    # The edge bears it all the while.
    assert times(timeline, "supports(floor,box)") == [(0.0, timeline.duration)]


def test_a_cup_pushed_at_its_rim_tips_over_and_one_pushed_at_its_foot_slides() -> None:
    cup = free("cup", "0 0 .0001", cup_geoms(0.03, 0.09))

    def push(model: Any, data: Any) -> None:
        data.mocap_pos[0, 0] = -0.1 + ramp(data.time, 0.2, 1.0, 0.16)

    assert the(watch(world(FLOOR + cup + finger(0.08)), 2.0, push), "tipping(cup)")["result"] == "over"
    slick = '<geom name="floor" type="plane" size="2 2 .1" friction=".2" priority="1"/>'
    assert not of_type(watch(world(slick + cup + finger(0.011)), 2.0, push), "tipping", "toppling")


def test_what_is_pushed_over_the_edge_of_a_table_tips_about_it_and_falls_from_there() -> None:
    def push(model: Any, data: Any) -> None:
        data.mocap_pos[0, 0] = -0.1 + 0.15 * data.time

    here = box("box", ".1 0 .43", ".05 .05 .03", 0.5)
    timeline = watch(world(FLOOR + TABLE + here + finger(0.43)), 3.0, push)
    told = the(timeline, "tipping(box)")
    assert (told["edge"], told["result"]) == ("table", "over")
    ((_, left),) = times(timeline, "tipping(box)")
    ((_, borne),) = times(timeline, "supports(table,box)")
    assert times(timeline, "toppling(box)")[0][1] == left == pytest.approx(borne, abs=0.01)
    assert times(timeline, "falling(box)")[0][0] == pytest.approx(left, abs=0.01)


@pytest.mark.parametrize(
    ("what", "geom", "where", "velocity"),
    [
        ("a ball rolls up to the edge", '<geom type="sphere" size=".03" mass=".1"/>', ".14 0 .43", (0.4, 0, 0, 0, 13)),
        ("it slips first", '<geom type="sphere" size=".03" mass=".1"/>', ".14 0 .43", (0.4,)),
        ("an egg", '<geom type="ellipsoid" size=".022 .0285 .022" mass=".058"/>', ".15 0 .4221", (0.1, 0, 0, 0, 4.5)),
    ],
)
def test_what_rolls_over_the_edge_of_a_table_falls_and_did_not_tip(
    what: str, geom: str, where: str, velocity: tuple[float, ...]
) -> None:
    timeline = watch(world(FLOOR + TABLE + free("a", where, geom)), 1.5, thrown(*velocity))
    assert of_type(timeline, "falling"), what
    assert not of_type(timeline, "tipping", "toppling"), what
    assert not [fact for fact in timeline.near_misses if fact.type == "toppling"], what


def test_a_rod_that_rolls_askew_over_the_edge_did_not_tip() -> None:
    # It is borne at one end, so that what bears it moves far less than its middle is away from there.
    def push(model: Any, data: Any) -> None:
        data.mocap_pos[0, 0] = min(0.031 + 0.24 * data.time, 0.166)

    rod = free("rod", ".131 0 .4102", '<geom type="capsule" size=".01 .06" euler="0 90 0" mass=".1"/>', "0 0 49")
    timeline = watch(world(FLOOR + TABLE + rod + finger(0.417, 0.031)), 1.5, push)
    assert of_type(timeline, "falling") == {"falling(rod)"}
    assert not of_type(timeline, "tipping", "toppling")


@pytest.mark.parametrize("degrees", [0, 30, 60, 90])
@pytest.mark.parametrize("size", [".022 .0285 .022", ".0285 .022 .022"])
def test_an_egg_that_a_finger_pushes_over_the_edge_is_never_back(degrees: float, size: str) -> None:
    def push(model: Any, data: Any) -> None:
        data.mocap_pos[0, 0] = 0.06 + 0.1 * data.time

    egg = free("egg", ".17 0 .4221", f'<geom type="ellipsoid" size="{size}" mass=".058"/>', f"0 0 {degrees}")
    timeline = watch(world(FLOOR + TABLE + egg + finger(0.43, 0.06)), 2.5, push)
    assert times(timeline, "falling(egg)")
    for fact in timeline.select(type="tipping"):
        assert fact.evidence["result"] == "over"
        assert times(timeline, "toppling(egg)")[0][1] == pytest.approx(times(timeline, "falling(egg)")[0][0], abs=0.02)


def roller(name: str, x: float) -> str:
    """Return a cylinder that lies on the floor."""
    return free(name, f"{x} 0 .02", '<geom type="cylinder" size=".02 .05" mass=".1" euler="90 0 0"/>')


@pytest.mark.parametrize(
    ("what", "below", "above", "velocity"),
    [
        ("a box on a roller", roller("low", 0.0), box("top", "0 0 .0901", ".03 .03 .05", 0.3), (0.05, 0, 0, 0, 2.5)),
        ("a plank on one", roller("low", 0.0), box("top", "0 0 .0451", ".15 .04 .005", 0.3), (0.1, 0, 0, 0, 5)),
        ("a box on a ball", ball("low", "0 0 .02", 0.02, 0.1), box("top", ".002 0 .0701", ".03 .03 .03", 0.3), (0.0,)),
        (
            "a cup on a marble",
            ball("low", "0 0 .008", 0.008, 0.1),
            free("top", ".004 0 .0161", cup_geoms(0.035)),
            (0.0,),
        ),
    ],
)
def test_what_tips_off_something_that_rolls_topples_until_it_lies(
    what: str, below: str, above: str, velocity: tuple[float, ...]
) -> None:
    timeline = watch(world(FLOOR + below + above), 1.2, thrown(*velocity))
    told = the(timeline, "tipping(top)")
    assert (told["edge"], told["result"]) == ("low", "over"), what
    ((_, end),) = times(timeline, "toppling(top)")
    lands = min(start for start, _ in times(timeline, "supports(floor,top)"))
    # What goes off the edge before is no longer borne by it.
    assert min(lands, max(end for _, end in times(timeline, "supports(low,top)"))) == pytest.approx(end, abs=0.06), what


def test_what_leans_on_something_that_rolls_away_tips_back_about_its_other_edge() -> None:
    cup = free("cup", "0 0 .0092", cup_geoms(0.035), f"0 {-math.degrees(math.asin(0.016 / 0.06)):.2f} 0")
    timeline = watch(world(FLOOR + ball("low", ".029 0 .008", 0.008, 0.1) + cup), 1.0, thrown(0.25, 0, 0, 0, 32))
    told = the(timeline, "tipping(cup)")
    assert (told["edge"], told["result"]) == ("floor", "back")


def test_a_plank_that_rolls_on_its_way_on_two_rollers_does_not_tip() -> None:
    here = roller("r1", -0.08) + roller("r2", 0.08) + box("plank", "0 0 .0449", ".15 .04 .005", 0.3)
    timeline = watch(world(FLOOR + here), 0.6, thrown(0.1, 0, 0, 0, 5, 0, 0.1, 0, 0, 0, 5, 0, 0.2))
    assert {"moving(plank)", "moving(r1)", "moving(r2)"} <= of_type(timeline, "moving")
    assert not of_type(timeline, "tipping", "toppling")


def test_what_goes_over_tells_how_far_beyond_its_balance_it_came() -> None:
    timeline = watch(world(FLOOR + BOX + finger(0.18, -0.05)), 5.0, pushing(1.1))
    assert the(timeline, "toppling(box)")["margin"] == pytest.approx(math.pi / 2 / BALANCE, rel=0.05)


def test_what_has_come_to_lie_on_something_else_has_tipped_whatever_shakes_it_there() -> None:
    log = '<body name="log" pos="0 0 .04"><geom type="box" size=".02 .1 .04"/></body>'

    def shake(model: Any, data: Any) -> None:
        if any(abs(data.time - time) < 1e-9 for time in (0.8, 1.0, 1.2)):
            data.qvel[4] = -0.4

    plank = box("plank", ".05 0 .0875", ".3 .05 .0075", 0.5)
    timeline = watch(world(FLOOR + log + plank), 1.6, shake)
    first, *_ = timeline.select(type="toppling")
    assert "supports(floor,plank)" in {str(fact.term) for fact in timeline.select(type="supports")}
    assert first.evidence["edge"] == "log"
    assert first.end < 0.8


def test_what_is_set_down_too_far_out_tips_off_at_once() -> None:
    bricks = box("low", "0 0 .02", ".02 .02 .02", 0.1) + box("top", ".025 0 .0601", ".02 .02 .02", 0.1)
    timeline = watch(world(FLOOR + bricks), 1.0)
    assert the(timeline, "tipping(top)")["edge"] == "low"
    assert of_type(timeline, "toppling") == {"toppling(top)"}


def test_dominoes_topple_in_order() -> None:
    row = "".join(box(f"d{k}", f"{0.05 * k} 0 .05", ".006 .03 .05", 0.05) for k in range(4))
    timeline = watch(world(FLOOR + row), 1.2, thrown(0, 0, 0, 0, 5))
    begun = [times(timeline, f"toppling(d{k})")[0][0] for k in range(4)]
    assert begun == sorted(begun)


@pytest.mark.parametrize(
    ("what", "body", "velocity"),
    [
        ("a ball rolls", ball("b", "0 0 .03"), (0.5,)),
        (
            "a cylinder rolls",
            free("b", "0 0 .03", '<geom type="cylinder" size=".03 .06" mass=".3"/>', "90 0 0"),
            (0.5,),
        ),
        ("an egg rocks", free("b", "0 0 .022", '<geom type="ellipsoid" size=".0285 .022 .022" mass=".06"/>'), (0,) * 5),
        ("a box slides", box("b", "0 0 .02", ".06 .06 .02", 0.5, 'friction=".3" priority="1"'), (1.0,)),
        ("a box lands on its edge", box("b", "0 0 .2", ".03 .05 .1", 0.5, turn="0 25 0"), (0.0,)),
        ("a box stands", BOX.replace("box", "b", 1), (0.0,)),
    ],
)
def test_what_rolls_slides_or_lands_does_not_tip(what: str, body: str, velocity: tuple[float, ...]) -> None:
    spin = (0.0, 0.0, 0.0, 0.0, 4.0) if what == "an egg rocks" else velocity
    assert not of_type(watch(world(FLOOR + body), 1.2, thrown(*spin)), "tipping", "toppling"), what


@pytest.mark.parametrize(("sides", "tips"), [(4, True), (6, False), (12, False), (32, False)])
def test_a_prism_of_many_faces_rolls(sides: int, tips: bool) -> None:
    angles = 2 * np.pi * np.arange(sides) / sides
    points = [(0.04 * math.cos(a), y, 0.04 * math.sin(a)) for a in angles for y in (-0.06, 0.06)]
    vertices = " ".join(f"{x} {y} {z}" for x, y, z in points)
    prism = free("b", f"0 0 {0.04 * math.cos(math.pi / sides)}", '<geom type="mesh" mesh="m" mass=".3"/>')
    mesh = f'<asset><mesh name="m" vertex="{vertices}"/></asset>'
    turned = prism.replace('"><free', f'" euler="0 {180 / sides} 0"><free')
    assert bool(of_type(watch(world(FLOOR + turned, mesh), 1.5, thrown(0.8, 0, 0, 0, 20)), "tipping")) == tips


def test_what_a_hand_holds_or_carries_does_not_tip() -> None:
    brick = box("brick", "0 0 .03", ".02 .03 .03", 0.2)
    control = drive(lambda t: ramp(t, 1.2, 2.0, 0.2), lambda t: ramp(t, 0.7, 1.1, 0.2), lambda t: 10 if t > 0.3 else -3)
    assert not of_type(watch(world(FLOOR + HAND + brick, HAND_DRIVES), 2.4, control), "tipping", "toppling")


def test_what_stands_on_a_board_that_is_tilted_does_not_tip_until_it_turns_on_it() -> None:
    board = '<body name="board" mocap="true" pos="0 0 .01"><geom type="box" size=".2 .2 .01" friction="2"/></body>'

    def tilt(degrees: float) -> Control:
        def control(model: Any, data: Any) -> None:
            half = ramp(data.time, 0.2, 1.8, math.radians(degrees)) / 2
            data.mocap_quat[0] = [math.cos(half), 0, math.sin(half), 0]

        return control

    here = box("box", "0 0 .12", ".03 .05 .1", 0.5, 'friction="2"')
    assert not of_type(watch(world(board + here), 2.0, tilt(12.0)), "tipping")
    assert the(watch(world(board + here), 2.5, tilt(25.0)), "tipping(box)")["edge"] == "board"


@pytest.mark.parametrize(("what", "begins"), [("after it was lifted", 1.2), ("while it is lifted", 0.4)])
def test_what_turns_below_a_thing_does_not_tip_it(what: str, begins: float) -> None:
    # The end of a plank lies on a ball that lifts it by a little and turns on the spot by much.
    block = '<body name="block" pos="-.1 0 .03"><geom type="box" size=".02 .05 .03"/></body>'
    sphere = '<geom type="sphere" size=".03" friction="0" priority="1"/>'
    prop = f'<body name="prop" mocap="true" pos=".1 0 .03">{sphere}</body>'
    lifted = 0.035

    def under(model: Any, data: Any) -> None:
        half = ramp(data.time, begins, begins + 0.6, math.radians(60)) / 2
        data.mocap_quat[0] = [math.cos(half), 0, math.sin(half), 0]
        data.mocap_pos[0, 2] = 0.03 + ramp(data.time, 0.4, 1.0, 0.22 * lifted)

    timeline = watch(world(FLOOR + block + prop + box("plank", "0 0 .07", ".15 .05 .01", 0.5)), 2.0, under)
    assert {"supports(block,plank)", "supports(prop,plank)"} <= of_type(timeline, "supports"), what
    assert not of_type(timeline, "toppling"), what
    ((start, end),) = times(timeline, "tipping(plank)")
    assert (start, end) == pytest.approx((0.4, 1.0), abs=0.1), what
    assert float(the(timeline, "tipping(plank)")["angle"]) < 1.1 * lifted, what


@pytest.mark.parametrize(("presses", "edge"), [(0.05, "block"), (4.0, "shard")])
def test_what_hardly_bears_a_thing_is_no_edge_of_it(presses: float, edge: str) -> None:
    # A plank is lifted at one end and turns about a line at which a block and a shard touch it.
    def at(name: str, y: float, mount: Mount) -> Thing:
        cube = Shape(geoms=(Geom(type="box", size=(0.01, 0.01, 0.01)),))
        return Thing(name=name, kind="Block", shape=cube, mass=0.001, position=(-0.1, y, 0.0), mount=mount)

    flat = Shape(geoms=(Geom(type="box", size=(0.1, 0.05, 0.01)),))
    plank = Thing(name="plank", kind="Block", shape=flat, mass=0.5, position=(0.0, 0.0, 0.01))
    draft = Draft(700, [plank, at("shard", 0.02, FREE), at("block", -0.02, FIXED)])
    angle = np.interp(np.arange(700), (200, 500), (0.0, 0.1))
    arm = np.array([0.1, 0.01])
    draft.poses[:, 0, 0] = np.cos(angle) * arm[0] - np.sin(angle) * arm[1] - 0.1
    draft.poses[:, 0, 2] = np.sin(angle) * arm[0] + np.cos(angle) * arm[1]
    draft.poses[:, 0, 3:] = np.stack([np.cos(angle / 2), 0 * angle, -np.sin(angle / 2), 0 * angle], axis=1)
    draft.rest("shard", "plank", 0, 700, presses)
    draft.rest("block", "plank", 0, 700, 4.9 - presses)
    assert the(recognize(draft.log()), "tipping(plank)")["edge"] == edge


def test_the_load_counts_and_the_centre_of_mass_that_a_model_tells() -> None:
    # Both are soft: the load leans on its way. Without it the angle would be three times as large.
    weight = '<geom type="box" size=".01 .01 .01" pos=".015 0 .08" mass=".4" contype="0" conaffinity="0"/>'
    heavy = free("box", "0 0 .1", f'<geom type="box" size=".03 .05 .1" mass=".1"/>{weight}')
    loaded = box("box", "0 0 .1", ".03 .05 .1", 0.1) + box("load", ".015 0 .2101", ".01 .02 .01", 0.4)
    for body, height in ((heavy, 0.18), (loaded, 0.21)):
        timeline = watch(world(FLOOR + body + finger(0.18, -0.05)), 4.0, pushing(0.22))
        told = the(timeline, "tipping(box)")
        balance = math.atan2(0.03 - 0.8 * 0.015, 0.2 * 0.1 + 0.8 * height)
        assert told["result"] == "back"
        assert float(told["angle"]) / float(told["margin"]) == pytest.approx(balance, rel=0.2)


def test_random_boxes_go_over_or_come_back_and_tell_how_far_as_their_poses_do() -> None:
    random = np.random.default_rng(5)
    for _ in range(8):
        length, width, height = (float(each) for each in random.uniform((0.03, 0.03, 0.05), (0.12, 0.12, 0.25)))
        balance, arm = math.atan2(length, height), math.hypot(length, height) / 2
        aim, yaw = random.choice([random.uniform(0.4, 0.92), random.uniform(1.1, 1.4)]), float(random.uniform(0, 360))
        top = math.cos(balance * (1 - aim)) if aim < 1 else 1.0
        rise = max(aim, 1.0) * arm * (top - math.cos(balance))
        spin = math.sqrt(2 * 9.81 * rise / ((length**2 + height**2) / 3))
        ahead, up = spin * height / 2, spin * length / 2
        turn = math.radians(yaw)
        velocity = (ahead * math.cos(turn), ahead * math.sin(turn), up, 0.0, spin, 0.0)
        turtle = FLOOR_TURTLE + block("b", (length, width, height), f":on :floor ; :yaw {yaw!r} ; :friction 5.0")
        log = run(turtle, duration=1.5, thrown={"b": velocity})
        timeline = recognize(log)
        turned = log.poses[:, log.index("b"), 3:]
        greatest = math.acos(float((1 - 2 * (turned[:, 1] ** 2 + turned[:, 2] ** 2)).min())) / balance
        told = the(timeline, "tipping(b)")
        assert told["result"] == ("over" if greatest > 1 else "back")
        assert bool(of_type(timeline, "toppling")) == (greatest > 1)
        assert bool([f for f in timeline.near_misses if f.type == "toppling"]) == (0.8 <= greatest < 1)
        if greatest < 1:
            assert told["margin"] == pytest.approx(greatest, rel=0.01)
