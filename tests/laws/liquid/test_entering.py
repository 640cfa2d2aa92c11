"""What falls into a liquid stops where added mass and drag say, gets nothing back, and floats as Archimedes says."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.comparing import Compare
from tests.laws.liquid.tank import GRAVITY
from tests.laws.rest_scenes import TABLE, ball, block
from tests.scenes import run

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.log import Log

INSIDE = 0.035
"""Inner radius of a cup [m]."""
RADIUS, DENSITY = 0.015, 600.0
"""Of a wooden ball [m], [kg/m^3]."""
HONEY = 1420.0, 19.0
"""Density [kg/m^3] and viscosity [Pa s]."""


def cup(liquid: str, inside: str, fill: float = 0.5) -> str:
    """Return a cup with a liquid on a table, and something more."""
    return TABLE + f":c a :Cup ; :on :table1 ; :contains :l . :l a :{liquid} ; :fill {fill!r} . " + inside


def height_of(log: Log) -> FloatArray:
    """Return the height of what falls over the undisturbed surface [m], shape (T,)."""
    particles = log.particles
    bottom = float(particles.position[0, :, 2].min()) - particles.spacing / 2
    level = bottom + float(particles.volume.sum()) / (math.pi * INSIDE**2)
    return log.poses[:, log.index("b"), 2] - level


def stopping_depth(speed: float, density: float, viscosity: float, *, walled: bool) -> float:
    """Return how deep a wooden ball's lowest point is when it has a twentieth of the speed with which it enters [m].

    Added mass is half of the liquid that it displaces, drag as in Stokes' law with Schiller and Naumann's factor and,
    if ``walled``, Francis' for the wall of a cup, both in the share that is immersed.
    """
    volume = 4 / 3 * math.pi * RADIUS**3
    mass, ratio, dt = DENSITY * volume, RADIUS / INSIDE, 1e-5
    wall = ((1 - 0.475 * ratio) / (1 - ratio)) ** 4 if walled else 1.0

    def share(depth: float) -> float:
        h = min(max(depth, 0.0), 2 * RADIUS)
        return math.pi * h * h * (RADIUS - h / 3) / volume

    depth, v = 0.0, speed
    while v > speed / 20:
        here, next = share(depth), share(depth + v * dt)
        reynolds = density * v * 2 * RADIUS / viscosity
        drag = 6 * math.pi * viscosity * RADIUS * wall * v * (1 + 0.15 * reynolds**0.687)
        added, growth = 0.5 * density * volume * here, 0.5 * density * volume * (next - here) / dt
        force = mass * GRAVITY - density * volume * here * GRAVITY - drag * here - growth * v
        v += force / (mass + added) * dt
        depth += v * dt
    return depth


@pytest.mark.parametrize("particles", [200, pytest.param(800, marks=pytest.mark.laws)])
def test_a_wooden_ball_stops_in_honey_and_stays(compare: Compare, particles: int) -> None:
    """It falls 39 cm, goes in as deep as the closed forms say, and comes up with a fiftieth of its speed at most.

    The wall brakes what has gone in deep, and less what is still near the surface: the depth lies between those with
    and without it.
    """
    log = run(cup("Honey", ball("b", RADIUS, f":z 1.15 ; :density {DENSITY!r}")), duration=0.8, particles=particles)
    height = height_of(log)
    speed = np.diff(height) / log.dt
    enters = int(np.flatnonzero(height < RADIUS)[0])
    entered = -float(speed[enters - 1])
    stopped = enters + int(np.flatnonzero(speed[enters:] > -entered / 20)[0])
    walled, free = (stopping_depth(entered, *HONEY, walled=each) for each in (True, False))
    depth, by = 1e3 * (RADIUS - height[stopped]), "added mass and drag, with and without the wall"
    compare("how deep a wooden ball goes into honey", depth, (1e3 * walled, 1e3 * free), by=by, unit="mm")
    lowest = enters + int(height[enters : enters + 100].argmin())
    back = float(speed[lowest:].max()) / entered
    compare("speed with which it comes back, over that before", back, (0.0, 0.02), by="a thick liquid gives nothing")
    timeline = recognize(log)
    (contained,) = (fact for fact in timeline.select(type="contains") if fact.args[1] == "b")
    assert 0.0 <= contained.start - enters * log.dt < 0.025
    (floating,) = timeline.select(type="floats")
    assert floating.end == log.duration and floating.start < contained.start + 0.1


@pytest.mark.laws
@pytest.mark.parametrize("falling", [0.0, 1e-6])
@pytest.mark.parametrize("particles", [400, 800, 1600])
def test_a_block_of_a_gram_is_not_thrown_out_of_water(compare: Compare, particles: int, falling: float) -> None:
    """It comes out with a quarter of its speed at most, which is as fast as it rises, and floats in the end."""
    rest = f":z {0.95 + falling!r} ; :mass 0.001"
    log = run(cup("Water", block("b", (0.02, 0.02, 0.02), rest), 0.4), duration=1.5, particles=particles)
    height = height_of(log)
    speed = np.diff(height) / log.dt
    lowest = int(speed.argmin())
    back, by = float(speed[lowest:].max() / -speed[lowest]), "it rises by its buoyancy alone"
    compare("speed of a block of 1 g out of water, over that before", back, (0.0, 0.25), by=by)
    assert any(fact.end == log.duration for fact in recognize(log).select(type="floats"))


@pytest.mark.laws
@pytest.mark.parametrize(
    ("what", "density"),
    [
        (ball("b", 0.015, ":z 0.8 ; :density 300.0"), 300.0),
        (ball("b", 0.015, ":z 0.8 ; :density 600.0"), 600.0),
        (ball("b", 0.015, ":z 0.8 ; :density 900.0"), 900.0),
        (block("b", (0.02, 0.02, 0.02), ":z 0.8 ; :density 600.0"), 600.0),
        (block("b", (0.04, 0.04, 0.01), ":z 0.8 ; :density 600.0"), 600.0),
    ],
)
def test_what_floats_is_as_deep_in_water_as_archimedes_says(compare: Compare, what: str, density: float) -> None:
    """Within 0.12 of its volume, a fifth of a spacing for the flattest."""
    log = run(cup("Water", what), duration=1.5, particles=1000)
    (fact,) = recognize(log).select(type="immersed")
    found, expected = float(fact.evidence["fraction_at_end"]), density / 998.0
    compare("share of what floats that is in water", found, expected, by="Archimedes", within=0.12)
