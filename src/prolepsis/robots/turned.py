"""Orientations that are given by yaw, pitch and roll from a first one."""

from __future__ import annotations

import math

import numpy as np

from prolepsis.geometry.shape import FloatArray, Quaternion, Triple
from prolepsis.system.mujoco import mujoco


def product(first: Quaternion, second: Quaternion) -> Quaternion:
    """Return the rotation ``second`` followed by ``first``, unit quaternions (w, x, y, z)."""
    a, b, c, d = first
    w, x, y, z = second
    return (
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )


def turned(first: Quaternion, turn: Triple) -> Quaternion:
    """Return an orientation turned by yaw about its z axis, then by pitch about y, then by roll about x [rad]."""
    result = first
    for axis, angle in zip((3, 2, 1), turn, strict=True):
        if angle:
            step = [math.cos(angle / 2), 0.0, 0.0, 0.0]
            step[axis] = math.sin(angle / 2)
            result = product(result, (step[0], step[1], step[2], step[3]))
    return result


def quaternion_of(axes: FloatArray) -> Quaternion:
    """Return the unit quaternion (w, x, y, z) of a rotation whose axes are given as columns, shape (3, 3)."""
    found = np.zeros(4)
    mujoco.mju_mat2Quat(found, axes.ravel())
    w, x, y, z = found.tolist()
    return (w, x, y, z)


def inverse(orientation: Quaternion) -> Quaternion:
    """Return the rotation back, a unit quaternion (w, x, y, z)."""
    w, x, y, z = orientation
    return (w, -x, -y, -z)


def turn_of(first: Quaternion, orientation: Quaternion) -> Triple:
    """Return yaw, pitch and roll [rad] of an orientation from ``first``; roll is 0 where they are not unique."""
    w, x, y, z = product(inverse(first), orientation)
    sine = max(-1.0, min(1.0, 2 * (w * y - x * z)))
    pitch = math.asin(sine)
    if abs(sine) > 1 - 1e-9:
        return (math.copysign(2.0, -sine) * math.atan2(x, w), pitch, 0.0)
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    return (yaw, pitch, roll)


def conjugated(orientation: Quaternion, vector: Triple) -> Triple:
    """Return a vector turned by a unit quaternion."""
    w, x, y, z = product(product(orientation, (0.0, *vector)), inverse(orientation))
    del w
    return (x, y, z)


def compose_pose(outer: FloatArray, inner: FloatArray) -> FloatArray:
    """Return the world pose of ``inner``, given in the frame ``outer``; both are (7,)."""
    result = np.zeros(7)
    mujoco.mju_mulPose(result[:3], result[3:], outer[:3], outer[3:], inner[:3], inner[3:])
    return result


def relative_pose(outer: FloatArray, inner: FloatArray) -> FloatArray:
    """Return the pose of ``inner`` in the frame of ``outer``; both are world poses, (7,)."""
    back = np.zeros(7)
    mujoco.mju_negPose(back[:3], back[3:], outer[:3], outer[3:])
    return compose_pose(back, inner)
