"""Surface tension: a drop that swings, and a puddle that stops spreading."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.laws.liquid.fitting import damped_wave
from tests.laws.liquid.tank import GRAVITY, GROUND, NONE, Tank, lattice, still

from prolepsis.things import FloatArray

TENSION, DENSITY = 0.0728, 998.0
"""Of water [N/m], [kg/m^3]."""
SHORT = 3e-4
"""Longest step for ripples of a millimetre [s]: ``sqrt(rho d^3 / (2 pi gamma))`` is 1.5 ms at 1 mm, 1 ms at 0.8 mm."""


def test_a_drop_swings_at_rayleighs_frequency() -> None:
    """Within 15 % of ``w^2 = 8 gamma / (rho R^3)``: 1800 particles of 0.8 mm in a drop of 12 mm.

    It was stretched by 15 %, and is damped within two swings, so the frequency is fitted together with the damping.
    """
    spacing = 0.0008
    places = lattice((-0.006, -0.006, -0.006), (0.006, 0.006, 0.006), spacing)
    places = places[np.linalg.norm(places, axis=1) < 0.006]
    radius = (len(places) * spacing**3 * 0.75 / math.pi) ** (1 / 3)
    tank = Tank([], places, spacing, viscosity=0.05, gravity=NONE)
    tank.run(0.1, longest=SHORT)
    tank.particles.viscosity[:] = 0.001
    tank.velocity[:] = 0.0
    tank.position[:] *= np.array([1.15**-0.5, 1.15**-0.5, 1.15])
    times: list[float] = []
    lengths: list[float] = []

    def look(_: float, __: FloatArray) -> None:
        square = ((tank.position - tank.position.mean(axis=0)) ** 2).mean(axis=0)
        times.append(tank.time)
        lengths.append(float(2 * square[2] / (square[0] + square[1])) - 1)

    tank.run(0.25, look, longest=SHORT)
    expected = math.sqrt(8 * TENSION / (DENSITY * radius**3))
    frequency, _ = damped_wave(times, lengths, expected)
    assert frequency == pytest.approx(expected, rel=0.15)


@pytest.mark.laws
@pytest.mark.parametrize("angle", [50.0, 90.0])
def test_a_puddle_is_as_thick_as_its_surface_tension_makes_it(angle: float) -> None:
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
    tank.run(0.8, longest=5e-4)
    area = 2 * math.pi * float((tank.position[:, :2] ** 2).sum(axis=1).mean())
    expected = 2 * math.sqrt(TENSION / (DENSITY * GRAVITY)) * math.sin(math.radians(angle) / 2)
    assert volume / area == pytest.approx(expected, rel=0.25)
    # The film's top over the whole area makes up its volume again: nothing is pressed together, nothing hollow.
    cells = np.floor(tank.position[:, :2] / (2 * spacing)).astype(int)
    _, index = np.unique(cells, axis=0, return_inverse=True)
    tops = np.zeros(int(index.max()) + 1)
    np.maximum.at(tops, index, tank.position[:, 2] + spacing / 2)
    assert float(tops.sum()) * (2 * spacing) ** 2 == pytest.approx(volume, rel=0.25)
