"""Through a hole flows what orifices let through if the liquid is thin, and if it is thick what Sampson says."""

from __future__ import annotations

import math
from typing import Any

import pytest
from tests.comparing import Compare
from tests.laws.liquid.tank import GRAVITY, Tank, cup, filled_cup, still
from tests.laws.rest_scenes import TABLE
from tests.scenes import run

from prolepsis.terms.errors import Note

RADIUS, DEPTH, WALL = 0.03, 0.05, 0.003
"""Of the cup, what it is filled to at first, and its bottom [m]."""
ORIFICE = (0.55, 0.70)
"""Discharge coefficients that are measured at holes with sharp edges [1].

Source: 0.61 at high Reynolds numbers, up to 0.7 at some hundreds (Lichtarowicz, Duggins and Markland, Journal of
Mechanical Engineering Science 7:210, 1965; Johansen, Proceedings of the Royal Society A 126:231, 1930)."""


def emptied(
    hole: float, spacing: float, *, wall: float, shares: tuple[float, float], beyond: float, **liquid: Any
) -> float:
    """Return in which time the depth in a cup falls from one share to another [s].

    Args:
        hole: Radius of the hole in its bottom [m].
        spacing: [m].
        wall: Thickness of the bottom [m].
        shares: Of the depth at first [1].
        beyond: How far under the bottom what has left is taken away [m].
        liquid: As ``Tank`` has it.
    """
    places = filled_cup(RADIUS, DEPTH, spacing, wall=wall)
    shut = Tank([(cup(RADIUS, 0.09, wall=wall), still)], places, spacing, **liquid)
    shut.settle()
    tank = Tank([(cup(RADIUS, 0.09, wall=wall, hole=hole), still)], shut.position, spacing, **liquid)
    times: list[float] = []
    for share in shares:
        while (tank.position[:, 2] > wall).mean() > share:
            tank.run(0.005)
            tank.park((tank.position[:, 2] < -beyond) & tank.particles.free)
            assert tank.time < 5.0
        times.append(tank.time)
    return times[1] - times[0]


@pytest.mark.parametrize(
    ("hole", "spacing"),
    [
        (0.006, 0.006),
        (0.006, 0.004),
        pytest.param(0.006, 0.003, marks=pytest.mark.laws),
        pytest.param(0.006, 0.0024, marks=pytest.mark.laws),
        (0.007, 0.0035),
        pytest.param(0.01, 0.005, marks=pytest.mark.laws),
        pytest.param(0.01, 0.01 / 3, marks=pytest.mark.laws),
    ],
)
def test_water_leaves_a_cup_as_fast_as_an_orifice_lets_it(compare: Compare, hole: float, spacing: float) -> None:
    """A discharge coefficient of 0.55 to 0.70 within 0.05, from two to six particles across the hole.

    From nine tenths to two fifths of 50 mm, by ``(R / r)^2 sqrt(2 / g) (sqrt h0 - sqrt h1) / t``.
    """
    shares = (0.9, 0.4)
    time = emptied(hole, spacing, wall=WALL, shares=shares, beyond=0.02)
    heads = math.sqrt(shares[0] * DEPTH) - math.sqrt(shares[1] * DEPTH)
    found = (RADIUS / hole) ** 2 * math.sqrt(2 / GRAVITY) * heads / time
    by = "orifices with sharp edges (Johansen; Lichtarowicz)"
    compare("discharge coefficient of a hole", found, ORIFICE, by=by, within=0.05)


@pytest.mark.parametrize(
    ("spacing", "wall"),
    [(0.02 / 3, 0.003), (0.005, 0.003), pytest.param(0.02 / 6, 0.003, marks=pytest.mark.laws), (0.005, 0.01)],
)
def test_syrup_leaves_a_cup_as_sampson_and_poiseuille_say(compare: Compare, spacing: float, wall: float) -> None:
    """Within 15 % at 10 Pa s through a hole of 20 mm, from three to six particles across it.

    The pressure that drives a flow Q is ``Q (1.5 mu / r^3 + 8 mu L / (pi r^4))``: half of Sampson's loss, as nothing is
    on the other side, and Poiseuille's in the bottom. What has left is taken away, so that no thread pulls.
    """
    viscosity, density, hole, shares = 10.0, 1420.0, 0.01, (0.95, 0.8)
    time = emptied(
        hole, spacing, wall=wall, shares=shares, beyond=0.6 * spacing, viscosity=viscosity, density=density, tension=0.0
    )
    loss = 1.5 * viscosity / hole**3 + 8 * viscosity * wall / (math.pi * hole**4)
    heads = math.log((shares[0] * DEPTH + wall) / (shares[1] * DEPTH + wall))
    expected = heads * math.pi * RADIUS**2 * loss / (density * GRAVITY)
    by = "Sampson 1891 and Poiseuille"
    compare("syrup leaves a cup by a hole", time, expected, by=by, share=0.15, unit="s")


def test_a_hole_that_is_too_narrow_for_the_particles_is_noted() -> None:
    leaking = TABLE + ":c a :Cup ; :on :table1 ; :bottomHoleRadius {} ; :contains :l . :l a :Water ; :volume 0.0002 ."
    with pytest.warns(Note, match=r"c: its hole of 6 mm is \S+ particles wide, .*; use particles = 312\d$"):
        run(leaking.format(0.003), particles=200)
    with pytest.warns(Note, match="no number of particles is enough"):
        run(leaking.format(0.0005), particles=200)
    run(leaking.format(0.008), particles=200)
