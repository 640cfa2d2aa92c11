"""Ordinary solids topple, fall, slide and rebound as closed forms tell."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.comparing import Compare
from tests.laws.solid_scenes import (
    G,
    overhanging,
    passes,
    random_tower,
    rebound,
    slide,
    slipped,
    topples,
    tower_falls,
)

pytestmark = pytest.mark.laws

WOOD = ":density 600.0 ; :restitution 0.55 ; :youngsModulus 10.0e9"
GLASS = ":density 2500.0 ; :restitution 0.94 ; :youngsModulus 70.0e9"
STEEL = ":density 7800.0 ; :restitution 0.6 ; :youngsModulus 200.0e9"
RUBBER = ":density 1100.0 ; :restitution 0.83 ; :youngsModulus 3.0e6"
STONE = ":restitution 0.6 ; :youngsModulus 50.0e9"
FIXED_WOOD = ":restitution 0.55 ; :youngsModulus 10.0e9"
FIXED_STEEL = ":restitution 0.6 ; :youngsModulus 200.0e9"


@pytest.mark.parametrize(("length", "height"), [(0.03, 0.1), (0.05, 0.1), (0.08, 0.1), (0.01, 0.03), (0.1, 0.4)])
def test_a_block_topples_once_its_weight_is_beyond_its_edge(compare: Compare, length: float, height: float) -> None:
    angle = math.degrees(math.atan(length / height))
    what, by = "a block on a slope topples (0.3 degrees below and above)", "`tan a = length / height`"
    compare(what, topples(length, height, angle - 0.3), False, by=by)
    compare(what, topples(length, height, angle + 0.3), True, by=by)


@pytest.mark.parametrize(
    ("count", "size"),
    [
        (1, (0.3, 0.05, 0.01)),
        (1, (0.2, 0.1, 0.06)),
        (2, (0.2, 0.1, 0.06)),
        (3, (0.2, 0.1, 0.06)),
        (5, (0.2, 0.1, 0.06)),
        (4, (0.05, 0.03, 0.015)),
    ],
)
def test_bricks_hang_over_by_half_of_the_harmonic_series(
    compare: Compare, count: int, size: tuple[float, float, float]
) -> None:
    what, by = "bricks fall that hang over an edge (99 and 101 % of the most)", "half of the harmonic series"
    compare(what, overhanging(count, size, 0.99), False, by=by)
    compare(what, overhanging(count, size, 1.01), True, by=by)


@pytest.mark.parametrize("number", range(48))
def test_a_tower_falls_if_what_is_above_a_face_is_not_over_it(compare: Compare, number: int) -> None:
    tower = random_tower(np.random.default_rng(number))
    what, by = "a random tower falls (margins of 1 to 12 mm)", "what is above a face is over it, or not"
    compare(what, tower_falls(tower), tower.margin < 0.0, by=by)


@pytest.mark.parametrize("height", [0.1, 0.5, 2.0])
@pytest.mark.parametrize(
    ("material", "below", "expected"),
    [
        (WOOD, FIXED_WOOD, 0.55),
        (WOOD, FIXED_STEEL, 0.55),
        (STEEL, FIXED_WOOD, 0.55),
        (STEEL, FIXED_STEEL, 0.6),
        (GLASS, STONE, 0.76),
        (RUBBER, STONE, 0.83),
        (RUBBER, FIXED_WOOD, 0.83),
    ],
    ids=["wood-wood", "wood-steel", "steel-wood", "steel-steel", "glass-stone", "rubber-stone", "rubber-wood"],
)
def test_a_ball_rebounds_as_its_material_and_that_below_allow(
    compare: Compare, height: float, material: str, below: str, expected: float
) -> None:
    by = "restitution of the pair"
    compare("speed after over before a ball's impact", rebound(height, material, below), expected, by=by, within=0.02)


@pytest.mark.parametrize("speed", [0.5, 1.0, 2.0, 4.0, 8.0])
@pytest.mark.parametrize(
    ("material", "below", "stated", "exponent"),
    [(STEEL, FIXED_STEEL, 0.6, 0.25), (RUBBER, STONE, 0.83, 0.035)],
    ids=["yields", "viscoelastic"],
)
def test_restitution_falls_with_speed_as_the_material_does(
    speed: float, material: str, below: str, stated: float, exponent: float
) -> None:
    falls = f" ; :restitutionSpeed 4.0 ; :restitutionExponent {exponent}"
    found = rebound(speed**2 / (2 * G), material + falls, below + falls)
    assert found == pytest.approx(min(stated * (speed / 4.0) ** -exponent, 1.0), abs=0.02)


@pytest.mark.parametrize(("friction", "speed"), [(0.3, 0.1), (0.3, 0.5), (0.3, 2.0), (0.1, 2.0), (0.3, 4.0)])
def test_what_slides_stops_after_its_energy_over_its_friction_and_does_not_hop(
    compare: Compare, friction: float, speed: float
) -> None:
    found = slide(friction, speed)
    way = speed**2 / (2.0 * friction * G)
    # In the first millisecond the sole finds its contacts.
    within = max(0.005 * way, 1e-3 * speed)
    compare("how far a block slides", found.distance, way, by="`v^2 / (2 mu g)`", within=within, unit="m")
    compare("how high a sliding block hops", 1e3 * found.rise, 0.0, by="not at all", within=0.02, unit="mm")
    if speed > 0.3:
        for force in found.force:
            compare("force of the floor over a sliding block's weight", force, 1.0, by="balance", within=0.05)


@pytest.mark.parametrize("friction", [0.2, 0.4, 0.6])
def test_a_block_slips_once_the_slope_is_steeper_than_its_friction(compare: Compare, friction: float) -> None:
    angle = math.degrees(math.atan(friction))
    still = 1e3 * slipped(friction, angle - 0.3)[-1]
    compare("a block 0.3 degrees below the angle of friction slips", still, 0.0, by="none", within=0.01, unit="mm")
    tilt = math.radians(angle + 0.3)
    acceleration = G * (math.sin(tilt) - friction * math.cos(tilt))
    way = slipped(friction, angle + 0.3)[-1]
    compare("... above it, in 2 s", way, acceleration * 2.0, by="`a t^2 / 2`", share=0.02, unit="m")


@pytest.mark.parametrize(("pitch", "roll"), [(0.0, 0.0), (10.0, 0.0), (45.0, 0.0), (45.0, 35.0)])
@pytest.mark.parametrize("speed", [0.1, 1.0, 3.0, 5.0, 10.0, 20.0])
def test_nothing_goes_through_a_plate(compare: Compare, speed: float, pitch: float, roll: float) -> None:
    what = "a cube of 1 cm at 0.1 to 20 m/s goes through a plate of 5 mm"
    compare(what, passes(speed, pitch, roll), False, by="solids do not")
