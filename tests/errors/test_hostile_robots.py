"""A robot's file from a stranger costs nothing but a message: no memory, no time, no other file, no crash."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

import pytest
from tests.errors.test_bad_robot import EXAMPLE, MODEL, refused

from prolepsis.robots.model_file import read_model_file
from prolepsis.robots.trial import try_robot
from prolepsis.terms.errors import ScenarioError

URDF = '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute"><parent link="a"/>'
SPHERE = '<geom size="0.01"/>'


def in_model(extra: str) -> str:
    """Return the example's model with more before its world."""
    return MODEL.replace("<worldbody>", f"{extra}<worldbody>", 1)


def in_world(extra: str) -> str:
    """Return the example's model with more in its world."""
    return MODEL.replace("<worldbody>", f"<worldbody>{extra}", 1)


def replicated(*counts: str) -> str:
    """Return a sphere in nested replications."""
    return "".join(f'<replicate count="{n}">' for n in counts) + SPHERE + "</replicate>" * len(counts)


BOMB = '<!DOCTYPE m [<!ENTITY a "lol"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;">]>'
FLOODS = {
    "entity bomb": (BOMB + MODEL.replace("own arm", "&b;"), "a document type (<!DOCTYPE ...>) is not allowed"),
    "entity bomb in a URDF": (f'{BOMB}<robot name="&b;"/>', "a document type (<!DOCTYPE ...>) is not allowed"),
    "external entity": (
        '<!DOCTYPE m [<!ENTITY a SYSTEM "file:///etc/passwd">]><mujoco model="&a;"/>',
        "a document type (<!DOCTYPE ...>) is not allowed",
    ),
    "external types": ('<!DOCTYPE m SYSTEM "http://localhost/m.dtd"><mujoco/>', "a document type"),
    "height field": (
        in_model('<asset><hfield name="h" nrow="100000" ncol="100000" size="1 1 1 1"/></asset>'),
        "hfield",
    ),
    "user data": (in_model('<size nuserdata="2000000000"/>'), "size: nuserdata=2000000000; allowed: up to 1000000"),
    "memory": (in_model('<size memory="2T"/>'), "size: memory=2T; allowed: up to 1000000, and 1G of memory"),
    "no number of keys": (in_model('<size nkey="nan"/>'), "size: nkey=nan; allowed"),
    "replications": (in_world(replicated("100000000")), "the robot has 1e+08 elements; allowed: 20000"),
    "nested replications": (in_world(replicated("1000", "1000", "1000")), "elements; allowed: 20000"),
    "endless replications": (in_world(replicated("1e400")), "elements; allowed: 20000"),
    "replications that are none": (in_world(replicated("nan")), "replicate: count=nan: is no whole number above 0"),
    "many elements": (in_world(SPHERE * 30_000), "too many elements"),
    "deep elements": (in_world("<body>" * 500 + "</body>" * 500), "too many elements"),
    "a flex": (in_world('<flexcomp name="f" type="grid" count="1000 1000 1000"/>'), "worldbody holds a flexcomp"),
    "a composite": (in_world('<composite type="cable" count="100000000 1 1"/>'), "worldbody holds a composite"),
    "another model": (in_model('<asset><model name="m" file="/etc/passwd"/></asset>'), "asset holds a model; allowed"),
    "a plugin": (
        in_model('<extension><plugin plugin="x"/></extension>'),
        "mujoco holds a extension; allowed: actuator",
    ),
    "a made mesh": (
        in_model('<asset><mesh name="m" builtin="sphere" params="9999999"/></asset>'),
        "mesh has builtin; allowed",
    ),
    "no mass": (MODEL.replace('mass="40"', 'mass="nan"'), "inertial: mass holds nan; allowed: numbers up to 1e+18"),
    "endless mass": (
        MODEL.replace('mass="40"', 'mass="inf"'),
        "inertial: mass holds inf; allowed: numbers up to 1e+18",
    ),
    "huge mass": (MODEL.replace('mass="40"', 'mass="1e300"'), "inertial: mass holds 1e+300; allowed"),
    "long name": (MODEL.replace('name="palm"', f'name="{"p" * 10_000}"'), "body: name is longer than 250 characters"),
    "an include outside": (in_model('<include file="../../../../etc/passwd"/>'), "is not in the robot's folder"),
    "an absolute include": (in_model('<include file="/etc/passwd"/>'), "is not in the robot's folder"),
    "a device": (in_model('<include file="/dev/zero"/>'), "is not in the robot's folder"),
    "itself": (in_model('<include file="own_arm.xml"/>'), "is included twice, or includes itself"),
    "nothing": ("", "the robot cannot be read: XML"),
    "rubbish": ("\x00\x01\x02", "the robot cannot be read: XML"),
    "another language": ("<html/>", "it is a <html>; allowed: mujoco, robot"),
    "a speed in words": (
        f'{URDF}<child link="b"/><limit effort="1" velocity="fast"/></joint></robot>',
        "joint j: velocity='fast': is no speed; allowed: 0 or more",
    ),
    "a speed backwards": (f'{URDF}<child link="b"/><limit velocity="-1"/></joint></robot>', "is no speed"),
}


