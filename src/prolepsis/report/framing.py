"""How far a thing reaches in a picture: the corners of its box, wherever it is."""

from __future__ import annotations

import itertools

import numpy as np

from prolepsis.geometry.rotations import rotate
from prolepsis.geometry.shape import FloatArray, Geom
from prolepsis.log.things import Thing

LARGEST = 0.3
"""Things draw the camera no farther than this from their middle [m]: a table that moves need not be seen whole."""


def corners(thing: Thing, poses: FloatArray) -> FloatArray:
    """Return the corners of a thing's box at each of ``poses`` (k, 7) in the world [m], shape (8 k, 3)."""
    boxes = [_box(geom) for geom in thing.shape.geoms if geom.type != "plane"]
    if not boxes:
        return poses[:, :3]
    low = np.clip(np.min([box[0] for box in boxes], axis=0), -LARGEST, LARGEST)
    high = np.clip(np.max([box[1] for box in boxes], axis=0), -LARGEST, LARGEST)
    own = np.array(list(itertools.product(*zip(low, high, strict=True))))
    return (poses[:, None, :3] + rotate(poses[:, None, 3:], own)).reshape(-1, 3)


def _box(geom: Geom) -> tuple[FloatArray, FloatArray]:
    """Return the lower and upper corner of a geom's box in the thing's frame [m]."""
    if geom.type == "mesh":
        own = np.asarray(geom.vertices, dtype=np.float64)
    else:
        x, y, z = geom.size
        half = {"box": (x, y, z), "ellipsoid": (x, y, z), "cylinder": (x, x, y), "capsule": (x, x, x + y)}
        own = np.array(list(itertools.product(*((-s, s) for s in half.get(geom.type, (x, x, x))))))
    points = rotate(np.asarray(geom.orientation), own) + np.asarray(geom.position)
    return points.min(axis=0), points.max(axis=0)
