"""What docs/grounding.md calls enough, from both sides: one log has a little more than that, one a little less."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.fluents.liquids import WALL, poured, puddle, says, table, vessel, wet
from tests.fluents.logs import Draft, floor, solid_box
from tests.fluents.test_hand_logs import grasp_draft
from tests.fluents.worlds import ever, times

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import Geom, Shape
from prolepsis.log.things import FIXED, Thing


@pytest.mark.parametrize(("degrees", "held"), [(55.0, False), (65.0, True)])
def test_two_fingers_grip_what_they_press_from_sides_that_are_opposed(degrees: float, held: bool) -> None:
    draft = grasp_draft()
    across, up = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    force = 0.981 / 2 / up
    for side, finger in ((1.0, "left_finger"), (-1.0, "right_finger")):
        normal = (0.0, -side * across, up)
        pressing = (0.0, -side * across * force, up * force)
        draft.press(f"rightGripper/{finger}", "egg1", 0, 1000, pressing, normal)
    assert ("attached(rightGripper,egg1)" in ever(recognize(draft.log()))) == held


@pytest.mark.parametrize(("force", "collides"), [(20.0, False), (30.0, True)])
def test_what_meets_something_without_an_impulse_touches_it_in_passing(force: float, collides: bool) -> None:
    # Two boxes of 1 kg that meet with 0.1 m/s: an impulse of 0.025 N s is the least that counts.
    draft = Draft(300, [floor(), solid_box("box1"), solid_box("box2", x=0.11)])
    draft.poses[:, draft.index("box1"), 0] += 0.1 * np.minimum(np.arange(300), 100) * 0.001
    draft.press("box1", "box2", 100, 101, (force, 0.0, 0.0), (1.0, 0.0, 0.0))
    terms = ever(recognize(draft.log()))
    assert "contacts(box1,box2)" in terms
    assert ("colliding(box1,box2)" in terms) == collides


@pytest.mark.parametrize(("share", "noticed"), [(0.015, False), (0.03, True)])
def test_of_a_stuff_a_fiftieth_is_noticed(share: float, noticed: bool) -> None:
    full = poured(WALL, 0.05)
    drops = round(share * len(full))
    lying = puddle()[:drops]
    rest = full[: len(full) - drops]
    timeline = recognize(wet([table(), vessel()], {"liq1": np.concatenate([lying, rest])}))
    assert "contains(cup1,liq1)" in says(timeline)
    assert ("spilled(liq1)" in says(timeline)) == noticed
    assert ("supports(table1,liq1)" in says(timeline)) == noticed
    beside = puddle(half=0.1)[: len(rest)]
    timeline = recognize(wet([table(), vessel()], {"liq1": np.concatenate([full[:drops], beside])}))
    assert ("contains(cup1,liq1)" in says(timeline)) == noticed


@pytest.mark.parametrize(("share", "supports"), [(0.05, False), (0.15, True)])
def test_a_tenth_of_a_weight_is_a_support(share: float, supports: bool) -> None:
    draft = Draft(300, [floor(), *(solid_box(name) for name in ("pier1", "pier2", "beam1"))])
    draft.rest("pier1", "beam1", 0, 300, (1 - share) * 9.81)
    draft.rest("pier2", "beam1", 0, 300, share * 9.81)
    terms = ever(recognize(draft.log()))
    assert "supports(pier1,beam1)" in terms
    assert ("supports(pier2,beam1)" in terms) == supports


@pytest.mark.parametrize(("degrees", "supports"), [(55.0, True), (65.0, False)])
def test_what_is_steeper_than_sixty_degrees_lies_not_under_what_it_pushes(degrees: float, supports: bool) -> None:
    draft = Draft(300, [floor(), solid_box("slope1"), solid_box("box1")])
    normal = (math.sin(math.radians(degrees)), 0.0, math.cos(math.radians(degrees)))
    draft.press("slope1", "box1", 0, 300, (5.0 * normal[0], 0.0, 5.0 * normal[2]), normal)
    assert ("supports(slope1,box1)" in ever(recognize(draft.log()))) == supports


@pytest.mark.parametrize(("height", "falls"), [(0.003, False), (0.007, True)])
def test_what_goes_down_freely_by_some_millimetres_falls_and_what_hops_does_not(height: float, falls: bool) -> None:
    draft = Draft(400, [floor(), solid_box("box1")])
    since = np.maximum(np.arange(400) - 100, 0) * 0.001
    down = np.minimum(9.81 / 2 * since**2, height)
    draft.poses[:, 1, 2] += height - down
    landed = int(np.argmax(down == height))
    draft.rest("floor", "box1", landed, 400, 9.81)
    assert ("falling(box1)" in ever(recognize(draft.log()))) == falls


def test_a_fall_begins_when_the_last_of_two_supports_is_lost() -> None:
    draft = Draft(600, [floor(), *(solid_box(name) for name in ("pier1", "pier2", "beam1"))])
    draft.rest("pier1", "beam1", 0, 280, 4.905)
    draft.rest("pier2", "beam1", 0, 300, 4.905)
    since = np.maximum(np.arange(600) - 300, 0) * 0.001
    draft.poses[:, draft.index("beam1"), 2] += 0.2 - np.minimum(9.81 / 2 * since**2, 0.2)
    ((start, _),) = times(recognize(draft.log()), "falling(beam1)")
    assert start == 0.3


def falling_box(*paths: tuple[float, float, float], contact: float = 0.003) -> Draft:
    """Return a box that goes down, and that something slows for a moment before each path but the first.

    Each path is its speed at the beginning [m/s, upward] and its length [s], and the acceleration meanwhile [m/s^2].
    """
    draft = Draft(600, [floor(), solid_box("pier1"), solid_box("box1")])
    speeds: list[float] = []
    for number, (speed, time, acceleration) in enumerate(paths):
        if number:
            draft.rest("floor", "box1", 100 + len(speeds), 100 + len(speeds) + round(contact * 1000), 500.0)
            speeds += np.linspace(speeds[-1], speed, round(contact * 1000)).tolist()
        speeds += [speed + acceleration * k * 0.001 for k in range(round(time * 1000))]
    z = np.cumsum(speeds) * 0.001
    draft.poses[101 : 101 + len(z), 2, 2] += z
    draft.poses[101 + len(z) :, 2, 2] += z[-1]
    draft.rest("floor", "box1", 100 + len(z), 600, 9.81)
    return draft


@pytest.mark.parametrize(
    ("rebound", "falls"),
    [(0.08, 2), (-0.6, 1), (-0.2, 2)],
    ids=["what rebounds falls anew from its apex", "what is only slowed falls on", "what is nearly stopped has landed"],
)
def test_a_bounce_ends_a_fall_and_a_brush_does_not(rebound: float, falls: int) -> None:
    timeline = recognize(falling_box((0.0, 0.1, -9.81), (rebound, 0.08, -9.81)).log())
    found = times(timeline, "falling(box1)")
    assert len(found) == falls
    assert found[0][0] == pytest.approx(0.1, abs=0.002)
    if falls == 2:
        assert found[0][1] == pytest.approx(0.2, abs=0.002)
        assert found[1][0] == pytest.approx(0.203 + max(rebound, 0.0) / 9.81, abs=0.003)


@pytest.mark.parametrize("lost", [0.101, 0.118, 0.13])
def test_no_fall_is_less_high_than_what_decides_it(lost: float) -> None:
    # It sinks while a support that gives way still bears a little; the fall begins when that is lost.
    draft = falling_box((0.0, 0.036, -9.81))
    draft.rest("pier1", "box1", 0, round(lost * 1000), 4.0)
    timeline = recognize(draft.log())
    margins = [float(fact.evidence["margin"]) for fact in timeline.select(type="falling")]
    missed = [float(fact.evidence["margin"]) for fact in timeline.near_misses if fact.type == "falling"]
    assert all(margin >= 1 for margin in margins)
    assert all(0.8 <= margin < 1 for margin in missed)
    assert (bool(margins), bool(missed)) == (lost < 0.11, 0.11 < lost < 0.12)


@pytest.mark.parametrize(("depth", "supports"), [(0.0, True), (0.05, False)])
def test_a_fixed_thing_bears_what_stands_on_it_and_not_what_is_sunk_into_it(depth: float, supports: bool) -> None:
    base = replace(solid_box("base1", half=0.1, z=0.1), mount=FIXED)
    post = replace(solid_box("post1", half=0.02, z=0.22 - depth), mount=FIXED)
    assert ("supports(base1,post1)" in ever(recognize(Draft(100, [floor(), base, post]).log()))) == supports


def tray() -> Thing:
    """Return a tray with a rim of 4 cm."""
    rims = [((0.005, 0.1, 0.02), (x, 0.0, 0.02)) for x in (-0.1, 0.1)]
    rims += [((0.1, 0.005, 0.02), (0.0, y, 0.02)) for y in (-0.1, 0.1)]
    geoms = [((0.1, 0.1, 0.002), (0.0, 0.0, 0.0)), *rims]
    shape = Shape(geoms=tuple(Geom(type="box", size=size, position=at) for size, at in geoms))
    return Thing(name="tray1", kind="Tray", shape=shape, mass=0.5, position=(0.0, 0.0, 0.002))


@pytest.mark.parametrize(("role", "contained"), [("Toy", True), ("Mounted", False), ("Driven", False)])
def test_what_is_mounted_or_driven_is_in_a_tray_and_not_contained(role: str, contained: bool) -> None:
    block = replace(solid_box("block1", half=0.012, z=0.017), roles=frozenset({role}))
    terms = ever(recognize(Draft(500, [floor(), tray(), block]).log()))
    assert ("contains(tray1,block1)" in terms) == contained


@pytest.mark.parametrize(("pause", "contained"), [(0.15, False), (0.3, True)])
def test_what_comes_to_rest_in_a_tray_is_contained_and_what_pauses_there_is_not(pause: float, contained: bool) -> None:
    draft = Draft(900, [floor(), tray(), solid_box("block1", half=0.012, z=0.017)])
    time = np.arange(900) * 0.001
    draft.poses[:, 2, 2] += np.interp(time, [0.2, 0.4, 0.4 + pause, 0.6 + pause], [0.2, 0.0, 0.0, 0.2])
    assert ("contains(tray1,block1)" in ever(recognize(draft.log()))) == contained
