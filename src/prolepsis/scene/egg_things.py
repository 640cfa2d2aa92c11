"""The things that an egg consists of: shell pieces and blobs of yolk and white, at rest inside one body.

Until liquids exist, a stuff is a handful of soft balls that come free when the shell opens.
"""

from __future__ import annotations

import numpy as np

from prolepsis.robots.hand import rotate
from prolepsis.shapes.egg import ellipsoid_shell
from prolepsis.things import FloatArray, Geom, Shape, Thing, Triple

PIECE_COUNT = 30
"""Pieces of a shell: enough for halves, caps and shards, few enough for a step of microseconds."""
BLOBS = {"yolk": (4, 0.0072), "white": (8, 0.0062)}
"""Number and radius [m] of the balls of a stuff. They fill a third of an egg, so they fit in whatever the packing."""
YOLK_COLOUR = (0.98, 0.72, 0.08, 1.0)
WHITE_COLOUR = (0.93, 0.93, 0.82, 0.75)
CLEARANCE = 0.0026
"""Distance between balls and mid-shell at the start [m]: flat pieces reach that far inside."""


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


def blobs(egg: Thing, stuffs: tuple[tuple[Thing, str], ...]) -> tuple[Thing, ...]:
    """Return the balls of an egg's stuffs, packed inside it.

    Args:
        egg: The egg.
        stuffs: Each stuff with its sort, ``"yolk"`` or ``"white"``.
    """
    rows = [(stuff, sort, k) for stuff, sort in stuffs for k in range(BLOBS[sort][0])]
    if not rows:
        return ()
    radii = np.array([BLOBS[sort][1] for _, sort, _ in rows])
    central = np.array([sort == "yolk" for _, sort, _ in rows])
    places = packed(np.asarray(egg.shape.geoms[0].size), radii, central)
    made: list[Thing] = []
    for (stuff, sort, k), radius, place in zip(rows, radii, places, strict=True):
        made.append(
            Thing(
                name=f"{stuff.name}/blob{k}",
                kind=stuff.kind,
                shape=Shape(
                    geoms=(Geom(type="sphere", size=(float(radius), 0.0, 0.0)),),
                    colour=YOLK_COLOUR if sort == "yolk" else WHITE_COLOUR,
                ),
                position=_placed(egg, place),
                orientation=egg.orientation,
                mass=stuff.mass / BLOBS[sort][0],
                whole=stuff.name,
                roles=frozenset({"Blob"}),
                # Stuff flows over a surface for a while and then lies: the resistance of a soft ball.
                quantities={"friction": stuff.quantities.get("friction", 0.2), "rollingFriction": 0.3 * float(radius)},
            )
        )
    return tuple(made)


def packed(semi_axes: FloatArray, radii: FloatArray, central: FloatArray) -> FloatArray:
    """Return centres of balls that lie apart inside an ellipsoid, shape (n, 3) [m].

    Balls push each other apart and are drawn back inside until none overlap; ``central`` ones start in the middle.
    """
    i = np.arange(len(radii)) + 0.5
    z = 1 - 2 * i / len(radii)
    angle = np.pi * (1 + 5**0.5) * i
    unit = np.stack([z, np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle)], axis=1)
    room = semi_axes[None, :] - radii[:, None] - CLEARANCE
    places = unit * room * np.where(central, 0.35, 0.95)[:, None]
    for _ in range(2000):
        apart = places[:, None, :] - places[None, :, :]
        distance = np.linalg.norm(apart, axis=2) + np.eye(len(radii))
        deficit = np.maximum(1.005 * (radii[:, None] + radii[None, :]) - distance, 0) * (1 - np.eye(len(radii)))
        if deficit.max() <= 0:
            break
        places = places + 0.4 * (apart / distance[:, :, None] * deficit[:, :, None]).sum(axis=1)
        outside = np.linalg.norm(places / room, axis=1, keepdims=True)
        places = places / np.maximum(outside, 1)
    return places


def _placed(egg: Thing, offset: FloatArray) -> Triple:
    x, y, z = np.asarray(egg.position) + rotate(egg.orientation, (offset[0], offset[1], offset[2]))
    return (float(x), float(y), float(z))


def egg_things(egg: Thing, shell: Thing, stuffs: tuple[tuple[Thing, str], ...]) -> tuple[Thing, ...]:
    """Return an egg with its parts, pieces and blobs, in that order."""
    parts = (shell, *(stuff for stuff, _ in stuffs))
    return (egg, *parts, *shell_pieces(egg, shell), *blobs(egg, stuffs))
