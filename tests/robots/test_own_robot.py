"""Robots that prolepsis has never seen - an MJCF and a URDF of the same arm - are driven like the ones it knows."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from prolepsis.log.things import Thing
from prolepsis.projection import Projection, project
from prolepsis.robots.loading import load_robot
from prolepsis.robots.model import robot_model
from prolepsis.robots.model_file import read_model_file
from prolepsis.robots.pr2 import PR2
from prolepsis.robots.robot_world import add_robot
from prolepsis.scenario.own_robot import OwnGripper, OwnRobot
from prolepsis.system.mujoco import mujoco

HERE = Path(__file__).parent
EXAMPLES = HERE.parents[1] / "examples"
FILES = (EXAMPLES / "own_arm.xml", HERE / "own_arm.urdf")
HOME = (0.0, -0.9, 1.7, 0.0, 0.3, 0.0)
FINGERS = {"fingers": ("left", "right")}
GRIPPER = OwnGripper(palm="palm", effector=FINGERS, tool=(0.08, 0.0, 0.0), home=HOME)


def own(file: Path, gripper: OwnGripper = GRIPPER) -> OwnRobot:
    return OwnRobot(file=str(file), grippers={"gripper1": gripper})


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.suffix)
def test_an_own_arm_puts_a_block_down_elsewhere(tmp_path: Path, file: Path) -> None:
    text = (EXAMPLES / "own_arm.toml").read_text(encoding="utf-8")
    for needed in (EXAMPLES / "own_arm.ttl", file):
        shutil.copy(needed, tmp_path)
    (tmp_path / "own_arm.toml").write_text(text.replace("own_arm.xml", file.name), encoding="utf-8")
    made = project(tmp_path / "own_arm.toml", out=tmp_path / "run")
    assert made.ask("holds(attached(gripper1, block1), T), after(T2, T), holds(supports(table1, block1), T2)")
    assert not made.ask("occurs(falling(block1), _)")
    block = made.log.poses[:, made.log.index("block1"), :3]
    # It is carried to where it should be within what a hand turns a block aside by.
    assert block[-1] - block[0] == pytest.approx((0.0, 0.2, 0.0), abs=5e-3)
    held = next(fact for fact in made.timeline.facts if fact.type == "attached")
    assert held.evidence["pad_force"] == pytest.approx(20.0, rel=0.01)
    loaded = Projection.load(tmp_path / "run").scenario
    assert isinstance(loaded.robot, OwnRobot)
    assert (loaded.path.parent / loaded.robot.file).read_bytes() == file.read_bytes()
    assert loaded.knowledge_base().parts("arm1") == ("gripper1",)


def test_both_files_are_the_same_arm() -> None:
    tools: list[tuple[float, ...]] = []
    for file in FILES:
        robot = load_robot(own(file), HERE)
        read = robot_model(robot)
        data, _ = read.at_home({"gripper1": 0.05})
        tools.append(tuple(data.body("palm").xpos))
        assert [joint.name for joint in robot.arms[0].joints] == ["pan", "lift", "elbow", "roll", "flex", "twist"]
        assert read.gaps["gripper1"].greatest == pytest.approx(0.08)
        assert robot.arms[0].gripper.max_force == pytest.approx(60.0)
        middle = (data.body("left_finger").xpos + data.body("right_finger").xpos) / 2
        # Fingers that open with opposite signs are on both sides of the middle.
        assert data.body("palm").xmat.reshape(3, 3).T @ (middle - data.body("palm").xpos) == pytest.approx((0.06, 0, 0))
    assert tools[0] == pytest.approx(tools[1], abs=1e-6)


def test_speeds_are_those_of_the_urdf_and_efforts_those_of_the_motors() -> None:
    arms = [load_robot(own(file), HERE).arms[0] for file in FILES]
    assert [joint.speed for joint in arms[1].joints] == [1.5, 1.5, 2.0, 3.0, 3.0, 3.0]
    model = robot_model(load_robot(own(FILES[0]), HERE)).model
    ranges = [model.jnt_actfrcrange[model.joint(name).id].tolist() for name in ("pan", "elbow", "twist")]
    assert ranges == [[-120.0, 120.0], [-80.0, 80.0], [-10.0, 10.0]]


def test_what_a_gripper_says_goes_before_what_is_computed() -> None:
    told = OwnGripper(
        palm="palm", effector=FINGERS, tool=(0.08, 0.0, 0.0), speed=1.0, stiffness=(900.0,) * 6, max_force=40.0
    )
    robot = load_robot(own(FILES[0], told), HERE)
    assert {(joint.speed, joint.stiffness) for joint in robot.arms[0].joints} == {(1.0, 900.0)}
    assert robot.arms[0].gripper.max_force == 40.0
    # Without a home, each joint is in the middle of its range.
    assert [joint.home for joint in robot.arms[0].joints] == pytest.approx([0.0, -0.3, 1.2, 0.0, 0.0, 0.0])


def test_the_gripper_frame_is_forward_and_from_pad_to_pad(tmp_path: Path) -> None:
    text = FILES[0].read_text(encoding="utf-8").replace('<body name="palm" pos="0.1 0 0">', TURNED_PALM)
    (tmp_path / "turned.xml").write_text(text, encoding="utf-8")
    palm = OwnGripper(palm="palm", effector=FINGERS, tool=(0.0, 0.0, 0.08), forward=(0.0, 0.0, 1.0), home=HOME)
    straight = load_robot(own(FILES[0]), HERE)
    turned = load_robot(own(tmp_path / "turned.xml", palm), tmp_path)
    for robot, forward in ((straight, (1.0, 0.0, 0.0)), (turned, (0.0, 0.0, 1.0))):
        w, x, y, z = robot.arms[0].gripper.tool_orientation
        first_axis = (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y))
        assert first_axis == pytest.approx(forward, abs=1e-9)


TURNED_PALM = '<body name="palm" pos="0.1 0 0" axisangle="0 1 0 1.5707963267948966">'


def test_a_robot_without_one_body_that_carries_all_gets_one(tmp_path: Path) -> None:
    file = tmp_path / "loose.xml"
    file.write_text(
        '<mujoco><worldbody><light/><geom type="plane" size="1 1 1"/><geom type="box" size=".1 .1 .1"/>'
        '<body name="link"><joint name="turn" axis="0 0 1"/><geom type="box" size=".1 .1 .1"/>'
        '<geom class="main" type="mesh" mesh="seen" contype="0" conaffinity="0" mass="0"/>'
        "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body></worldbody>"
        '<asset><mesh name="seen" file="nowhere.stl"/></asset></mujoco>',
        encoding="utf-8",
    )
    model = read_model_file(file).spec.compile()
    assert [model.body(b).name for b in range(model.nbody)] == ["world", "mount", "link"]
    assert model.geom_bodyid.tolist() == [1, 2]
    # No plane, nothing that is only seen; the rest touches things but not itself.
    assert set(zip(model.geom_contype.tolist(), model.geom_conaffinity.tolist(), strict=True)) == {(2, 1)}
    assert model.body_gravcomp[2] == 1.0


def test_fingers_that_turn_part_as_the_model_says() -> None:
    right = OwnGripper(
        palm="r_gripper_palm_link",
        effector={
            "fingers": ("r_gripper_l_finger_joint", "r_gripper_r_finger_joint"),
            "pads": ("r_gripper_l_finger_tip_link", "r_gripper_r_finger_tip_link"),
        },
        tool=(0.18, 0.0, 0.0),
        max_force=80.0,
    )
    base = ("base_x", "base_y", "base_yaw")
    own_pr2 = OwnRobot(file=str(PR2.file), base=base, torso=("torso_lift_joint",), grippers={"rightGripper": right})
    robot = load_robot(own_pr2, HERE)
    read, known = robot_model(robot).gaps["rightGripper"], robot_model(PR2).gaps["rightGripper"]
    assert read.gaps == pytest.approx(known.gaps) and read.ahead == pytest.approx(known.ahead, abs=1e-9)
    assert [joint.name for joint in robot.arms[0].joints] == [joint.name for joint in PR2.arms[0].joints]
    # The other arm and the head, which nothing names, hold still.
    assert {"torso_lift_joint", "head_pan_joint", "l_elbow_flex_joint"} < {joint.name for joint in robot.torso}


def test_objects_are_held_at_the_middle_of_the_pads() -> None:
    read = robot_model(PR2)
    for width in (0.02, 0.045, 0.08):
        data, _ = read.at_home({"rightGripper": width, "leftGripper": width})
        palm = data.body("r_gripper_palm_link")
        body = read.model.body("r_gripper_l_finger_tip_link").id
        pad = next(geom for geom in range(read.model.ngeom) if read.model.geom_bodyid[geom] == body)
        place = palm.xmat.reshape(3, 3).T @ (data.geom_xpos[pad] - palm.xpos)
        assert read.gaps["rightGripper"].held_at(width)[0] == pytest.approx(float(place[0]) - 0.18, abs=1e-3)
        assert np.isfinite(place).all()


def arm_at(y: float, number: int) -> str:
    """Return an arm that is mounted at ``y`` [m] on the trunk, in MJCF."""
    box = '<geom type="box" size=".02 .01 .01"/>'
    fingers = "".join(
        f'<body name="{side}{number}" pos=".06 {sign}.02 0"><joint name="{side}{number}" type="slide" '
        f'axis="0 {sign}1 0" range="0 .04"/>{box}</body>'
        for side, sign in (("left", ""), ("right", "-"))
    )
    return (
        f'<body name="link{number}" pos="0 {y} 0.5"><joint name="turn{number}" axis="0 0 1" range="-2 2"/>'
        f'<geom type="box" size=".1 .1 .1"/><body name="palm{number}" pos=".2 0 0">'
        f'<joint name="bend{number}" axis="0 1 0" range="-2 2"/><geom type="box" size=".02 .05 .02"/>'
        f"{fingers}</body></body>"
    )


def test_each_of_three_arms_touches_the_others_but_not_where_they_begin(tmp_path: Path) -> None:
    arms = "".join(arm_at(0.15 * k, k) for k in range(3))
    trunk = f'<body name="trunk"><geom type="box" size=".1 .6 .6"/>{arms}</body>'
    (tmp_path / "three.xml").write_text(f"<mujoco><worldbody>{trunk}</worldbody></mujoco>", encoding="utf-8")
    grippers = {
        f"gripper{k}": OwnGripper(
            palm=f"palm{k}", effector={"fingers": (f"left{k}", f"right{k}")}, tool=(0.06, 0.0, 0.0), max_force=20.0
        )
        for k in range(3)
    }
    robot = load_robot(OwnRobot(file="three.xml", grippers=grippers), tmp_path)
    spec = mujoco.MjSpec()
    add_robot(spec, robot, Thing(name="robot1", kind="Robot"), list(grippers))
    model = spec.compile()
    data = mujoco.MjData(model)
    # All links are beside each other and inside the trunk; then two palms are put into each other.
    mujoco.mj_forward(model, data)
    assert not data.ncon
    data.joint("robot1/turn0").qpos[0], data.joint("robot1/turn1").qpos[0] = 0.4, -0.4
    mujoco.mj_forward(model, data)
    touched = {frozenset(model.body(int(model.geom_bodyid[g])).name[-1] for g in pair) for pair in data.contact.geom}
    assert touched == {frozenset("01")}
