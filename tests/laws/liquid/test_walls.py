"""No particle gets through a wall of 3 mm, though particles are 5 mm apart, and none is lost."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from tests.laws.liquid.tank import GRAVITY, Motion, Pose, Tank, cup, filled_cup, turned
from tests.scenes import run

from prolepsis.geometry.shape import FloatArray
from prolepsis.log.log import PARKED

RADIUS, HEIGHT, WALL, DEPTH, SPACING = 0.035, 0.09, 0.003, 0.05, 0.005
"""A lidded cup, a little more than half full of 1540 particles [m]."""


def outside(places: FloatArray) -> int:
    """Return how many places in the frame of the cup are not within its inner surface."""
    radial = np.hypot(places[:, 0], places[:, 1])
    return int(((radial > RADIUS) | (places[:, 2] < WALL) | (places[:, 2] > WALL + HEIGHT)).sum())


def shaken(axis: int) -> Motion:
    """Return 5 Hz with a greatest speed of 1 m/s along an axis."""

    def motion(time: float) -> Pose:
        place = np.zeros(3)
        place[axis] = math.sin(2 * math.pi * 5 * time) / (2 * math.pi * 5)
        return place, np.eye(3)

    return motion


def dropped(time: float) -> Pose:
    """Return a fall of 10 cm that ends dead after 0.2 s of rest."""
    fallen = min(max(time - 0.2, 0.0), math.sqrt(2 * 0.1 / GRAVITY))
    return np.array([0.0, 0.0, -GRAVITY * fallen**2 / 2]), np.eye(3)


def turned_over(time: float) -> Pose:
    """Return half a turn in 0.4 s."""
    return np.zeros(3), turned("x", math.pi * min(time / 0.4, 1.0))


@pytest.mark.parametrize("viscosity", [0.001, 19.0], ids=["water", "honey"])
@pytest.mark.parametrize(
    "motion",
    [shaken(0), shaken(2), dropped, turned_over],
    ids=["shaken sideways", "shaken up and down", "dropped", "turned over"],
)
def test_nothing_leaves_a_lidded_cup(motion: Callable[[float], Pose], viscosity: float) -> None:
    places = filled_cup(RADIUS, DEPTH, SPACING, wall=WALL)
    tank = Tank([(cup(RADIUS, HEIGHT, wall=WALL, lid=WALL), motion)], places, SPACING, viscosity=viscosity)
    tank.settle(0.1)
    for _ in range(5):
        tank.run(0.2)
        position, rotation = motion(tank.time)
        assert outside((tank.position - position) @ rotation) == 0


def test_a_lidded_cup_that_falls_on_the_floor_keeps_all() -> None:
    """The same through MuJoCo, with the floor's impact and the liquid pushing back: count, mass and place of all."""
    log = run(
        ":floor a :Floor . :cup1 a :Cup ; :z 0.1 ; :thickness 0.003 ; :lid true ; :contains :liq1 . "
        ":liq1 a :Water ; :volume 0.0002 .",
        duration=0.5,
    )
    particles, cup1 = log.particles, log.index("cup1")
    assert particles is not None
    profile = np.array(log.things[cup1].shape.profile)
    count = particles.position.shape[1]
    assert particles.mass.shape == (count,)
    assert float(particles.mass.sum()) == pytest.approx(998 * 0.0002, rel=1e-12)
    assert not (particles.holder == PARKED).any()
    for frame, tick in enumerate(particles.tick):
        pose = log.poses[tick, cup1]
        w, x, y, z = pose[3:]
        rotation = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
        local = (particles.position[frame] - pose[:3]) @ rotation
        radial = np.hypot(local[:, 0], local[:, 1])
        assert radial.max() < profile[:, 0].max() - 0.0015
        assert local[:, 2].min() > 0.0015
        assert local[:, 2].max() < profile[:, 1].max() - 0.0015
