"""A body in a liquid: a ball sinks in honey as fast as Stokes says, and one that is lighter floats."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.comparing import Compare
from tests.laws.liquid.tank import GRAVITY, cup, filled_cup
from tests.scenes import scene

from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.geometry.shape import Geom, Shape
from prolepsis.log.log import Log
from prolepsis.log.things import FIXED, WITHIN, Thing
from prolepsis.programs import read_program
from prolepsis.scene.scene import Pool
from prolepsis.terms.errors import InvalidSimulationError
from prolepsis.terms.reader import parse_term

JAR, DEPTH = 0.032, 0.08
"""Inner radius of a jar that stands fast, and depth of the honey [m]."""
BALL = 0.008
"""Radius of the ball [m]."""
DENSITY = 1420.0
"""Of honey [kg/m^3]."""
STOKES = "Stokes, with Faxen's correction for the wall"


def sinking(density: float, viscosity: float, height: float, spacing: float, duration: float) -> Log:
    """Return the log of a ball that is let go within honey.

    Args:
        density: Of the ball [kg/m^3].
        viscosity: Of the honey [Pa s].
        height: Of the ball's centre at the start [m].
        spacing: [m].
        duration: [s].
    """
    mass = density * 4 / 3 * math.pi * BALL**3
    places = filled_cup(JAR, DEPTH, spacing)
    places = places[np.linalg.norm(places - [0.0, 0.0, height], axis=1) > BALL + 0.4 * spacing]
    volume = len(places) * spacing**3
    # The profile is what the liquid touches, the geom stands for it in MuJoCo: the ball comes near neither.
    glass = Shape(
        profile=cup(JAR, 1.5 * DEPTH).profile,
        geoms=(Geom(type="cylinder", size=(JAR, 0.0025, 0.0), position=(0.0, 0.0, 0.0025)),),
    )
    plain = scene(":floor a :Floor . :ball1 a :Ball ; :z 0.1 .")
    ball = replace(
        plain.thing("ball1"),
        shape=Shape(geoms=(Geom(type="sphere", size=(BALL, 0.0, 0.0)),)),
        mass=mass,
        position=(0.0, 0.0, height),
    )
    honey = Thing(
        name="liq1",
        kind="Honey",
        roles=frozenset({"Stuff", "Liquid"}),
        mass=volume * DENSITY,
        mount=WITHIN,
        quantities={"density": DENSITY, "viscosity": viscosity, "surfaceTension": 0.05, "volume": volume},
    )
    made = replace(
        plain,
        things=(plain.thing("floor"), ball, Thing(name="jar1", kind="Jar", shape=glass, mount=FIXED), honey),
        pools=(Pool(stuff="liq1", position=places, spacing=spacing),),
    )
    return simulate(compile_world(made), read_program(parse_term(f"wait({duration})"), made), duration=duration)


def test_a_steel_ball_sinks_in_honey_at_the_speed_of_stokes(compare: Compare) -> None:
    """Within 25 % of ``2/9 (rho_s - rho) g a^2 / (mu K)`` with Faxen's correction K for the wall, 24 mm/s here.

    4000 particles of 4 mm, two to the ball's radius of 8 mm, in a jar four times as wide; the speed is the mean over
    0.5 s, after the ball has come up to it (within milliseconds), in the middle half of the jar.
    """
    viscosity, density = 19.0, 7800.0
    log = sinking(density, viscosity, 0.063, 0.004, 0.7)
    ratio = BALL / JAR
    wall = 1 / (1 - 2.104 * ratio + 2.089 * ratio**3 - 0.948 * ratio**5)
    expected = 2 / 9 * (density - DENSITY) * GRAVITY * BALL**2 / (viscosity * wall)
    heights = log.poses[:, log.index("ball1"), 2]
    speed = float(heights[200] - heights[-1]) / (log.dt * (len(heights) - 201))
    compare("a steel ball of 16 mm sinks in honey (19 Pa s)", speed, expected, by=STOKES, share=0.25, unit="m/s")


@pytest.mark.laws
@pytest.mark.xfail(
    strict=True,
    raises=(AssertionError, InvalidSimulationError),
    reason="particles under pressure shear like grains, which is half of what drives it: see docs/liquids.md",
)
def test_a_light_ball_rises_in_honey(compare: Compare) -> None:
    """A ball of 500 kg/m^3 rises with the same law, the other way round, at 2 Pa s and within 25 %.

    32 mm/s: the buoyancy is the liquid's, there is no term for it.
    """
    viscosity, density = 2.0, 500.0
    log = sinking(density, viscosity, 0.03, 0.004, 0.6)
    ratio = BALL / JAR
    wall = 1 / (1 - 2.104 * ratio + 2.089 * ratio**3 - 0.948 * ratio**5)
    expected = 2 / 9 * (DENSITY - density) * GRAVITY * BALL**2 / (viscosity * wall)
    heights = log.poses[:, log.index("ball1"), 2]
    speed = float(heights[-1] - heights[200]) / (log.dt * (len(heights) - 201))
    compare("a light ball of 16 mm rises in syrup (2 Pa s)", speed, expected, by=STOKES, share=0.25, unit="m/s")
