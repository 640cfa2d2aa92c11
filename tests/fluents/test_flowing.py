"""Liquids that flow, on logs made by hand: pouring, overflowing, leaking, absorbing, and what is none of these."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from tests.fluents.liquids import (
    DT,
    EVERY,
    HEIGHT,
    INNER,
    RADIUS,
    WALL,
    D,
    level_in,
    liquid,
    poured,
    puddle,
    says,
    table,
    tilted,
    upturned,
    vessel,
    wet,
)
from tests.fluents.logs import Draft, egg
from tests.fluents.worlds import times

from prolepsis.fluents import recognize
from prolepsis.fluents.solids.containment import NOTICEABLE_FRACTION
from prolepsis.geometry.shape import FloatArray, Geom, Hole, Shape
from prolepsis.log.log import PARKED, Action, Log
from prolepsis.log.things import Thing
from prolepsis.log.timeline import Timeline
from prolepsis.logic.process import PROLOG_FILES
from prolepsis.terms.terms import Term

TICKS = 200
FRAMES = TICKS // EVERY
CUP2 = (0.0, -0.1, 0.0)
AFTERWARDS = """
    occurs(E, T1), eventT(E, pouringTo), argsOf(E, [cup1, liq1, cup2]),
    after(T2, T1), holds(F, T2), objOf(F, liq1)
