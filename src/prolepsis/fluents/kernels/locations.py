"""Where the particles of a liquid are: in the pool or the hollow of a vessel, and on which surfaces."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from prolepsis.geometry.faces import MOST_FACES, Solids, faces_of
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.system.kernels import njit

Positions = npt.NDArray[np.float32]
Bits = npt.NDArray[np.uint8]
Labels = npt.NDArray[np.int16]

POOL, HOLLOW, ROUND = 1, 2, 4
"""Bits that say where a particle is: in the pool, in the hollow, or near the hollow round its rim."""
BESIDE, ON, RESTING = 1, 2, 3
"""How a particle touches a surface: along a wall, on top of it, or on top and hardly moving."""


@njit(cache=True)
def pool_bits(
    position: Positions,
    frames: IntArray,
    loose: BoolArray,
    poses: FloatArray,
    up: FloatArray,
    origin: FloatArray,
    step: float,
    distance: FloatArray,
    pool: FloatArray,
    hollow: BoolArray,
    near: BoolArray,
    spacing: float,
    tolerance: float,
    bits: Bits,
    depth: npt.NDArray[np.float32],
) -> None:
    """Say of each particle whether it is in the pool (1), in the hollow (2), or near the hollow (4) of a body.

    Args:
        position: World frame [m], shape (F, P, 3).
        frames: The frames to look at, in all of which ``up`` is the same.
        loose: Particles that flow, shape (F, P).
        poses: Pose of the body in each frame, shape (F, 7).
        up: Direction up in the body's frame, shape (3,).
        origin: First node of the body's grid [m].
        step: Distance between its nodes [m].
        distance: Signed distance at each node [m].
        pool: Level of the pool at each node [m], minus infinity where there is none.
        hollow: Nodes in the hollow.
        near: Nodes in the hollow or near it.
        spacing: Distance of neighbours in the liquid [m].
        tolerance: How far above the level a particle may be whose foot is in the pool [m].
        bits: Filled in, shape (F, P).
        depth: How far below the level a particle of the pool is [m], filled in, shape (F, P).
    """
    nx, ny, nz = distance.shape
    reach = step * math.sqrt(float(nx * nx + ny * ny + nz * nz))
    for f in frames:
        w, a, b, c = poses[f, 3], poses[f, 4], poses[f, 5], poses[f, 6]
        r00, r01, r02 = 1 - 2 * (b * b + c * c), 2 * (a * b - w * c), 2 * (a * c + w * b)
        r10, r11, r12 = 2 * (a * b + w * c), 1 - 2 * (a * a + c * c), 2 * (b * c - w * a)
        r20, r21, r22 = 2 * (a * c - w * b), 2 * (b * c + w * a), 1 - 2 * (a * a + b * b)
        for p in range(position.shape[1]):
            if not loose[f, p]:
                continue
            dx = position[f, p, 0] - poses[f, 0]
            dy = position[f, p, 1] - poses[f, 1]
            dz = position[f, p, 2] - poses[f, 2]
            if abs(dx) > reach or abs(dy) > reach or abs(dz) > reach:
                continue
            x = r00 * dx + r10 * dy + r20 * dz
            y = r01 * dx + r11 * dy + r21 * dz
            z = r02 * dx + r12 * dy + r22 * dz
            height = x * up[0] + y * up[1] + z * up[2]
            gx, gy, gz = (x - origin[0]) / step, (y - origin[1]) / step, (z - origin[2]) / step
            i, j, k = int(round(gx)), int(round(gy)), int(round(gz))
            if i < 0 or j < 0 or k < 0 or i >= nx or j >= ny or k >= nz:
                continue
            found = 0
            if near[i, j, k]:
                found = 4
            if hollow[i, j, k]:
                found |= 2
            level = _level(gx, gy, gz, distance, pool, step)
            if level < height:
                # The foot of a particle of the surface is in the pool, that of one on the rim is in the wall.
                fx, fy, fz = gx - up[0] * spacing / step, gy - up[1] * spacing / step, gz - up[2] * spacing / step
                if _gap(fx, fy, fz, distance) > 0.25 * spacing:
                    level = _level(fx, fy, fz, distance, pool, step)
                    if level + tolerance < height or level < height - spacing:
                        level = -np.inf
                else:
                    level = -np.inf
            if level > -np.inf:
                found |= 1
                depth[f, p] = min(max(level - height, 0.0), reach)
            bits[f, p] = found


@njit(cache=True)
def _level(gx: float, gy: float, gz: float, distance: FloatArray, pool: FloatArray, step: float) -> float:
    """Return the highest level at the free corners of the cell in which a point lies."""
    nx, ny, nz = distance.shape
    i, j, k = int(math.floor(gx)), int(math.floor(gy)), int(math.floor(gz))
    level = -np.inf
    if i < 0 or j < 0 or k < 0 or i + 1 >= nx or j + 1 >= ny or k + 1 >= nz:
        return level
    for a in range(2):
        for b in range(2):
            for c in range(2):
                level = max(level, pool[i + a, j + b, k + c])
    return level


@njit(cache=True)
def _gap(gx: float, gy: float, gz: float, distance: FloatArray) -> float:
    """Return the signed distance between nodes [m]."""
    nx, ny, nz = distance.shape
    i, j, k = int(math.floor(gx)), int(math.floor(gy)), int(math.floor(gz))
    if i < 0 or j < 0 or k < 0 or i + 1 >= nx or j + 1 >= ny or k + 1 >= nz:
        return np.inf
    u, v, w = gx - i, gy - j, gz - k
    found = 0.0
    for a in range(2):
        for b in range(2):
            for c in range(2):
                share = (u if a else 1 - u) * (v if b else 1 - v) * (w if c else 1 - w)
                found += share * distance[i + a, j + b, k + c]
    return found


@njit(cache=True)
def touch_surfaces(
    position: Positions,
    tick: IntArray,
    dt: float,
    look: BoolArray,
    poses: FloatArray,
    up: FloatArray,
    solids: Solids,
    low: FloatArray,
    high: FloatArray,
    reach: float,
    level_cosine: float,
    rest_speed: float,
    body: int,
    manner: Bits,
    on: Labels,
    gap: npt.NDArray[np.float32],
) -> None:
    """Note which particles touch a body and how, where it is a firmer or nearer touch than one noted before.

    Args:
        position: World frame [m], shape (F, P, 3).
        tick: Tick of each frame, shape (F,).
        dt: Tick [s].
        look: Particles to look at, shape (F, P).
        poses: Pose of the body in each frame, shape (F, 7).
        up: Direction up in the world, shape (3,).
        solids: The body's solids in its frame.
        low: Least coordinates of the body in its frame [m]; minus infinity for a plane.
        high: Greatest coordinates [m].
        reach: Greatest distance of a touch [m].
        level_cosine: Least upward part of the surface's normal [1] of what lies on it.
        rest_speed: Speed relative to the body below which a particle rests [m/s].
        body: Number of the body, to be noted.
        manner: How each particle touches, filled in, shape (F, P).
        on: What it touches, filled in, shape (F, P).
        gap: How near it is [m], filled in, shape (F, P).
    """
    frame_count = position.shape[0]
    count = position.shape[1]
    which, local = np.empty(count, dtype=np.int64), np.empty((count, 3))
    faces, seen = np.empty((count, MOST_FACES, 4)), np.empty(count, dtype=np.int64)
    manners, gaps = np.empty(count, dtype=np.int64), np.empty(count)
    here, before, after = np.zeros(3), np.zeros(3), np.zeros(3)
    least, most = low - reach, high + reach
    for f in range(frame_count):
        pose = poses[f]
        first, last = max(f - 1, 0), min(f + 1, frame_count - 1)
        still = True
        for k in range(poses.shape[1]):
            still = still and poses[first, k] == poses[last, k]
        travel = rest_speed * max((tick[last] - tick[first]) * dt, 1e-9)
        ux, uy, uz = _turned_back(pose, up[0], up[1], up[2])
        near = 0
        for p in range(count):
            if not look[f, p]:
                continue
            _into(pose, position, f, p, here)
            if not (least[0] < here[0] < most[0] and least[1] < here[1] < most[1] and least[2] < here[2] < most[2]):
                continue
            for c in range(3):
                local[near, c] = here[c]
            which[near], manners[near], gaps[near] = p, 0, reach
            near += 1
        for k in range(len(solids.kind)):
            faces_of(solids, k, local, near, reach, faces, seen)
            for m in range(near):
                for i in range(seen[m]):
                    gaps[m] = min(gaps[m], faces[m, i, 0])
                    upward = faces[m, i, 1] * ux + faces[m, i, 2] * uy + faces[m, i, 3] * uz
                    manners[m] = max(manners[m], 2 if upward >= level_cosine else 1)
        for m in range(near):
            p, how, nearest = which[m], manners[m], gaps[m]
            if how == 2:
                square = 0.0
                if not still:
                    _into(poses[first], position, first, p, before)
                    _into(poses[last], position, last, p, after)
                for axis in range(3):
                    here[axis] = position[last, p, axis] - position[first, p, axis]
                    shift = here[axis] if still else after[axis] - before[axis]
                    square += shift * shift
                if square < travel * travel:
                    how = 3
            if how > manner[f, p] or (how == manner[f, p] and how > 0 and nearest < gap[f, p]):
                manner[f, p], on[f, p], gap[f, p] = how, body, nearest


@njit(cache=True)
def _turned_back(pose: FloatArray, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return a vector of the world along the axes of a pose."""
    w, a, b, c = pose[3], -pose[4], -pose[5], -pose[6]
    u, v, t = 2 * (b * z - c * y), 2 * (c * x - a * z), 2 * (a * y - b * x)
    return x + w * u + b * t - c * v, y + w * v + c * u - a * t, z + w * t + a * v - b * u


@njit(cache=True)
def _into(pose: FloatArray, position: Positions, f: int, p: int, found: FloatArray) -> None:
    """Write where a particle is in the frame of a pose."""
    x, y, z = position[f, p, 0] - pose[0], position[f, p, 1] - pose[1], position[f, p, 2] - pose[2]
    found[0], found[1], found[2] = _turned_back(pose, x, y, z)
