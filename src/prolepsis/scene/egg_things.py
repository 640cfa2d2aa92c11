"""The things that an egg consists of: shell, stuffs, and the pieces that the shell falls into."""

from __future__ import annotations

import numpy as np

from prolepsis.robots.hand import rotate
from prolepsis.shapes.egg import ellipsoid_shell
from prolepsis.things import FloatArray, Geom, Shape, Thing, Triple

PIECE_COUNT = 30
"""Pieces of a shell: enough for halves, caps and shards, few enough for a step of microseconds."""


def shell_pieces(egg: Thing, shell: Thing) -> tuple[Thing, ...]:
    """Return the pieces of an egg's shell, with their share of its mass."""
    a, b, c = egg.shape.geoms[0].size
    parts = ellipsoid_shell((a, b, c), PIECE_COUNT, shell.quantities["shellThickness"])
    made: list[Thing] = []
    for k, (centre, outline, area) in enumerate(zip(parts.centres, parts.outlines, parts.areas, strict=True)):
        vertices = tuple((float(x), float(y), float(z)) for x, y, z in outline)
        made.append(
            Thing(
                name=f"{shell.name}/piece{k}",
                kind="EggShellPiece",
                shape=Shape(geoms=(Geom(type="mesh", vertices=vertices),), colour=egg.shape.colour),
                position=_placed(egg, centre),
                orientation=egg.orientation,
                mass=float(shell.mass * area / parts.areas.sum()),
                whole=shell.name,
                roles=frozenset({"Piece"}),
                quantities={"friction": shell.quantities["friction"]},
            )
        )
    return tuple(made)


def _placed(egg: Thing, offset: FloatArray) -> Triple:
    x, y, z = np.asarray(egg.position) + rotate(egg.orientation, (offset[0], offset[1], offset[2]))
    return (float(x), float(y), float(z))


def egg_things(egg: Thing, shell: Thing, stuffs: tuple[Thing, ...]) -> tuple[Thing, ...]:
    """Return an egg with its parts and the pieces of its shell, in that order."""
    return (egg, shell, *stuffs, *shell_pieces(egg, shell))
