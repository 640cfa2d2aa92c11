"""Posed scenes: what contains, supports and has spilled a liquid or a ball, as anybody would say who looks at them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from tests.fluents.liquids import (
    DISH,
    HEIGHT,
    HOOP,
    INNER,
    LIDDED,
    RADIUS,
    WALL,
    D,
    block,
    judged,
    level_in,
    placed,
    poured,
    puddle,
    says,
    table,
    tilted,
    upturned,
    vessel,
    within,
)
from tests.fluents.logs import Draft

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import FloatArray, Geom, Hole, Shape, Triple
from prolepsis.log.things import Thing

IN = {"contains(cup1,liq1)"}
ON_TABLE = {"spilled(liq1)", "supports(table1,liq1)"}
ON_CUP = {"spilled(liq1)", "supports(cup1,liq1)"}
NOTHING: set[str] = set()
SIDE_HOLE = (Hole(position=(RADIUS + 0.01, 0.0, 0.04), direction=(-1.0, 0.0, 0.0), radius=0.005),)
BOTTOM_HOLE = (Hole(position=(0.0, 0.0, -0.01), direction=(0.0, 0.0, 1.0), radius=0.005),)
LYING = vessel(at=(0.0, 0.0, RADIUS), turn=tilted(90.0))
"""A cup on its side; its mouth looks along -y."""
JUG_BELLY, NECK = 0.06, 0.02
"""Where a jug begins to narrow, and the inner radius of its neck [m]."""
JUG = (
    *((0.0, 0.0), (RADIUS, 0.0), (RADIUS, JUG_BELLY), (NECK + WALL, 0.08), (NECK + WALL, HEIGHT), (NECK, HEIGHT)),
    *((NECK, 0.08), (INNER, JUG_BELLY), (INNER, WALL), (0.0, WALL)),
)


def leaning(degrees: float) -> Thing:
    """Return a cup that is held tilted above the table; its lowest lip looks along -y."""
    return vessel(at=(0.0, 0.0, 0.1), turn=tilted(degrees))


def lip(degrees: float) -> float:
    """Return how high the lowest point of that cup's inner edge is [m]."""
    a = math.radians(degrees)
    return 0.1 + HEIGHT * math.cos(a) - INNER * math.sin(a)


def lying_jug(*, mesh: bool = False) -> Thing:
    """Return a jug on its side; the lower edge of its neck is at 2 cm."""
    return vessel(profile=JUG, at=(0.0, 0.0, RADIUS), turn=tilted(90.0), mesh=mesh)


def above(height: float, points: FloatArray) -> FloatArray:
    return points[points[:, 2] > height]


def ring(radius: float, low: float, high: float) -> FloatArray:
    """Return particles in a layer round the z axis."""
    count = int(2 * math.pi * radius / D)
    angle = 2 * math.pi * np.arange(count) / count
    heights = np.arange(low + D / 2, high, D)
    return np.array([(radius * math.cos(a), radius * math.sin(a), z) for z in heights for a in angle])


def joined(*several: FloatArray) -> FloatArray:
    return np.concatenate(several)


OUTER_FILM = ring(RADIUS + D / 2, 0.02, 0.08)
ON_RIM = ring((RADIUS + INNER) / 2, HEIGHT, HEIGHT + D)
PUDDLE = puddle(half=0.03)
STREAM = within(block((-0.006, -0.006, 0.0), (0.006, 0.006, 0.2)), 0.006)
BULGE = within(block((-INNER, -INNER, HEIGHT - 0.25 * D), (INNER, INNER, HEIGHT + 0.75 * D)), INNER - 0.004)

