"""The signed distance field of a shape: how far points are from its surface, negative within the solid."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from prolepsis.geometry.faces import (
    BOX,
    CAPSULE,
    CYLINDER,
    ELLIPSOID,
    GRID,
    HULL,
    MOST_FACES,
    PLANE,
    PROFILE,
    SHELL,
    SPHERE,
    Solids,
    faces_of,
)
from prolepsis.geometry.grid import grid_of
from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray, Patch, Shape, triple
from prolepsis.geometry.solids import Solid, solid_of
from prolepsis.geometry.thin_shells import ThinShell
from prolepsis.system.kernels import njit

PRIMITIVES = {
    "plane": PLANE,
    "sphere": SPHERE,
    "capsule": CAPSULE,
    "ellipsoid": ELLIPSOID,
    "cylinder": CYLINDER,
    "box": BOX,
    "mesh": HULL,
}

SAME = 1.0e-4
"""Centres of pieces that are nearer than this are one [m]."""
AT_ONCE = 1024
"""Points whose distances are computed at once."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Field:
    """The signed distance of one shape in the frame of its thing."""

    solids: Solids
    """The solids whose union it is."""

    def distance(self, points: FloatArray) -> FloatArray:
        """Return the signed distance of points, shape (N, 3), to the surface [m], shape (N,)."""
        return _distances(self.solids, np.ascontiguousarray(points, dtype=np.float64))


@lru_cache(maxsize=256)
def field_of(shape: Shape) -> Field:
    """Return the field of a shape: of its profile or surface if it has one, else of its convex solids."""
    return Field(solids=solids_as_arrays(shape))


def solids_as_arrays(shape: Shape) -> Solids:
    """Return a shape as flat arrays."""
    if shape.profile:
        outline = np.array(shape.profile)
        radius, bottom, top = outline[:, 0].max(), outline[:, 1].min(), outline[:, 1].max()
        bounds = np.array([-radius, -radius, bottom, radius, radius, top])
        holes = [(*hole.position, *hole.direction, hole.radius) for hole in shape.holes]
        return _joined([(PROFILE, _AT_HOME, np.zeros(3), bounds, _sides(outline).ravel(), np.ravel(holes))])
    if shape.patch is not None:
        return _patched([shape.patch], np.zeros((1, 3)))
    if shape.surface is not None:
        numbers = grid_of(shape.surface)
        bounds = np.concatenate([numbers[:3], numbers[:3] + numbers[3] * (numbers[4:7] - 1)])
        return _joined([(GRID, _AT_HOME, np.zeros(3), bounds, numbers, np.zeros(0))])
    return _joined([_convex(solid_of(geom)) for geom in shape.geoms])


def _sides(outline: FloatArray) -> FloatArray:
    """Return begin, end, direction and length of each side of a closed outline [m], shape (S, 7)."""
    end = np.roll(outline, -1, axis=0)
    edge = end - outline
    length = np.linalg.norm(edge, axis=1, keepdims=True)
    kept = length[:, 0] > 0.0
    return np.column_stack([outline, end, edge / np.maximum(length, 1e-300), length])[kept]


_AT_HOME = np.array([0.0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1])
_Row = tuple[int, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]
"""Kind, frame, size, bounds, numbers and holes of one solid."""


def _convex(solid: Solid) -> _Row:
    numbers = np.zeros(0) if solid.type != "mesh" else solid.planes
    frame = np.concatenate([solid.position, solid.rotation.ravel()])
    corners = solid.corners
    bounds = np.concatenate([corners.min(axis=0), corners.max(axis=0)])
    if solid.type == "plane":
        bounds = np.array([-np.inf, -np.inf, -np.inf, np.inf, np.inf, 0.0])
    elif solid.type == "capsule":
        bounds = np.array([-1.0, -1, -1, 1, 1, 1]) * solid.size[0] + np.array([0.0, 0, -1, 0, 0, 1]) * solid.size[1]
    elif solid.type in ("cylinder", "sphere"):
        size = solid.size[[0, 0, 1]] if solid.type == "cylinder" else np.full(3, solid.size[0])
        bounds = np.concatenate([-size, size])
    return (PRIMITIVES[solid.type], frame, solid.size, bounds, np.ravel(numbers), np.zeros(0))


