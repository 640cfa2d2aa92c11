"""What effectors that pinch have in common: joints that open when they grow, one motor on a tendon, a measured gap."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from prolepsis.geometry.rotations import compose_pose, from_axes, rotated
from prolepsis.geometry.shape import FloatArray, Quaternion, quaternion
from prolepsis.robots.effectors.gap import Gap
from prolepsis.robots.effectors.gripper_control import Drive
from prolepsis.robots.parts import follow_couplings, pad_body, pad_geoms
from prolepsis.scenario.own_robot import OwnGripper
from prolepsis.scene.robot import Effector
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import ScenarioError, UnknownNameError

TABLE = 257
"""Lengths at which a gap is measured: it is interpolated to a micrometre."""
FARTHEST = 1.0
"""No gripper opens wider [m]."""
ACROSS = 0.9
"""Cosine of the angle between the way from palm to fingertips and from pad to pad, at which they are taken for one."""
BACKWARD = -0.5
"""Cosine of the angle between forward and the way from the palm's middle to the tool, below which it is reversed."""
STIFFNESS, DAMPING = 4.0e3, 80.0
"""Servo of the opening [N/m, N s/m]."""


def moved_bodies(
    model: Any, palm: str, joints: Sequence[str], pads: Sequence[str], key: str, noun: str, where: str
) -> list[int]:
    """Return the bodies that the joints of an effector move on its palm.

    Args:
        model: The robot's model.
        palm: Body that carries the effector.
        joints: Their names.
        pads: Names of the bodies or geoms that are the pads, as far as they are given.
        key: What the scenario calls the joints, ``fingers``.
        noun: One of them, ``finger``.
        where: Where the effector is told of.

    Raises:
        UnknownNameError: If the model lacks what is named.
        ScenarioError: If a joint moves something else.
    """
    known = [model.joint(j).name for j in range(model.njnt)]
    bodies = [model.body(b).name for b in range(1, model.nbody)]
    for joint in joints:
        if joint not in known:
            raise UnknownNameError.of("joint", joint, known, f"{where}: {key}")
    if palm not in bodies:
        raise UnknownNameError.of("body", palm, bodies, f"{where}: palm")
    touching = [*bodies, *filter(None, (model.geom(g).name for g in range(model.ngeom)))]
    for pad in pads:
        if pad not in touching:
            raise UnknownNameError.of("body or geom", pad, touching, f"{where}: pads")
    moved = [int(model.jnt_bodyid[model.joint(joint).id]) for joint in joints]
    for joint, body in zip(joints, moved, strict=True):
        if int(model.body_parentid[body]) != int(model.body(palm).id):
            parent = model.body(int(model.body_parentid[body])).name
            raise ScenarioError(f"{where}: the {noun} {joint} moves on {parent}, not on the palm {palm}")
    return moved


def refuse_bare_pads(model: Any, pads: Sequence[str], where: str) -> None:
    """Refuse pads that cannot touch."""
    for pad in pads:
        if not pad_geoms(model, pad):
            raise ScenarioError(f"{where}: {pad} has no geom that can touch; give pads, the bodies that carry them")


def open_by_growing(
    spec: Any, model: Any, joint: str, pads: Sequence[str], noun: str, where: str
) -> tuple[float, float]:
    """Let a joint of a spec part two pads when it grows, without friction, and return its range [m or rad].

    Raises:
        ScenarioError: If it has none.
    """
    each, number = spec.joint(joint), int(model.joint(joint).id)
    if not model.jnt_limited[number]:
        raise ScenarioError(f"{where}: the {noun} joint {joint} has no range")
    low, high = (float(value) for value in model.jnt_range[number])
    if _opens_backwards(model, joint, pads, low, high):
        low, high = 0.0 - high, 0.0 - low
        each.axis, each.range = [-float(value) for value in each.axis], [low, high]
        each.ref = -each.ref
        _reverse_couplings(spec, joint)
    # The effector's controller is taken to make up for what is lost between its motor and its pads.
    each.frictionloss = 0.0
    each.stiffness = [0.0, 0.0, 0.0]
    return low, high


def frame(forward: Sequence[float], across: FloatArray, where: str) -> Quaternion:
    """Return the frame of an effector in that of its palm: x forward, y as far as can be ``across``, shape (3,).

    Raises:
        ScenarioError: If both are one direction.
    """
    ahead = np.array(forward)
    lengths = np.linalg.norm(ahead), np.linalg.norm(across)
    if not all(lengths) or abs(float(ahead @ across)) > ACROSS * lengths[0] * lengths[1]:
        raise ScenarioError(
            f"{where}: forward must point from the palm to the fingertips, not from pad to pad: {list(forward)}"
        )
    x = ahead / lengths[0]
    y = across - (across @ x) * x
    y /= np.linalg.norm(y)
    return from_axes(np.stack([x, y, np.cross(x, y)], axis=1))


def pad_distance(model: Any, data: Any, first: Sequence[int], second: Sequence[int]) -> float:
    """Return the least distance between two groups of geoms [m]."""
    return min(mujoco.mj_geomDistance(model, data, a, b, FARTHEST, None) for a in first for b in second)


