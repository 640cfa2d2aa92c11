"""Whatever MuJoCo loads is read, or refused with a reason: each trap of models from elsewhere in a few lines."""

from __future__ import annotations

import struct
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from prolepsis.robots.loading import load_robot
from prolepsis.robots.model_file import ModelFile, read_model_file
from prolepsis.scenario.own_robot import OwnGripper, OwnRobot
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import ScenarioError

SEEN = 'contype="0" conaffinity="0"'
WEIGHS = '<inertial pos="0 0 0" mass="1" diaginertia=".1 .1 .1"/>'
TETRAHEDRON = 'vertex="0 0 0 .1 0 0 0 .1 0 0 0 .1"'
MARK = '<body name="mark" mocap="true"><geom size=".01"/></body>'
MATERIALS = (
    '<default><geom material="red"/><site material="red"/><tendon material="red"/>'
    '<default class="own"><geom material="grey"/></default></default>'
    '<asset><material name="red" rgba="1 0 0 1"/><material name="grey" rgba=".2 .2 .2 1"/></asset>'
)


def model(more: str = "", *, palm: str = "", beside: str = "") -> str:
    """Return a hand on a lift, with more before its world, in its palm and beside it."""
    fingers = "".join(
        f'<body name="{name}" pos=".04 {side}.02 0"><joint name="{name}" type="slide" axis="0 {side}1 0" '
        f'range="0 .05"/><geom name="{name}" type="box" size=".03 .005 .01"/><site name="{name}"/></body>'
        for name, side in (("left", ""), ("right", "-"))
    )
    return (
        f'<mujoco>{more}<worldbody>{beside}<body name="base"><geom name="base" size=".1"/><body name="palm" '
        f'pos="0 0 .3"><joint name="lift" type="slide" axis="0 0 1" range="0 .5"/><geom name="palm" type="box" '
        f'size=".02 .04 .02"/>{palm}{fingers}</body></body></worldbody></mujoco>'
    )


def stl() -> bytes:
    """Return a tetrahedron."""
    corners = ((0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1))
    faces = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
    triangles = (struct.pack("<12fH", 0, 0, 0, *(x for k in face for x in corners[k]), 0) for face in faces)
    return bytes(80) + struct.pack("<I", len(faces)) + b"".join(triangles)


def read(folder: Path, text: str, name: str = "robot.xml") -> tuple[ModelFile, Any]:
    """Return a robot that is read, and its model, written and read again as a world's is."""
    (folder / name).write_text(text, encoding="utf-8")
    file = read_model_file(folder / name, tried=True)
    return file, mujoco.MjSpec.from_string(file.spec.to_xml()).compile()


def refused(folder: Path, text: str, name: str = "robot.xml") -> str:
    """Return the reason for which a robot is refused."""
    with pytest.raises(ScenarioError) as raised:
        read(folder, text, name)
    said = str(raised.value).replace(f"{folder / name}: ", "")
    assert "\n" not in said and str(folder) not in said
    return said


def touching(read_model: Any) -> int:
    return int(np.count_nonzero(read_model.geom_contype))


