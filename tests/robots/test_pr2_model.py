"""The PR2's model moves like its URDF, has the real robot's limits, and its pads press as hard as they are told."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from prolepsis.geometry.shape import FloatArray
from prolepsis.robots import pr2
from prolepsis.system.mujoco import mujoco

FILE = Path(pr2.__file__).with_name("pr2.xml")

ARM: dict[str, tuple[tuple[float, float] | None, float]] = {
    "shoulder_pan": ((-0.7146, 2.2854), 30.0),
    "shoulder_lift": ((-0.5236, 1.3963), 30.0),
    "upper_arm_roll": ((-0.8, 3.9), 30.0),
    "elbow_flex": ((-2.3213, 0.0), 30.0),
    "forearm_roll": (None, 30.0),
    "wrist_flex": ((-2.094, 0.0), 10.0),
    "wrist_roll": (None, 10.0),
}
"""Range [rad] and effort [N m] of the left arm's joints. Source: the PR2's URDF."""
MIRRORED = ("shoulder_pan", "upper_arm_roll")
"""Joints whose range is the other way round on the right."""
BODY: dict[str, tuple[tuple[float, float] | None, float]] = {
    "torso_lift_joint": ((0.0, 0.31), 10000.0),
    "head_pan_joint": ((-3.007, 3.007), 2.645),
    "head_tilt_joint": ((-0.4712, 1.3963), 15.0),
}
"""Range [m or rad] and effort [N or N m] of the other joints. Source: the PR2's URDF."""
HOME = {
    "shoulder_pan": 0.6,
    "shoulder_lift": 0.4,
    "upper_arm_roll": 1.2,
    "elbow_flex": -1.6,
    "wrist_flex": -0.9,
}
"""A posture with the hands before the chest: joints of the left arm [rad]."""
FINGER_JOINTS = ("l_finger", "r_finger", "l_finger_tip", "r_finger_tip")


def pad_gap(angle: float) -> float:
    """Return the gap [m] at a finger angle [rad]: twice (hinge + link turned by the angle - depth of the pad)."""
    return 2 * (0.01 + 0.09137 * math.sin(angle) + 0.00495 * math.cos(angle) - 0.0158)


def finger_angle(gap: float) -> float:
    """Return the finger angle [rad] at a gap [m]."""
    return math.asin((gap / 2 + 0.0058) / math.hypot(0.09137, 0.00495)) - math.atan2(0.00495, 0.09137)


def home_posture() -> dict[str, float]:
    """Return the joints' values at home [m or rad]."""
    right = {joint: -value if joint in MIRRORED else value for joint, value in HOME.items()}
    arms = (("l", HOME), ("r", right))
    posture = {f"{side}_{joint}_joint": value for side, arm in arms for joint, value in arm.items()}
    return posture | {"torso_lift_joint": 0.2}


def posed(model: Any, posture: dict[str, float]) -> Any:
    """Return the kinematics of a posture."""
    data = mujoco.MjData(model)
    for joint, value in posture.items():
        data.joint(joint).qpos[0] = value
    mujoco.mj_kinematics(model, data)
    return data


Frames = dict[str, tuple[FloatArray, FloatArray]]
"""Place [m] and rotation matrix by link."""


# --- Kinematics -------------------------------------------------------------------------------------------------------


def urdf_joints() -> list[ElementTree.Element]:
    """Return the joints of the PR2's URDF, or skip where the package with it is not installed."""
    try:
        files = metadata.files("example-robot-data") or []
    except metadata.PackageNotFoundError:
        pytest.skip("the package example-robot-data is not installed")
    (file,) = (f for f in files if f.name == "pr2.urdf")
    return ElementTree.parse(str(file.locate())).getroot().findall("joint")


def triple(text: str) -> FloatArray:
    return np.array([float(number) for number in text.split()])


