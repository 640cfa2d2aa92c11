"""Where the bodies of a granular stuff are at the start: in layers within a vessel, or side by side on a surface."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from prolepsis.geometry.hollows import Basin, space_of
from prolepsis.geometry.packing import lattice
from prolepsis.geometry.shape import FloatArray, Geom, Shape, triple
from prolepsis.geometry.signed_distance import shifted
from prolepsis.log.things import Thing
from prolepsis.scene.kind import RestingHeight
from prolepsis.scene.posed import Posed, nearest, posed
from prolepsis.terms.errors import KnowledgeError

APART = 1.02
"""Distance of neighbours over their diameter [1]: they do not press on each other at the start."""
CLOSE = 2.5e-4
"""How far the lowest layer may be above the ground at first [m]."""
PASSES = 0.7
"""Share of their radius that gaps must leave on either side for the bodies to fall through [1], as in recognition."""
UP = np.array([0.0, 0.0, 1.0])
"""Direction against gravity."""


def packed(grains: Sequence[Thing], stuff: str, vessel: Sequence[Thing], solids: Sequence[Thing]) -> list[Thing]:
    """Return bodies in layers from the bottom of a vessel upwards, clear of each other and of what else is in it.

    Args:
        grains: The bodies, not yet placed.
        stuff: What they are.
        vessel: The bodies of the vessel.
        solids: All bodies that are at their places.

    Raises:
        KnowledgeError: If they do not fit below the brim.
    """
    radius = max(map(around, grains))
    container = posed(replace(vessel[0], shape=replace(vessel[0].shape, holes=()))) if vessel else None
    basin = None if container is None else _basin(container, vessel[0], PASSES * radius)
    if container is None or basin is None:
        raise KnowledgeError(f"{vessel[0].name if vessel else stuff} contains {stuff}, but has no cavity as it stands")
    matter = [container, *_near(solids, container, radius)]
    low, high = container.low.copy(), container.high.copy()
    high[2] = basin.brim
    points = np.zeros((0, 3))
    for height in np.arange(basin.bottom - basin.step + radius, basin.brim, CLOSE).tolist():
        low[2] = height
        points = lattice(low, high, 2 * APART * radius)
        points = points[basin.within(points)]
        points = points[nearest(matter, points) >= radius]
        if len(points) and points[:, 2].min() < height + CLOSE:
            break
    if len(points) < len(grains):
        raise KnowledgeError(
            f"{stuff}: {len(grains)} bodies of {2e3 * radius:.3g} mm are to be in {container.name}, where "
            f"{len(points)} have room below the brim"
        )
    beside = np.hypot(*(points - (low + high) / 2)[:, :2].T)
    return _at(grains, points[np.lexsort((beside, points[:, 2]))])


def layer(
    grains: Sequence[Thing],
    stuff: str,
    middle: tuple[float, float],
    under: Sequence[Thing],
    solids: Sequence[Thing],
    resting_height: RestingHeight,
) -> list[Thing]:
    """Return bodies side by side on a level surface, round a place in the world [m].

    Raises:
        KnowledgeError: If the surface is not level so far, or something else is there.
    """
    radius, (x, y) = max(map(around, grains)), middle
    ball = Thing(name=stuff, kind="Granular", shape=Shape(geoms=(Geom(type="sphere", size=(radius, 0.0, 0.0)),)))
    ground = [thing for thing in under if thing.shape.geoms]
    height = resting_height(replace(ball, position=(x, y, 0.0)), ground)
    half = (math.ceil(math.sqrt(len(grains))) + 1) * APART * radius
    low, high = np.array([x - half, y - half, height]), np.array([x + half, y + half, height])
    points = lattice(low, high, 2 * APART * radius)
    points = points[np.argsort(np.hypot(points[:, 0] - x, points[:, 1] - y), kind="stable")][: len(grains)]
    surface = nearest([posed(thing) for thing in ground], points)
    others = nearest([posed(thing) for thing in solids if thing.shape.geoms], points)
    if (np.abs(surface - radius) > CLOSE).any() or (others < radius - CLOSE).any():
        raise KnowledgeError(
            f"{stuff}: {len(grains)} bodies of {2e3 * radius:.3g} mm do not lie side by side round x = {x:g}, "
            f"y = {y:g}, where {under[0].whole or under[0].name} is not level or not free so far; allowed: elsewhere, "
            "or :contains"
        )
    return _at(grains, points)


def around(grain: Thing) -> float:
    """Return the radius of the ball about a body's origin that has all of it inside [m]."""
    return max(float(np.linalg.norm(geom.position)) + _reach(geom) for geom in grain.shape.geoms)


def _reach(geom: Geom) -> float:
    size = geom.size
    match geom.type:
        case "sphere":
            return size[0]
        case "ellipsoid":
            return max(size)
        case "cylinder":
            return math.hypot(size[0], size[1])
        case "capsule":
            return size[0] + size[1]
        case "mesh":
            return float(np.linalg.norm(geom.vertices, axis=1).max())
        case _:
            return float(np.linalg.norm(size))


def _basin(container: Posed, vessel: Thing, clearance: float) -> Basin | None:
    solids = shifted(container.field.solids, np.array([*vessel.position, *vessel.orientation]))
    return space_of(solids, container.low, container.high).basin(UP, clearance)


def _near(solids: Sequence[Thing], container: Posed, radius: float) -> list[Posed]:
    low, high = container.low - radius, container.high + radius
    others = (posed(thing) for thing in solids if thing.shape.geoms and thing.name != container.name)
    return [each for each in others if (each.low < high).all() and (each.high > low).all()]


def _at(grains: Sequence[Thing], points: FloatArray) -> list[Thing]:
    return [replace(grain, position=triple(point)) for grain, point in zip(grains, points, strict=False)]
