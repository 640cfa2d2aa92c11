"""Vessels: a wall with real thickness turned round the upright axis, in convex pieces; and an open box."""

from __future__ import annotations

import math
from collections.abc import Mapping

from prolepsis.geometry import turned
from prolepsis.geometry.shape import Geom, Shape, Triple
from prolepsis.geometry.turned import Point, Vessel
from prolepsis.scene.shapes.holes import Window, holes_of, refuse_holes, windows_of

SEGMENTS = 20
"""Wall pieces round a vessel: the wall departs from a circle by 1.2 % of its radius."""
CUP_RINGS, BOWL_RINGS = 1, 5
"""Wall pieces from the bottom of a cup, or a bowl, to its rim."""
SLIVER = 1e-6
"""Rows and pieces narrower than this [m, rad] are left out."""


def cup(q: Mapping[str, float]) -> Shape:
    """Return a round wall of outer ``radius`` and ``height`` on a flat bottom, all of ``thickness`` [m].

    The frame lies at the middle of the underside.
    """
    return _shape(turned.cup(q), q, CUP_RINGS)


def bowl(q: Mapping[str, float]) -> Shape:
    """Return a spherical cap of rim ``radius`` and ``height`` with a wall of ``thickness``, on a flat foot [m].

    The frame lies at the middle of the foot.
    """
    return _shape(turned.bowl(q), q, BOWL_RINGS)


def open_box(q: Mapping[str, float]) -> Shape:
    """Return a box without a lid, ``length`` x ``width`` x ``height`` outside, walls of ``thickness`` [m].

    The frame lies at the middle of the underside.

    Raises:
        KnowledgeError: If the walls leave no cavity.
    """
    refuse_holes(q, "an open box")
    limit = min(q["length"] / 2, q["width"] / 2, q["height"])
    turned.refuse_thick(q["thickness"], limit, "half its length and width, and its height")
    x, y, h, t = q["length"] / 2, q["width"] / 2, q["height"], q["thickness"] / 2
    middle = h / 2 + t
    return Shape(
        geoms=(
            Geom(type="box", size=(x, y, t), position=(0.0, 0.0, t)),
            Geom(type="box", size=(t, y, h / 2 - t), position=(x - t, 0.0, middle)),
            Geom(type="box", size=(t, y, h / 2 - t), position=(t - x, 0.0, middle)),
            Geom(type="box", size=(x - 2 * t, t, h / 2 - t), position=(0.0, y - t, middle)),
            Geom(type="box", size=(x - 2 * t, t, h / 2 - t), position=(0.0, t - y, middle)),
        )
    )


def _shape(vessel: Vessel, q: Mapping[str, float], rings: int) -> Shape:
    holes = holes_of(vessel, q)
    geoms = [*_bottom(vessel, q.get("bottomHoleRadius", 0.0)), *_walls(vessel, rings, windows_of(vessel, q))]
    if vessel.lid:
        radius, middle = vessel.outer[-1][0], vessel.brim + vessel.lid / 2
        geoms.append(Geom(type="cylinder", size=(radius, vessel.lid / 2, 0.0), position=(0.0, 0.0, middle)))
    return Shape(geoms=tuple(geoms), profile=vessel.outline, holes=holes)


def _bottom(vessel: Vessel, hole: float) -> list[Geom]:
    radius, top = vessel.outer[1][0], vessel.inner[0][1]
    if not hole:
        return [Geom(type="cylinder", size=(radius, top / 2, 0.0), position=(0.0, 0.0, top / 2))]
    return [
        _piece(((hole, 0.0), (radius, 0.0), (hole, top), (radius, top)), sides) for sides in _sides(((0.0, math.tau),))
    ]


def _walls(vessel: Vessel, rings: int, windows: tuple[Window, ...]) -> list[Geom]:
    """Return the convex pieces of the wall, cut so that each window stays open."""
    wall = vessel.wall
    edges = [wall.start + (wall.end - wall.start) * k / rings for k in range(rings + 1)]
    edges = sorted([*edges, *(edge for window in windows for edge in window.rows)])
    made: list[Geom] = []
    for low, high in zip(edges[:-1], edges[1:], strict=True):
        if high - low < SLIVER:
            continue
        open_here = [w.sides for w in windows if w.rows[0] < (low + high) / 2 < w.rows[1]]
        corners = (*wall.at(low), *wall.at(high))
        made += [_piece(corners, sides) for sides in _sides(_between(open_here))]
    return made


def _between(open_here: list[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    """Return the stretches round the axis that are not open [rad]; all of it if nothing is."""
    if not open_here:
        return ((0.0, math.tau),)
    ordered = sorted(open_here)
    following = [*ordered[1:], (ordered[0][0] + math.tau, 0.0)]
    return tuple((this[1], after[0]) for this, after in zip(ordered, following, strict=True))


def _sides(stretches: tuple[tuple[float, float], ...]) -> list[tuple[float, float]]:
    found: list[tuple[float, float]] = []
    for first, last in stretches:
        if last - first < SLIVER:
            continue
        count = math.ceil((last - first) / math.tau * SEGMENTS - SLIVER)
        step = (last - first) / count
        found += [(first + k * step, first + (k + 1) * step) for k in range(count)]
    return found


def _piece(corners: tuple[Point, ...], sides: tuple[float, float]) -> Geom:
    vertices: list[Triple] = [(r * math.cos(angle), r * math.sin(angle), z) for r, z in corners for angle in sides]
    return Geom(type="mesh", vertices=tuple(dict.fromkeys(vertices)))
