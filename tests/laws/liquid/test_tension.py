"""Surface tension: a puddle stops spreading."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.comparing import Compare
from tests.laws.liquid.tank import GRAVITY, GROUND, Tank, lattice, still

TENSION, DENSITY = 0.0728, 998.0
"""Of water [N/m], [kg/m^3]."""
SHORT = 5e-4
"""Longest step for ripples of a millimetre [s]: they need less than ``sqrt(rho d^3 / (2 pi gamma))``, 1.5 ms."""


TOO_THICK = "the thickness depends too little on the contact angle: see docs/liquids.md"


@pytest.mark.laws
@pytest.mark.parametrize(
    "angle",
    [pytest.param(50.0, marks=pytest.mark.xfail(strict=True, raises=AssertionError, reason=TOO_THICK)), 90.0],
)
def test_a_puddle_is_as_thick_as_its_surface_tension_makes_it(compare: Compare, angle: float) -> None:
    """5 ml of water come to within 25 % of ``2 sqrt(gamma / (rho g)) sin(theta / 2)``: 2.3, and 3.9 mm at 90 degrees.

    5000 particles of 1 mm, two to four layers; a spacing is a quarter to a half of the thickness, which is what the
    tolerance stands for. The puddle is spread from 4 mm down with 50 times the viscosity of water, so that it does
    not overshoot, and in steps short enough for its ripples. Thickness is volume over area, and the area that of a
    disc with the same mean square radius.
    """
    volume, spacing, radius = 5e-6, 0.001, 0.02
    count = round(volume / spacing**3)
    places = lattice((-radius, -radius, 0.0), (radius, radius, 0.006), spacing)
    places = places[np.hypot(places[:, 0], places[:, 1]) < radius]
    places = places[np.argsort(places[:, 2], kind="stable")[:count]]
    tank = Tank([(GROUND, still)], places, spacing, viscosity=0.05, contact_angle=math.radians(angle))
    tank.run(0.8, longest=SHORT)
    area = 2 * math.pi * float((tank.position[:, :2] ** 2).sum(axis=1).mean())
    expected = 2 * math.sqrt(TENSION / (DENSITY * GRAVITY)) * math.sin(math.radians(angle) / 2)
    by = "`2 sqrt(gamma / (rho g)) sin(theta / 2)`"
    compare("thickness of a puddle of water", 1e3 * volume / area, 1e3 * expected, by=by, share=0.25, unit="mm")
    # The film's top over the whole area makes up its volume again: nothing is pressed together, nothing hollow.
    cells = np.floor(tank.position[:, :2] / (2 * spacing)).astype(int)
    _, index = np.unique(cells, axis=0, return_inverse=True)
    tops = np.zeros(int(index.max()) + 1)
    np.maximum.at(tops, index, tank.position[:, 2] + spacing / 2)
    assert float(tops.sum()) * (2 * spacing) ** 2 == pytest.approx(volume, rel=0.25)
