"""An arm gets to where it should be within its limits, or says why not."""

from __future__ import annotations

import numpy as np
import pytest
from tests.scenes import run, scene

from prolepsis.engine.state import State
from prolepsis.engine.world import compile_world
from prolepsis.fluents import recognize
from prolepsis.log.log import Log
from prolepsis.robots.arm_paths import is_of
from prolepsis.robots.inverse import ArmKinematics, Found
from prolepsis.robots.model_fitting import OTHERS, OWN
from prolepsis.robots.pr2 import PR2

BLOCK = (
    ":floor a :Floor . :table1 a :Table . :block1 a :Block ; :on :table1 ; :length 0.05 ; :width 0.05 ; :height 0.07 "
)
ROBOT = (
    " . :pr2 a :PR2 ; :x -0.8 ; :hasPart :rightGripper , :leftGripper . "
    ":rightGripper a :Gripper . :leftGripper a :Gripper ."
)
NEAR = BLOCK + "; :x -0.2 ; :y -0.15" + ROBOT
BETWEEN = BLOCK + "; :x -0.3" + ROBOT
FAR = BLOCK + "; :x 0.35 ; :y -0.1" + ROBOT


def outcomes(log: Log) -> dict[str, str]:
    return {action.term.functor: action.outcome for action in log.actions}


@pytest.fixture(scope="module")
def right_arm() -> ArmKinematics:
    return ArmKinematics(PR2, PR2.arms[0])


def test_what_a_thing_is_made_of_is_of_it_however_it_is_called() -> None:
    state = State.of(compile_world(scene(":floor a :Floor . :egg a :HardBoiledEgg ; :z 0.5 . :egg2 a :Egg ; :z 0.7 .")))
    pieces = [thing.name for thing in state.scene.things if thing.whole == "eggshell"]
    kernel = state.scene.index("kernel")
    state.split("egg", [[kernel], *([state.scene.index(name)] for name in pieces)])
    bodies = {state.model.body(body).name: body for body in range(1, state.model.nbody)}
    assert set(bodies) == {"floor", "egg2", "kernel", *pieces}
    assert {name for name, body in bodies.items() if is_of(state, body, {"egg"})} == {"kernel", *pieces}
    assert {name for name, body in bodies.items() if is_of(state, body, {"eggshell"})} == {*pieces}
    assert not is_of(state, 0, {"egg"})


def test_a_search_finds_postures_that_exist(right_arm: ArmKinematics) -> None:
    rng = np.random.default_rng(3)
    low, high = np.maximum(right_arm.low, -np.pi) + 0.3, np.minimum(right_arm.high, np.pi) - 0.3
    found: list[Found] = []
    for _ in range(50):
        joints = rng.uniform(low, high)
        near = np.clip(joints + rng.uniform(-0.4, 0.4, len(joints)), low, high)
        found.append(right_arm.solve(right_arm.pose(joints), near))
    assert sum(each.is_there for each in found) >= 48
    assert all((each.joints >= right_arm.low).all() and (each.joints <= right_arm.high).all() for each in found)


def test_a_step_towards_a_place_stays_within_the_joints_speeds(right_arm: ArmKinematics) -> None:
    goal = right_arm.pose(right_arm.home)
    goal[:3] += (0.1, 0.05, -0.1)
    rates = right_arm.step(right_arm.home, goal, 0.004)
    assert (np.abs(rates) <= right_arm.speeds * (1 + 1e-9)).all()
    assert np.abs(rates / right_arm.speeds).max() > 0.99


def test_a_block_is_grasped_lifted_and_held_with_the_commanded_force() -> None:
    log = run(NEAR, "sequence([grasp(rightGripper, block1, 20), lift(rightGripper, 0.1), hold(rightGripper, 0.3)])")
    assert outcomes(log) == {"grasp": "done", "reach": "done", "lift": "done", "hold": "done"}
    height = log.poses[:, log.index("block1"), 2]
    assert height[-1] - height[0] == pytest.approx(0.1, abs=0.003)
    held = log.channels["rightGripper.pad_force"][-200:]
    assert np.abs(held - 20).max() < 0.2


