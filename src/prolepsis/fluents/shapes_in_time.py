"""Rigid shapes as they are at a time: a body with all that it carries, a fragment as the union of its pieces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from prolepsis.fluents.observation import Observation
from prolepsis.geometry.rotations import inverses, matrix, multiply, rotate_back
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray, Shape
from prolepsis.geometry.solids import Solid, bounded


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Part:
    """One thing's shape, placed in the frame of the body that carries it."""

    shape: Shape
    """The shape in the thing's own frame."""
    displacement: FloatArray
    """Origin of the thing's frame in the body's [m], shape (3,)."""
    rotation: FloatArray
    """Rotation from the thing's frame to the body's, shape (3, 3)."""
    solids: tuple[Solid, ...]
    """Its convex solids, in the body's frame."""

    @property
    def is_exact(self) -> bool:
        """Whether the shape says more than its convex solids do."""
        return bool(self.shape.profile) or self.shape.surface is not None

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Return the least and greatest coordinates in the body's frame [m], each of shape (3,)."""
        if self.shape.profile:
            outline = np.array(self.shape.profile)
            wide, low, high = outline[:, 0].max(), outline[:, 1].min(), outline[:, 1].max()
            sides = ((-wide, wide), (-wide, wide), (low, high))
            corners = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 3)
        elif self.shape.surface is not None:
            corners = np.array(self.shape.surface.vertices)
        else:
            corners = np.concatenate([np.stack(solid.bounds()) for solid in self.solids])
            return corners.min(axis=0), corners.max(axis=0)
        points = corners @ self.rotation.T + self.displacement
        return points.min(axis=0), points.max(axis=0)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RigidShape:
    """One body's solids over the ticks during which it carries the same things."""

    body: int
    """Index of the thing that is the body."""
    solids: tuple[Solid, ...]
    """Its convex solids, in the body's frame."""
    parts: tuple[Part, ...]
    """The shapes that it consists of."""
    during: BoolArray
    """When it is so, shape (T,)."""

    @property
    def is_hollow(self) -> bool:
        """Whether it may have depressions: one convex solid has none."""
        return len(self.solids) > 1 or any(part.is_exact for part in self.parts)

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Return the least and greatest coordinates in the body's frame [m], each of shape (3,)."""
        several = [part.bounds() for part in self.parts]
        return np.min([low for low, _ in several], axis=0), np.max([high for _, high in several], axis=0)


def rigid_shapes(observation: Observation) -> tuple[RigidShape, ...]:
    """Return every rigid shape of the run. Pieces and blobs inside an intact whole are covered by its own shape."""
    found: dict[tuple[int, tuple[int, ...]], list[int]] = {}
    for segment, tick in enumerate(observation.segments.tolist()):
        carrier = observation.log.carrier[tick]
        for body in np.flatnonzero(carrier == np.arange(len(carrier))).tolist():
            if observation.has_role(body, "Panel"):
                continue  # A wall that has given way counts by the whole's own shape.
            found.setdefault((body, _carried(observation, body, np.flatnonzero(carrier == body))), []).append(segment)
    shapes: list[RigidShape] = []
    for (body, parts), segments in found.items():
        carried = _parts(observation, body, parts, int(observation.segments[segments[0]]))
        if carried:
            held = np.zeros(len(observation.segments), dtype=np.bool_)
            held[segments] = True
            solids = tuple(solid for part in carried for solid in part.solids)
            shapes.append(RigidShape(body=body, solids=solids, parts=carried, during=observation.spread(held)))
    return tuple(shapes)


def _carried(observation: Observation, body: int, candidates: IntArray) -> tuple[int, ...]:
    pieces = observation.has_role(body, "Piece")
    return tuple(
        int(i)
        for i in candidates.tolist()
        if i == body or observation.has_role(i, "Piece") == pieces and not observation.has_role(i, "Blob", "Stuff")
    )


def _parts(observation: Observation, body: int, parts: tuple[int, ...], tick: int) -> tuple[Part, ...]:
    pose = observation.log.poses[tick, body]
    found: list[Part] = []
    for part in parts:
        shape = observation.log.things[part].shape
        solids = bounded(shape)
        displacement, rotation = np.zeros(3), np.eye(3)
        if part != body:
            here = observation.log.poses[tick, part]
            displacement = rotate_back(pose[3:], here[:3] - pose[:3])
            rotation = matrix(multiply(inverses(pose[3:]), here[3:]))
            solids = tuple(_moved(solid, displacement, rotation) for solid in solids)
        if solids or shape.profile or shape.surface is not None:
            found.append(Part(shape=shape, displacement=displacement, rotation=rotation, solids=solids))
    return tuple(found)


def _moved(solid: Solid, displacement: FloatArray, rotation: FloatArray) -> Solid:
    return Solid(
        type=solid.type,
        size=solid.size,
        position=displacement + rotation @ solid.position,
        rotation=rotation @ solid.rotation,
        geom=solid.geom,
        corners=solid.corners,
    )
