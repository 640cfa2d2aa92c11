"""Rigid shapes as they are at a time: a body with all that it carries, a fragment as the union of its pieces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from prolepsis.fields.solids import Solid, bounded, matrix
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.rigid import multiply, rotate_back
from prolepsis.things import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RigidShape:
    """One body's solids over the ticks during which it carries the same things."""

    body: int
    """Index of the thing that is the body."""
    solids: tuple[Solid, ...]
    """Its convex solids, in the body's frame."""
    during: BoolArray
    """When it is so, shape (T,)."""


def rigid_shapes(observation: Observation) -> tuple[RigidShape, ...]:
    """Return every rigid shape of the run. Pieces and blobs inside an intact whole are covered by its own shape."""
    found: dict[tuple[int, tuple[int, ...]], list[int]] = {}
    for segment, tick in enumerate(observation.segments.tolist()):
        carrier = observation.log.carrier[tick]
        for body in np.flatnonzero(carrier == np.arange(len(carrier))).tolist():
            found.setdefault((body, _carried(observation, body, np.flatnonzero(carrier == body))), []).append(segment)
    shapes: list[RigidShape] = []
    for (body, parts), segments in found.items():
        solids = _solids(observation, body, parts, int(observation.segments[segments[0]]))
        if solids:
            held = np.zeros(len(observation.segments), dtype=np.bool_)
            held[segments] = True
            shapes.append(RigidShape(body=body, solids=solids, during=observation.spread(held)))
    return tuple(shapes)


def _carried(observation: Observation, body: int, candidates: IntArray) -> tuple[int, ...]:
    pieces = observation.has_role(body, "Piece")
    return tuple(
        int(i)
        for i in candidates.tolist()
        if i == body or observation.has_role(i, "Piece") == pieces and not observation.has_role(i, "Blob", "Stuff")
    )


def _solids(observation: Observation, body: int, parts: tuple[int, ...], tick: int) -> tuple[Solid, ...]:
    pose = observation.log.poses[tick, body]
    found: list[Solid] = []
    for part in parts:
        solids = bounded(observation.log.things[part].shape)
        if part == body:
            found += solids
            continue
        here = observation.log.poses[tick, part]
        shift = rotate_back(pose[3:], here[:3] - pose[:3])
        turn = matrix(multiply(pose[3:] * np.array([1.0, -1.0, -1.0, -1.0]), here[3:]))
        found += [_placed(solid, shift, turn) for solid in solids]
    return tuple(found)


def _placed(solid: Solid, shift: FloatArray, turn: FloatArray) -> Solid:
    return Solid(
        type=solid.type,
        size=solid.size,
        position=shift + turn @ solid.position,
        rotation=turn @ solid.rotation,
        geom=solid.geom,
        corners=solid.corners,
    )