TAME = {
    "materials in defaults": model(MATERIALS),
    "a mesh in a default that nothing uses": model(
        '<default><default class="seen"><geom type="mesh" mesh="m"/></default></default>'
        f'<asset><mesh name="m" {TETRAHEDRON}/></asset>'
    ),
    "a mesh in a default for what is seen": model(
        f'<default><default class="seen"><geom type="mesh" mesh="m" {SEEN}/></default></default>'
        f'<asset><mesh name="m" {TETRAHEDRON}/></asset>',
        palm=f'{WEIGHS}<geom class="seen"/>',
    ),
    "a mesh that tells how it looks": model(
        f'<asset><material name="m"/><mesh name="m" material="m" content_type="model/obj" {TETRAHEDRON}/></asset>',
        palm='<geom type="mesh" mesh="m"/>',
    ),
    "nested defaults": model(
        '<default><joint damping="1"/><default class="a"><joint armature="2"/><default class="b"><joint damping="3"/>'
        "</default></default></default>",
        palm='<body name="more" childclass="b"><joint name="more"/><geom size=".01"/></body>',
    ),
    "a tendon about what is only seen": model(
        '<tendon><spatial name="t" range="0 1"><site site="left"/><geom geom="w"/><site site="right"/></spatial>'
        "</tendon>",
        palm=f'{WEIGHS}<geom name="w" type="cylinder" size=".01 .02" {SEEN}/>',
    ),
    "weight by shapes alone": model('<compiler inertiafromgeom="true"/>', palm=f'{WEIGHS}<geom size=".1" {SEEN}/>'),
    "a total mass": model('<compiler settotalmass="7"/>'),
    "degrees and another order of angles": model(
        '<compiler angle="degree" eulerseq="zyx"/>',
        palm='<body euler="10 20 30"><joint name="more" range="-90 90"/><geom size=".01"/></body>',
    ),
    "limits that are told": model('<compiler autolimits="false"/>').replace("range", 'limited="true" range'),
    "frames and replications": model(
        palm='<frame pos="0 0 1" euler="0 0 30"><replicate count="3" offset=".1 0 0" sep="-"><body name="more">'
        '<joint name="more"/><geom size=".01"/></body></replicate></frame>'
    ),
    "bodies and joints without names": model(
        palm='<body><joint/><geom size=".01"/></body><body name="body3"><joint name="joint2"/><geom size=".01"/></body>'
    ),
    "a motor with windings": model('<actuator><dcmotor joint="lift" motorconst="1 1" resistance="1"/></actuator>'),
    "a muscle": model('<actuator><muscle joint="lift" lengthrange="0 1"/><muscle joint="left" force="3"/></actuator>'),
    "motors that wait": model(
        '<actuator><general joint="lift" dyntype="filter" actrange="0 1"/><intvelocity joint="left" actrange="0 1"/>'
        '<adhesion body="palm" ctrlrange="0 1"/><cylinder joint="right"/></actuator>'
    ),
    "couplings": model(
        '<equality><connect site1="left" site2="right"/><weld body1="base"/><tendon tendon1="l" tendon2="r"/>'
        '<joint joint1="left" joint2="right"/></equality><tendon><fixed name="l"><joint joint="left" coef="1"/></fixed>'
        '<fixed name="r"><joint joint="right" coef="1"/></fixed></tendon>'
    ),
    "all that is not the robot": model(
        '<option timestep="1"/><size nkey="3" memory="1M"/><statistic extent="1"/><custom/>'
        '<sensor><touch site="left"/></sensor><asset><texture name="t" builtin="flat" width="2" height="2" type="2d"/>'
        '<material name="m" texture="t"/></asset>',
        palm='<camera/><light/><site name="m" material="m"/>',
    ),
}


