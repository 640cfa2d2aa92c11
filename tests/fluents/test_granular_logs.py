"""Many like bodies that are declared one stuff: what contains it, where it is spilled, and no word of a single one."""

from __future__ import annotations

from typing import Any

import pytest
from tests.fluents.worlds import (
    FLOOR,
    STEP,
    at_end,
    ball,
    box,
    cup_geoms,
    ever,
    free,
    of_type,
    ramp,
    roll,
    watch,
    world,
)

from prolepsis.log.folding import fold
from prolepsis.log.log import Log
from prolepsis.log.things import Thing
from prolepsis.log.timeline import Fact, Timeline

BEADS = {"beads": "bead*"}
CUP = cup_geoms(0.03, 0.06, 0.004)


def bead(number: int, where: str) -> str:
    """Return a bead of 6 mm that soon stops rolling."""
    more = 'condim="6" friction=".5 .005 .005"'
    return ball(f"bead{number}", where, radius=0.006, mass=0.001, more=more)


def in_cup(number: int, height: float = 0.0) -> str:
    """Return where a bead is within a cup that stands at a height over the origin: four in a layer."""
    x, y, layer = number % 2, number // 2 % 2, number // 4
    return f"{-0.0075 + 0.015 * x} {-0.0075 + 0.015 * y} {height + 0.0105 + 0.0125 * layer:.4f}"


def on_floor(number: int) -> str:
    """Return where a bead lies on the floor beside the cup."""
    return f"{0.1 + 0.02 * number} 0 .006"


def tipped() -> Timeline:
    """Return the timeline of a cup of twelve beads, high above the floor, that is tipped over."""
    hinge = f'<body name="cup" pos="0 0 .2"><joint name="tilt" axis="0 1 0" damping=".05"/>{CUP}</body>'
    beads = "".join(bead(k, in_cup(k, 0.2)) for k in range(12))
    drive = '<actuator><position joint="tilt" kp="5" kv=".5"/></actuator>'

    def tilt(model: Any, data: Any) -> None:
        data.ctrl[0] = ramp(data.time, 0.5, 0.8, 2.6)

    return watch(world(FLOOR + hinge + beads, drive), 2.2, tilt, stuffs=BEADS)


@pytest.fixture(scope="module")
def tipping() -> Timeline:
    return tipped()


def the(timeline: Timeline, term: str) -> Fact:
    """Return the only fact of a term."""
    (found,) = (fact for fact in timeline.facts if str(fact.term) == term)
    return found


def test_a_cup_that_is_tipped_over_contains_the_beads_first_and_then_they_are_spilled(tipping: Timeline) -> None:
    held, spilled = the(tipping, "contains(cup,beads)"), the(tipping, "spilled(beads)")
    # What runs out last is a bead or two.
    last = float(held.evidence["fraction_at_end"])
    mean, least = (float(held.evidence[f"fraction_{name}"]) for name in ("mean", "least"))
    assert {name: held.evidence[name] for name in ("fraction", "mass", "margin")} == pytest.approx(
        {"fraction": 1.0, "mass": 0.012, "margin": 50.0}
    )
    assert 0.02 <= least <= last < mean < 1.0
    assert 0.0 < last < 0.5
    assert [spilled.evidence[name] for name in ("fraction", "fraction_at_end", "mass")] == pytest.approx([1, 1, 0.012])
    assert held.start < 0.1 < 0.5 < held.end < spilled.start
    assert spilled.end == tipping.duration
    assert "supports(floor,beads)" in at_end(tipping)
    assert {"moving(beads)", "spilling(beads)"} <= ever(tipping)


def test_beads_that_run_along_the_inside_of_a_cup_are_not_spilled_yet(tipping: Timeline) -> None:
    held, spilled = the(tipping, "contains(cup,beads)"), the(tipping, "spilled(beads)")
    # A fall of 15 cm lies between.
    assert spilled.start - held.end > 0.15


def test_no_fact_names_a_single_bead_and_a_stuff_neither_contacts_nor_collides(tipping: Timeline) -> None:
    named = {str(arg) for fact in tipping.facts for arg in fact.args}
    assert named == {"cup", "floor", "beads"}
    assert not [f for f in tipping.facts if f.type in ("contacts", "colliding", "attached") and "beads" in f.args]
    assert len(tipping.facts) < 12