SCENES: dict[str, tuple[Sequence[Thing], FloatArray, set[str]]] = {
    "half a cup": ([vessel()], poured(high=0.045), IN),
    "half a cup of a mesh": ([vessel(mesh=True)], poured(high=0.045, radius=0.036), IN),
    "a thin layer in a cup": ([vessel()], poured(high=WALL + D), IN),
    "a thin layer in a cup of a mesh": ([vessel(mesh=True)], poured(high=WALL + D, radius=0.036), IN),
    "a cup full to the brim": ([vessel()], poured(), IN),
    "a brimful cup that bulges": ([vessel()], joined(poured(high=HEIGHT - D), BULGE), IN),
    "only the bulge is looked at": ([vessel()], BULGE, IN),
    "upturned, a puddle on its base": ([upturned()], puddle(0, 0, z=HEIGHT), ON_CUP),
    "upturned mesh, a puddle on its base": ([upturned(mesh=True)], puddle(0, 0, z=HEIGHT), ON_CUP),
    "upturned, two layers on its base": ([upturned()], puddle(0, 0, z=HEIGHT, layers=2), ON_CUP),
    "upturned, a heap on its base": ([upturned()], joined(
        puddle(0, 0, z=HEIGHT, layers=2), puddle(0, 0, z=HEIGHT + 2 * D, half=0.01, layers=2)), ON_CUP),
    "upturned over a puddle": ([upturned()], puddle(0, 0), ON_TABLE),
    "upturned mesh over a puddle": ([upturned(mesh=True)], puddle(0, 0), ON_TABLE),
    "on its side, what will run out": ([LYING], level_in(LYING, 0.012), NOTHING),
    "a jug on its side keeps a little": ([lying_jug()], level_in(LYING, 0.018, depth=JUG_BELLY), IN),
    "a jug of a mesh on its side": ([lying_jug(mesh=True)], level_in(LYING, 0.018, depth=JUG_BELLY), IN),
    "a jug on its side, above its neck": ([lying_jug()], above(0.03, level_in(LYING, 0.07, depth=JUG_BELLY)), NOTHING),
    "on its side, a puddle before its mouth": ([LYING], puddle(0, -0.15), ON_TABLE),
    "on its side, liquid on its belly": ([LYING], puddle(0, -0.04, z=2 * RADIUS, half=0.003), ON_CUP),
    "film on the outer wall": ([vessel()], OUTER_FILM, {"spilled(liq1)"}),
    "film on the outer wall of a mesh": ([vessel(mesh=True)], OUTER_FILM, {"spilled(liq1)"}),
    "on the rim": ([vessel()], ON_RIM, ON_CUP),
    "in the cup and on the rim": ([vessel()], joined(poured(high=0.03), ON_RIM), IN | ON_CUP),
    "beside the cup": ([vessel()], puddle(0.07, 0), ON_TABLE),
    "puddle against the cup's foot": ([vessel()], ring(RADIUS + D / 2, 0, D), ON_TABLE),
    "a hole in the side, filled below it": ([vessel(holes=SIDE_HOLE)], poured(high=0.03), IN),
    "a hole in the side, liquid above it": ([vessel(holes=SIDE_HOLE)], poured(low=0.055), IN),
    "a hole in the bottom": ([vessel(holes=BOTTOM_HOLE)], poured(high=0.045), IN),
    "holes in side and bottom": ([vessel(holes=SIDE_HOLE + BOTTOM_HOLE)], poured(high=0.07), IN),
    "a hole in the bottom of a cup on its side": (
        [vessel(at=(0.0, 0.0, RADIUS), turn=tilted(90.0), holes=BOTTOM_HOLE)], level_in(LYING, 0.012), NOTHING),
    "a hole in the bottom, tilted by 60 degrees": (
        [vessel(at=(0.0, 0.0, 0.1), turn=tilted(60.0), holes=BOTTOM_HOLE)], level_in(leaning(60), lip(60)), IN),
    "a hole in the bottom, tilted by 60 degrees, above the lip": (
        [vessel(at=(0.0, 0.0, 0.1), turn=tilted(60.0), holes=BOTTOM_HOLE)],
        above(lip(60) + D, level_in(leaning(60), 1.0)), NOTHING),
    "a hoop": ([vessel(profile=HOOP)], poured(0.0, 0.045), ON_TABLE),
    "a lidded cup": ([vessel(profile=LIDDED)], poured(high=0.045), IN),
    "a lidded cup upside down": ([vessel(profile=LIDDED, at=(0, 0, HEIGHT), turn=tilted(180.0))],
        poured(high=0.045), IN),
    "a lidded cup on its side": ([vessel(profile=LIDDED, at=(0, 0, RADIUS), turn=tilted(90.0))],
        level_in(LYING, 0.02, depth=HEIGHT - WALL), IN),
    "liquid on a lid": ([vessel(profile=LIDDED)], puddle(0, 0, z=HEIGHT), ON_CUP),
    "a dish": ([vessel(profile=DISH)], poured(high=0.012, radius=0.097), IN),
    "a cup in a dish, liquid in the cup below both rims": (
        [vessel(at=(0, 0, 0.003)), vessel("dish1", profile=DISH)], poured(0.006, 0.03), IN | {"contains(dish1,liq1)"}),
    "a cup in a dish, liquid in the cup above the dish": (
        [vessel(at=(0, 0, 0.003)), vessel("dish1", profile=DISH)], poured(0.05, 0.08), IN),
    "a cup in a dish, liquid between them": (
        [vessel(at=(0, 0, 0.003)), vessel("dish1", profile=DISH)], ring(0.07, 0.003, 0.015), {"contains(dish1,liq1)"}),
    "an upturned cup in a dish, liquid on its base": (
        [upturned(at=(0, 0, HEIGHT + 0.003)), vessel("dish1", profile=DISH)], puddle(0, 0, z=HEIGHT + 0.003), ON_CUP),
    "a stream through the air into a cup": ([vessel()], STREAM[STREAM[:, 2] > WALL], IN),
    "a stream beside a cup": ([vessel()], STREAM + np.array([0.06, 0, 0.01]), NOTHING),
    "drops in the air above a cup": ([vessel()], puddle(0, 0, z=0.13), NOTHING),
    "carried tilted by 30 degrees": ([leaning(30)], level_in(leaning(30), lip(30)), IN),
    "carried tilted by 60 degrees": ([leaning(60)], level_in(leaning(60), lip(60)), IN),
    "tilted by 60 degrees, above the lip": ([leaning(60)], above(lip(60) + D, level_in(leaning(60), 1.0)), NOTHING),
    "tilted by 100 degrees": ([leaning(100)], level_in(leaning(100), 1.0), NOTHING),
    "a splash in the cup and the rest beside it": ([vessel()], joined(poured(high=0.045)[:4], PUDDLE), ON_TABLE),
    "a little in the cup and the rest beside it": ([vessel()], joined(poured(high=0.045)[:8], PUDDLE), IN | ON_TABLE),
    "a splash beside the cup": ([vessel()], joined(poured(high=0.045), PUDDLE[:30]), IN),
    "a little beside the cup": ([vessel()], joined(poured(high=0.045), PUDDLE[:60]), IN | ON_TABLE),
}  # fmt: skip