def pieces_of(shell: ThinShell, there: BoolArray, position: FloatArray) -> Solids:
    """Return those pieces of a shell that are there as one solid, its middle at a position [m] in the frame."""
    size = np.asarray(shell.semi_axes)
    frame = np.concatenate([position, _AT_HOME[3:]])
    within = np.concatenate([-size, size])
    return _joined([(SHELL, frame, size, within, shell.numbers(there), np.zeros(0))])


Part = tuple[Shape, FloatArray]
"""A shape, and its pose on its body, shape (7,)."""


def placed(parts: Sequence[Part]) -> Solids:
    """Return the union of shapes with their poses; pieces of a shell are one solid, with no edges at joints."""
    patches = [shape.patch for shape, _ in parts if shape.patch is not None]
    if len(patches) < len(parts) or len(parts) < 2:
        return union_of([shifted(field_of(shape).solids, pose) for shape, pose in parts])
    poses = np.array([pose for _, pose in parts])
    turned = matrix(poses[0, 3:])
    positions = (poses[:, :3] - poses[0, :3]) @ turned
    return shifted(_patched(patches, positions), poses[0])


def _patched(patches: Sequence[Patch], positions: FloatArray) -> Solids:
    """Return pieces of one shell with their positions, shape (k, 3), as one solid."""
    middle = positions[0] + patches[0].middle
    centres = positions - middle
    beside = [np.reshape(each.neighbours, (-1, 3)) + at for each, at in zip(patches, centres, strict=True)]
    known = np.concatenate([centres, *beside])
    # Each once: pieces that are there first, then those only beside them.
    first = (np.linalg.norm(known[:, None] - known, axis=2) < SAME).argmax(axis=1)
    kept = known[first == np.arange(len(known))]
    shell = ThinShell(
        semi_axes=patches[0].semi_axes, thickness=patches[0].thickness, centres=tuple(triple(each) for each in kept)
    )
    return pieces_of(shell, np.arange(len(kept)) < len(centres), middle)


def _joined(rows: Sequence[_Row]) -> Solids:
    spans: list[tuple[int, int, int, int]] = []
    numbers: list[FloatArray] = []
    end = 0
    for *_, own, holes in rows:
        spans.append((end, len(own), end + len(own), len(holes)))
        numbers += [own, holes]
        end += len(own) + len(holes)
    return Solids(
        kind=np.array([row[0] for row in rows], dtype=np.int64),
        frame=np.array([row[1] for row in rows], dtype=np.float64).reshape(-1, 12),
        size=np.array([row[2] for row in rows], dtype=np.float64).reshape(-1, 3),
        bounds=np.array([row[3] for row in rows], dtype=np.float64).reshape(-1, 6),
        span=np.array(spans, dtype=np.int64).reshape(-1, 4),
        numbers=np.concatenate([np.zeros(0), *numbers]),
    )


@njit(cache=True)
def _distances(solids: Solids, points: FloatArray) -> FloatArray:
    result = np.full(len(points), np.inf)
    room = min(len(points), AT_ONCE)
    found, seen = np.zeros((room, MOST_FACES, 4)), np.zeros(room, dtype=np.int64)
    for begin in range(0, len(points), AT_ONCE):
        some = points[begin : begin + AT_ONCE]
        for k in range(len(solids.kind)):
            faces_of(solids, k, some, len(some), np.inf, found, seen)
            for i in range(len(some)):
                if seen[i] > 0:
                    result[begin + i] = min(result[begin + i], found[i, 0, 0])
    return result


def shifted(solids: Solids, pose: FloatArray) -> Solids:
    """Return solids as seen in a frame in which theirs has the given pose, shape (7,)."""
    rotation = matrix(pose[3:])
    frame = solids.frame.copy()
    frame[:, :3] = solids.frame[:, :3] @ rotation.T + pose[:3]
    frame[:, 3:] = (rotation @ solids.frame[:, 3:].reshape(-1, 3, 3)).reshape(-1, 9)
    return solids._replace(frame=frame)


def union_of(parts: Sequence[Solids]) -> Solids:
    """Return all solids of several, in their order."""
    spans: list[IntArray] = []
    end = 0
    for part in parts:
        spans.append(part.span + np.array([end, 0, end, 0]))
        end += len(part.numbers)
    if not parts:
        return _joined([])
    return Solids(
        kind=np.concatenate([part.kind for part in parts]),
        frame=np.concatenate([part.frame for part in parts]),
        size=np.concatenate([part.size for part in parts]),
        bounds=np.concatenate([part.bounds for part in parts]),
        span=np.concatenate(spans),
        numbers=np.concatenate([part.numbers for part in parts]),
    )
