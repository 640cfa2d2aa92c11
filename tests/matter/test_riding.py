"""A soft thing with pores that slides over a thick liquid rides up on it, and takes it up through its whole face."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import integrate  # pyright: ignore[reportMissingTypeStubs]
from tests.scenes import run, scene

from prolepsis.matter.sponges.riding_law import INLET, RidingLaw, mixed

U, HONEY, WATER = 0.1, 10.0, 1.0e-3
"""Speed of a stroke [m/s]; viscosities [Pa s]."""


@pytest.fixture(scope="module")
def law() -> RidingLaw:
    known = scene(":floor a :Floor . :sponge1 a :Sponge ; :on :floor .").thing("sponge1").quantities
    found = RidingLaw.of(known, smallest=0.03, thickness=0.03, face=66e-4)
    assert found is not None
    return found


def test_the_pressure_at_a_rounded_inlet_is_reynolds() -> None:
    radius, film = 3e-3, 1.5e-3
    quad: float = integrate.quad(lambda x: x**2 / 2 / radius / (film + x**2 / 2 / radius) ** 3, 0, np.inf)[0]  # pyright: ignore
    assert 6 * HONEY * U * quad == pytest.approx(INLET * HONEY * U * math.sqrt(radius) / film**1.5, rel=1e-6)


def test_it_rides_as_high_as_foam_or_load_allow(law: RidingLaw) -> None:
    drive = INLET * HONEY * U * math.sqrt(law.edge_radius)
    assert law.height(HONEY, U, 0.0) == pytest.approx((drive / law.stiffness) ** 0.4, rel=1e-4)
    hard = replace(law, stiffness=1e-3)
    assert hard.height(HONEY, U, 2.0) == pytest.approx((drive * law.face / 2.0) ** (2 / 3), rel=1e-4)
    assert law.height(HONEY, U, 2.0) < law.height(HONEY, U, 1.0) < law.height(HONEY, U, 0.0)


def test_it_rides_on_honey_and_batter_but_not_on_what_is_within_its_pores(law: RidingLaw) -> None:
    heights = [law.height(viscosity, U, 2.0) for viscosity in (HONEY, 2.0, 0.08, WATER)]
    assert heights[0] > heights[1] > law.pore_size
    assert heights[2:] == [0.0, 0.0]


def test_a_front_deepens_as_washburns_whatever_the_steps(law: RidingLaw) -> None:
    depth = 0.0
    for _ in range(200):
        depth = law.depth_after(depth, WATER, 0.0, 0.03)
    # As the mean speed is told of: 3 cm of it fill with water in 6 s.
    assert depth == pytest.approx(0.03)
    assert law.depth_after(0.0, HONEY, 0.0, 6.0) == pytest.approx(0.03 * math.sqrt(WATER / HONEY))
    assert law.depth_after(0.0, HONEY, 1e3, 1.0) > law.depth_after(0.0, HONEY, 0.0, 1.0)


def amounts(water: float) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return molecules of water and of simple sugars in what has a share of water in its mass."""
    return np.array([water / 18.0, (1 - water) / 180.0])


def test_water_thins_honey_as_it_does_in_the_world() -> None:
    """Honey at 25 degrees: 40 Pa s with 14 % of water, 2 Pa s with 20 %; a syrup of 60 % sugar: 0.06 Pa s."""
    sugar = math.exp((math.log(40.0) - amounts(0.14)[0] / amounts(0.14).sum() * math.log(WATER))
                     * amounts(0.14).sum() / amounts(0.14)[1])  # fmt: skip
    thinner, syrup = (mixed(amounts(water), np.array([WATER, sugar])) for water in (0.20, 0.40))
    assert 2.0 / 2 < thinner < 2.0 * 2
    assert 0.06 / 4 < syrup < 0.06 * 4


WIPED = """:floor a :Floor . :table1 a :Table . :liquid1 a :{} ; :on :table1 ; :volume "3 ml" .
:sponge1 a :Sponge ; :on :table1 ; :y -0.08 ; :width 0.06 ; :saturation {} ; :absorbs :water1 . :water1 a :Water .
:hand1 a :Gripper ; :pitch 90 ; :y -0.08 ; :z 0.765 ; :opening 0.085 ."""
STROKE = "sequence([grasp(hand1, sponge1, 4, 0.012), wipe(hand1, sponge1, table1, [0, 0.14, 0], 1, 2, 0.1)])"


def test_a_wet_sponge_takes_up_honey_that_it_slides_over_and_loses_no_particle() -> None:
    log = run(WIPED.format("Honey", 0.3), STROKE, particles=320)
    p, honey, sponge = log.particles, log.index("liquid1"), log.index("sponge1")
    held = p.holder[:, p.stuff == honey] == sponge
    assert held[0].sum() == 0
    assert held[-1].mean() > 0.3
    assert not (np.diff(held.astype(int), axis=0) < 0).any()
    assert np.isfinite(p.position).all()
    assert p.position[:, :, 2].min() > 0.7
