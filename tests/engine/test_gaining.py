"""Nothing moves with more energy than it had or was given, and the run is still an answer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from tests.scenes import run, scene

from prolepsis.engine.gaining import Surroundings, gains
from prolepsis.engine.simulation import simulate
from prolepsis.engine.stretches import Matter, Movers, Stretch
from prolepsis.engine.world import compile_world
from prolepsis.log.log import Contacts, Joints, Particles
from prolepsis.log.things import Thing
from prolepsis.programs import read_program
from prolepsis.scene.kind import Controller, Kind
from prolepsis.scene.running import Running
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import InvalidSimulationError
from prolepsis.terms.reader import parse_term

FLOOR = ":floor a :Floor . "
TABLE = FLOOR + ":table1 a :Table . "
CUP = TABLE + ":c a :Cup ; :on :table1 ; :contains :l . :l a :Water ; :fill 0.5 . "
BOWL = TABLE + ":c a :Bowl ; :radius 0.12 ; :on :table1 ; :contains :l . :l a :Water ; :fill 0.5 . "
SMALL = ":b a :Sponge ; :length 0.03 ; :width 0.03 ; :height 0.03 ; :z 1.0 . "


class Spring(Kind, Controller):
    """Throws a ball back that falls on it, as a liquid would that has energy to give away."""

    order = 99
    LEVEL, TIME = 1.1, 0.01
    """Height from which on it does so [m], and for how long [s]."""

    def __init__(self, speed: float) -> None:
        """Throw the ball up with a speed [m/s]."""
        self.speed = speed
        self.force: float | None = None

    def start(self, state: Running) -> Sequence[Controller]:
        """Act in the run."""
        return [self]

    def end_tick(self, state: Running) -> None:
        """Push what is low enough for the first time, for a while."""
        ball, model = state.model.body("b").id, state.model
        if self.force is None and state.data.xpos[ball, 2] < self.LEVEL:
            change = self.speed - float(state.data.joint("b").qvel[2])
            self.force, self.until = model.body_mass[ball] * (change / self.TIME + 9.81), state.data.time + self.TIME
        elif self.force is None:
            return
        force = self.force if state.data.time < self.until - 1e-9 else 0.0
        state.push(self, np.array([ball]), np.array([[0.0, 0.0, force, 0.0, 0.0, 0.0]]), passes_on=True)


@pytest.mark.parametrize(("speed", "how"), [(2.4, "moves with more energy than"), (1.7, "is thrown back")])
def test_what_only_passes_energy_on_may_not_throw_back_what_falls_on_it(speed: float, how: str) -> None:
    """It comes with 2 m/s."""
    composed = scene(CUP + ":b a :Ball ; :radius 0.01 ; :z 1.3 . ", particles=200)
    springy = replace(composed, kinds=(*composed.kinds, Spring(speed)))
    with pytest.raises(InvalidSimulationError, match=rf"at 0\.2[0-9]+ s b {how}"):
        simulate(compile_world(springy), read_program(parse_term("wait(0.1)"), springy), duration=0.3)


@pytest.mark.parametrize(
    ("what", "particles"), [(BOWL + ":b a :Sponge ; :z 0.9 . ", 1500), (CUP + SMALL, 500), (CUP + SMALL, 1500)]
)
def test_a_dry_sponge_that_falls_into_water_stays_in_it(what: str, particles: int) -> None:
    log = run(what, duration=0.4, particles=particles)
    assert log.poses[-1, log.index("b"), 2] < 0.8


def block(name: str, size: tuple[float, float, float], rest: str) -> str:
    """Return a block of a length, width and height [m]."""
    x, y, z = size
    return f":{name} a :Block ; :length {x!r} ; :width {y!r} ; :height {z!r} ; {rest} . "


PASSED_ON = {
    "an M&M that bounces": FLOOR + ":b a :MandM ; :z 0.5 . ",
    "a light ball that a heavy one throws up": FLOOR
    + ":a a :Ball ; :radius 0.05 ; :z 0.35 ; :mass 3.0 . "
    + ":b a :Ball ; :radius 0.02 ; :z 0.4205 ; :mass 0.03 . ",
    "a light block that a see-saw throws up": FLOOR
    + block("a", (0.03, 0.1, 0.03), ":on :floor ; :density 2000.0")
    + block("plank", (0.6, 0.06, 0.01), ":z 0.0355 ; :density 600.0")
    + block("b", (0.03, 0.03, 0.03), ":x -0.27 ; :z 0.056 ; :mass 0.01")
    + block("heavy", (0.05, 0.05, 0.05), ":x 0.26 ; :z 0.3 ; :mass 3.0"),
    "a ball that rises in water": CUP + ":b a :Ball ; :radius 0.02 ; :density 300.0 ; :z 0.725 . ",
    "a cup that is hit": CUP + block("b", (0.05, 0.05, 0.05), ":z 1.0 ; :mass 0.5 ; :x 0.01"),
}


@pytest.mark.parametrize("what", PASSED_ON)
def test_what_is_given_energy_by_others_is_an_answer(what: str) -> None:
    log = run(PASSED_ON[what], duration=0.6, particles=200)
    b = log.index("b")
    assert log.poses[:, b, 2].max() > log.poses[:, b, 2].min() + 0.004


def test_what_a_hand_lifts_and_lets_go_is_an_answer() -> None:
    log = run(
        TABLE
        + block("b", (0.04, 0.04, 0.04), ":on :table1 ; :mass 0.05")
        + ":hand1 a :Gripper ; :pitch 90.0 ; :z 0.722 ; :opening 0.06 .",
        "sequence([grasp(hand1, b, 5), lift(hand1, 0.1), release(hand1)])",
        duration=5.0,
    )
    assert log.poses[:, log.index("b"), 2].max() > 0.78


HAND_PLATE_BALL = """
<mujoco><worldbody>
  <body name="hand"><joint type="slide"/><geom size=".01"/></body>
  <body name="plate"><freejoint/><geom size=".01"/></body>
  <body name="ball"><freejoint/><geom size=".01"/></body>