def test_the_beads_are_parts_of_the_stuff_in_queries(tipping: Timeline) -> None:
    assert tipping.ask("has_part(beads, B)")[0] == {"B": "bead0"}
    assert tipping.ask("has_part(beads, B), instance_of(beads, 'Stuff')", limit=20)[-1] == {"B": "bead9"}
    assert not tipping.ask("holds(contacts(cup, bead3), T)")


def test_some_beads_are_contained_while_others_are_spilled() -> None:
    beads = "".join(bead(k, in_cup(k) if k < 8 else on_floor(k)) for k in range(12))
    timeline = watch(world(FLOOR + free("cup", "0 0 .0001", CUP) + beads), 0.6, stuffs=BEADS)
    assert the(timeline, "contains(cup,beads)").evidence["fraction"] == pytest.approx(8 / 12)
    share = 4 / 12
    every = {"fraction": share, "fraction_mean": share, "fraction_least": share, "fraction_at_end": share}
    evidence = {**every, "mass": 0.004, "margin": share / 0.02}
    assert the(timeline, "spilled(beads)").evidence == pytest.approx(evidence)
    assert the(timeline, "supports(floor,beads)").evidence["fraction"] == pytest.approx(4 / 12)
    assert {"contains(cup,beads)", "spilled(beads)", "supports(floor,cup)"} <= at_end(timeline)
    assert not of_type(timeline, "falling", "spilling", "contacts") - {"contacts(cup,floor)"}


def test_beads_beside_the_slot_in_a_cup_stay_in_it_and_those_above_the_slot_are_spilled() -> None:
    slot = "".join(f'<geom type="box" size=".01 .03 .002" pos="{x} 0 .002" mass=".1"/>' for x in (-0.0175, 0.0175))
    legs = "".join(
        f'<geom type="box" size=".003 .003 .02" pos="{x} {y} -.02" mass=".1"/>'
        for x in (-0.02, 0.02)
        for y in (-0.02, 0.02)
    )
    sieve = free("sieve", "0 0 .0401", cup_geoms(0.03, 0.06, bottom=False) + slot + legs)
    beside = [f"{0.0165 * side} {0.0125 * (k - 1)} .0503" for side in (-1, 1) for k in range(3)]
    above = [f"0 {0.0125 * (k - 1)} .0603" for k in range(3)]
    beads = "".join(bead(k, where) for k, where in enumerate([*beside, *above]))
    timeline = watch(world(FLOOR + sieve + beads), 0.6, stuffs=BEADS)
    assert the(timeline, "contains(sieve,beads)").evidence["fraction"] == pytest.approx(6 / 9)
    assert the(timeline, "spilled(beads)").evidence["fraction"] == pytest.approx(3 / 9)
    assert the(timeline, "contains(sieve,beads)").start < 0.05
    assert {"contains(sieve,beads)", "spilled(beads)"} <= at_end(timeline)


def test_a_stuff_of_which_exactly_half_is_knocked_off_a_table_moves_and_falls() -> None:
    table = '<body name="table" pos="0 0 .3"><geom type="box" size=".1 .1 .01"/></body>'
    # Of twelve masses that are alike, six shares sum up to a little less than a half.
    kept = [f"-.05 {0.016 * k - 0.04} .316" for k in range(6)]
    knocked = [f".09 {0.016 * k - 0.04} .316" for k in range(6)]
    beads = "".join(bead(k, where) for k, where in enumerate([*kept, *knocked]))

    def knock(model: Any, data: Any) -> None:
        if abs(data.time - 0.2) < STEP / 2:
            data.qvel[6 * 6 :: 6] = 0.4

    timeline = watch(world(FLOOR + table + beads), 0.8, knock, stuffs=BEADS)
    moving, falling = the(timeline, "moving(beads)"), the(timeline, "falling(beads)")
    assert 0.19 < moving.start < 0.22 < falling.start < 0.4
    assert moving.evidence["fraction"] == falling.evidence["fraction"] == pytest.approx(0.5)
    supported = the(timeline, "supports(table,beads)").evidence
    assert (supported["fraction"], supported["fraction_at_end"]) == (pytest.approx(1.0), pytest.approx(0.5))


def test_one_bead_beside_the_cup_is_noticed() -> None:
    beads = "".join(bead(k, in_cup(k) if k < 11 else on_floor(k)) for k in range(12))
    timeline = watch(world(FLOOR + free("cup", "0 0 .0001", CUP) + beads), 0.4, stuffs=BEADS)
    assert the(timeline, "spilled(beads)").evidence["fraction"] == pytest.approx(1 / 12)
    assert the(timeline, "contains(cup,beads)").evidence["fraction"] == pytest.approx(11 / 12)


