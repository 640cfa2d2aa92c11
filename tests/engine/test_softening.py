"""Contacts of pieces are soft: as MuJoCo makes contacts of which both sides are told to be."""

from __future__ import annotations

import numpy as np
import pytest

from prolepsis.engine.softening import HARD_SOLIMP, SOFT, SOLREF, STIFF, Softening
from prolepsis.system.mujoco import mujoco

WORLD = """<mujoco><option cone="elliptic" impratio="{impratio}" integrator="implicitfast" timestep="0.0005"/>
<default><geom friction=".7" solref=".004 1" solimp=".9 .95 .001 .5 2" mass=".002"/></default><worldbody>
<geom type="plane" size="1 1 .1" friction=".3" priority="2" solref="{solref}" solimp="{solimp}"/>
<body pos="0 0 .0099"><freejoint/><geom type="box" size=".01 .01 .01" condim="3"/></body>
<body pos=".1 0 .0098"><freejoint/><geom type="sphere" size=".01" condim="6"/></body>
</worldbody></mujoco>"""


def words(numbers: tuple[float, ...]) -> str:
    return " ".join(map(str, numbers))


@pytest.mark.parametrize("squeezed", [False, True])
def test_pieces_move_as_on_what_is_soft_throughout(squeezed: bool) -> None:
    smooth = WORLD.format(impratio=SOFT if squeezed else STIFF, solref=".005 1", solimp="0 .95 .001 .5 2")
    hard = WORLD.format(impratio=STIFF, solref=words(SOLREF), solimp=words(HARD_SOLIMP))
    softening = Softening(pieces=np.array([False, True, True]), any_pieces=True, until=1.0 if squeezed else 0.0)
    models = [mujoco.MjModel.from_xml_string(each) for each in (smooth, hard)]
    expected, found = (mujoco.MjData(model) for model in models)
    for data in (expected, found):
        data.qvel[:] = (0.3, 0.1, -0.1, 0, 0, 0, 0.5, 0, -0.2, 0, 10, 0)
    for _ in range(400):
        mujoco.mj_step(models[0], expected)
        mujoco.mj_step1(models[1], found)
        softening.soften(models[1], found)
        mujoco.mj_step2(models[1], found)
    assert found.ncon
    np.testing.assert_allclose(found.qpos, expected.qpos, atol=1e-9)