@pytest.mark.parametrize(("model", "message"), FLOODS.values(), ids=FLOODS)
def test_a_flood_is_refused_before_anything_is_built(tmp_path: Path, model: str, message: str) -> None:
    said = refused(tmp_path, EXAMPLE, model)
    assert message in said
    assert len(said.replace(str(tmp_path), "")) <= 300 and "root:" not in said


IMPOSSIBLE = [
    ('mass="40"', 'mass="-40"', "inertial of body pedestal: mass is -40; allowed: numbers of at least 0"),
    ('diaginertia="3 3 1"', 'diaginertia="3 -3 1"', "inertial of body pedestal: diaginertia is 3 -3 1; allowed"),
    ('size="0.1 0.4"', 'size="0.1 -0.4"', "geom of body pedestal: size is 0.1 -0.4; allowed: numbers of at least 0"),
    ('damping="0.5"', 'damping="-1"', "damping is -1; allowed: numbers of at least 0"),
    ('armature="0.02"', 'armature="-1"', "armature is -1; allowed"),
    ('range="-2.8 2.8"', 'range="2.8 -2.8"', "joint pan: range is 2.8 -2.8; allowed: the lesser number first"),
    ('forcerange="-60 60"', 'forcerange="60 -60"', "forcerange is 60 -60; allowed: the lesser number first"),
]
IN_URDF = [
    (
        '<mass value="40"/>',
        '<mass value="-40"/>',
        "mass of link pedestal: value is -40; allowed",
    ),
    ('radius="0.1"', 'radius="-0.1"', "cylinder of link pedestal: radius is -0.1; allowed"),
    ('lower="-2" upper="1.4"', 'lower="2" upper="1.4"', "lower is 2, upper 1.4; allowed: the lesser number as lower"),
]


@pytest.mark.parametrize(("old", "new", "message"), [*IMPOSSIBLE, *IN_URDF], ids=lambda text: text[:30])
def test_what_no_body_and_no_joint_can_have_is_refused(tmp_path: Path, old: str, new: str, message: str) -> None:
    urdf = (Path(__file__).parents[1] / "robots" / "own_arm.urdf").read_text(encoding="utf-8")
    path, text = (tmp_path / "own_arm.urdf", urdf) if old in urdf else (tmp_path / "own_arm.xml", MODEL)
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ScenarioError, match=re.escape(message)):
        read_model_file(path)


def test_nothing_is_left_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    refused(tmp_path, EXAMPLE, MODEL.replace('mass="40"', 'mass="nan"'))
    before = sorted(tmp_path.iterdir())
    refused(tmp_path, EXAMPLE, MODEL.replace('diaginertia="3 3 1"', 'diaginertia="3 3 100"'))
    assert sorted(tmp_path.iterdir()) == before


