"""A vessel's mass lies where its matter is: thick bottoms weigh more than thin walls."""

from __future__ import annotations

import math

import pytest
from tests.scenes import scene

from prolepsis.engine.world import compile_world


def test_a_cup_s_centre_of_mass_is_that_of_its_wall_and_bottom() -> None:
    made = scene(":floor a :Floor . :cup1 a :Cup ; :on :floor .")
    body = compile_world(made).model.body("cup1")
    wall, bottom = math.pi * (0.04**2 - 0.035**2) * 0.085, math.pi * 0.04**2 * 0.005
    height = (wall * (0.005 + 0.085 / 2) + bottom * 0.0025) / (wall + bottom)
    assert float(body.mass[0]) == pytest.approx(made.thing("cup1").mass)
    # The wall consists of twenty flat pieces.
    assert float(body.ipos[2]) == pytest.approx(height, rel=0.01)


def test_a_lid_raises_the_centre_of_mass_and_holes_leave_it_whole() -> None:
    plain = compile_world(scene(":floor a :Floor . :cup1 a :Cup ; :on :floor .")).model.body("cup1")
    lidded = compile_world(scene(":floor a :Floor . :cup1 a :Cup ; :lid true ; :on :floor .")).model.body("cup1")
    holes = ":holeRadius 0.006 ; :holeHeight 0.03 ; :holeCount 4 ; :bottomHoleRadius 0.01"
    made = scene(f":floor a :Floor . :cup1 a :Cup ; {holes} ; :on :floor .")
    assert float(lidded.ipos[2]) > float(plain.ipos[2]) + 0.003
    assert float(compile_world(made).model.body("cup1").mass[0]) == pytest.approx(made.thing("cup1").mass)
