"""Vessels: a wall with real thickness turned round the upright axis, in convex pieces; and an open box."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from prolepsis.things import Geom, Triple

SEGMENTS = 20
"""Wall pieces round a vessel: the wall departs from a circle by 1.2 % of its radius."""
RINGS = 5
"""Wall pieces from the bottom of a bowl to its rim."""

Point = tuple[float, float]
"""Radius and height [m]."""


def turned(inner: Sequence[Point], outer: Sequence[Point]) -> tuple[Geom, ...]:
    """Return the convex pieces of a wall between two profiles with equally many points, bottom first."""
    made: list[Geom] = []
    for k in range(len(inner) - 1):
        corners = (inner[k], inner[k + 1], outer[k], outer[k + 1])
        for s in range(SEGMENTS):
            sides = (2 * math.pi * s / SEGMENTS, 2 * math.pi * (s + 1) / SEGMENTS)
            vertices: list[Triple] = [
                (r * math.cos(angle), r * math.sin(angle), z) for r, z in corners for angle in sides
            ]
            made.append(Geom(type="mesh", vertices=tuple(dict.fromkeys(vertices))))
    return tuple(made)


def cup(q: Mapping[str, float]) -> tuple[Geom, ...]:
    """Return a round wall of outer ``radius`` and ``height`` on a flat bottom, all of ``thickness`` [m].

    The frame lies at the middle of the underside.
    """
    r, h, t = q["radius"], q["height"], q["thickness"]
    bottom = Geom(type="cylinder", size=(r, t / 2, 0.0), position=(0.0, 0.0, t / 2))
    return (bottom, *turned([(r - t, t), (r - t, h)], [(r, t), (r, h)]))


def bowl(q: Mapping[str, float]) -> tuple[Geom, ...]:
    """Return a spherical cap of rim ``radius`` and ``height`` with a wall of ``thickness``, on a flat foot [m].

    The frame lies at the middle of the foot.
    """
    r, h, t = q["radius"], q["height"], q["thickness"]
    sphere = (r * r + h * h) / (2 * h)
    foot = 0.35 * r
    angles = [
        math.asin(foot / sphere) + k / RINGS * (_opening(r, h) - math.asin(foot / sphere)) for k in range(RINGS + 1)
    ]
    outer = [(sphere * math.sin(a), sphere * (1 - math.cos(a))) for a in angles]
    inner = [((sphere - t) * math.sin(a), sphere - (sphere - t) * math.cos(a)) for a in angles]
    base = Geom(type="cylinder", size=(foot, (inner[0][1]) / 2, 0.0), position=(0.0, 0.0, inner[0][1] / 2))
    return (base, *turned(inner, outer))


def _opening(radius: float, height: float) -> float:
    """Return the polar angle of the rim of a spherical cap [rad]."""
    return math.atan2(radius, (radius * radius + height * height) / (2 * height) - height)


def open_box(q: Mapping[str, float]) -> tuple[Geom, ...]:
    """Return a box without a lid, ``length`` x ``width`` x ``height`` outside, walls of ``thickness`` [m].

    The frame lies at the middle of the underside.
    """
    x, y, h, t = q["length"] / 2, q["width"] / 2, q["height"], q["thickness"] / 2
    middle = h / 2 + t
    return (
        Geom(type="box", size=(x, y, t), position=(0.0, 0.0, t)),
        Geom(type="box", size=(t, y, h / 2 - t), position=(x - t, 0.0, middle)),
        Geom(type="box", size=(t, y, h / 2 - t), position=(t - x, 0.0, middle)),
        Geom(type="box", size=(x - 2 * t, t, h / 2 - t), position=(0.0, y - t, middle)),
        Geom(type="box", size=(x - 2 * t, t, h / 2 - t), position=(0.0, t - y, middle)),
    )
