"""A liquid at rest: its weight, its torque, its height, and nothing lost."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.comparing import Compare
from tests.laws.liquid.tank import DOWN, NONE, Tank, cup, filled_cup, lattice, still, turned
from tests.scenes import run

from prolepsis.geometry.shape import FloatArray
from prolepsis.matter.liquids.solver import COURANT

RADIUS, DEPTH, WALL = 0.035, 0.06, 0.005
"""The cup of these tests [m]."""
SPACING = 0.005
"""About that of 2000 particles in a full cup, the default [m]."""
CUP_ON_TABLE = (
    ":floor a :Floor . :table1 a :Table . :cup1 a :Cup ; :on :table1 ; :x 0.1 ; :y -0.05 ; :contains :liq1 . "
    ":liq1 a :Water ; :volume 0.0002 ."
)


def test_the_table_bears_the_weight_of_a_cup_and_its_water_where_they_stand(compare: Compare) -> None:
    """The force within 1 % of the weight, its moment about the world's origin within 3 % of that of the weight.

    1600 particles of 5 mm. The forces are averaged over 0.6 s, since particles tremble in a resting cup.
    """
    log = run(CUP_ON_TABLE, duration=1.0)
    cup1, liq1 = log.things[log.index("cup1")], log.things[log.index("liq1")]
    rows = (log.contacts.a == log.index("cup1")) | (log.contacts.b == log.index("cup1"))
    rows &= log.contacts.tick >= 400
    force = (
        np.where(log.contacts.a[rows] == log.index("cup1"), -1.0, 1.0)[:, None]
        * log.contacts.force[rows]
        / (log.tick_count - 400)
    )
    total = force.sum(axis=0)
    moment = np.cross(log.contacts.point[rows], force).sum(axis=0)
    weight = 9.81 * (cup1.mass + liq1.mass)
    assert liq1.mass == pytest.approx(998 * 0.0002)
    compare("a cup of water weighs on a table", total[2], weight, by="its weight", share=0.01, unit="N")
    assert moment[0] == pytest.approx(-0.05 * weight, rel=0.03)
    assert moment[1] == pytest.approx(-0.1 * weight, rel=0.03)


@pytest.mark.parametrize("angle", [20.0, 35.0])
def test_a_tilted_cup_feels_the_torque_of_the_water_off_its_centre(compare: Compare, angle: float) -> None:
    """1350 particles of 5 mm: force within 1 % of the weight, torque within 3 % of weight times lever."""
    pose = (np.zeros(3), turned("y", math.radians(angle)))
    tank = Tank([(cup(RADIUS, 0.09), lambda _: pose)], filled_cup(RADIUS, 0.045, SPACING, pose=pose), SPACING)
    tank.settle()
    levers: list[FloatArray] = []
    push = tank.run(1.0, lambda _, __: levers.append(tank.position.mean(axis=0)))[0]
    lever = np.mean(levers, axis=0)
    assert lever[0] > 0.005
    compare("water weighs on a tilted cup", -push[2], tank.weight, by="its weight", share=0.01, unit="N")
    assert push[:2] == pytest.approx([0.0, 0.0], abs=0.005 * tank.weight)
    torque = tank.weight * lever[0]
    compare("torque of the water on a tilted cup", push[4], torque, by="weight times lever", share=0.03, unit="N m")
    assert push[3] == pytest.approx(-tank.weight * lever[1], abs=0.03 * tank.weight * lever[0])


@pytest.mark.laws
def test_water_keeps_its_height_for_ten_seconds(compare: Compare) -> None:
    """1847 particles of 5 mm, 60 mm deep: twice the mean height, and the top of the surface, within 3 %, to the end.

    The top is the mean of the uppermost layer, half a spacing higher.
    """
    tank = Tank([(cup(RADIUS, 0.09), still)], filled_cup(RADIUS, DEPTH, SPACING), SPACING)
    layer = round(math.pi * (RADIUS / SPACING) ** 2)
    means: list[float] = []
    tops: list[float] = []

    def look(_: float, __: FloatArray) -> None:
        heights = np.sort(tank.position[:, 2]) - WALL
        means.append(2 * float(heights.mean()))
        tops.append(float(heights[-layer:].mean()) + SPACING / 2)

    for _ in range(10):
        tank.run(0.9)
        means.clear()
        tops.clear()
        tank.run(0.1, look)
        for height in (np.mean(means), np.mean(tops)):
            compare("height of water over 10 s", float(height), DEPTH, by="its volume", share=0.03, unit="m")


@pytest.mark.parametrize(("depth", "spacing"), [(0.08, 0.004), pytest.param(0.12, 0.005, marks=pytest.mark.laws)])
def test_deep_water_does_not_collapse(compare: Compare, depth: float, spacing: float) -> None:
    """20 and 24 spacings deep, in a cup of 25 mm radius: twice the mean height within 3 %, after a third of a second.

    With steps that a wave of pressure outruns it sank by 12 % (and 7 % so far) and went on to.
    """
    tank = Tank([(cup(0.025, 1.5 * depth), still)], filled_cup(0.025, depth, spacing), spacing)
    tank.settle()
    tank.run(0.4)
    height = 2 * float((tank.position[:, 2] - WALL).mean())
    compare("height of deep water", height, depth, by="its volume", share=0.03, unit="m")


def test_water_is_evenly_in_a_cup_when_a_run_begins() -> None:
    """Neighbours are three quarters of a spacing apart at least: none are pressed into each other."""
    log = run(CUP_ON_TABLE, duration=0.01, particles=1000)
    places: FloatArray = log.particles.position[0].astype(np.float64)
    apart = np.linalg.norm(places[:, None] - places, axis=2) + np.diag(np.full(len(places), np.inf))
    assert apart.min() > 0.75 * log.particles.spacing


def test_a_free_blob_keeps_its_momentum() -> None:
    """1000 particles of water without walls or weight, thrown about at 0.1 m/s.

    Momentum to single precision. Angular momentum to 1e-3: calming exchanges velocities across the line between two.
    """
    generator = np.random.default_rng(1)
    places = lattice((-0.02, -0.02, -0.02), (0.02, 0.02, 0.02), 0.004)
    tank = Tank([], places + generator.normal(0.0, 2e-4, places.shape), 0.004, gravity=NONE)
    tank.velocity[:] = generator.normal(0.0, 0.1, places.shape)
    mass = tank.particles.mass[:, None]

    def momenta() -> FloatArray:
        return np.concatenate(
            [(mass * tank.velocity).sum(axis=0), (mass * np.cross(tank.position, tank.velocity)).sum(axis=0)]
        )

    before = momenta()
    whole = float((mass * np.abs(tank.velocity)).sum())
    tank.run(0.3)
    assert momenta()[:3] == pytest.approx(before[:3], abs=1e-6 * whole)
    assert momenta()[3:] == pytest.approx(before[3:], abs=1e-3 * whole * 0.02)


def test_the_step_follows_the_fastest_particle() -> None:
    tank = Tank([(cup(RADIUS, 0.09), still)], filled_cup(RADIUS, DEPTH, SPACING), SPACING, gravity=DOWN)
    longest = tank.liquid.next_step()
    tank.velocity[7] = (0.0, 0.0, 3.0)
    assert tank.liquid.next_step() * 3.0 <= COURANT * SPACING
    assert tank.liquid.next_step() < 0.6 * longest