def test_beads_that_hop_in_a_cup_stay_contained() -> None:
    def shake(model: Any, data: Any) -> None:
        data.ctrl[0] = 0.006 if data.time % 0.2 < 0.05 and data.time > 0.3 else 0.0

    cup = f'<body name="cup" pos="0 0 .02"><joint name="up" type="slide"/>{CUP}</body>'
    beads = "".join(bead(k, in_cup(k, 0.02)) for k in range(12))
    drive = '<actuator><position joint="up" kp="2000" kv="40"/></actuator>'
    timeline = watch(world(FLOOR + cup + beads, drive), 1.0, shake, stuffs=BEADS)
    held = the(timeline, "contains(cup,beads)")
    assert (held.end, held.evidence["fraction"]) == (timeline.duration, pytest.approx(1.0))
    assert not of_type(timeline, "spilled", "spilling")


def test_a_heap_lies_on_the_floor_with_all_that_it_consists_of() -> None:
    corners = [(x, y) for x in (-1, 1) for y in (-1, 1)]
    pen = "".join(f'<geom type="box" size=".001 .015 .005" pos="{0.015 * x} 0 .005"/>' for x in (-1, 1))
    pen += "".join(f'<geom type="box" size=".015 .001 .005" pos="0 {0.015 * y} .005"/>' for y in (-1, 1))
    frame = free("frame", "0 0 .0001", pen)
    beads = "".join(bead(k, f"{0.0065 * x} {0.0065 * y} .0065") for k, (x, y) in enumerate(corners))
    timeline = watch(world(FLOOR + frame + beads + bead(4, "0 0 .0158")), 0.6, stuffs=BEADS)
    # The frame has no bottom: it keeps nothing, and what it surrounds lies on the floor.
    assert "contains(frame,beads)" not in ever(timeline)
    assert the(timeline, "supports(floor,beads)").evidence["fraction"] == pytest.approx(1.0)


def test_two_stuffs_are_told_apart() -> None:
    beads = "".join(bead(k, in_cup(k)) for k in range(4))
    peas = "".join(ball(f"pea{k}", f"{0.1 + 0.02 * k} 0 .005", 0.005, 0.0005, 'condim="6"') for k in range(4))
    stuffs = {**BEADS, "peas": "pea?"}
    timeline = watch(world(FLOOR + free("cup", "0 0 .0001", CUP) + beads + peas), 0.4, stuffs=stuffs)
    assert of_type(timeline, "contains", "spilled") == {"contains(cup,beads)", "spilled(peas)"}


def test_a_scene_may_say_more_of_a_stuff() -> None:
    beads = "".join(bead(k, in_cup(k)) for k in range(4))
    model, states = roll(world(FLOOR + free("cup", "0 0 .0001", CUP) + beads), 0.05)
    log = Log.from_mujoco(model, states, STEP, {"beads": Thing(name="beads", kind="Sugar")}, stuffs=BEADS)
    beads_found = log.things[log.index("beads")]
    assert (beads_found.kind, beads_found.mass) == ("Sugar", pytest.approx(0.004))
    assert beads_found.roles == {"Stuff"}


def test_what_is_no_stuff_is_told_and_folded_as_before() -> None:
    boxes = "".join(box(f"box{k}", f"{0.1 * k} 0 .01", ".01 .01 .01", 0.01) for k in range(7))
    timeline = watch(world(FLOOR + boxes + bead(0, "0 .5 .006") + bead(1, "0 .6 .006")), 0.3, stuffs=BEADS)
    told = [row.what for row in fold(timeline.facts, timeline.domain) if row.what.startswith("supports")]
    assert sorted(told) == ["supports(floor,[7 like box0])", "supports(floor,beads)"]


def test_beads_support_a_board_together() -> None:
    grid = [(x, y) for x in range(-2, 3) for y in range(-2, 3)]
    beads = "".join(bead(k, f"{0.014 * x} {0.014 * y} .006") for k, (x, y) in enumerate(grid))
    board = box("board", "0 0 .0141", ".05 .05 .002", 0.1)
    timeline = watch(world(FLOOR + beads + board), 0.5, stuffs=BEADS)
    assert of_type(timeline, "supports") == {"supports(floor,beads)", "supports(beads,board)"}
    assert the(timeline, "supports(beads,board)").evidence["mean_force"] == pytest.approx(0.1 * 9.81, rel=0.05)
    assert not of_type(timeline, "contacts", "colliding", "falling")