@pytest.mark.parametrize("scene", SCENES)
def test_a_liquid_is_where_one_sees_it(scene: str) -> None:
    things, particles, said = SCENES[scene]
    assert judged([table(), *things], {"liq1": particles}) == said


def test_two_liquids_in_a_cup_are_both_contained() -> None:
    liquids = {"liq1": poured(WALL, 0.04), "liq2": poured(0.04, 0.08)}
    assert judged([table(), vessel()], liquids) == {"contains(cup1,liq1)", "contains(cup1,liq2)"}


def test_of_two_liquids_one_is_in_the_cup_and_one_has_run_over() -> None:
    liquids = {"liq1": poured(), "liq2": puddle()}
    assert judged([table(), vessel()], liquids) == {"contains(cup1,liq1)", "spilled(liq2)", "supports(table1,liq2)"}


BALLS: dict[str, tuple[Thing, Triple, bool]] = {
    "in a cup": (vessel(), (0.0, 0.0, WALL + 0.015), True),
    "in a cup of a mesh": (vessel(mesh=True), (0.0, 0.0, WALL + 0.015), True),
    "beside a cup": (vessel(), (0.06, 0.0, 0.015), False),
    "beside a cup of a mesh": (vessel(mesh=True), (0.06, 0.0, 0.015), False),
    "under an upturned cup": (upturned(), (0.0, 0.0, 0.015), False),
    "under an upturned cup of a mesh": (upturned(mesh=True), (0.0, 0.0, 0.015), False),
    "on an upturned cup": (upturned(), (0.0, 0.0, HEIGHT + 0.015), False),
    "in a hoop": (vessel(profile=HOOP), (0.0, 0.0, 0.015), False),
    "in a hoop of a mesh": (vessel(profile=HOOP, mesh=True), (0.0, 0.0, 0.015), False),
    "in a cup on its side": (LYING, (0.0, -0.05, WALL + 0.015), False),
    "in a lidded cup upside down": (vessel(profile=LIDDED, at=(0.0, 0.0, HEIGHT), turn=tilted(180.0)),
        (0.0, 0.0, WALL + 0.015), True),
    "in a cup that leans by 30 degrees": (leaning(30), tuple(placed(np.array([0.0, -0.02, 0.02]), leaning(30))), True),
    "in a cup with a hole that it does not fit through": (vessel(holes=BOTTOM_HOLE), (0.0, 0.0, WALL + 0.0145), True),
    "in a dish": (vessel(profile=DISH), (0.03, 0.0, WALL + 0.015), True),
}  # fmt: skip