"""


def journey(starts: FloatArray, ends: FloatArray, over: Sequence[tuple[float, float, float]]) -> FloatArray:
    """Return the way of particles that set off one by one, pass some points within 0.3 s, and stay at their ends."""
    time = np.arange(FRAMES) * EVERY * DT
    stops = np.linspace(0.0, 0.3, len(over) + 2)
    found = np.empty((FRAMES, len(starts), 3))
    for p, (start, end) in enumerate(zip(starts, ends, strict=True)):
        since = time - 0.3 - p / len(starts)
        way = np.array([start, *over, end])
        for axis in range(3):
            found[:, p, axis] = np.interp(since, stops, way[:, axis])
    return found


def pouring(second: Thing, ends: FloatArray) -> tuple[list[Thing], FloatArray]:
    """Return a scene in which a leaning cup is emptied, and the ways of its liquid, which ends up at some places."""
    a = math.radians(60)
    lean = vessel(at=(0.0, 0.0, 0.2), turn=tilted(60.0))
    lip = (0.0, -HEIGHT * math.sin(a) - INNER * math.cos(a), 0.2 + HEIGHT * math.cos(a) - INNER * math.sin(a))
    starts = level_in(lean, lip[2])[: len(ends)]
    assert len(starts) == len(ends)
    over = [(0.0, lip[1] + 0.01, lip[2] + 0.006), (0.0, lip[1] - 0.012, lip[2]), (0.0, -0.1, 0.15)]
    return [table(), lean, second], journey(starts, ends, over)


def test_pouring_into_a_cup_binds_what_the_paper_states() -> None:
    things, way = pouring(vessel("cup2", CUP2), poured(high=0.02)[:300] + np.array(CUP2))
    timeline = recognize(wet(things, {"liq1": way}, ticks=TICKS))
    assert {str(row["F"]) for row in timeline.ask(AFTERWARDS)} == {"contains(cup2,liq1)"}
    ((start, end),) = [(fact.start, fact.end) for fact in timeline.select(type="flowingOut")]
    ((_, emptied),) = times(timeline, "contains(cup1,liq1)")
    assert start < emptied <= end
    ((received, _),) = times(timeline, "contains(cup2,liq1)")
    assert start < received < end
    assert not timeline.ask("occurs(overflowing(_, _), _)")
    assert not timeline.ask("occurs(leaking(_, _), _)")


def test_pouring_onto_an_upturned_cup_binds_what_the_paper_states() -> None:
    ends = np.concatenate((puddle(0, -0.1, z=HEIGHT, half=0.03)[:150], puddle(0.0, -0.3, half=0.03)[:150]))
    things, way = pouring(upturned("cup2", (0.0, -0.1, HEIGHT)), ends)
    timeline = recognize(wet(things, {"liq1": way}, ticks=TICKS))
    assert {str(row["F"]) for row in timeline.ask(AFTERWARDS)} == {
        "spilled(liq1)", "supports(table1,liq1)", "supports(cup2,liq1)",
    }  # fmt: skip


def test_what_is_poured_beside_the_cup_is_poured_to_the_table() -> None:
    things, way = pouring(vessel("cup2", (0.3, 0.0, 0.0)), puddle(0.0, -0.3, half=0.04)[:300])
    timeline = recognize(wet(things, {"liq1": way}, ticks=TICKS))
    assert [str(row["To"]) for row in timeline.ask("occurs(pouringTo(cup1, liq1, To), _)")] == ["table1"]
    assert timeline.ask(AFTERWARDS) == []


def test_a_cup_that_is_full_overflows_and_its_evidence_tells_so() -> None:
    starts, ends = poured(0.12, 0.16, radius=0.02), puddle(0.12, 0, half=0.03)
    count = min(len(starts), len(ends))
    inside, rim, beyond = (0.0, 0.0, 0.08), (RADIUS - WALL / 2, 0.0, HEIGHT + D / 2), (RADIUS + 2 * D, 0.0, 0.05)
    way = journey(starts[:count], ends[:count], [inside, (0.03, 0.0, HEIGHT - D / 2), rim, beyond])
    log = wet([table(), vessel()], {"liq1": way, "liq2": poured()}, ticks=TICKS)
    # A square lattice leaves room at a round wall, so each particle stands for a little more.
    capacity = math.pi * INNER**2 * (HEIGHT - WALL)
    volume = np.full(len(log.particles.stuff), capacity / len(poured()))
    timeline = recognize(replace(log, particles=replace(log.particles, volume=volume)))
    (out,) = timeline.select(type="flowingOut")
    assert out.args == ("cup1", "liq1")
    assert (out.evidence["over_rim"], out.evidence["tilt"]) == (1.0, 0.0)
    assert 0.97 < float(out.evidence["fill"]) < 1.15
    assert [row["X"] for row in timeline.ask("occurs(overflowing(cup1, X), _)")] == ["liq1"]
    assert {fact.args for fact in timeline.select(type="flowingOnto")} == {("liq1", "cup1"), ("liq1", "table1")}
    assert times(timeline, "contains(cup1,liq2)") == [(0.0, TICKS * DT)]
    assert "spilled(liq1)" in says(timeline)
    # The same beside an empty cup's brim is no overflowing.
    alone = recognize(wet([table(), vessel()], {"liq1": way}, ticks=TICKS))
    assert not alone.ask("occurs(overflowing(_, _), _)")


def test_a_cup_with_a_hole_leaks() -> None:
    hole = Hole(position=(RADIUS + 0.01, 0.0, 0.04), direction=(-1.0, 0.0, 0.0), radius=0.006)
    starts = poured(0.05, 0.07)[:200]
    ends = puddle(0.12, 0, half=0.03)[:200]
    way = journey(starts, ends, [(0.03, 0.0, 0.04), (RADIUS + 2 * D, 0.0, 0.04)])
    staying = poured(high=0.03)
    timeline = recognize(wet([table(), vessel(holes=(hole,))], {"liq1": way, "liq2": staying}, ticks=TICKS))
    (out,) = timeline.select(type="flowingOut")
    assert out.args == ("cup1", "liq1")
    assert out.evidence["through_holes"] == 1.0
    assert [row["C"] for row in timeline.ask("occurs(leaking(C, liq1), _)")] == ["cup1"]
    assert not timeline.ask("occurs(pouringTo(_, _, _), _)")
    assert not timeline.ask("occurs(overflowing(_, _), _)")
    ((since, until),) = times(timeline, "contains(cup1,liq1)")
    assert since == 0.0 and out.start < until <= out.end


def test_what_falls_through_a_vessel_without_staying_is_not_contained() -> None:
    hole = Hole(position=(0.0, 0.0, -0.01), direction=(0.0, 0.0, 1.0), radius=0.02)
    funnel = vessel(at=(0.0, 0.0, 0.3), holes=(hole,))
    drops = poured(0.45, 0.6, radius=0.01)
    fall = 4.9 * np.square(np.arange(FRAMES) * EVERY * DT)
    way = np.broadcast_to(drops, (FRAMES, *drops.shape)).copy()
    way[:, :, 2] = np.maximum(way[:, :, 2] - fall[:, None], D / 2)
    assert says(recognize(wet([table(), funnel], {"liq1": way}, ticks=TICKS))) == {
        "spilled(liq1)", "supports(table1,liq1)",
    }  # fmt: skip


def test_a_box_of_boards_with_a_gap_leaks() -> None:
    def board(size: tuple[float, float, float], position: tuple[float, float, float]) -> Geom:
        return Geom(type="box", size=size, position=position)

    walls = [board((0.05, 0.05, 0.002), (0, 0, 0.002)), board((0.002, 0.05, 0.04), (-0.048, 0, 0.04))]
    walls += [board((0.05, 0.002, 0.04), (0, y, 0.04)) for y in (-0.048, 0.048)]
    walls += [board((0.002, 0.05, 0.017), (0.048, 0, z)) for z in (0.017, 0.063)]
    box = Thing(name="cup1", kind="Box", shape=Shape(geoms=tuple(walls)), mass=0.1)
    starts, ends = poured(0.05, 0.07)[:200], puddle(0.15, 0, half=0.03)[:200]
    below = journey(starts, ends, [(0.04, 0.0, 0.04), (0.06, 0.0, 0.04)])
    (leak,) = recognize(wet([table(), box], {"liq1": below}, ticks=TICKS)).select(type="flowingOut")
    assert leak.evidence["through_holes"] == 1.0
    above = journey(starts, ends, [(0.0, 0.0, 0.076), (0.04, 0.0, 0.084), (0.06, 0.0, 0.08)])
    (splash,) = recognize(wet([table(), box], {"liq1": above}, ticks=TICKS)).select(type="flowingOut")
    assert float(splash.evidence["over_rim"]) > 0.9


def test_what_splashes_out_between_two_frames_went_over_the_rim_and_leaves_no_leak() -> None:
    starts = poured(0.02, 0.04)[:200]
    ends = puddle(0.15, 0, half=0.03)[:200]
    way = np.repeat(starts[None], FRAMES, axis=0)
    jump = FRAMES // 3 + np.arange(200) // 20
    for p, frame in enumerate(jump):
        way[frame : frame + 3, p] = [[0.07 + 0.03 * k, 0.0, HEIGHT + 0.05 - 0.05 * k] for k in range(3)]
        way[frame + 3 :, p] = ends[p]
    timeline = recognize(wet([table(), vessel()], {"liq1": way}, ticks=TICKS))
    (out,) = timeline.select(type="flowingOut")
    assert (out.evidence["over_rim"], out.evidence["through_holes"]) == (1.0, 0.0)
    assert not timeline.ask("occurs(leaking(_, _), _)")


def test_a_carried_cup_keeps_its_liquid_in_one_stretch_and_pours_nothing() -> None:
    points = poured(high=0.05)
    shift = np.linspace(0.0, 0.4, FRAMES)[:, None, None] * np.array([1.0, 0.0, 0.5])
    pose = np.zeros((TICKS, 7))
    pose[:, 3] = 1.0
    pose[:, :3] = np.interp(np.arange(TICKS), np.arange(FRAMES) * EVERY, shift[:, 0, 0])[:, None] * (1.0, 0.0, 0.0)
    pose[:, 2] = 0.5 * pose[:, 0]
    timeline = recognize(wet([table(), vessel()], {"liq1": points + shift}, ticks=TICKS, poses={"cup1": pose}))
    assert says(timeline) - {"supports(table1,cup1)"} == {"contains(cup1,liq1)"}
    assert times(timeline, "contains(cup1,liq1)") == [(0.0, TICKS * DT)]
    assert not says(timeline, "flowingOut", "flowingOnto", "spilling", "falling")


def test_what_is_carried_past_or_falls_beside_a_cup_is_not_contained() -> None:
    level = puddle(-0.2, 0, z=HEIGHT + 0.01) + np.linspace(0.0, 0.4, FRAMES)[:, None, None] * np.array([1.0, 0.0, 0.0])
    drops = puddle(0, 0, z=0.3)
    heights = np.maximum(0.3 - 4.9 * (np.arange(FRAMES) * EVERY * DT) ** 2, D / 2)
    beside = np.broadcast_to(drops + np.array([0.08, 0.0, 0.0]), (FRAMES, *drops.shape)).copy()
    beside[:, :, 2] = heights[:, None]
    timeline = recognize(wet([table(), vessel()], {"liq1": level, "liq2": beside}, ticks=TICKS))
    assert not says(timeline, "contains")
    assert "spilled(liq2)" in says(timeline)
    assert "spilled(liq1)" not in says(timeline)
    assert "falling(liq2)" in says(timeline, "falling")


def test_the_residue_of_an_emptied_cup_is_not_contained_again() -> None:
    points = poured(high=0.05)
    way = np.broadcast_to(points, (FRAMES, *points.shape)).copy()
    gone = np.arange(len(points)) >= 0.04 * len(points)
    way[FRAMES // 4 :, gone] = np.resize(puddle(0.2, 0, half=0.1), (int(gone.sum()), 3))
    way[FRAMES // 4 : FRAMES // 2, ~gone] += np.array([0.0, 0.0, 0.3])
    timeline = recognize(wet([table(), vessel()], {"liq1": way}, ticks=TICKS))
    ((start, end),) = times(timeline, "contains(cup1,liq1)")
    assert (start, end) == (0.0, pytest.approx(FRAMES // 4 * EVERY * DT))  # type: ignore[reportUnknownMemberType]


def test_parked_particles_are_spilled_and_a_few_drops_are_not() -> None:
    points = poured(high=0.05)
    holders = np.full((FRAMES, len(points)), -1.0)
    holders[FRAMES // 2 :, : len(points) // 10] = PARKED
    log = wet([table(), vessel()], {"liq1": points}, ticks=TICKS, holders={"liq1": holders})
    timeline = recognize(log)
    assert times(timeline, "spilled(liq1)") == [(TICKS // 2 * DT, TICKS * DT)]
    holders[:, len(points) // 100 :] = -1.0
    few = recognize(wet([table(), vessel()], {"liq1": points}, ticks=TICKS, holders={"liq1": holders}))
    assert "spilled(liq1)" not in says(few)


def wiped(*, touching: bool = True, drops: int = 0) -> Timeline:
    """Return the timeline of a sponge that is drawn over a puddle and takes it up; some drops leave it in the end."""
    shape = Shape(geoms=(Geom(type="box", size=(0.05, 0.03, 0.015)),))
    sponge = Thing(name="sponge1", kind="Sponge", shape=shape, mass=0.01, position=(-0.1, 0.0, 0.015))
    points = puddle(0.0, 0.0, half=0.04)
    holders = np.full((FRAMES, len(points)), -1.0)
    for p in range(len(points)):
        holders[30 + p * 40 // len(points) :, p] = 1
    holders[90:, :drops] = -1.0
    wipe = Action(
        term=Term("wipe", ("hand1", "sponge1", "table1", 0.2)),
        arguments={"hand": "hand1", "object": "sponge1", "surface": "table1"},
        start=40,
        end=150,
    )
    log = wet([table(), sponge], {"liq1": points}, ticks=TICKS, holders={"liq1": holders}, actions=(wipe,))
    if touching:
        draft = Draft(TICKS, log.things)
        draft.rest("table1", "sponge1", 0, TICKS, 1.0)
        log = replace(log, contacts=draft.log().contacts)
    return recognize(log)


def test_a_sponge_absorbs_what_it_wipes_and_the_paper_query_says_so() -> None:
    timeline = wiped()
    goal = "occurs(E, T1), eventT(E, wiping), argsOf(E, [sponge1, table1]), after(T2, T1), holds(F, T2)"
    assert {str(row["F"]) for row in timeline.ask(goal)} == {"absorbs(sponge1,liq1)"}
    assert says(timeline, "wiping", "absorbing", "dripping") == {"wiping(sponge1,table1)", "absorbing(sponge1,liq1)"}
    ((_, cleaned), *_) = times(timeline, "spilled(liq1)")
    assert cleaned < 150 * DT
    assert "contains(sponge1,liq1)" not in says(timeline)


def test_a_sponge_that_loses_a_noticeable_part_again_drips() -> None:
    timeline = wiped(drops=40)
    ((start, _),) = times(timeline, "dripping(sponge1,liq1)")
    assert start == 90 * EVERY * DT
    assert ("spilled(liq1)", 1.8) in {(str(fact.term), round(fact.start, 6)) for fact in timeline.facts}
    assert not says(wiped(drops=2), "dripping")


def test_a_sponge_that_does_not_touch_the_table_does_not_wipe_it() -> None:
    assert not says(wiped(touching=False), "wiping")


def test_an_intact_egg_contains_the_particles_of_its_yolk() -> None:
    things = [table(), *egg()[:4]]
    for k in range(1, 5):
        things[k] = replace(things[k], position=(0.0, 0.0, 0.0285))
    base = wet(things, {"liq1": puddle(0, 0, z=0.03, half=0.01)}, ticks=100)
    yolk = base.index("yolk1")
    particles = replace(base.particles, stuff=np.full_like(base.particles.stuff, yolk))
    held = np.full_like(particles.holder, base.index("egg1"))
    held[25:] = -1
    log: Log = replace(base, particles=replace(particles, holder=held))
    timeline = recognize(log)
    assert times(timeline, "contains(egg1,yolk1)")[0][0] == 0.0
    assert not says(timeline, "absorbs")
    assert liquid().name not in {name for fact in timeline.facts for name in fact.args}


def test_chronicles_take_the_noticeable_fraction_from_recognition() -> None:
    assert f"noticeable({NOTICEABLE_FRACTION})." in (PROLOG_FILES / "chronicles.pl").read_text()