def tabulated(model: Any, effector: Effector, measure: Callable[[Any], tuple[float, float, float]], where: str) -> Gap:
    """Return the gap over the range of an effector's joints, which all move alike.

    Args:
        model: The robot's model.
        effector: What it pinches with.
        measure: Returns gap, and position of what is held along x and y of the frame [m], from ``mujoco.MjData``.
        where: Where the effector is told of.

    Raises:
        ScenarioError: If the pads do not part where the joints grow.
    """
    data, lengths = mujoco.MjData(model), _lengths(model, effector, where)
    rows = np.zeros((TABLE, 3))
    for k, length in enumerate(lengths):
        open_to(model, data, effector, length)
        rows[k] = measure(data)
    gaps, ahead, aside = rows.T
    if not (np.diff(gaps) > 0).all():
        raise ScenarioError(f"{where}: its pads do not part where its joints grow")
    return Gap.tabulated(lengths, gaps, ahead, aside)


def half_open(model: Any, effector: Effector, where: str) -> Any:
    """Return ``mujoco.MjData`` in which an effector is half open."""
    data = mujoco.MjData(model)
    open_to(model, data, effector, float(_lengths(model, effector, where)[TABLE // 2]))
    return data


def tool_pose(model: Any, data: Any, effector: Effector) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return origin, x axis and y axis of an effector's frame [m], each shape (3,)."""
    palm = data.body(effector.palm)
    tool = np.array([*effector.tool, *effector.tool_orientation])
    pose = compose_pose(np.array([*palm.xpos, *palm.xquat]), tool)
    rotation = quaternion(pose[3:])
    return pose[:3], rotated(rotation, (1.0, 0.0, 0.0)), rotated(rotation, (0.0, 1.0, 0.0))


def pinching(
    kind: str,
    model: Any,
    joints: tuple[str, ...],
    pads: tuple[str, str],
    across: FloatArray,
    given: OwnGripper,
    where: str,
) -> Effector:
    """Return the effector of a kind whose pads, bodies or geoms, pinch along ``across``, shape (3,), seen by its palm.

    Raises:
        ScenarioError: If that is the way to the fingertips, or they are on the other side of the palm.
    """
    ahead = np.array(given.tool) - model.body(given.palm).ipos
    if float(ahead @ np.array(given.forward)) < BACKWARD * float(np.linalg.norm(ahead) * np.linalg.norm(given.forward)):
        raise ScenarioError(
            f"{where}: forward must point from the palm to the fingertips, not back: {list(given.forward)}, while the "
            f"tool is at {list(given.tool)}"
        )
    return Effector(
        kind=kind,
        palm=given.palm,
        joints=joints,
        pads=tuple(pad_body(model, pad) for pad in pads),
        surfaces=pads,
        tool=given.tool,
        tool_orientation=frame(given.forward, across, where),
        max_force=given.max_force or 0.0,
    )


def _lengths(model: Any, effector: Effector, where: str) -> FloatArray:
    low, high = (float(v) for v in model.joint(effector.joints[0]).range)
    if not high > low:
        raise ScenarioError(f"{where}: the joint {effector.joints[0]} has no range")
    return np.linspace(len(effector.joints) * low, len(effector.joints) * high, TABLE)


def open_to(model: Any, data: Any, effector: Effector, length: float) -> None:
    """Put an effector's joints where they add up to ``length`` [m or rad]."""
    for joint in effector.joints:
        data.joint(joint).qpos[0] = length / len(effector.joints)
    follow_couplings(model, data)
    mujoco.mj_kinematics(model, data)


def add_drive(spec: Any, name: str, joints: Sequence[str]) -> None:
    """Join the joints of the effector called ``name`` by a tendon, and give it a motor."""
    tendon = spec.add_tendon(name=f"{name}/gap")
    for joint in joints:
        tendon.wrap_joint(joint, 1.0)
    motor = spec.add_actuator(name=f"{name}/gap", target=f"{name}/gap", trntype=mujoco.mjtTrn.mjTRN_TENDON)
    motor.biastype = mujoco.mjtBias.mjBIAS_AFFINE


def pinching_drive(effector: Effector, gap: Gap, robot: str, name: str) -> Drive:
    """Return what ``add_drive`` has built on a robot, for the controller."""
    return Drive(
        motor=f"{name}/gap",
        tendon=f"{name}/gap",
        pads=tuple(f"{robot}/{pad}" for pad in effector.pads),
        moving=len(effector.joints),
        gap=gap,
        max_force=effector.max_force,
        stiffness=STIFFNESS,
        damping=DAMPING,
    )


def _opens_backwards(model: Any, joint: str, pads: Sequence[str], low: float, high: float) -> bool:
    """Return whether the pads are farther apart where the coordinate of a joint is low."""
    data, gaps = mujoco.MjData(model), list[float]()
    first, second = (pad_geoms(model, pad) for pad in pads)
    for position in (low, high):
        data.joint(joint).qpos[0] = position
        follow_couplings(model, data)
        # The joint itself may have followed another one.
        data.joint(joint).qpos[0] = position
        mujoco.mj_kinematics(model, data)
        gaps.append(pad_distance(model, data, first, second))
    return gaps[0] > gaps[1]


def _reverse_couplings(spec: Any, joint: str) -> None:
    """Let the couplings of a joint hold when its coordinate has the other sign."""
    for each in spec.equalities:
        if each.type != mujoco.mjtEq.mjEQ_JOINT:
            continue
        shape = np.array(each.data)
        if each.name1 == joint:
            shape[:5] *= -1.0
        if each.name2 == joint:
            shape[1:5:2] *= -1.0
        each.data = shape
