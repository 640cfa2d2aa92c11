"""Solids above the hole of a vessel: what rests on the vessel there is in it until it leaves it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from tests.fluents.liquids import CUP, HOOP, WALL, Profile, vessel
from tests.fluents.logs import DT, Draft
from tests.fluents.worlds import FLOOR, ball, cup_geoms, free, watch, world

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import FloatArray, Geom, Hole, Shape, Triple
from prolepsis.log.things import FIXED, Thing
from prolepsis.log.timeline import Timeline

TICKS = 600
ALWAYS = (0.0, TICKS * DT)
UP = 0.1
"""Height of the vessel above the table [m]."""
RADIUS = 0.008
"""Of the ball [m]."""
LYING: Triple = (0.028, 0.0, UP + WALL + RADIUS)
"""Where it lies on the bottom of the cup, beside the hole."""


def bottom_hole(radius: float) -> Hole:
    """Return a hole in the middle of a vessel's bottom."""
    return Hole(position=(0.0, 0.0, 2 * WALL), direction=(0.0, 0.0, -1.0), radius=radius)


def draft(*things: Thing, hole: float = 0.02, profile: Profile = CUP, height: float = UP, role: str = "Shelf") -> Draft:
    """Return a log in the making of a cup with a hole in its bottom, above a table, and what is with it."""
    top = Geom(type="box", size=(0.5, 0.5, 0.1), position=(0.0, 0.0, -0.1))
    holes = (bottom_hole(hole),) if hole else ()
    cup = vessel("cup", (0.0, 0.0, height), profile=profile, holes=holes)
    table = Thing(name="table", kind=role, shape=Shape(geoms=(top,)), mount=FIXED)
    return Draft(ticks=TICKS, things=[table, cup, *things])


def a_ball(name: str = "ball", at: Triple = LYING, radius: float = RADIUS) -> Thing:
    """Return a ball of 10 g."""
    return Thing(name=name, kind="Ball", shape=Shape(geoms=(Geom(type="sphere", size=(radius, 0, 0)),)), mass=0.01,
                 position=at)  # fmt: skip


def contained(draft: Draft) -> Mapping[str, list[tuple[float, float]]]:
    """Return when what is in the cup."""
    found: dict[str, list[tuple[float, float]]] = {}
    for fact in recognize(draft.log()).select(type="contains"):
        found.setdefault(str(fact.args[1]), []).append((fact.start, fact.end))
    return found


def along(*corners: tuple[int, Triple]) -> FloatArray:
    """Return positions on the way from corner to corner, each at its tick, shape (T, 3)."""
    ticks, places = [tick for tick, _ in corners], np.array([place for _, place in corners])
    return np.stack([np.interp(np.arange(TICKS), ticks, places[:, axis]) for axis in range(3)], axis=1)


def test_a_ball_beside_the_hole_of_a_cup_is_in_it() -> None:
    log = draft(a_ball())
    log.rest("cup", "ball", 0, TICKS, 0.1)
    assert contained(log) == {"ball": [ALWAYS]}


def test_a_block_over_the_hole_is_in_the_cup_and_so_is_what_lies_on_it() -> None:
    half = 0.015
    block = Thing(name="block", kind="Box", shape=Shape(geoms=(Geom(type="box", size=(half, half, half)),)), mass=0.1,
                  position=(0.0, 0.0, UP + WALL + half))  # fmt: skip
    pea = a_ball("pea", (0.0, 0.0, UP + WALL + 2 * half + 0.004), 0.004)
    log = draft(block, pea, hole=0.014)
    log.rest("cup", "block", 0, TICKS, 1.0)
    log.rest("block", "pea", 0, TICKS, 0.1)
    assert contained(log) == {"block": [ALWAYS], "pea": [ALWAYS]}


def test_what_rolls_into_the_hole_is_in_the_cup_until_it_has_left() -> None:
    log = draft(a_ball())
    over = (0.008, 0.0, LYING[2])
    log.poses[:, 2, :3] = along((300, LYING), (400, over), (500, (0.0, 0.0, 0.02)))
    log.rest("cup", "ball", 0, 400, 0.1)
    ((start, end),) = contained(log)["ball"]
    # Half of it is below the bottom when it has fallen by less than a third of its way: at 0.43 s.
    assert start == 0.0
    assert 0.4 < end < 0.44


def test_what_falls_through_the_hole_was_never_in_the_cup() -> None:
    log = draft(a_ball())
    log.poses[:, 2, :3] = along((0, (0.0, 0.0, 0.3)), (TICKS, (0.0, 0.0, 0.0)))
    assert not contained(log)


def test_what_the_table_bears_within_a_hole_or_a_hoop_is_not_in_the_vessel() -> None:
    standing: Triple = (0.0, 0.0, 0.002)
    log = draft(a_ball(at=standing, radius=0.002), height=0.0)
    log.rest("table", "ball", 0, TICKS, 0.1)
    assert not contained(log)
    log = draft(
        a_ball(at=(0.0, 0.0, RADIUS)), a_ball("rider", (0.0, 0.0, 3 * RADIUS)), height=0.0, profile=HOOP, hole=0
    )
    log.rest("table", "ball", 0, TICKS, 0.2)
    log.rest("ball", "rider", 0, TICKS, 0.1)
    assert not contained(log)


def test_what_has_dropped_through_the_hole_on_to_the_table_has_left() -> None:
    # The bottom is thicker than the marble is wide, so that it is still within the hole.
    marble = a_ball(at=(0.028, 0.0, WALL + 0.001), radius=0.001)
    log = draft(marble, height=0.0)
    log.poses[:, 2, :3] = along((300, marble.position), (400, (0.0, 0.0, WALL + 0.001)), (420, (0.0, 0.0, 0.001)))
    log.rest("cup", "ball", 0, 400, 0.1)
    log.rest("table", "ball", 420, TICKS, 0.1)
    ((start, end),) = contained(log)["ball"]
    assert start == 0.0
    assert 0.4 < end <= 0.42


def boards(slot: float) -> str:
    """Return a cup of boards on legs of which the bottom leaves a slot of a width [m]."""
    half = (0.04 - slot / 2) / 2
    bottom = "".join(
        f'<geom type="box" size="{half} .04 .002" pos="{side * (slot / 2 + half)} 0 .002" mass=".1"/>'
        for side in (-1, 1)
    )
    legs = "".join(
        f'<geom type="box" size=".003 .003 .02" pos="{x} {y} -.02" mass=".1"/>'
        for x in (-0.03, 0.03)
        for y in (-0.03, 0.03)
    )
    return free("cup", "0 0 .0401", cup_geoms(0.04, 0.06, bottom=False) + bottom + legs)


def beside_slot(slot: float, radius: float) -> Timeline:
    """Return the timeline of a ball that lies on a board beside the slot between two."""
    where = f"{slot / 2 + radius} 0 {0.0442 + radius}"
    return watch(
        world(FLOOR + boards(slot) + ball("ball", where, radius, 0.01, 'condim="6" friction="1 .01 .01"')), 0.5
    )


def test_a_slot_between_boards_is_a_hole_if_it_is_narrow_or_no_wider_than_what_lies_there() -> None:
    for slot, radius, held in ((0.014, 0.005, True), (0.024, 0.013, True), (0.028, 0.005, False)):
        found = {str(fact.term) for fact in beside_slot(slot, radius).select(type="contains")}
        assert found == ({"contains(cup,ball)"} if held else set()), (slot, radius)
