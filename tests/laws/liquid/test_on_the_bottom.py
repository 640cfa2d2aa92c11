"""What lies on the bottom under water bears on it with its weight less its buoyancy, and what is light gets up."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.comparing import Compare
from tests.laws.liquid.tank import GRAVITY
from tests.laws.rest_scenes import TABLE, ball, block, disc
from tests.scenes import run

from prolepsis.log.log import Log

WATER = 998.0
"""[kg/m^3]"""
SUNK = {
    "a ball of glass": ball("b", 0.015, ":on :c ; :density 2500.0"),
    "a ball of steel": ball("b", 0.008, ":on :c ; :density 7800.0"),
    "a ball that is hardly denser": ball("b", 0.012, ":on :c ; :density 1100.0"),
    "a cube of steel": block("b", (0.02, 0.02, 0.02), ":on :c ; :density 7800.0"),
    "a cube that is hardly denser": block("b", (0.02, 0.02, 0.02), ":on :c ; :density 1100.0"),
    "a flat block": block("b", (0.04, 0.04, 0.01), ":on :c ; :density 2700.0"),
    "a coin": disc("b", 0.012, 0.004, ":on :c"),
}
"""What lies in a cup of water."""


def standing(inside: str, particles: int, fill: float, duration: float = 1.0) -> Log:
    """Return the log of a cup of water with something in it."""
    cup = f":c a :Cup ; :on :table1 ; :contains :l . :l a :Water ; :fill {fill!r} . "
    return run(TABLE + cup + inside, duration=duration, particles=particles)


def borne(log: Log, upper: str, lower: str, since: int = 500) -> float:
    """Return the force with which one thing bears on another [N]: the mean since a tick."""
    a, b = log.index(lower), log.index(upper)
    rows = (log.contacts.a == min(a, b)) & (log.contacts.b == max(a, b)) & (log.contacts.tick >= since)
    return abs(float(log.contacts.force[rows, 2].sum())) / (log.tick_count - since)


@pytest.mark.parametrize("what", list(SUNK))
@pytest.mark.parametrize(
    ("particles", "fill"), [(1000, 0.5), pytest.param(2000, 0.5, marks=pytest.mark.laws), (1000, 0.8)]
)
def test_what_lies_on_the_bottom_bears_its_weight_less_its_buoyancy(
    compare: Compare, what: str, particles: int, fill: float
) -> None:
    """Within 0.12 of what it displaces, at any depth; and the table bears cup, water and thing."""
    log = standing(SUNK[what], particles, fill)
    thing = log.things[log.index("b")]
    (geom,) = thing.shape.geoms
    x, y, z = geom.size
    volume = {"sphere": 4 / 3 * math.pi * x**3, "box": 8 * x * y * z, "cylinder": 2 * math.pi * x * x * y}[geom.type]
    buoyancy = (thing.mass * GRAVITY - borne(log, "b", "c")) / (WATER * volume * GRAVITY)
    compare("buoyancy of what lies on the bottom, over that of its volume", buoyancy, 1.0, by="Archimedes", within=0.12)
    whole = GRAVITY * sum(log.things[log.index(name)].mass for name in ("b", "c", "l"))
    compare("a cup of water with something in it weighs", borne(log, "c", "table1"), whole, by="its weight", share=0.01)


@pytest.mark.parametrize(
    "what",
    [
        ball("b", 0.012, ":on :c ; :density 900.0"),
        block("b", (0.02, 0.02, 0.02), ":on :c ; :density 600.0"),
        block("b", (0.03, 0.03, 0.01), ":on :c ; :density 600.0"),
    ],
)
def test_what_is_light_gets_up_from_the_bottom(what: str) -> None:
    log = standing(what, 1000, 0.5, duration=2.0)
    heights = log.poses[:, log.index("b"), 2]
    assert heights[-1] > heights[0] + 0.02


def test_what_stands_in_a_puddle_that_does_not_reach_it_is_not_lifted() -> None:
    """There is nothing in a gap whose mouth is dry."""
    plate = block("b", (0.04, 0.04, 0.01), ":on :table1 ; :density 1100.0")
    puddle = ":l a :Water ; :on :table1 ; :x 0.2 ; :volume 0.00002 . "
    log = run(TABLE + plate + puddle, duration=1.0, particles=300)
    weight = GRAVITY * log.things[log.index("b")].mass
    assert borne(log, "b", "table1") == pytest.approx(weight, rel=0.01)
    assert np.ptp(log.poses[:, log.index("b"), 2]) < 1e-4