def test_includes_that_include_each_other_end(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text('<mujoco><include file="b.xml"/></mujoco>', encoding="utf-8")
    (tmp_path / "b.xml").write_text('<mujoco><include file="a.xml"/></mujoco>', encoding="utf-8")
    assert "a.xml: is included twice" in refused(tmp_path, EXAMPLE, in_model('<include file="a.xml"/>'))


def test_includes_that_go_deep_together_are_refused(tmp_path: Path) -> None:
    for k in range(20):
        inner = f'<include file="{k + 1}.xml"/>' if k < 19 else ""
        text = "<mujoco>" + "<body>" * 190 + inner + "</body>" * 190 + "</mujoco>"
        (tmp_path / f"{k}.xml").write_text(text, encoding="utf-8")
    said = refused(tmp_path, EXAMPLE, in_world('<include file="0.xml"/>'))
    assert "elements within more than 200 others" in said


def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.xml")
    assert "pipe.xml: cannot read the robot file: it is a pipe, not a file" in refused(
        tmp_path, EXAMPLE.replace("own_arm.xml", "pipe.xml")
    )
    assert "pipe.xml" in refused(tmp_path, EXAMPLE, in_model('<include file="pipe.xml"/>'))


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("../outside.stl", "meshes are outside the robot's folder"),
        ("HERE/outside.stl", "meshes are outside the robot's folder"),
        ("link.stl", "meshes are missing"),
        ("package://../outside.stl", "meshes are missing"),
    ],
)
def test_a_mesh_outside_the_robots_folder_is_not_read(tmp_path: Path, name: str, reason: str) -> None:
    folder = tmp_path / "robot"
    folder.mkdir()
    (tmp_path / "outside.stl").write_bytes(b"secret")
    (folder / "link.stl").symlink_to(tmp_path / "outside.stl")
    model = in_model(f'<asset><mesh name="m" file="{name.replace("HERE", str(tmp_path))}"/></asset>')
    model = model.replace('<geom type="sphere" size="0.04"/>', '<geom type="mesh" mesh="m"/>')
    assert reason in refused(folder, EXAMPLE, model)


def test_what_is_included_is_read_as_if_it_stood_there(tmp_path: Path) -> None:
    start, end = MODEL.index("<actuator>"), MODEL.index("</mujoco>")
    (tmp_path / "whole.xml").write_text(MODEL, encoding="utf-8")
    (tmp_path / "more").mkdir()
    (tmp_path / "more" / "motors.xml").write_text(f"<mujoco>{MODEL[start:end]}</mujoco>", encoding="utf-8")
    parted = MODEL[:start] + '<include file="more/motors.xml"/>' + MODEL[end:]
    (tmp_path / "parted.xml").write_text(parted, encoding="utf-8")
    whole, parts = (read_model_file(tmp_path / f"{name}.xml") for name in ("whole", "parted"))
    assert whole.efforts == parts.efforts and whole.spec.to_xml() == parts.spec.to_xml()


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("tool = [0.08, 0, 0]", "tool = [1e300, 0, 0]", "tool.0: must be at most 10, not 1e+300"),
        ("tool = [0.08, 0, 0]", "tool = [nan, 0, 0]", "tool.0: must be at most 10, not nan"),
        ("[robot]", '[robot]\nbase = ["left", "right", "left"]', "the joint left is in base and in base; allowed: one"),
        ("[robot]", '[robot]\nbase = ["pan"]', "base: pan are no base; allowed: two joints that slide, then one that"),
        ("[robot]", '[robot]\nhead = ["pan"]', "the joint pan is in head and in an arm of gripper1; allowed: one of"),
        ("[robot]", '[robot]\ntorso = ["left"]', "the joint left is in torso and in fingers of gripper1; allowed: one"),
    ],
)
def test_a_table_that_cannot_be(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert message in refused(tmp_path, EXAMPLE.replace(old, new))


@pytest.mark.parametrize("signal", ["SEGV", "ABRT", "KILL"])
def test_a_crash_on_reading_a_robot_is_a_message(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, signal: str) -> None:
    dying = tmp_path / "python"
    dying.write_text(f"#!/bin/sh\nkill -{signal} $$\n", encoding="utf-8")
    dying.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(dying))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    with pytest.raises(ScenarioError, match=f"arm.xml: the robot cannot be built: .* ended with SIG{signal}"):
        try_robot(Path("arm.xml"), None, b"", ())
    assert not (tmp_path / "prolepsis").exists()


def test_a_trial_that_was_passed_is_not_made_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "arm.xml").write_text(MODEL, encoding="utf-8")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    read_model_file(tmp_path / "arm.xml")
    assert len(list((tmp_path / "cache" / "prolepsis" / "robots").iterdir())) == 1
    monkeypatch.setattr(sys, "executable", "/bin/false")
    read_model_file(tmp_path / "arm.xml")
    (tmp_path / "arm.xml").write_text(MODEL.replace("40", "41"), encoding="utf-8")
    with pytest.raises(ScenarioError, match="ended with an error"):
        read_model_file(tmp_path / "arm.xml")
