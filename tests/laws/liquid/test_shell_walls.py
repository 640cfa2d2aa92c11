"""What is left of an eggshell is a wall: 0.35 mm thick, it holds what is below its rim, with particles of 4 mm."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.comparing import Compare
from tests.laws.liquid.tank import GRAVITY, Motion, Pose, Tank, lattice, still, turned

from prolepsis.geometry.faces import Solids
from prolepsis.geometry.shape import BoolArray, FloatArray, triple
from prolepsis.geometry.signed_distance import pieces_of
from prolepsis.geometry.thin_shells import ThinShell

THICKNESS = 3.5e-4
"""[m]"""
INNER = np.array([0.0285, 0.022, 0.022]) - THICKNESS
"""Semi-axes of the room within an eggshell [m]."""
CAPACITY = 2 / 3 * math.pi * float(np.prod(INNER))
"""Volume of half an ellipsoid [m^3]."""


def white(walls: Solids, motion: Motion, places: FloatArray, spacing: float) -> Tank:
    """Return egg white at places within walls."""
    return Tank([(walls, motion)], places, spacing, density=1035.0, viscosity=0.1, tension=0.048)


def shell(*, closed: bool = False) -> Solids:
    """Return the lower half of an eggshell that lies, or all of it."""
    halves = ((0.0, 0.0, -0.01), (0.0, 0.0, 0.01))
    made = ThinShell(semi_axes=triple(INNER + THICKNESS / 2), thickness=THICKNESS, centres=halves)
    return pieces_of(made, np.array([True, closed]), np.zeros(3))


def filling(share: float, spacing: float, *, closed: bool = False) -> FloatArray:
    """Return places in a shell, of a share of what half of it holds."""
    count = round(share * CAPACITY / spacing**3)
    step = spacing
    while True:
        points = lattice(triple(-INNER), triple(INNER * (1, 1, 1 if closed or share > 1 else 0)), step)
        points = points[np.linalg.norm(points / (INNER - 0.4 * spacing), axis=1) < 1]
        if len(points) >= count:
            return points[np.argsort(points[:, 2], kind="stable")[:count]]
        step *= 0.98


def surface(volume: float) -> float:
    """Return where the surface of a volume [m^3] in half a shell is, over the shell's middle [m].

    Filled to a height h over the bottom, c deep, it holds pi a b (h^2 - h^3 / 3c) / c.
    """
    a, b, c = (float(each) for each in INNER)
    low, high = 0.0, c
    for _ in range(50):
        h = (low + high) / 2
        low, high = (h, high) if math.pi * a * b / c * (h**2 - h**3 / (3 * c)) < volume else (low, h)
    return low - c


def within(places: FloatArray) -> BoolArray:
    """Return which places, in the frame of the shell, are inside the whole ellipsoid."""
    return np.linalg.norm(places / INNER, axis=1) < 1


@pytest.mark.parametrize("spacing", [0.004, 0.003])
def test_half_a_shell_keeps_all_that_is_below_its_rim(compare: Compare, spacing: float) -> None:
    """Of seven tenths of what it holds nothing leaves, and the surface is where it should be."""
    tank = white(shell(), still, filling(0.7, spacing), spacing)
    tank.run(2.0)
    assert within(tank.position).all()
    level = surface(len(tank.position) * spacing**3)
    inner = np.hypot(tank.position[:, 0], tank.position[:, 1]) < 0.01
    top = float(np.sort(tank.position[inner, 2])[-10:].mean()) + spacing / 2
    by = "volume of a half ellipsoid"
    compare("surface in half a shell", 1e3 * top, 1e3 * level, by=by, within=500 * spacing, unit="mm")


@pytest.mark.parametrize("spacing", [0.004, 0.003])
def test_half_a_shell_holds_what_is_below_its_rim(compare: Compare, spacing: float) -> None:
    """Filled with a third more it keeps its capacity, and what bulges over the rim: less than a layer of particles."""
    tank = white(shell(), still, filling(1.33, spacing), spacing)
    held = 0.0
    for _ in range(15):
        tank.run(0.2)
        fallen = tank.position[:, 2] < -0.06
        tank.park(fallen)
        held = float(within(tank.position).sum()) * spacing**3
    rim = math.pi * INNER[0] * INNER[1]
    most = 1e6 * (CAPACITY + rim * spacing)
    by = "half an ellipsoid (95 %), and a layer of particles over its rim"
    compare("what half a shell holds", 1e6 * held, (0.95e6 * CAPACITY, most), by=by, unit="ml")


def shaken(time: float) -> Pose:
    """Return 5 Hz with a greatest speed of 1 m/s, aslant."""
    return np.array([0.6, 0.0, 0.8]) * math.sin(2 * math.pi * 5 * time) / (2 * math.pi * 5), np.eye(3)


def dropped(time: float) -> Pose:
    """Return a fall of 30 cm that ends dead."""
    fallen = min(time, math.sqrt(2 * 0.3 / GRAVITY))
    return np.array([0.0, 0.0, -GRAVITY * fallen**2 / 2]), np.eye(3)


def rolled(time: float) -> Pose:
    """Return two turns in a second."""
    return np.zeros(3), turned("y", 4 * math.pi * time)


@pytest.mark.parametrize("motion", [shaken, dropped, rolled])
@pytest.mark.parametrize("spacing", [0.005, 0.003])
def test_nothing_gets_through_a_closed_shell(motion: Motion, spacing: float) -> None:
    tank = white(shell(closed=True), motion, filling(1.7, spacing, closed=True), spacing)
    for _ in range(4):
        tank.run(0.2)
        position, rotation = motion(tank.time)
        assert within((tank.position - position) @ rotation).all()
