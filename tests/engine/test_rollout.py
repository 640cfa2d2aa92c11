"""Foreign rollouts become logs: things, forces as MuJoCo gives them, joints, and refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.fluents.worlds import FLOOR, HAND, HAND_DRIVES, STEP, ball, box, roll, world

from prolepsis.geometry.shape import FloatArray
from prolepsis.log.checks import check_log
from prolepsis.log.log import Log
from prolepsis.log.things import Thing
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import InputError, InvalidSimulationError, UnknownNameError


@pytest.mark.parametrize("cone", ["elliptic", "pyramidal"])
def test_contact_forces_are_those_of_mujoco(cone: str) -> None:
    xml = world(FLOOR + box("a", "0 0 .05") + box("b", ".02 .01 .15") + ball("c", ".3 0 .03"))
    model, states = roll(xml.replace('cone="elliptic"', f'cone="{cone}"'), 0.2, push)
    log = Log.from_mujoco(model, states, STEP)
    data = mujoco.MjData(model)
    for tick in (3, 40, 99):
        mujoco.mj_setState(model, data, states[tick], mujoco.mjtState.mjSTATE_INTEGRATION)
        mujoco.mj_forward(model, data)
        expected = np.zeros((len(log.things), 3))
        wrench = np.zeros(6)
        for number in range(data.ncon):
            mujoco.mj_contactForce(model, data, number, wrench)
            body = model.geom_bodyid[data.contact[number].geom2]
            expected[body] += data.contact[number].frame.reshape(3, 3).T @ wrench[:3]
        found = np.zeros_like(expected)
        here = log.contacts.tick == tick
        np.add.at(found, log.contacts.b[here], log.contacts.force[here])
        assert np.abs(expected).max() > 1
        assert np.allclose(found, expected, atol=1e-9)


def push(model: Any, data: Any) -> None:
    data.qfrc_applied[0] = 3.0


def test_a_resting_box_is_borne_with_its_weight() -> None:
    model, states = roll(world(FLOOR + box("a", "0 0 .05", mass=2)), 0.5)
    log = Log.from_mujoco(model, states, STEP)
    last = log.contacts.tick == log.tick_count - 1
    assert np.allclose(log.contacts.force[last].sum(axis=0), (0, 0, 2 * 9.81), atol=1e-3)
    assert [thing.name for thing in log.things] == ["floor", "a"]


def test_bodies_parts_and_world_geoms_become_things() -> None:
    shade = '<body name="shade"><geom type="sphere" size=".1"/></body>'
    lamp = f'<body name="lamp"><geom type="box" size=".1 .1 .1"/>{shade}</body>'
    walls = '<geom name="wall" type="box" size=".1 1 1" pos="3 0 0"/><geom type="box" size=".1 .1 .1" pos="-3 0 0"/>'
    model, states = roll(world(FLOOR + walls + lamp + HAND + box("a", "1 0 .05"), HAND_DRIVES), 0.01)
    log = Log.from_mujoco(model, states, STEP)
    things = {thing.name: thing for thing in log.things}
    assert set(things) == {
        "floor", "wall", "world", "lamp", "lamp/shade", "hand", "hand/left_finger", "hand/right_finger", "a",
    }  # fmt: skip
    assert {name for name, thing in things.items() if thing.fixed} == {"floor", "wall", "world", "lamp", "lamp/shade"}
    assert things["hand/left_finger"].whole == "hand"
    assert {"Driven", "Mounted"} <= things["hand"].roles
    assert not things["a"].roles
    assert things["floor"].roles == {"Floor"}
    carrier = dict(zip(things, log.carrier[0].tolist(), strict=True))
    assert carrier["lamp/shade"] == carrier["lamp"]
    assert carrier["hand/left_finger"] != carrier["hand"]


def test_a_scene_says_more_of_the_things() -> None:
    model, states = roll(world(FLOOR + HAND, HAND_DRIVES), 0.01)
    gripper = Thing(name="hand", kind="Hand", roles=frozenset({"Gripper"}), quantities={"friction": 0.9})
    for scene in ({"hand": gripper}, [gripper]):
        log = Log.from_mujoco(model, states, STEP, scene)
        hand = log.things[log.index("hand")]
        assert (hand.kind, hand.quantities["friction"]) == ("Hand", 0.9)
        assert {"Gripper", "Driven"} <= hand.roles
        assert hand.shape.geoms
    with pytest.raises(UnknownNameError, match="no thing named 'hnad'; did you mean 'hand'"):
        Log.from_mujoco(model, states, STEP, {"hnad": gripper})


def test_a_mesh_becomes_the_vertices_of_its_hull() -> None:
    points = "0 0 0  .1 0 0  0 .1 0  0 0 .1  .02 .02 .02"
    asset = f'<asset><mesh name="corner" vertex="{points}"/></asset>'
    body = '<body name="corner" pos="0 0 1"><freejoint/><geom type="mesh" mesh="corner"/></body>'
    model, states = roll(world(body, asset), 0.01)
    (geom,) = Log.from_mujoco(model, states, STEP).things[0].shape.geoms
    assert (geom.type, len(geom.vertices)) == ("mesh", 4)


def test_a_switched_weld_is_a_joint_while_it_is_on() -> None:
    weld = '<equality><weld body1="a" body2="b"/></equality>'

    def switch(model: Any, data: Any) -> None:
        data.eq_active[0] = 0.01 < data.time < 0.05

    model, states = roll(world(box("a", "0 0 1") + box("b", "0 0 2"), weld), 0.1, switch)
    joints = Log.from_mujoco(model, states, STEP).joints
    assert len(joints.a) == 1
    assert (joints.a[0], joints.b[0]) == (0, 1)
    assert 4 <= joints.start[0] <= 7
    assert 24 <= joints.end[0] <= 27


def spoil(states: FloatArray, row: int, value: float) -> FloatArray:
    spoilt = states.copy()
    spoilt[row, 3] = value
    return spoilt


def test_bad_states_are_refused() -> None:
    model, states = roll(world(FLOOR + box("a", "0 0 .05")), 0.02)
    with pytest.raises(InvalidSimulationError, match=r"nan at 0.008 s \(state 4\)"):
        Log.from_mujoco(model, spoil(states, 4, np.nan), STEP)
    with pytest.raises(InvalidSimulationError, match="unstable"):
        Log.from_mujoco(model, spoil(states, 4, 1e12), STEP)
    with pytest.raises(InputError, match=r"shape \(10, 7\); \(T, \d+\) with T > 0 is needed"):
        Log.from_mujoco(model, states[:, :7], STEP)
    with pytest.raises(InputError, match="dt: 0 s; a positive time"):
        Log.from_mujoco(model, states, 0)


@pytest.mark.parametrize("model", [None, "world.xml", 3])
def test_what_is_no_model_is_refused(model: Any) -> None:
    with pytest.raises(InputError, match=r"model: a mujoco\.MjModel is needed, as .*, not (NoneType|str|int)"):
        Log.from_mujoco(model, np.zeros((3, 13)), STEP)


def test_what_is_no_number_is_refused() -> None:
    model, states = roll(world(FLOOR + box("a", "0 0 .05")), 0.02)
    wrong: list[Any] = ["0.002", None, True]
    for dt in wrong:
        with pytest.raises(InputError, match="dt: a number of seconds is needed, not "):
            Log.from_mujoco(model, states, dt)
    wrong = ["states.npz", [["a"]], [[1.0], [1.0, 2.0]]]
    for rows in wrong:
        with pytest.raises(InputError, match="states: an array of numbers is needed"):
            Log.from_mujoco(model, rows, STEP)


def test_logs_can_be_compared_and_kept_in_sets() -> None:
    model, states = roll(world(FLOOR + box("a", "0 0 .05")), 0.02)
    log, other = Log.from_mujoco(model, states, STEP), Log.from_mujoco(model, states, STEP)
    assert log == log
    assert log != other
    assert len({log, other}) == 2


def test_names_that_clash_are_refused() -> None:
    model, states = roll(world('<geom name="a" type="plane" size="1 1 1"/>' + box("a", "0 0 .05")), 0.01)
    with pytest.raises(InputError, match="several things are called a"):
        Log.from_mujoco(model, states, STEP)


def beads(*names: str) -> tuple[Any, FloatArray]:
    """Return the rollout of balls side by side, with a hand."""
    balls = "".join(ball(name, f"{0.2 * k} 1 .03") for k, name in enumerate(names))
    return roll(world(FLOOR + HAND + balls, HAND_DRIVES), 0.01)


def test_like_bodies_become_parts_of_a_stuff_that_is_no_body() -> None:
    model, states = beads("bead1", "bead2", "pea")
    log = Log.from_mujoco(model, states, STEP, stuffs={"beads": "bead?"})
    stuff = log.index("beads")
    assert stuff == len(log.things) - 1
    assert (log.things[stuff].kind, log.things[stuff].roles) == ("Granular", {"Stuff"})
    assert log.things[stuff].mass == pytest.approx(0.4)
    assert {thing.name for thing in log.things if thing.whole == "beads"} == {"bead1", "bead2"}
    assert (log.carrier[:, stuff] == -1).all()
    check_log(log)


@pytest.mark.parametrize(
    ("stuffs", "message"),
    [
        (["bead*"], r"stuffs: \['bead\*'\]; needed: a name and a pattern each"),
        ({"beads": None}, r"stuffs: \('beads', None\); needed: a name and a pattern, texts"),
        ({"beads": "*" * 5000}, r"needed: a name and a pattern, texts of 1 to 100"),
        ({"beads": "beed*"}, r"stuffs: beads: no thing named 'beed\*'; did you mean 'bead[12]'"),
        ({"beads": "Bead*"}, "no thing named"),
        ({"fingers": "hand/*"}, "no thing named 'hand/"),
        ({"beads": "bead*", "ones": "*1"}, r"bead1 matches 'bead\*' of beads and '\*1' of ones; allowed: one of them"),
        ({"beads": "*"}, r"floor matches '\*', but is fixed; a stuff consists of what moves freely"),
        ({"beads": "[bh]*"}, "hand matches .*, but is moved by actuators"),
        ({"pea": "bead*"}, "'pea' is the name of a thing already"),
        ({"": "bead*"}, r"stuffs: \('', 'bead\*'\); needed: a name and a pattern, texts"),
    ],
)
def test_a_stuff_that_cannot_be_one_is_refused(stuffs: dict[str, str], message: str) -> None:
    model, states = beads("bead1", "bead2", "pea")
    with pytest.raises(InputError, match=message):
        Log.from_mujoco(model, states, STEP, stuffs=stuffs)


def test_a_tick_that_the_states_own_times_contradict_is_refused() -> None:
    model, states = roll(world(FLOOR + ball("ball", "0 0 .5")), 0.2)
    with pytest.raises(InputError, match=r"dt: 0.002 s, but by their own times the states are 0.01 s apart"):
        Log.from_mujoco(model, states[::5], 0.002)
    timeless = states[::5].copy()
    timeless[:, 0] = 0.0
    assert Log.from_mujoco(model, timeless, 0.01).dt == 0.01


def test_what_says_more_of_a_thing_is_a_thing() -> None:
    model, states = roll(world(FLOOR + ball("ball", "0 0 .5")), 0.02)
    with pytest.raises(InputError, match="scene: ball is given 'Gripper'; needed: a Thing"):
        Log.from_mujoco(model, states, STEP, {"ball": "Gripper"})  # pyright: ignore[reportArgumentType]