@pytest.mark.parametrize("scene", BALLS)
def test_a_ball_is_where_one_sees_it(scene: str) -> None:
    container, place, contained = BALLS[scene]
    shape = Shape(geoms=(Geom(type="sphere", size=(0.015, 0.0, 0.0)),))
    ball = Thing(name="ball1", kind="Ball", shape=shape, mass=0.01, position=place)
    draft = Draft(400, [table(), container, ball])
    draft.rest(container.name, "ball1", 0, 400, 0.0981)
    assert says(recognize(draft.log()), "contains") == ({"contains(cup1,ball1)"} if contained else set())


def test_the_evidence_tells_fraction_volume_and_depth() -> None:
    from tests.fluents.liquids import wet

    points = joined(poured(high=0.045), puddle(half=0.03))
    timeline = recognize(wet([table(), vessel()], {"liq1": points}))
    (contained,) = timeline.select(type="contains")
    (spilled,) = timeline.select(type="spilled")
    (supported,) = [fact for fact in timeline.select(type="supports") if "liq1" in fact.args]
    share = len(poured(high=0.045)) / len(points)
    assert contained.evidence["fraction"] == pytest.approx(share)
    assert contained.evidence["volume"] == pytest.approx(len(poured(high=0.045)) * D**3)
    assert float(contained.evidence["depth"]) == pytest.approx(HEIGHT - (WALL + 0.045) / 2, abs=0.002)
    assert spilled.evidence["fraction"] == supported.evidence["fraction"] == pytest.approx(1 - share)
    assert spilled.evidence["mass"] == pytest.approx((1 - share) * len(points) * 1000 * D**3)


def test_what_is_in_a_closed_vessel_is_no_deeper_than_the_vessel() -> None:
    from tests.fluents.liquids import wet

    (contained,) = recognize(wet([table(), vessel(profile=LIDDED)], {"liq1": poured(high=0.045)})).select(
        type="contains"
    )
    assert float(contained.evidence["depth"]) == pytest.approx(HEIGHT - WALL - (WALL + 0.045) / 2, abs=0.003)