@pytest.mark.parametrize("text", TAME.values(), ids=TAME)
def test_a_robot_is_built_as_mujoco_builds_it(tmp_path: Path, text: str) -> None:
    _, read_model = read(tmp_path, text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        whole: Any = mujoco.MjModel.from_xml_string(text)
    assert (read_model.nbody, read_model.njnt, read_model.neq) == (whole.nbody, whole.njnt, whole.neq)
    for what in (
        "body_mass",
        "body_inertia",
        "jnt_range",
        "jnt_limited",
        "dof_damping",
        "dof_armature",
        "tendon_range",
    ):
        assert getattr(read_model, what) == pytest.approx(getattr(whole, what), rel=1e-4, abs=1e-9), what
    places: list[Any] = []
    for each in (read_model, whole):
        data = mujoco.MjData(each)
        mujoco.mj_kinematics(each, data)
        places.append(np.hstack([data.xpos, data.xquat]))
    assert places[0] == pytest.approx(places[1], abs=1e-5)
    assert touching(read_model) == touching(whole)
    assert all(read_model.body(b).name for b in range(1, read_model.nbody))
    assert all(read_model.joint(j).name for j in range(read_model.njnt))


def test_a_colour_is_the_geoms_own_or_that_of_its_material(tmp_path: Path) -> None:
    palm = '<geom name="a" size=".01" class="own"/><geom name="b" size=".01" rgba="0 1 0 1"/>'
    _, read_model = read(tmp_path, model(MATERIALS, palm=palm))
    colours = [tuple(read_model.geom(name).rgba) for name in ("palm", "a", "b")]
    assert colours == [pytest.approx(rgba) for rgba in ((1, 0, 0, 1), (0.2, 0.2, 0.2, 1), (0, 1, 0, 1))]


def test_a_mark_that_drags_a_robot_goes_with_its_weld(tmp_path: Path) -> None:
    more = (
        '<equality><weld body1="mark" body2="palm"/><joint joint1="left" joint2="right"/></equality>'
        '<contact><exclude body1="mark" body2="palm"/></contact>'
        '<keyframe><key name="home" qpos=".2 0 0" mpos="0 0 1" mquat="1 0 0 0"/></keyframe>'
    )
    file, read_model = read(tmp_path, model(more, beside=MARK))
    assert file.home["lift"] == 0.2
    assert [read_model.body(b).name for b in range(read_model.nbody)] == ["world", "base", "palm", "left", "right"]
    assert (read_model.neq, read_model.nexclude) == (1, 0)


def test_a_robot_that_hangs_on_a_mark_stands_still(tmp_path: Path) -> None:
    _, read_model = read(tmp_path, model().replace('name="base"', 'name="base" mocap="true"', 1))
    assert read_model.njnt == 3 and read_model.nmocap == 0


def test_what_touches_by_a_pair_touches_but_not_the_robot(tmp_path: Path) -> None:
    more = '<contact><pair geom1="tip" geom2="base"/><pair geom1="floor" geom2="tip"/></contact>'
    palm = f'{WEIGHS}<geom name="tip" size=".01" {SEEN}/>'
    floor = '<geom name="floor" type="plane" size="1 1 1"/>'
    _, read_model = read(tmp_path, model(more, palm=palm, beside=floor))
    assert read_model.npair == 0 and touching(read_model) == 5


def test_a_floor_goes_wherever_it_stands(tmp_path: Path) -> None:
    floor = '<body name="room"><geom type="plane" size="1 1 1"/></body>'
    _, read_model = read(tmp_path, model(beside=floor))
    assert mujoco.mjtGeom.mjGEOM_PLANE not in read_model.geom_type


def test_a_keyframe_tells_home_whatever_its_motors_did_there(tmp_path: Path) -> None:
    more = (
        '<actuator><position joint="lift" timeconst=".1"/></actuator>'
        '<keyframe><key name="home" qpos=".2 .01 .01" act=".2" ctrl=".2" qvel="0 0 0"/></keyframe>'
    )
    assert read(tmp_path, model(more))[0].home == {"lift": 0.2, "left": 0.01, "right": 0.01}


def test_the_effort_of_any_motor_is_read(tmp_path: Path) -> None:
    more = (
        '<default><general forcerange="-7 7"/></default><actuator><dcmotor joint="lift" motorconst="1 1" '
        'resistance="1" forcerange="-3 3"/><position joint="left" kp="9"/></actuator>'
    )
    assert read(tmp_path, model(more))[0].efforts == {"lift": 3.0, "left": 7.0}


def test_a_robot_with_a_mount_of_its_own_gets_another(tmp_path: Path) -> None:
    text = model(palm='<body name="mount"><geom size=".01"/></body>', beside='<geom type="box" size=".1 .1 .1"/>')
    assert read(tmp_path, text)[1].body(1).name == "mount_"


def test_a_joint_without_a_name_holds_still_at_home(tmp_path: Path) -> None:
    text = model(
        '<keyframe><key name="home" qpos=".1 .5 0 0"/></keyframe>', palm='<body><joint/><geom size=".1"/></body>'
    )
    assert read(tmp_path, text)[0].home == {"lift": 0.1, "joint1": 0.5, "left": 0.0, "right": 0.0}


@pytest.mark.parametrize(
    ("named", "options"),
    [
        ("m.stl", 'meshdir="shapes"'),
        ("m.stl", 'assetdir="shapes"'),
        ("shapes/m.stl", ""),
        ("a/b/m.stl", 'meshdir="shapes" strippath="true"'),
    ],
)
def test_a_mesh_is_found_where_mujoco_finds_it(tmp_path: Path, named: str, options: str) -> None:
    (tmp_path / "shapes").mkdir()
    (tmp_path / "shapes" / "m.stl").write_bytes(stl())
    text = model(
        f'<compiler {options}/><asset><mesh file="{named}" scale="2 2 -2"/></asset>',
        palm='<geom type="mesh" mesh="m"/>',
    )
    assert read(tmp_path, text)[1].mesh_vert.max() == pytest.approx(
        mujoco.MjModel.from_xml_path(str(tmp_path / "robot.xml")).mesh_vert.max()
    )


@pytest.mark.parametrize("deep", ["more/deep.xml", "deep.xml"])
def test_an_include_is_found_from_the_robot_or_from_what_includes_it(tmp_path: Path, deep: str) -> None:
    (tmp_path / "more").mkdir()
    (tmp_path / "more" / "first.xml").write_text(f'<mujocoinclude><include file="{deep}"/></mujocoinclude>', "utf-8")
    (tmp_path / "more" / "deep.xml").write_text('<mujoco><body name="deep"/></mujoco>', "utf-8")
    text = model(beside='<include file="more/first.xml"/>')
    assert read(tmp_path, text)[1].body("deep").id
    assert mujoco.MjModel.from_xml_path(str(tmp_path / "robot.xml")).body("deep").id


def test_files_of_a_folder_above_are_used_if_the_table_names_it(tmp_path: Path) -> None:
    (tmp_path / "models").mkdir()
    (tmp_path / "shapes").mkdir()
    (tmp_path / "shapes" / "m.stl").write_bytes(stl())
    (tmp_path / "shapes" / "motors.xml").write_text("<mujoco><actuator/></mujoco>", "utf-8")
    path = tmp_path / "models" / "robot.xml"
    text = model(
        '<compiler meshdir="../shapes"/><asset><mesh file="m.stl"/></asset>', palm='<geom type="mesh" mesh="m"/>'
    )
    said = refused(tmp_path / "models", text)
    assert said == (
        "meshes are outside the robot's folder: m.stl; allowed: files there, or in the one above it that folder in "
        "[robot] names"
    )
    path.write_text(text.replace("<compiler", '<include file="../shapes/motors.xml"/><compiler'), "utf-8")
    with pytest.raises(ScenarioError, match="is not in the robot's folder; allowed: .* that folder in .robot. names"):
        read_model_file(path)
    assert len(read_model_file(path, tmp_path).spec.meshes) == 1
    with pytest.raises(ScenarioError, match=r"the robot is not in the folder .*shapes; allowed: one above it"):
        read_model_file(path, tmp_path / "shapes")
    hand = OwnGripper(palm="palm", effector={"fingers": ("left", "right")}, tool=(0.05, 0.0, 0.0), max_force=20.0)
    own = OwnRobot(file="models/robot.xml", folder=".", grippers={"hand1": hand})
    assert [joint.name for joint in load_robot(own, tmp_path).arms[0].joints] == ["lift"]


INERTIA = '<inertial><mass value="1"/><inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial>'
NOTHING = INERTIA.replace('"1"', '"0"').replace(".1", "0")


def urdf(more: str = "", *, root: str = INERTIA, kind: str = "revolute", link: str = INERTIA) -> str:
    """Return two links and a joint, with more beside them."""
    return (
        f'<?xml version="1.0"?><robot name="r"><link name="a">{root}</link><link name="b">{link}</link>'
        f'<joint name="j" type="{kind}"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
        f'<limit lower="-1" upper="1" effort="5" velocity="2"/></joint>{more}</robot>'
    )


FOLLOWER = (
    f'<link name="c">{INERTIA}</link><joint name="k" type="revolute"><parent link="b"/><child link="c"/>'
    '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="5" velocity="2"/><mimic joint="j" multiplier="2"/></joint>'
)
PLACE = '<joint name="f" type="fixed"><parent link="b"/><child link="tip"/><origin xyz="0 0 1"/></joint>'
DESCRIPTIONS = {
    "a root without weight": (urdf(root=""), 1),
    "a root that weighs nothing": (urdf(root=NOTHING), 1),
    "a place without weight": (urdf(f'<link name="tip"/>{PLACE}'), 1),
    "a place that weighs nothing": (urdf(f'<link name="tip">{NOTHING}</link>{PLACE}'), 1),
    "no limits": (urdf(kind="continuous"), 1),
    "a joint that follows": (urdf(FOLLOWER), 2),
    "what other programs read": (urdf('<gazebo/><transmission name="t"><actuator name="m"/></transmission>'), 1),
}


@pytest.mark.parametrize(("text", "joints"), DESCRIPTIONS.values(), ids=DESCRIPTIONS)
def test_a_description_is_read_with_all_its_links(tmp_path: Path, text: str, joints: int) -> None:
    file, read_model = read(tmp_path, text, "robot.urdf")
    assert {"a", "b"} < {read_model.body(b).name for b in range(read_model.nbody)}
    assert read_model.njnt == joints and file.speeds["j"] == 2.0 and file.efforts["j"] == 5.0
    assert read_model.neq == joints - 1


def mesh_of(file: str) -> str:
    """Return a mesh that a link touches with."""
    return f'<collision><geometry><mesh filename="{file}"/></geometry></collision>'


REASONS = {
    "a joint that floats": (
        urdf(kind="floating"),
        "j is a free joint; allowed: hinge and slide (what lies loose belongs in the situation)",
    ),
    "what is not written out": (
        urdf('<xacro:include filename="x.xacro"/>'),
        "robot holds a xacro:include; allowed: a URDF that xacro has written out",
    ),
    "a mesh that MuJoCo does not read": (
        urdf(link=INERTIA + mesh_of("m.dae")),
        "the mesh m.dae cannot be read; allowed: .msh, .obj, .stl",
    ),
    "a mesh with a long path": (
        urdf(link=INERTIA + mesh_of("package://" + "very/" * 30 + "far/away.stl")),
        "meshes are missing: ...very/very/very/very/very/very/very/very/very/far/away.stl; looked for",
    ),
    "a mesh in words": (
        urdf(link=INERTIA + mesh_of("words.stl")),
        "number of faces should be between 1 and 200000 in STL file 'words.stl'",
    ),
    "a link that moves but weighs nothing": (urdf(link=""), "bodies must be larger than mjMINVAL Element name 'b'"),
}


@pytest.mark.parametrize(("text", "reason"), REASONS.values(), ids=REASONS)
def test_a_description_is_refused_by_the_name_of_what_is_wrong(tmp_path: Path, text: str, reason: str) -> None:
    (tmp_path / "words.stl").write_text("solid words\n" * 100, encoding="utf-8")
    assert reason in refused(tmp_path, text, "robot.urdf")


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (model(beside='<body name="egg"><freejoint name="e"/><geom size=".1"/></body>'), "e is a free joint; allowed"),
        (model(palm='<body name="ball"><joint type="ball"/><geom size=".1"/></body>'), "ball is a ball joint; allowed"),
        (model(palm='<geom type="plane" size="1 1 1"/>'), "palm has a plane to touch with; allowed: box, sphere"),
        (model('<extension><plugin plugin="mujoco.pid"/></extension>'), "mujoco holds a extension; allowed: actuator"),
        (model(palm='<body name="left"><geom size=".1"/></body>'), "repeated name 'left' in body Element 'body'"),
    ],
)
def test_a_model_is_refused_by_the_name_of_what_is_wrong(tmp_path: Path, text: str, reason: str) -> None:
    said = refused(tmp_path, text)
    # What MuJoCo is given is one line, so that its numbers of lines would mislead.
    assert reason in said and "line" not in said
