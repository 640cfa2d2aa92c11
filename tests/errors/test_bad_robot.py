"""Robots of the user's own that do not fit are refused with what is wrong, where, and what is allowed."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from prolepsis.projection import project
from prolepsis.terms.errors import InputError

ROOT = Path(__file__).parents[2]
EXAMPLE = (ROOT / "examples" / "own_arm.toml").read_text(encoding="utf-8")


def refused(folder: Path, text: str, model: str | None = None) -> str:
    """Return the message with which a scenario is refused."""
    for name in ("own_arm.ttl", "own_arm.xml"):
        shutil.copy(ROOT / "examples" / name, folder)
    shutil.copy(ROOT / "tests" / "robots" / "own_arm.urdf", folder)
    if model is not None:
        (folder / "own_arm.xml").write_text(model, encoding="utf-8")
    (folder / "own_arm.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as raised:
        project(folder / "own_arm.toml")
    message = str(raised.value)
    assert "\n" not in message
    return message


TABLE = [
    ('file = "own_arm.xml"', 'file = "other.xml"', "other.xml: cannot read the robot file: No such file or directory"),
    (
        'file = "own_arm.xml"',
        'fil = "own_arm.xml"',
        "own_arm.toml: robot: the key 'file' is missing; needed: file, grippers",
    ),
    (
        'name = "arm1"',
        'name = "Arm 1"',
        "robot: 'Arm 1' is no name; allowed: a lower-case letter, then letters, digits and _",
    ),
    (
        'name = "arm1"',
        'names = "arm1"',
        "own_arm.toml: robot: unknown key 'names'; did you mean 'name'?; known: file, folder, name",
    ),
    ('palm = "palm"\n', "", "robot.grippers.gripper1: the key 'palm' is missing; needed: palm, tool"),
    (
        'palm = "palm"',
        'palm = "hand"',
        "own_arm.xml: gripper gripper1: palm: no body named 'hand'; known: flange, forearm",
    ),
    ('palm = "palm"', 'palm = "flange"', "gripper1: the finger left moves on palm, not on the palm flange"),
    (
        '"left", "right"',
        '"left", "rite"',
        "gripper1: fingers: no joint named 'rite'; did you mean 'right'?; known: elbow, flex",
    ),
    ('"left", "right"', '"left", "left"', "gripper1: fingers: two joints of two fingers are needed"),
    ('"left", "right"', '"left"', "robot.grippers.gripper1.fingers.1: is missing"),
    ("tool = [0.08, 0, 0]", "tool = [0.08, 0]", "robot.grippers.gripper1.tool.2: is missing"),
    ("tool = [0.08, 0, 0]", "tool = [1, 2, 3, 4]", "robot.grippers.gripper1.tool: has 4 items; allowed: at most 3"),
    ("tool = [0.08, 0, 0]", 'tool = "front"', "robot.grippers.gripper1.tool: give a list"),
    ('"left", "right"]', '"left", "right"]\nspeed = "fast"', "gripper1.speed: give a number, not 'fast'"),
    (
        "tool = ",
        "forward = [0, 1, 0]\ntool = ",
        "forward must point from the palm to the fingertips, not from pad to pad: [0.0, 1.0, 0.0]",
    ),
    (
        "tool = ",
        "forward = [-1, 0, 0]\ntool = ",
        "forward must point from the palm to the fingertips, not back: [-1.0, 0.0, 0.0], while the tool is at [0.08, 0",
    ),
    ("tool = ", 'pads = ["palm", "wheel"]\ntool = ', "gripper1: pads: no body or geom named 'wheel'"),
    ("tool = ", 'joints = ["pan", "lift", "bend"]\ntool = ', "gripper1.joints: no joint named 'bend'; known: elbow"),
    (
        "tool = ",
        'joints = ["lift", "pan"]\ntool = ',
        "joints: lift, pan are not in this order on the way from the root to the palm palm; on it are: pan, lift",
    ),
    (
        "[0.0, -0.9, 1.7, 0.0, 0.3, 0.0]",
        "[0.0, -0.9]",
        "gripper1: home has 2 values for 6 joints: pan, lift, elbow, roll, flex, twist",
    ),
    ("[0.0, -0.9, 1.7,", "[0.0, -0.9, 2.7,", "gripper1: home of elbow is 2.7, allowed -0.2 to 2.6"),
    ("tool = ", "speed = -1\ntool = ", "robot.grippers.gripper1.speed"),
    ("tool = ", "speed = [1, 2]\ntool = ", "gripper1: speed has 2 values for 6 joints"),
    ("[robot]", '[robot]\ntorso = ["wrist"]', "own_arm.xml: torso: no joint named 'wrist'"),
    (
        "tool = ",
        'kind = "jaws"\ntool = ',
        "robot.grippers.gripper1.kind: no kind of effector named 'jaws'; did you mean 'jaw'?; known: jaw, parallel",
    ),
    ("fingers = ", "fingrs = ", "robot.grippers.gripper1: unknown key 'fingrs'; did you mean 'fingers'?; known: palm"),
    ("tool = ", 'kind = "jaw"\ntool = ', "robot.grippers.gripper1: unknown key 'fingers'; known: palm, tool, forward"),
    (
        "tool = ",
        'jaw = "left"\ntool = ',
        "gripper1: its keys do not tell one kind of effector; needed: palm, tool and jaw (jaw) or fingers (parallel)",
    ),
]


@pytest.mark.parametrize(("old", "new", "message"), TABLE, ids=[new for _, new, _ in TABLE])
def test_a_bad_robot_table(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert EXAMPLE.count(old) == 1
    assert message in refused(tmp_path, EXAMPLE.replace(old, new))


JAW = [
    ('jaw = "jaw"', 'jaw = "roll"', "own_jaw.xml: gripper gripper1: the jaw roll moves on wrist, not on the palm palm"),
    (
        "tool = ",
        "forward = [-1, 0, 0]\ntool = ",
        "gripper1: forward must point from the palm to the fingertips, not back",
    ),
    ('jaw = "jaw"', "jaw = 3", "own_jaw.toml: robot.grippers.gripper1.jaw: give a text in quotes, not 3"),
    (
        '"fixed_jaw", "moving_jaw"',
        '"moving_jaw", "fixed_jaw"',
        "gripper1: pads: the first stands still on the palm, moving_jaw moves",
    ),
    ('"moving_jaw"', '"palm"', "gripper1: pads: the second moves with the jaw jaw, palm does not"),
    ('"moving_jaw"', '"movin_jaw"', "pads: no body or geom named 'movin_jaw'; did you mean 'moving_jaw'?"),
    ("[0.0975, 0.0115, 0]", "[0.0975, -0.005, 0]", "tool must lie between the pads, [0.0975, -0.005, 0.0] is inside"),
    ("tool = ", "forward = [0, 1, 0]\ntool = ", "gripper1: forward must point from the palm to the fingertips"),
]


@pytest.mark.parametrize(("old", "new", "message"), JAW, ids=[new for _, new, _ in JAW])
def test_a_bad_jaw(tmp_path: Path, old: str, new: str, message: str) -> None:
    for name in ("own_jaw.ttl", "own_jaw.xml"):
        shutil.copy(ROOT / "examples" / name, tmp_path)
    text = (ROOT / "examples" / "own_jaw.toml").read_text(encoding="utf-8")
    assert text.count(old) == 1
    (tmp_path / "own_jaw.toml").write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(InputError, match=re.escape(message)):
        project(tmp_path / "own_jaw.toml")


def test_a_jaw_that_turns_aside(tmp_path: Path) -> None:
    shutil.copy(ROOT / "examples" / "own_jaw.ttl", tmp_path)
    shutil.copy(ROOT / "examples" / "own_jaw.toml", tmp_path)
    model = (ROOT / "examples" / "own_jaw.xml").read_text(encoding="utf-8")
    for axis in ("1 0.2 0", "1 0 0", "0.8 0 0.6"):
        turned = model.replace(
            '<joint name="jaw" axis="0 0 1" range="-0.17 1.745"', f'<joint name="jaw" axis="{axis}" range="0.2 1.2"'
        )
        assert turned != model
        (tmp_path / "own_jaw.xml").write_text(turned, encoding="utf-8")
        with pytest.raises(
            InputError, match="the jaw jaw turns aside: its axis .* must be across both forward and the"
        ):
            project(tmp_path / "own_jaw.toml")


def test_a_jaw_that_slides(tmp_path: Path) -> None:
    shutil.copy(ROOT / "examples" / "own_jaw.ttl", tmp_path)
    shutil.copy(ROOT / "examples" / "own_jaw.toml", tmp_path)
    model = (ROOT / "examples" / "own_jaw.xml").read_text(encoding="utf-8")
    assert model.count('<joint name="jaw"') == 1
    (tmp_path / "own_jaw.xml").write_text(model.replace('<joint name="jaw"', '<joint type="slide" name="jaw"'), "utf-8")
    with pytest.raises(InputError, match="the jaw jaw slides; allowed: a joint that turns"):
        project(tmp_path / "own_jaw.toml")


SECOND = EXAMPLE + EXAMPLE[EXAMPLE.index("[robot.grippers") :].replace("gripper1", "gripper2")


def test_a_robot_that_is_neither_name_nor_table(tmp_path: Path) -> None:
    text = EXAMPLE[: EXAMPLE.index("[robot]")].replace("seed = 1", "seed = 1\nrobot = 3")
    assert "own_arm.toml: robot = 3: give a name, or a table [robot] with file and grippers" in refused(tmp_path, text)


def test_arms_that_share_a_joint(tmp_path: Path) -> None:
    assert "the joint pan is on the way to gripper1 and to gripper2; list it under torso" in refused(tmp_path, SECOND)


MODEL = (ROOT / "examples" / "own_arm.xml").read_text(encoding="utf-8")
MOTORS = """    <motor joint="left" forcerange="-60 60"/>
    <motor joint="right" forcerange="-60 60"/>
