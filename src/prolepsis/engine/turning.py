"""Turning: rotations of many poses at once."""

from __future__ import annotations

import numpy as np

from prolepsis.geometry.shape import FloatArray


def matrices(quaternions: FloatArray) -> FloatArray:
    """Return rotation matrices, shape (..., 3, 3), of unit quaternions, shape (..., 4)."""
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def rotated(quaternions: FloatArray, vectors: FloatArray) -> FloatArray:
    """Return ``vectors``, shape (n, 3), turned by unit ``quaternions``, shape (T, n, 4)."""
    w, axis = quaternions[..., :1], quaternions[..., 1:]
    twice = 2 * _cross(axis, vectors)
    return vectors + w * twice + _cross(axis, twice)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return cross products of vectors along the last axis; numpy's own takes three times as long."""
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    u, v, w = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)


def product(outer: FloatArray, inner: FloatArray) -> FloatArray:
    """Return quaternion products, shape (T, n, 4), of ``outer``, shape (T, n, 4), and ``inner``, shape (n, 4)."""
    w = outer[..., 0] * inner[..., 0] - (outer[..., 1:] * inner[..., 1:]).sum(axis=-1)
    axis = outer[..., :1] * inner[..., 1:] + inner[..., :1] * outer[..., 1:] + _cross(outer[..., 1:], inner[..., 1:])
    return np.concatenate([w[..., None], axis], axis=-1)