</worldbody></mujoco>
"""


@pytest.mark.parametrize(("let_go", "found"), [(100, []), (20, [131])])
def test_what_a_hand_pressed_may_spring_back_for_a_moment_when_it_lets_go(let_go: int, found: list[int]) -> None:
    # A ball on a plate that a hand holds: it hops at 0.1 s, comes back, and at 0.131 s is thrown up by 5 cm.
    model = mujoco.MjModel.from_xml_string(HAND_PLATE_BALL)
    things = tuple(Thing(name=name, kind="Thing") for name in ("hand", "plate", "ball"))
    bodies, count = Movers.of(model, np.arange(1, 4)), 180
    poses = np.tile((0.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0), (count, 3, 1))
    for start, end, speed in ((101, 125, 0.118), (131, count, 1.0)):
        since = np.arange(end - start) * 0.001
        poses[start:end, 2, 2] += speed * since - 9.81 / 2 * since**2
    rows = [(tick, 0, 1) for tick in range(let_go)]
    rows += [(tick, 1, 2) for tick in (*range(101), *range(125, 131))]
    tick, a, b = np.array(sorted(rows)).T
    three, none = np.zeros((len(tick), 3)), np.zeros((0, 3), dtype=np.bool_)
    around = Surroundings(
        contacts=Contacts(tick=tick, a=a, b=b, force=three, normal=three, point=three, peak=np.zeros(len(tick))),
        joints=(Joints(), Joints()),
        wet=none,
        driven=none,
        mass=np.zeros((0, 3)),
        particles=Particles(),
    )
    stretch = Stretch(start=0, end=count, matter=Matter.of(model, things), bodies=bodies)
    made = list(gains(things, poses, around, [stretch], np.array([0.0, 0.0, -9.81]), 0.001))
    assert [(gain.tick, gain.thing) for gain in made] == [(tick, 2) for tick in found]