def turn(axis: FloatArray, angle: float) -> FloatArray:
    """Return the rotation by ``angle`` [rad] about a unit axis, by Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def urdf_frames(joints: list[ElementTree.Element], posture: dict[str, float]) -> Frames:
    """Return the frame of every link below base_footprint."""
    frames: Frames = {"base_footprint": (np.zeros(3), np.eye(3))}
    waiting = list(joints)
    while waiting:
        ready = [joint for joint in waiting if joint.find("parent").attrib["link"] in frames]  # type: ignore[union-attr]
        assert ready
        for joint in ready:
            parent, child = (joint.find(end).attrib["link"] for end in ("parent", "child"))  # type: ignore[union-attr]
            origin = joint.find("origin")
            attributes = {} if origin is None else origin.attrib
            roll, pitch, yaw = triple(attributes.get("rpy", "0 0 0"))
            x, y, z = np.eye(3)
            place, turned = frames[parent]
            place = place + turned @ triple(attributes.get("xyz", "0 0 0"))
            turned = turned @ turn(z, yaw) @ turn(y, pitch) @ turn(x, roll)
            value = posture.get(joint.attrib["name"], 0.0)
            if value:
                axis = triple(joint.find("axis").attrib["xyz"])  # type: ignore[union-attr]
                if joint.attrib["type"] == "prismatic":
                    place = place + turned @ axis * value
                else:
                    turned = turned @ turn(axis, value)
            frames[child] = (place, turned)
        waiting = [joint for joint in waiting if joint not in ready]
    return frames


def random_postures(model: Any, count: int) -> list[dict[str, float]]:
    """Return postures within the joints' ranges; endless joints within a turn; the base stays."""
    random = np.random.default_rng(4)
    postures: list[dict[str, float]] = []
    for _ in range(count):
        posture: dict[str, float] = {}
        for j in range(model.njnt):
            joint = model.joint(j)
            low, high = joint.range if model.jnt_limited[j] else (-math.pi, math.pi)
            posture[joint.name] = float(random.uniform(low, high))
        postures.append(posture | dict.fromkeys(("base_x", "base_y", "base_yaw"), 0.0))
    return postures


def test_every_link_is_where_the_urdf_puts_it() -> None:
    joints = urdf_joints()
    model: Any = mujoco.MjModel.from_xml_path(str(FILE))
    moving = {model.body(int(model.jnt_bodyid[j])).name for j in range(model.njnt)} - {"base_footprint"}
    assert len(moving) == 3 + 2 * (7 + 4)
    for posture in random_postures(model, 50):
        data, frames = posed(model, posture), urdf_frames(joints, posture)
        for link in moving:
            place, turned = frames[link]
            np.testing.assert_allclose(data.body(link).xpos, place, atol=1e-9)
            np.testing.assert_allclose(data.body(link).xmat.reshape(3, 3), turned, atol=1e-9)
        for tool in ("l_gripper_tool_frame", "r_gripper_tool_frame"):
            np.testing.assert_allclose(data.site(tool).xpos, frames[tool][0], atol=1e-9)


def test_at_home_the_hands_are_before_the_chest() -> None:
    data = posed(mujoco.MjModel.from_xml_path(str(FILE)), home_posture())
    np.testing.assert_allclose(data.site("r_gripper_tool_frame").xpos, (0.495, -0.077, 1.038), atol=0.002)
    np.testing.assert_allclose(data.site("l_gripper_tool_frame").xpos, (0.495, 0.077, 1.038), atol=0.002)


def test_the_camera_looks_forward_from_the_head() -> None:
    model: Any = mujoco.MjModel.from_xml_path(str(FILE))
    data = posed(model, {"torso_lift_joint": 0.0})
    mujoco.mj_camlight(model, data)
    sight = -data.cam("head_camera").xmat.reshape(3, 3)[:, 2]
    np.testing.assert_allclose(sight, (1.0, 0.0, 0.0), atol=1e-9)
    np.testing.assert_allclose(data.body("head_camera").xmat.reshape(3, 3), np.eye(3), atol=1e-9)


