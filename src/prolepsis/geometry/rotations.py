"""Rotations as unit quaternions (w, x, y, z), and poses: only here, and in MuJoCo, is known how they are put together.

One rotation is a tuple, or a part of a pose of shape (7,), position and quaternion; many are arrays of shape (..., 4).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray, Quaternion, Triple


def product(first: Quaternion, second: Quaternion) -> Quaternion:
    """Return the rotation ``second`` followed by ``first``."""
    a, b, c, d = first
    w, x, y, z = second
    return (
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )


def inverse(orientation: Quaternion) -> Quaternion:
    """Return the rotation back."""
    w, x, y, z = orientation
    return (w, -x, -y, -z)


def rotated(orientation: Quaternion, vector: Triple) -> FloatArray:
    """Return a vector turned by a rotation, shape (3,)."""
    return np.array(_rotated(orientation, vector))


def _rotated(orientation: Quaternion, vector: Triple) -> Triple:
    w, x, y, z = orientation
    a, b, c = vector
    p, q, r = w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a
    return (a + 2.0 * (y * r - z * q), b + 2.0 * (z * p - x * r), c + 2.0 * (x * q - y * p))


def turned(first: Quaternion, angles: Triple) -> Quaternion:
    """Return ``first`` turned by yaw about its z axis, then by pitch about y, then by roll about x [rad]."""
    result = first
    for axis, angle in zip((3, 2, 1), angles, strict=True):
        if angle:
            step = [math.cos(angle / 2), 0.0, 0.0, 0.0]
            step[axis] = math.sin(angle / 2)
            result = product(result, (step[0], step[1], step[2], step[3]))
    return result


def angles_of(first: Quaternion, orientation: Quaternion) -> Triple:
    """Return yaw, pitch and roll [rad] of an orientation from ``first``; roll is 0 where they are not unique."""
    w, x, y, z = product(inverse(first), orientation)
    sine = max(-1.0, min(1.0, 2 * (w * y - x * z)))
    pitch = math.asin(sine)
    if abs(sine) > 1 - 1e-9:
        return (math.copysign(2.0, -sine) * math.atan2(x, w), pitch, 0.0)
    yaw = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    roll = math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    return (yaw, pitch, roll)


def yaw_of(orientation: Quaternion) -> float:
    """Return the direction in which an orientation that is turned about the vertical faces [rad]."""
    w, _, _, z = orientation
    return 2 * math.atan2(z, w)


def wrapped(angle: float) -> float:
    """Return an angle between -pi and pi [rad]."""
    return (angle + math.pi) % (2 * math.pi) - math.pi


def from_axes(axes: FloatArray) -> Quaternion:
    """Return the rotation whose axes are given as columns, shape (3, 3)."""
    (a, b, c), (d, e, f), (g, h, i) = axes.tolist()
    squares = (a + e + i, a - e - i, e - a - i, i - a - e)
    k = max(range(4), key=lambda n: squares[n])
    # Four times the products of the greatest part with each; the greatest one is not near zero.
    rows = (
        (1 + squares[0], h - f, c - g, d - b),
        (h - f, 1 + squares[1], b + d, c + g),
        (c - g, b + d, 1 + squares[2], f + h),
        (d - b, c + g, f + h, 1 + squares[3]),
    )
    w, x, y, z = rows[k]
    length = math.sqrt(w * w + x * x + y * y + z * z)
    return (w / length, x / length, y / length, z / length)


def rolled(angle: float) -> FloatArray:
    """Return the rotation matrix of a roll about x by ``angle`` [rad], shape (3, 3)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def yawed(angle: float) -> FloatArray:
    """Return the rotation matrix of a yaw about z by ``angle`` [rad], shape (3, 3)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def turned_about(axis: FloatArray, angle: float) -> FloatArray:
    """Return the rotation matrix of a turn about a unit axis by ``angle`` [rad], shape (3, 3)."""
    half = math.sin(angle / 2)
    x, y, z = (float(v) * half for v in axis)
    return matrix((math.cos(angle / 2), x, y, z))


def matrix(quaternion: FloatArray | Quaternion) -> FloatArray:
    """Return the rotation matrix of a quaternion, which need not be of unit length, shape (3, 3)."""
    w, x, y, z = np.asarray(quaternion) / np.linalg.norm(quaternion)
    return np.array(_rows(w, x, y, z))


def matrices(quaternions: FloatArray) -> FloatArray:
    """Return rotation matrices, shape (..., 3, 3), of unit quaternions, shape (..., 4)."""
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    return np.stack([np.stack(row, axis=-1) for row in _rows(w, x, y, z)], axis=-2)


def _rows(w: Any, x: Any, y: Any, z: Any) -> tuple[tuple[Any, Any, Any], ...]:
    """Return the rows of a rotation matrix, of numbers or of arrays alike."""
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


def rotate(quaternion: FloatArray, vector: FloatArray) -> FloatArray:
    """Return vectors turned by unit quaternions (w, x, y, z), with broadcasting.

    Args:
        quaternion: Shape (..., 4).
        vector: Shape (..., 3).
    """
    w, axis = quaternion[..., :1], quaternion[..., 1:]
    twice = 2.0 * cross(axis, vector)
    return vector + w * twice + cross(axis, twice)


def cross(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return the cross product, shape (..., 3), several times faster than numpy's general one."""
    found = np.empty(np.broadcast_shapes(first.shape, second.shape))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[..., i] = first[..., j] * second[..., k] - first[..., k] * second[..., j]
    return found