"""
IN_MODEL = [
    ("<worldbody>", "<worldbody", "own_arm.xml: the robot cannot be read: XML"),
    (
        '<body name="pedestal">',
        '<body name="pedestal"><freejoint/>',
        "own_arm.xml: pedestal is a free joint; allowed: hinge and slide",
    ),
    (
        'class="finger" range="-0.04 0"',
        'class="finger" range="-0.06 0"',
        "its fingers do not move alike: left by 0 to 0.04, right by 0 to 0.06 when opening",
    ),
    (MOTORS, "", "gripper1: nothing tells the greatest force of its pads; give max_force [N]"),
    (
        '<geom type="box" size="0.04 0.005 0.01" pos="0 -0.005 0" rgba="0.2 0.2 0.2 1"/>',
        "",
        "right_finger has no geom that can touch; give pads",
    ),
    (
        'type="sphere" size="0.04"',
        'type="mesh" mesh="m"',
        "own_arm.xml: meshes are missing: wrist.stl; looked for beside the file",
    ),
    (
        'type="sphere" size="0.04"',
        'type="mesh" mesh="d"',
        "the mesh wrist.dae cannot be read; allowed: .msh, .obj, .stl",
    ),
]
ASSETS = {
    'mesh="m"': '<asset><mesh name="m" file="wrist.stl"/></asset>',
    'mesh="d"': '<asset><mesh name="d" file="wrist.dae"/></asset>',
}


@pytest.mark.parametrize(("old", "new", "message"), IN_MODEL, ids=[m[2][:40] for m in IN_MODEL])
def test_a_bad_model(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert MODEL.count(old) == 1
    model = MODEL.replace(old, new)
    for needle, asset in ASSETS.items():
        if needle in new:
            model = model.replace("<worldbody>", asset + "<worldbody>")
    assert message in refused(tmp_path, EXAMPLE, model)


def test_a_urdf_whose_meshes_are_missing(tmp_path: Path) -> None:
    urdf = (ROOT / "tests" / "robots" / "own_arm.urdf").read_text(encoding="utf-8")
    for name, solid in (("wrist", '<sphere radius="0.04"/>'), ("turret", '<cylinder radius="0.08" length="0.1"/>')):
        assert urdf.count(solid) == 1
        urdf = urdf.replace(solid, f'<mesh filename="package://my_arm/meshes/{name}.stl"/>')
    text = EXAMPLE.replace("own_arm.xml", "meshes.urdf")
    (tmp_path / "meshes.urdf").write_text(urdf, encoding="utf-8")
    missing = "meshes are missing: package://my_arm/meshes/turret.stl, package://my_arm/meshes/wrist.stl"
    assert missing in refused(tmp_path, text)


IN_PLAN = [
    (
        "grasp(gripper1, block1, Force)",
        "grasp(gripper2, block1, Force)",
        "plan: hand of grasp(gripper2,block1,20.0): no gripper named 'gripper2'; did you mean 'gripper1'?; known",
    ),
    (
        "grasp(gripper1, block1, Force)",
        "grasp(gripper1, table1, Force)",
        "plan: table1 is not graspable: 602 mm wide between the pads, gripper1 opens 80 mm",
    ),
    ("value = 20", "value = 70", "plan: force of grasp(gripper1,block1,70.0) is 70 N, gripper1 can do 60 N at most"),
    ("[0, 0.2, 0])", "[0, 0.2, 0], 1, 3)", "plan: speed of carry(gripper1,[0,0.2,0],1,3) is 3 m/s, gripper1 can do"),
    (
        "[0, 0.2, 0])",
        "[0, 0.2, 0], 29)",
        "plan: acceleration of carry(gripper1,[0,0.2,0],29) is 29 m/s2, gripper1 can do",
    ),
]


@pytest.mark.parametrize(("old", "new", "message"), IN_PLAN, ids=[new for _, new, _ in IN_PLAN])
def test_a_plan_that_asks_too_much(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert EXAMPLE.count(old) == 1
    assert message in refused(tmp_path, EXAMPLE.replace(old, new))


def test_what_is_out_of_reach_is_an_outcome(tmp_path: Path) -> None:
    for name in ("own_arm.ttl", "own_arm.xml"):
        shutil.copy(ROOT / "examples" / name, tmp_path)
    situation = (tmp_path / "own_arm.ttl").read_text(encoding="utf-8")
    (tmp_path / "own_arm.ttl").write_text(situation.replace("-0.65", "-1.3"), encoding="utf-8")
    (tmp_path / "own_arm.toml").write_text(EXAMPLE, encoding="utf-8")
    timeline = project(tmp_path / "own_arm.toml").timeline
    actions = {fact.type: fact.evidence for fact in timeline.facts if fact.type in ("grasping", "lifting")}
    assert list(actions) == ["grasping"]
    assert actions["grasping"]["outcome"] == "unreachable"
    assert "block1 by gripper1: stays" in str(actions["grasping"]["reason"])
