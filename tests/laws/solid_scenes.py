"""Experiments with ordinary solids whose outcome is a closed form, and what comes of them in simulation."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from tests.laws.rest_scenes import FLOOR, TABLE, ball, block
from tests.scenes import run

from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.log.log import Log

G = 9.81
EDGE = 0.4
"""The table's edge is so far from its middle [m]."""
Size = tuple[float, float, float]


def on_slope(size: Size, angle: float, friction: float) -> str:
    """Return the situation of a block that rests on a board which goes down by an angle [degree] towards x."""
    tilt, away, up = math.radians(angle), -0.1, 0.01 + size[2] / 2
    x, z = away * math.cos(tilt) + up * math.sin(tilt), 0.6 - away * math.sin(tilt) + up * math.cos(tilt)
    board = ":ramp a :Obstacle ; :z 0.6 ; :length 0.8 ; :width 0.4 ; :height 0.02"
    return (
        f"{FLOOR}{board} ; :pitch {angle!r} ; :friction {friction!r} . "
        f"{block('b', size, f':x {x!r} ; :z {z!r} ; :pitch {angle!r} ; :friction {friction!r}')}"
    )


def topples(length: float, height: float, angle: float) -> bool:
    """Return whether a block that cannot slip topples on a slope of an angle [degree]."""
    log = run(on_slope((length, 0.1, height), angle, 5.0), duration=2.0)
    turned = log.poses[:, log.index("b"), 3:]
    return bool((np.abs(turned @ turned[0]) < math.cos(math.radians(5.0))).any())


def slipped(friction: float, angle: float) -> FloatArray:
    """Return how far a flat block has slipped on a slope of an angle [degree] at each tick [m]."""
    log = run(on_slope((0.1, 0.1, 0.05), angle, friction), duration=2.0)
    place = log.poses[:, log.index("b"), :3]
    return np.linalg.norm(place - place[0], axis=1)


def overhanging(count: int, size: Size, share: float) -> bool:
    """Return whether bricks fall that stand over the edge of a table by a share of the most that is possible [1].

    The most is half of the harmonic series: each hangs over by its length over twice the number of those from it up.
    """
    turtle, below = TABLE, "table1"
    for k in range(count, 0, -1):
        over = share * size[0] / (2 * k)
        x = EDGE - size[0] / 2 + over if k == count else over
        turtle += block(f"b{k}", size, f":on :{below} ; :x {x!r} ; :density 2000.0")
        below = f"b{k}"
    return _falls(run(turtle, duration=2.0), 1 + np.arange(count))


@dataclass(frozen=True, kw_only=True, slots=True)
class Tower:
    """A random tower."""

    turtle: str
    count: int
    margin: float
    """How far within the face below the centre of mass of all that is above is, where that is least [m]."""


def random_tower(random: np.random.Generator) -> Tower:
    """Return a tower of three to six blocks whose margin is 1 to 12 mm, either way."""
    while True:
        count = int(random.integers(3, 7))
        size = random.uniform((0.04, 0.04, 0.015), (0.1, 0.1, 0.05), (count, 3))
        least = np.minimum(size[1:, :2], size[:-1, :2])
        step = random.uniform(-0.45, 0.45, (count - 1, 2)) * least * random.uniform(0.2, 1.2, (count - 1, 1))
        place = np.cumsum(np.vstack([np.zeros(2), step]), axis=0)
        density = random.uniform(400.0, 2500.0, count)
        mass = density * size.prod(axis=1)
        half = size[:, :2] / 2
        low = np.maximum(place[1:] - half[1:], place[:-1] - half[:-1])
        high = np.minimum(place[1:] + half[1:], place[:-1] + half[:-1])
        above = [(mass[k:, None] * place[k:]).sum(axis=0) / mass[k:].sum() for k in range(1, count)]
        margin = float(np.minimum(above - low, high - above).min())
        if (high - low).min() > 0.004 and 0.001 <= abs(margin) <= 0.012:
            break
    turtle, below = TABLE, "table1"
    for k, (x, y) in enumerate(np.vstack([np.zeros(2), step]).tolist()):
        where = f":on :{below} ; :x {x!r} ; :y {y!r} ; :density {float(density[k])!r}"
        turtle += block(f"b{k}", (float(size[k, 0]), float(size[k, 1]), float(size[k, 2])), where)
        below = f"b{k}"
    return Tower(turtle=turtle, count=count, margin=margin)


def tower_falls(tower: Tower) -> bool:
    """Return whether a block of a tower falls."""
    return _falls(run(tower.turtle, duration=1.5), np.arange(tower.count))


def _falls(log: Log, numbers: IntArray) -> bool:
    height = log.poses[:, [log.index(f"b{k}") for k in numbers.tolist()], 2]
    return bool((height[-1] < height[0] - 0.005).any())


def rebound(height: float, material: str, below: str) -> float:
    """Return the speed after over the speed before the first impact of a ball that falls on a fixed plate [1]."""
    plate = f":plate a :Obstacle ; :z 0.1 ; :length 0.5 ; :width 0.5 ; :height 0.2 ; {below} . "
    turtle = FLOOR + plate + ball("b", 0.02, f":z {0.22 + height!r} ; {material}")
    log = run(turtle, duration=2.2 * math.sqrt(2.0 * height / G))
    high = log.poses[:, log.index("b"), 2] - 0.22
    rises = int(np.flatnonzero(np.diff(high) > 0)[0])
    return math.sqrt(max(float(high[rises + 1 :].max()), 0.0) / height)


@dataclass(frozen=True, kw_only=True, slots=True)
class Slide:
    """What comes of a block that slides over the floor until it stops."""

    distance: float
    """[m]"""
    rise: float
    """Its highest place over that at the end [m]."""
    force: tuple[float, float]
    """Least and greatest force of the floor over its weight while it slides, from 20 ms on [1]."""


def slide(friction: float, speed: float) -> Slide:
    """Return what comes of a block that slides at first at a speed [m/s]."""
    turtle = FLOOR + block("b", (0.1, 0.1, 0.05), f":on :floor ; :friction {friction!r}")
    lasts = speed / (friction * G)
    log = run(turtle, duration=lasts + 0.3, thrown={"b": (speed, 0.0, 0.0, 0.0, 0.0, 0.0)})
    place, contacts = log.poses[:, log.index("b")], log.contacts
    force = np.zeros(log.tick_count)
    np.add.at(force, contacts.tick, contacts.peak)
    sliding = force[20 : round((lasts - 0.01) / log.dt)] / (log.things[log.index("b")].mass * G)
    return Slide(
        distance=float(place[-1, 0] - place[0, 0]),
        rise=float(place[:, 2].max() - place[-1, 2]),
        force=(float(sliding.min()), float(sliding.max())),
    )


def passes(speed: float, pitch: float, roll: float) -> bool:
    """Return whether a cube of 1 cm goes through a fixed plate of 5 mm at a speed [m/s]."""
    board = ":board a :Obstacle ; :z 0.5 ; :length 0.3 ; :width 0.3 ; :height 0.005 . "
    turtle = FLOOR + board + block("b", (0.01, 0.01, 0.01), f":z 1.2 ; :pitch {pitch!r} ; :roll {roll!r}")
    log = run(turtle, duration=0.8 / max(speed, 3.0) + 0.2, thrown={"b": (0.0, 0.0, -speed, 0.0, 0.0, 0.0)})
    place = log.poses[:, log.index("b"), :3]
    under = place[:, 2] < 0.495
    return bool(under.any()) and bool((np.abs(place[under.argmax(), :2]) < 0.15).all())
