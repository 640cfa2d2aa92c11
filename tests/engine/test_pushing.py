"""Kinds push: what they do is summed, goes on while the model is rebuilt, and is no gain unless it must not be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pytest
from tests.scenes import scene

from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.log.log import Log
from prolepsis.programs.reading import read_program
from prolepsis.scene.kind import Controller, Kind
from prolepsis.scene.running import Running
from prolepsis.terms.errors import InvalidSimulationError
from prolepsis.terms.reader import parse_term

G = 9.81
FLOOR = ":floor a :Floor . "
BLOCK = FLOOR + ":b a :Block ; :mass 0.1 ; :on :floor . "
CUP = FLOOR + ":cup1 a :Cup ; :on :floor ; :contains :w . :w a :Water ; :fill 0.5 . "


@dataclass
class Lifter(Controller):
    """Pushes a thing upwards, once."""

    name: str
    force: float
    passes_on: bool = False
    begun: bool = False

    __hash__ = object.__hash__

    def begin_tick(self, state: Running) -> None:
        if not self.begun:
            bodies = np.array([state.model.body(self.name).id])
            state.push(self, bodies, np.array([[0, 0, self.force, 0, 0, 0]]), passes_on=self.passes_on)
            self.begun = True


class Lifting(Kind):
    """The kind of what some lifters do."""

    def __init__(self, *lifters: Controller) -> None:
        self.lifters = lifters

    def start(self, state: Running) -> Sequence[Controller]:
        del state
        return self.lifters


def lifted(turtle: str, *lifters: Lifter, duration: float = 0.2) -> Log:
    known = scene(turtle, particles=200)
    world = compile_world(replace(known, kinds=(*known.kinds, Lifting(*lifters))))
    return simulate(world, read_program(parse_term(f"wait({duration})"), known), duration=duration)


def rise(log: Log, name: str) -> float:
    heights = log.poses[:, log.index(name), 2]
    return float(heights[-1] - heights[0])


def test_what_kinds_push_is_summed() -> None:
    log = lifted(BLOCK, Lifter("b", 1.2), Lifter("b", 0.762))
    assert rise(log, "b") == pytest.approx(G * 0.199**2 / 2, rel=0.02)


def test_a_kind_that_must_only_pass_energy_on_makes_no_answer() -> None:
    with pytest.raises(InvalidSimulationError, match="b moves with more energy than it had"):
        lifted(BLOCK, Lifter("b", 1.962, passes_on=True))


def test_a_kind_and_a_liquid_push_the_same_body() -> None:
    """A cup with water in it is lifted by as much as their weight twice."""
    water = scene(CUP, particles=200).thing("w").mass
    cup = scene(CUP, particles=200).thing("cup1").mass
    log = lifted(CUP, Lifter("cup1", 1.5 * (cup + water) * G))
    assert rise(log, "cup1") == pytest.approx(0.5 * G * 0.2**2 / 2, rel=0.1)


def test_a_push_goes_on_when_the_model_is_rebuilt() -> None:
    log = lifted(BLOCK + ":egg1 a :Egg ; :x 1.5 ; :z 0.3 . ", Lifter("b", 0.9), duration=0.4)
    split = np.flatnonzero((log.carrier[1:] != log.carrier[:-1]).any(axis=1))
    assert 200 < split[0] < 350
    pair = sorted((log.index("floor"), log.index("b")))
    late = (log.contacts.a == pair[0]) & (log.contacts.b == pair[1]) & (log.contacts.tick >= 350)
    borne = np.abs(log.contacts.force[late, 2]).sum() / 50
    assert borne == pytest.approx(0.1 * G - 0.9, rel=0.05)


class Spring(Controller):
    """Pulls two things together as a spring does."""

    def __init__(self, stiffness: float, length: float) -> None:
        self.stiffness, self.length = stiffness, length

    def is_steady(self) -> bool:
        return False

    def act(self, state: Running) -> None:
        state.renew_poses(centres=True)
        bodies = np.array([state.model.body(name).id for name in ("b", "c")])
        force = self.stiffness * (state.data.xipos[bodies[1], 0] - state.data.xipos[bodies[0], 0] - self.length)
        state.push(self, bodies, np.array([[force, 0, 0, 0, 0, 0], [-force, 0, 0, 0, 0, 0]]))


@pytest.mark.parametrize("step", [1.0e-3, 0.5e-3])
def test_a_spring_keeps_its_energy_at_any_substep(step: float) -> None:
    stiffness, mass = 40.0, 0.1
    known = scene(":floor a :Floor . :b a :Block ; :mass 0.1 ; :z 9.0 . :c a :Block ; :mass 0.1 ; :x 0.35 ; :z 9.0 .")
    world = compile_world(replace(known, kinds=(*known.kinds, Lifting(Spring(stiffness, 0.3)))))
    log = simulate(world, read_program(parse_term("wait(1.0)"), known), duration=1.0, max_step=step)
    apart = log.poses[:, log.index("c"), 0] - log.poses[:, log.index("b"), 0] - 0.3
    omega = np.sqrt(2 * stiffness / mass)
    assert np.abs(apart[-300:]).max() == pytest.approx(0.05, rel=0.02)
    assert apart == pytest.approx(0.05 * np.cos(omega * log.time), abs=0.004)
