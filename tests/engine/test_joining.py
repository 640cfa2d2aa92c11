"""Kinds hold bodies together, each its own, whatever another one holds."""

from __future__ import annotations

import numpy as np
import pytest
from tests.scenes import scene

from prolepsis.engine.state import State
from prolepsis.engine.world import compile_world
from prolepsis.scene.running import PointJoint
from prolepsis.system.mujoco import mujoco

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