def test_the_robot_does_not_touch_itself() -> None:
    model: Any = mujoco.MjModel.from_xml_path(str(FILE))
    for posture in random_postures(model, 20):
        data = posed(model, posture)
        mujoco.mj_collision(model, data)
        assert data.ncon == 0


# --- Limits -----------------------------------------------------------------------------------------------------------


def limits() -> list[tuple[str, tuple[float, float] | None, float]]:
    """Return name, range and effort of every joint but the fingers' and the base's."""
    table = [(joint, span, effort) for joint, (span, effort) in BODY.items()]
    for joint, (span, effort) in ARM.items():
        mirrored = (-span[1], -span[0]) if span and joint in MIRRORED else span
        table += [(f"l_{joint}_joint", span, effort), (f"r_{joint}_joint", mirrored, effort)]
    return table


@pytest.mark.parametrize(("name", "span", "effort"), limits())
def test_ranges_and_efforts_are_the_urdfs(name: str, span: tuple[float, float] | None, effort: float) -> None:
    model: Any = mujoco.MjModel.from_xml_path(str(FILE))
    joint = model.joint(name)
    assert bool(model.jnt_limited[joint.id]) == (span is not None)
    if span is not None:
        np.testing.assert_allclose(joint.range, span, atol=1e-4)
    assert model.jnt_actfrclimited[joint.id]
    np.testing.assert_allclose(model.jnt_actfrcrange[joint.id], (-effort, effort))


@pytest.mark.parametrize("finger", FINGER_JOINTS)
@pytest.mark.parametrize("side", ["l", "r"])
def test_the_fingers_open_as_far_as_the_urdfs(side: str, finger: str) -> None:
    model: Any = mujoco.MjModel.from_xml_path(str(FILE))
    np.testing.assert_allclose(model.joint(f"{side}_gripper_{finger}_joint").range, (0.0, 0.548))


def test_every_body_is_balanced() -> None:
    # Springs carry the real arms: at rest no motor has to.
    model: Any = mujoco.MjModel.from_xml_path(str(FILE))
    data = posed(model, home_posture())
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.qfrc_bias - data.qfrc_gravcomp, 0.0, atol=1e-9)
    assert np.abs(data.qfrc_bias).max() > 100.0


# --- The grippers -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("side", ["l", "r"])
def test_the_gap_follows_the_fingers(side: str) -> None:
    model: Any = mujoco.MjModel.from_xml_path(str(FILE))
    pads = [int(model.body(f"{side}_gripper_{finger}_finger_tip_link").geomadr[0]) for finger in "lr"]
    for angle in np.linspace(0.0, 0.548, 30):
        data = posed(model, {f"{side}_gripper_{joint}_joint": float(angle) for joint in FINGER_JOINTS})
        gap = mujoco.mj_geomDistance(model, data, *pads, 1.0, None)
        assert gap == pytest.approx(pad_gap(float(angle)), abs=1e-4)
    assert pad_gap(0.548) == pytest.approx(0.092, abs=1e-3)


@pytest.mark.parametrize("side", ["l", "r"])
def test_the_tool_frame_lies_between_the_pads(side: str) -> None:
    model: Any = mujoco.MjModel.from_xml_path(str(FILE))
    angle = finger_angle(0.044)
    data = posed(model, home_posture() | {f"{side}_gripper_{joint}_joint": angle for joint in FINGER_JOINTS})
    pads = [int(model.body(f"{side}_gripper_{finger}_finger_tip_link").geomadr[0]) for finger in "lr"]
    middle = data.geom_xpos[pads].mean(axis=0)
    np.testing.assert_allclose(data.site(f"{side}_gripper_tool_frame").xpos, middle, atol=5e-4)


