"""The shards that a shell may fall into, as things, and the room that they leave inside."""

from __future__ import annotations

import numpy as np

from prolepsis.geometry.shape import FloatArray, Geom, Shape, Triple
from prolepsis.log.things import WITHIN, Thing
from prolepsis.robots.hand import rotate
from prolepsis.scene.parts import Shard
from prolepsis.scene.shapes.egg import Shell, curvature_radius, ellipsoid_shell

CLEARANCE = 0.99
"""Size of what is firm inside a shell over the room that the pieces leave [1]."""


def shell_of(egg: Thing, shell: Thing) -> Shell:
    """Return the shell of an egg, cut into as many pieces as it may fall into."""
    a, b, c = egg.shape.geoms[0].size
    return ellipsoid_shell((a, b, c), round(shell.quantities["pieceCount"]), shell.quantities["shellThickness"])


def room_within(egg: Thing, shell: Thing) -> float:
    """Return the size of an ellipsoid of the egg's form that touches no piece of its shell, over the egg's [1]."""
    cut = shell_of(egg, shell)
    room = 1.0
    for centre, normal, outline in zip(cut.centres, cut.normals, cut.outlines, strict=True):
        # The inner face of a convex piece is flat: it lies as deep as its corners.
        outside = float(centre @ normal)
        room = min(room, (outside + float((outline @ normal).min())) / outside)
    return CLEARANCE * room


def shell_pieces(egg: Thing, shell: Thing) -> tuple[tuple[Thing, ...], tuple[Shard, ...]]:
    """Return the pieces of an egg's shell as things, with their share of its mass, and what they are."""
    parts = shell_of(egg, shell)
    made: list[Thing] = []
    shards: list[Shard] = []
    for k, (centre, outline, area) in enumerate(zip(parts.centres, parts.outlines, parts.areas, strict=True)):
        vertices = tuple((float(x), float(y), float(z)) for x, y, z in outline)
        made.append(
            Thing(
                name=f"{shell.name}/piece{k}",
                kind=f"{shell.kind}Piece",
                shape=Shape(geoms=(Geom(type="mesh", vertices=vertices),), colour=egg.shape.colour),
                position=_placed(egg, centre),
                orientation=egg.orientation,
                mass=float(shell.mass * area / parts.areas.sum()),
                whole=shell.name,
                mount=WITHIN,
                roles=frozenset({"Piece"}),
                quantities={"friction": shell.quantities["friction"]},
            )
        )
        radius = curvature_radius(np.asarray(egg.shape.geoms[0].size), centre)
        shards.append(Shard(name=made[-1].name, whole=egg.name, area=float(area), radius=radius))
    return tuple(made), tuple(shards)


def _placed(egg: Thing, offset: FloatArray) -> Triple:
    x, y, z = np.asarray(egg.position) + rotate(egg.orientation, (offset[0], offset[1], offset[2]))
    return (float(x), float(y), float(z))
