"""Grippers of a robot of the user's own: which way its fingers open, and that both move alike."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from prolepsis.geometry.shape import Quaternion
from prolepsis.robots.model import FARTHEST, follow_couplings, gap_of, touching_geoms
from prolepsis.scenario.own_robot import OwnGripper
from prolepsis.scene.robot import ParallelGripper
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import ScenarioError, UnknownNameError

ALIKE = 1.0e-3
"""Ranges of two fingers may differ by this share."""
PARALLEL = 0.9
"""Cosine of the angle between the way from palm to fingertips and from pad to pad, at which they are taken for one."""
COUPLING_SOLREF, COUPLING_SOLIMP = (0.004, 1.0), (0.99, 0.9999, 0.001, 0.5, 2.0)
"""Of what couples fingers: as stiff as a linkage, or a tenth of the pad force is lost."""


def pads_of(model: Any, given: OwnGripper, where: str) -> tuple[str, str]:
    """Return the bodies that carry the pads.

    Raises:
        UnknownNameError: If the model lacks what the gripper names.
        ScenarioError: If the fingers are not two that move on the palm and have something to touch with.
    """
    joints = [model.joint(j).name for j in range(model.njnt)]
    bodies = [model.body(b).name for b in range(1, model.nbody)]
    for finger in given.fingers:
        if finger not in joints:
            raise UnknownNameError.of("joint", finger, joints, f"{where}: fingers")
    for what, name in (("palm", given.palm), *(("pads", pad) for pad in given.pads or ())):
        if name not in bodies:
            raise UnknownNameError.of("body", name, bodies, f"{where}: {what}")
    palm = int(model.body(given.palm).id)
    moved = [int(model.jnt_bodyid[model.joint(finger).id]) for finger in given.fingers]
    for finger, body in zip(given.fingers, moved, strict=True):
        if int(model.body_parentid[body]) != palm:
            parent = model.body(int(model.body_parentid[body])).name
            raise ScenarioError(f"{where}: the finger {finger} moves on {parent}, not on the palm {given.palm}")
    if moved[0] == moved[1]:
        raise ScenarioError(f"{where}: fingers: two joints of two fingers are needed, {given.fingers} move one body")
    pads = given.pads or (model.body(moved[0]).name, model.body(moved[1]).name)
    for pad in pads:
        if not touching_geoms(model, pad):
            raise ScenarioError(f"{where}: {pad} has no geom that can touch; give pads, the bodies that carry them")
    return pads


def make_fingers_open(spec: Any, model: Any, given: OwnGripper, pads: tuple[str, str], where: str) -> None:
    """Let both finger joints of a spec open when they grow, by the same amount and without friction.

    Raises:
        ScenarioError: If the fingers do not move alike.
    """
    ranges: list[tuple[float, float]] = []
    for finger in given.fingers:
        joint, number = spec.joint(finger), int(model.joint(finger).id)
        if not model.jnt_limited[number]:
            raise ScenarioError(f"{where}: the finger joint {finger} has no range")
        low, high = (float(value) for value in model.jnt_range[number])
        if _opens_backwards(model, finger, pads, low, high):
            low, high = 0.0 - high, 0.0 - low
            joint.axis, joint.range = [-float(value) for value in joint.axis], [low, high]
            joint.ref = -joint.ref
            _turn_couplings(spec, finger)
        # The gripper's controller is taken to make up for what is lost between its motor and its pads.
        joint.frictionloss = 0.0
        joint.stiffness = [0.0, 0.0, 0.0]
        ranges.append((low, high))
    (low, high), (other_low, other_high) = ranges
    if max(abs(low - other_low), abs(high - other_high)) > ALIKE * (high - low):
        raise ScenarioError(
            f"{where}: its fingers do not move alike: {given.fingers[0]} by {low:g} to {high:g}, {given.fingers[1]} by "
            f"{other_low:g} to {other_high:g} when opening; allowed: the same range"
        )
    for each in list(spec.equalities):
        if each.type == mujoco.mjtEq.mjEQ_JOINT:
            each.solref, each.solimp = list(COUPLING_SOLREF), list(COUPLING_SOLIMP)
            if {each.name1, each.name2} == {*given.fingers} and list(each.data[:5]) != [0.0, 1.0, 0.0, 0.0, 0.0]:
                raise ScenarioError(f"{where}: the model couples its fingers otherwise than by opening alike")


def gripper_of(
    model: Any, given: OwnGripper, pads: tuple[str, str], effort: float | None, where: str
) -> ParallelGripper:
    """Return a gripper whose frame has its y axis from pad to pad.

    Args:
        model: The robot's model, its fingers made to open when they grow.
        given: What the scenario says.
        pads: Bodies that carry the pads.
        effort: Greatest effort of a finger [N or N m], if it is known.
        where: Where the gripper is told of.

    Raises:
        ScenarioError: If the pads lie before each other, or nothing tells the greatest force.
    """
    gripper = ParallelGripper(
        palm=given.palm,
        fingers=given.fingers,
        pads=pads,
        tool=given.tool,
        tool_orientation=_frame(model, given, pads, where),
        max_force=given.max_force or 0.0,
    )
    gap = gap_of(model, gripper, where)
    if given.max_force is not None:
        return gripper
    if effort is None:
        raise ScenarioError(f"{where}: nothing tells the greatest force of its pads; give max_force [N]")
    return replace(gripper, max_force=effort / round(max(gap.levers), 9))


def _frame(model: Any, given: OwnGripper, pads: tuple[str, str], where: str) -> Quaternion:
    """Return the gripper's frame in the palm's: x forward, y from the second pad to the first."""
    data = mujoco.MjData(model)
    for finger in given.fingers:
        data.joint(finger).qpos[0] = model.joint(finger).range[1]
    follow_couplings(model, data)
    mujoco.mj_kinematics(model, data)
    palm = model.body(given.palm).id
    middles = [np.mean([data.geom_xpos[g] for g in touching_geoms(model, pad)], axis=0) for pad in pads]
    across = data.xmat[palm].reshape(3, 3).T @ (middles[0] - middles[1])
    forward = np.array(given.forward)
    lengths = np.linalg.norm(forward), np.linalg.norm(across)
    if not all(lengths) or abs(float(forward @ across)) > PARALLEL * lengths[0] * lengths[1]:
        raise ScenarioError(
            f"{where}: forward must point from the palm to the fingertips, not from pad to pad: {list(given.forward)}"
        )
    x = forward / lengths[0]
    y = across - (across @ x) * x
    y /= np.linalg.norm(y)
    turn = np.zeros(4)
    mujoco.mju_mat2Quat(turn, np.stack([x, y, np.cross(x, y)], axis=1).ravel())
    w, i, j, k = (float(value) for value in turn)
    return (w, i, j, k)


def _opens_backwards(model: Any, finger: str, pads: tuple[str, str], low: float, high: float) -> bool:
    """Return whether the pads are farther apart where the coordinate of a finger joint is low."""
    data, gaps = mujoco.MjData(model), list[float]()
    first, second = (touching_geoms(model, pad) for pad in pads)
    for place in (low, high):
        data.joint(finger).qpos[0] = place
        follow_couplings(model, data)
        # The finger itself may have followed the other one.
        data.joint(finger).qpos[0] = place
        mujoco.mj_kinematics(model, data)
        gaps.append(min(mujoco.mj_geomDistance(model, data, a, b, FARTHEST, None) for a in first for b in second))
    return gaps[0] > gaps[1]


def _turn_couplings(spec: Any, joint: str) -> None:
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