def rotate_back(quaternion: FloatArray, vector: FloatArray) -> FloatArray:
    """Return vectors turned by the inverse of unit quaternions."""
    return rotate(inverses(quaternion), vector)


def inverses(quaternions: FloatArray) -> FloatArray:
    """Return the inverses of unit quaternions, shape (..., 4)."""
    return quaternions * np.array([1.0, -1.0, -1.0, -1.0])


def multiply(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return the product of quaternions (w, x, y, z), shape (..., 4)."""
    w1, x1, y1, z1 = np.moveaxis(first, -1, 0)
    w2, x2, y2, z2 = np.moveaxis(second, -1, 0)
    return np.stack(
        (
            w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2,
            w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2,
            w1 * y2 - x1 * z2 + y1 * w2 + z1 * x2,
            w1 * z2 + x1 * y2 - y1 * x2 + z1 * w2,
        ),
        axis=-1,
    )


def rotation_vectors(before: FloatArray, after: FloatArray) -> FloatArray:
    """Return the rotation vectors from unit quaternions to others [rad], shape (..., 3): exact when small."""
    change = multiply(after, inverses(before))
    # q and -q are the same rotation; none has the sign 0.
    return 2.0 * change[..., 1:] * np.sign(change[..., :1] + 1e-300)


def angle_between(before: FloatArray, after: FloatArray) -> FloatArray:
    """Return the angle between unit quaternions [rad], shape (...): exact when small, a tenth less at 180 degrees."""
    # The chord between two unit quaternions is 2 sin(angle / 4); q and -q are the same rotation.
    cosine = np.abs(np.einsum("...q,...q->...", before, after))
    return 2.0 * np.sqrt(np.maximum(2.0 - 2.0 * cosine, 0.0))


def compose_pose(outer: FloatArray, inner: FloatArray) -> FloatArray:
    """Return the world pose of ``inner``, given in the frame ``outer``; both are (7,)."""
    x, y, z, *rotation = outer.tolist()
    a, b, c, *own = inner.tolist()
    orientation = (rotation[0], rotation[1], rotation[2], rotation[3])
    p, q, r = _rotated(orientation, (a, b, c))
    w, i, j, k = product(orientation, (own[0], own[1], own[2], own[3]))
    length = math.sqrt(w * w + i * i + j * j + k * k)
    return np.array([x + p, y + q, z + r, w / length, i / length, j / length, k / length])


def relative_pose(outer: FloatArray, inner: FloatArray) -> FloatArray:
    """Return the pose of ``inner`` in the frame of ``outer``; both are world poses, (7,)."""
    x, y, z, w, i, j, k = outer.tolist()
    back = (w, -i, -j, -k)
    p, q, r = _rotated(back, (x, y, z))
    return compose_pose(np.array([-p, -q, -r, *back]), inner)