def grasped_block(side: str, width: float, offset: float) -> tuple[Any, Any]:
    """Return model and data of a robot held at home, with a free block half a millimetre narrower than the gap.

    Args:
        side: ``l`` or ``r``.
        width: Width of the block [m].
        offset: How far beyond the pads' middle the block lies [m].
    """
    spec = mujoco.MjSpec.from_file(str(FILE))
    spec.option.timestep = 1e-3
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    posture = home_posture()
    for joint in spec.joints:
        if "finger" not in joint.name:
            held = [posture.get(joint.name, 0.0), *[0.0] * 11]
            kind = {"type": mujoco.mjtEq.mjEQ_JOINT, "objtype": mujoco.mjtObj.mjOBJ_JOINT}
            spec.add_equality(name1=joint.name, data=held, **kind)
    spec.add_actuator(name="gap", target=f"{side}_gripper_gap", trntype=mujoco.mjtTrn.mjTRN_TENDON)
    angle = finger_angle(width + 5e-4)
    posture |= {f"{side}_gripper_{joint}_joint": angle for joint in FINGER_JOINTS}

    data = posed(spec.compile(), posture)
    tip = data.body(f"{side}_gripper_l_finger_tip_link")
    palm = data.body(f"{side}_gripper_palm_link")
    turned = palm.xmat.reshape(3, 3)
    reach = float((turned.T @ (tip.xpos - palm.xpos))[0]) + 0.016 + offset
    block = spec.worldbody.add_body(name="block", pos=palm.xpos + turned[:, 0] * reach, quat=palm.xquat, gravcomp=1)
    block.add_freejoint()
    size = [0.018, width / 2, 0.02]
    block.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=size, mass=0.05, contype=1, conaffinity=1)
    model: Any = spec.compile()
    block_at = model.jnt_qposadr[int(model.body("block").jntadr[0])]
    start = model.qpos0[block_at : block_at + 7].copy()
    data = posed(model, posture)
    np.testing.assert_array_equal(data.qpos[block_at : block_at + 7], start)
    return model, data


def pad_forces(model: Any, data: Any, side: str) -> list[float]:
    """Return the normal force of each pad [N]."""
    forces: list[float] = []
    wrench = np.zeros(6)
    for finger in "lr":
        pad = int(model.body(f"{side}_gripper_{finger}_finger_tip_link").id)
        force = 0.0
        for k in range(data.ncon):
            if pad in model.geom_bodyid[data.contact[k].geom]:
                mujoco.mj_contactForce(model, data, k, wrench)
                force += wrench[0]
        forces.append(force)
    return forces


@pytest.mark.parametrize("force", [2.0, 5.0, 15.0, 40.0, 80.0])
@pytest.mark.parametrize(
    ("side", "width", "offset"),
    [("r", 0.02, 0.0), ("r", 0.044, 0.0), ("r", 0.08, 0.0), ("l", 0.044, 0.0), ("r", 0.044, 0.02)],
)
def test_pads_press_as_they_are_told_and_stay_parallel(side: str, width: float, offset: float, force: float) -> None:
    model, data = grasped_block(side, width, offset)
    finger = data.joint(f"{side}_gripper_l_finger_joint")
    measured: list[list[float]] = []
    for step in range(800):
        # Virtual work: the pad moves by (.09137 cos q - .00495 sin q) dq while both joints turn by dq.
        lever = 0.09137 * math.cos(finger.qpos[0]) - 0.00495 * math.sin(finger.qpos[0])
        data.ctrl[0] = -force * min(step / 300, 1.0) * lever
        mujoco.mj_step(model, data)
        if step >= 600:
            measured.append(pad_forces(model, data, side))
    np.testing.assert_allclose(np.array(measured).mean(axis=0), force, rtol=0.01)

    palm = data.body(f"{side}_gripper_palm_link").xmat.reshape(3, 3)
    for tip in "lr":
        relative = palm.T @ data.body(f"{side}_gripper_{tip}_finger_tip_link").xmat.reshape(3, 3)
        assert abs(math.degrees(math.atan2(relative[1, 0], relative[0, 0]))) < 0.1
