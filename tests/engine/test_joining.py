"""Kinds hold bodies together, each its own, whatever another one holds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.scenes import scene

from prolepsis.engine.simulation import simulate
from prolepsis.engine.state import State
from prolepsis.engine.world import compile_world
from prolepsis.log.log import Log
from prolepsis.programs.reading import read_program
from prolepsis.scene.kind import Controller, Kind
from prolepsis.scene.running import PointJoint, Running
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import InputError
from prolepsis.terms.reader import parse_term

G = 9.81
FLOOR = ":floor a :Floor . "
ROW = FLOOR + "".join(f":{name} a :Block ; :x {k / 10} ; :z 1.0 . " for k, name in enumerate("abc"))


def between(first: str, second: str) -> PointJoint:
    half = np.array([0.05, 0.0, 0.0])
    return PointJoint(first=first, second=second, point_on_first=half, point_on_second=-half)


def held(state: State) -> set[tuple[str, str]]:
    model = state.model
    pairs = [(model.body(a).name, model.body(b).name) for a, b in zip(model.eq_obj1id, model.eq_obj2id, strict=True)]
    return {pair for pair, active in zip(pairs, state.data.eq_active, strict=True) if active}


def test_what_one_holds_another_leaves() -> None:
    state = State.of(compile_world(scene(ROW)))
    first, second = object(), object()
    state.join(first, [between("a", "b")])
    state.join(second, [between("b", "c")])
    assert held(state) == {("a", "b"), ("b", "c")}
    assert sorted(state.joint_numbers(first) + state.joint_numbers(second)) == [0, 1]
    state.join(first, [])
    assert held(state) == {("b", "c")}
    assert state.joint_numbers(first) == []
    assert len(state.joint_numbers(second)) == 1


def test_a_joint_stays_where_it_is_and_let_go_while_another_is_made() -> None:
    state = State.of(compile_world(scene(ROW)))
    first, second = object(), object()
    (number,) = state.join(first, [between("a", "b")])
    state.data.eq_active[number] = 0
    points = state.model.eq_data[number].copy()
    state.join(second, [between("b", "c")])
    (number,) = state.joint_numbers(first)
    assert not state.data.eq_active[number]
    assert state.model.eq_data[number] == pytest.approx(points)
    mujoco.mj_step(state.model, state.data, 10)
    assert [*state.joint_forces()] == state.joint_numbers(second)


def test_what_several_tell_of_what_sticks_is_all_told() -> None:
    state = State.of(compile_world(scene(ROW)))
    state.stick("one", [(1, 2)])
    state.stick("other", [(2, 3)])
    assert state.joints == {(1, 2), (2, 3)}
    state.stick("one", [])
    assert state.joints == {(2, 3)}


class Chain(Controller):
    """Holds b to a, and tells nobody."""

    def begin_tick(self, state: Running) -> None:
        if not state.joint_numbers(self):
            state.join(self, [between("a", "b")])


class Looking(Controller):
    """Counts how often it looks something up, and joins c to b once it may."""

    def __init__(self) -> None:
        self.bound: list[int] = []
        self.numbers: list[int] = []

    def bind(self, state: Running) -> None:
        self.bound.append(state.version)
        self.numbers = state.joint_numbers(self)

    def act(self, state: Running) -> None:
        if not self.numbers:
            state.join(self, [between("b", "c")])


class Two(Kind):
    """The kind of both."""

    def __init__(self, *controllers: Controller) -> None:
        self.controllers = controllers

    def start(self, state: Running) -> Sequence[Controller]:
        return self.controllers


def joined(*controllers: Controller, duration: float = 0.2) -> Log:
    known = scene(ROW)
    world = compile_world(replace(known, kinds=(*known.kinds, Two(*controllers))))
    return simulate(world, read_program(parse_term(f"wait({duration})"), known), duration=duration)


class Pulling(Chain):
    """And lifts a with twice the weight of both."""

    def begin_tick(self, state: Running) -> None:
        super().begin_tick(state)
        force = 2 * G * float(state.model.body("a").mass[0] + state.model.body("b").mass[0])
        state.push(self, np.array([state.model.body("a").id]), np.array([[0, 0, force, 0, 0, 0]]))


def test_what_is_held_by_a_joint_that_nobody_told_of_may_be_lifted_by_it() -> None:
    log = joined(Pulling())
    middle = (log.poses[:, log.index("a"), 2] + log.poses[:, log.index("b"), 2]) / 2
    assert middle[-1] - middle[0] == pytest.approx(G * 0.2**2 / 2, rel=0.02)


def test_all_look_up_anew_whenever_one_rebuilds_the_model() -> None:
    chain, looking = Chain(), Looking()
    joined(chain, looking, duration=0.01)
    assert looking.bound == [0, 1, 2]
    assert looking.numbers == [1]


def test_who_rebuilds_the_model_while_it_is_bound_is_refused() -> None:
    class Binder(Looking):
        def bind(self, state: Running) -> None:
            state.join(self, [between("a", "b")])

    with pytest.raises(InputError, match=r"Binder\.bind rebuilds the model"):
        joined(Binder())


@pytest.mark.parametrize(
    ("joint", "message"),
    [
        (between("a", "zz"), "object joins: no body named 'zz'"),
        (between("", "a"), "object joins: no body named ''"),
        (between("a", "a"), "object joins a with itself"),
        (replace(between("a", "b"), point_on_first=np.array([np.nan, 0, 0])), "at .*nan.*; needed: three numbers"),
        (replace(between("a", "b"), point_on_second=np.array([0.1])), "needed: three numbers"),
    ],
)
def test_what_is_no_joint_is_refused_and_nothing_is_changed(joint: PointJoint, message: str) -> None:
    state = State.of(compile_world(scene(ROW)))
    with pytest.raises(InputError, match=message):
        state.join(object(), [joint])
    state.join(object(), [between("a", "b")])
    assert held(state) == {("a", "b")}


@pytest.mark.parametrize("pair", [(0, 99), (-1, 2), (0.5, 1), (1, 2, 3)])
def test_what_are_no_two_things_do_not_stick(pair: Any) -> None:
    state = State.of(compile_world(scene(ROW)))
    with pytest.raises(InputError, match="needed: two of 4 things"):
        state.stick("glue", [pair])


@pytest.mark.parametrize("friction", [-0.1, 10.1, np.nan, np.inf])
def test_a_friction_that_no_surface_has_is_refused(friction: float) -> None:
    state = State.of(compile_world(scene(ROW)))
    with pytest.raises(InputError, match="a: friction .*; allowed: 0 to 10"):
        state.set_friction(state.scene.index("a"), friction)


@pytest.mark.parametrize(
    ("bodies", "wrenches"),
    [
        ([1], [1.0, 0, 0, 0, 0, 0]),
        ([1], [[1.0]]),
        ([1], [[np.nan, 0, 0, 0, 0, 0]]),
        ([-1], [[1.0, 0, 0, 0, 0, 0]]),
        ([99], [[1.0, 0, 0, 0, 0, 0]]),
        ([1, 1], [[1.0, 0, 0, 0, 0, 0]] * 2),
    ],
)
def test_what_is_no_push_is_refused_and_nothing_is_changed(bodies: list[int], wrenches: Any) -> None:
    state = State.of(compile_world(scene(ROW)))
    with pytest.raises(InputError, match="object pushes"):
        state.push(object(), np.array(bodies), np.array(wrenches))
    state.push(object(), np.array([1]), np.array([[1.0, 0, 0, 0, 0, 0]]))
    assert state.data.xfrc_applied[1, 0] == 1.0
