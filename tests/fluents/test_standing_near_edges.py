"""What stands a hair inside its limit nearly went over, or nearly slid; what stands well inside it did not."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.fluents.logs import Draft, floor, solid_box
from tests.fluents.worlds import FLOOR as PLANE
from tests.fluents.worlds import box, watch, world
from tests.laws.rest_scenes import FLOOR, TABLE, block, cup, disc
from tests.scenes import run

from prolepsis.fluents import recognize
from prolepsis.log.timeline import Timeline

EDGE = 0.4
"""Half the length of a table [m]."""


def missed(timeline: Timeline, type: str) -> list[float]:
    """Return the margins of what was nearly so."""
    return [float(fact.evidence["margin"]) for fact in timeline.near_misses if fact.type == type]


def on_a_ramp(degrees: float, friction: float, size: tuple[float, float, float]) -> Timeline:
    """Return what is told of a block that stands on a ramp."""
    angle, height = math.radians(degrees), 0.01 + size[2] / 2
    where = f":x {height * math.sin(angle)!r} ; :z {0.3 + height * math.cos(angle)!r} ; :pitch {degrees!r}"
    ramp = f":ramp a :Obstacle ; :z 0.3 ; :length 0.6 ; :width 0.3 ; :height 0.02 ; :pitch {degrees!r} "
    turtle = FLOOR + ramp + f"; :friction {friction!r} . " + block("b", size, f"{where} ; :friction {friction!r}")
    return recognize(run(turtle, duration=0.8))


@pytest.mark.parametrize(("inside", "share"), [(0.0001, 0.99), (0.001, 0.96), (0.004, 0.85), (0.02, None), (0.4, None)])
def test_what_hangs_over_the_edge_of_a_table_as_far_as_it_can_nearly_toppled(
    inside: float, share: float | None
) -> None:
    timeline = recognize(run(TABLE + block("b", (0.1, 0.1, 0.06), f":on :table1 ; :x {EDGE - inside!r}"), duration=0.8))
    assert not timeline.select(type="toppling")
    # Where it presses is the middle of the part that lies on the table once it has sunk in a little.
    assert missed(timeline, "toppling") == ([pytest.approx(share, abs=0.03)] if share else [])
    if share:
        assert timeline.ask("near_miss(toppling(b), T, M), M > 0.8, holds(supports(table1, b), T)")


@pytest.mark.parametrize(("inside", "share"), [(0.0001, 0.951), (0.0003, 0.860), (0.0006, None)])
def test_the_edge_of_a_small_thing_is_found_as_exactly_as_that_of_a_large_one(
    inside: float, share: float | None
) -> None:
    tile = block("b", (0.008, 0.008, 0.004), f":on :table1 ; :x {EDGE - inside!r}")
    margins = missed(recognize(run(TABLE + tile, duration=0.6)), "toppling")
    assert margins == ([pytest.approx(share, abs=0.002)] if share else [])


@pytest.mark.parametrize(("middle", "share"), [(0.0, None), (0.08, None), (0.095, 0.905), (0.103, 0.981)])
def test_what_stands_on_two_supports_stands_on_all_that_is_between_them(middle: float, share: float | None) -> None:
    # At last its middle is above the outer half of one of them, which bears it all; the other would if it leant back.
    piers = "".join(block(n, (0.01, 0.1, 0.1), f":on :table1 ; :x {x!r}") for n, x in (("p", -0.1), ("q", 0.1)))
    board = block("b", (0.5, 0.1, 0.01), f":on :p, :q ; :x {middle!r}")
    timeline = recognize(run(TABLE + piers + board, duration=0.6))
    assert not timeline.select(type="toppling")
    margins = [fact.evidence["margin"] for fact in timeline.near_misses if str(fact.term) == "toppling(b)"]
    assert margins == ([pytest.approx(share, abs=0.005)] if share else [])


def test_what_hangs_over_too_far_topples_and_nearly_did_not() -> None:
    timeline = recognize(run(TABLE + block("b", (0.1, 0.1, 0.06), f":on :table1 ; :x {EDGE + 0.001!r}"), duration=0.8))
    assert timeline.select(type="toppling")
    assert not missed(timeline, "toppling")


@pytest.mark.parametrize(("inside", "nearly"), [(-0.5, False), (0.1, True), (1.0, True), (6.0, False)])
def test_what_stands_on_a_steep_ramp_nearly_toppled_or_nearly_slid(inside: float, nearly: bool) -> None:
    tall = on_a_ramp(math.degrees(math.atan(0.06 / 0.2)) - inside, 2.0, (0.06, 0.1, 0.2))
    flat = on_a_ramp(math.degrees(math.atan(0.5)) - inside, 0.5, (0.2, 0.1, 0.05))
    assert bool(tall.select(type="toppling")) == bool(flat.select(type="moving")) == (inside < 0)
    assert bool(missed(tall, "toppling")) == bool(missed(flat, "moving")) == nearly
    assert not missed(tall, "moving")
    assert not missed(flat, "toppling")


def test_what_it_carries_counts() -> None:
    # Its own middle is 25 mm inside; with a brick at its outer end it is 5 mm.
    plank = block("plank", (0.4, 0.05, 0.02), f":on :table1 ; :x {EDGE - 0.025!r} ; :density 600.0")
    brick = block("brick", (0.04, 0.04, 0.04), ":on :plank ; :x 0.16 ; :mass 0.034 ; :friction 0.9")
    assert not missed(recognize(run(TABLE + plank, duration=0.6)), "toppling")
    loaded = recognize(run(TABLE + plank + brick, duration=0.6))
    assert missed(loaded, "toppling") == [pytest.approx(1 - 2 * 0.005 / 0.205, abs=0.05)]


@pytest.mark.parametrize(
    "turtle",
    [
        TABLE + disc("b", 0.03, 0.2, ":on :table1"),
        TABLE + ":b a :Egg ; :on :table1 .",
        TABLE + ":b a :Bowl ; :on :table1 .",
        cup(0.5, ""),
        TABLE + block("a", (0.1, 0.1, 0.02), ":on :table1") + block("b", (0.1, 0.1, 0.02), ":on :a ; :x 0.02"),
    ],
)
def test_what_stands_well_has_no_near_miss(turtle: str) -> None:
    assert recognize(run(turtle, duration=0.5)).near_misses == ()


def test_of_a_model_whose_friction_is_not_known_nothing_nearly_slides() -> None:
    slope = '<geom name="slope" type="box" size=".6 .3 .02" euler="0 16 0" friction=".3"/>'
    here = box("b", f"{0.07 * math.sin(math.radians(16))} 0 {0.07 * math.cos(math.radians(16))}", turn="0 16 0")
    assert not missed(watch(world(PLANE.replace("<geom", '<geom pos="0 0 -1"') + slope + here), 0.5), "moving")


def test_what_a_liquid_bears_in_part_is_not_told_of_by_where_it_presses() -> None:
    draft = Draft(600, [floor(), solid_box("box1")])
    point = draft.poses[0, 1, :3].copy()
    for share, nearly in ((1.0, True), (0.5, False)):
        draft.rows.clear()
        draft.rest("floor", "box1", 0, 600, share * 9.81)
        log = draft.log()
        edge = np.tile(point + [0.047, 0.0, -0.05], (600, 1))
        timeline = recognize(replace(log, contacts=replace(log.contacts, point=edge)))
        assert bool(missed(timeline, "toppling")) == nearly
