"""Rotations and poses agree with MuJoCo's."""

from __future__ import annotations

import numpy as np
import pytest

from prolepsis.geometry import rotations
from prolepsis.geometry.shape import FloatArray, quaternion, triple
from prolepsis.system.mujoco import mujoco

RANDOM = np.random.default_rng(2)


def pose() -> FloatArray:
    """Return a pose anywhere, shape (7,)."""
    found = RANDOM.normal(size=7)
    found[3:] /= np.linalg.norm(found[3:])
    return found


@pytest.mark.parametrize("_", range(20))
def test_poses_are_put_together_as_by_mujoco(_: int) -> None:
    outer, inner, expected, back = pose(), pose(), np.zeros(7), np.zeros(7)
    mujoco.mju_mulPose(expected[:3], expected[3:], outer[:3], outer[3:], inner[:3], inner[3:])
    assert rotations.compose_pose(outer, inner) == pytest.approx(expected, abs=1e-14)
    mujoco.mju_negPose(back[:3], back[3:], outer[:3], outer[3:])
    mujoco.mju_mulPose(expected[:3], expected[3:], back[:3], back[3:], inner[:3], inner[3:])
    assert rotations.relative_pose(outer, inner) == pytest.approx(expected, abs=1e-14)
    assert rotations.compose_pose(outer, rotations.relative_pose(outer, inner))[:3] == pytest.approx(inner[:3])


@pytest.mark.parametrize("_", range(20))
def test_vectors_and_axes_turn_as_by_mujoco(_: int) -> None:
    turn, vector = quaternion(pose()[3:]), triple(RANDOM.normal(size=3))
    expected, axes, back = np.zeros(3), np.zeros(9), np.zeros(4)
    mujoco.mju_rotVecQuat(expected, np.array(vector), np.array(turn))
    assert np.array_equal(rotations.rotated(turn, vector), expected)
    mujoco.mju_quat2Mat(axes, np.array(turn))
    assert rotations.matrix(np.array(turn)) == pytest.approx(axes.reshape(3, 3), abs=1e-15)
    mujoco.mju_mat2Quat(back, axes)
    found = np.array(rotations.from_axes(axes.reshape(3, 3)))
    assert min(np.abs(found - back).max(), np.abs(found + back).max()) < 1e-14


@pytest.mark.parametrize("_", range(20))
def test_turns_about_an_axis_are_those_of_mujoco(_: int) -> None:
    axis, angle = pose()[4:], float(RANDOM.uniform(-3, 3))
    axis /= np.linalg.norm(axis)
    expected, axes = np.zeros(4), np.zeros(9)
    mujoco.mju_axisAngle2Quat(expected, axis, angle)
    mujoco.mju_quat2Mat(axes, expected)
    assert rotations.turned_about(axis, angle) == pytest.approx(axes.reshape(3, 3), abs=1e-15)
    up = np.array([0.0, 0.0, 1.0])
    assert rotations.yawed(angle) == pytest.approx(rotations.turned_about(up, angle), abs=1e-15)
    assert rotations.yaw_of(rotations.turned((1.0, 0.0, 0.0, 0.0), (angle, 0.0, 0.0))) == pytest.approx(angle)
    before = pose()[3:]
    mujoco.mju_axisAngle2Quat(expected, axis, 1e-4 * angle)
    after = rotations.multiply(expected, before)
    for sign in (1.0, -1.0):
        found = rotations.rotation_vectors(before[None], sign * after[None])
        assert found[0] == pytest.approx(1e-4 * angle * axis, abs=1e-12)


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1)])
def test_half_turns_have_axes_too(axis: tuple[int, int, int]) -> None:
    unit = np.array(axis) / np.linalg.norm(axis)
    found = rotations.from_axes(2 * np.outer(unit, unit) - np.eye(3))
    assert np.abs(found) == pytest.approx(np.abs([0.0, *unit]), abs=1e-12)


@pytest.mark.parametrize("angles", [(0.3, 0.2, 0.1), (-2.0, 1.2, 3.0), (0.0, 0.0, -0.5)])
def test_yaw_pitch_and_roll_come_back(angles: tuple[float, float, float]) -> None:
    first = quaternion(pose()[3:])
    assert rotations.angles_of(first, rotations.turned(first, angles)) == pytest.approx(angles)