def test_what_is_out_of_reach_is_an_outcome_and_ends_the_plan() -> None:
    log = run(FAR, "sequence([grasp(rightGripper, block1, 20), lift(rightGripper, 0.1)])")
    assert outcomes(log) == {"grasp": "unreachable", "reach": "unreachable"}
    assert "away" in str(log.actions[0].evidence["reason"])


def test_what_is_not_held_cannot_be_hit() -> None:
    log = run(NEAR, "sequence([hit(rightGripper, block1, table1), wait(0.1)])")
    assert outcomes(log) == {"hit": "not_held"}


def test_it_drives_while_its_head_turns() -> None:
    plan = "sequence([together([drive(pr2, [-0.9, -0.2], 0.3), look_at(pr2, block1)]), wait(0.2)])"
    log = run(NEAR, plan)
    assert outcomes(log)["drive"] == outcomes(log)["look_at"] == "done"
    base = log.poses[-1, log.index("pr2/base_footprint")]
    assert base[:2] == pytest.approx((-0.9, -0.2), abs=0.005)
    assert 2 * np.arctan2(base[6], base[3]) == pytest.approx(0.3, abs=0.01)


def test_looking_turns_the_camera_towards_the_object() -> None:
    log = run(NEAR, "sequence([look_at(pr2, block1), wait(0.3)])")
    camera, block = (log.poses[-1, log.index(name)] for name in ("pr2/head_camera", "block1"))
    w, x, y, z = camera[3:]
    forward = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)])
    way = block[:3] - camera[:3]
    # The camera is some centimetres beside the axes of the head.
    assert np.degrees(np.arccos(forward @ way / np.linalg.norm(way))) < 8


def test_links_belong_to_the_robot_and_hands_to_themselves() -> None:
    known = scene(NEAR)
    assert {t.name for t in known.things if "Gripper" in t.roles} == {"rightGripper", "leftGripper"}
    assert known.thing("pr2/r_gripper_palm_link").whole == "rightGripper"
    assert known.thing("pr2/r_forearm_link").whole == "pr2"


def test_an_arm_does_not_go_where_the_other_one_is() -> None:
    log = run(BETWEEN, "sequence([reach(rightGripper, block1), reach(leftGripper, block1)])")
    right, left = log.actions
    assert (right.outcome, left.outcome) == ("done", "in_collision")
    assert left.evidence["reason"] == "block1 by leftGripper: rightGripper"


def test_two_hands_that_meet_keep_apart() -> None:
    ways = "carry(rightGripper, [0, 0.25, 0], 1, 0.3), carry(leftGripper, [0, -0.25, 0], 1, 0.3)"
    log = run(BETWEEN, f"sequence([together([{ways}]), wait(0.1)])")
    right, left = (log.poses[:, log.index(f"pr2/{side}_gripper_palm_link"), 1] for side in "rl")
    # Without contact the hands would have passed each other: they were sent 20 cm past where they meet.
    assert left[-1] - right[-1] > 0.05
    touched = {fact.args for fact in recognize(log).select(type="contacts")}
    assert ("leftGripper", "rightGripper") in touched
    assert all(first != second for first, second in touched)


def test_hands_that_do_not_meet_do_not_touch() -> None:
    log = run(BETWEEN, "together([lift(rightGripper, 0.1), lift(leftGripper, 0.1)])")
    assert not [args for args in (f.args for f in recognize(log).select(type="contacts")) if "leftGripper" in args]


def test_an_arm_can_touch_the_other_one_but_neither_itself_nor_the_trunk() -> None:
    known = compile_world(scene(NEAR)).model
    side = {g: known.body(int(known.geom_bodyid[g])).name.removeprefix("pr2/")[:2] for g in range(known.ngeom)}
    types, affinities = known.geom_contype, known.geom_conaffinity
    robot = [g for g in side if types[g] & OWN]
    assert {"r_", "l_", "ba", "to", "he"} <= {side[g] for g in robot}
    for a in robot:
        for b in robot:
            meet = bool(types[a] & affinities[b] or types[b] & affinities[a])
            assert meet == ({side[a], side[b]} == {"r_", "l_"})
        assert types[a] & OTHERS or affinities[a] & OTHERS
