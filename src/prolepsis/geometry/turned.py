"""A vessel that is turned round its axis: the lines of its wall, the outline they enclose, and what it holds.

Lines are points (radius, height) [m] from the axis at the bottom to the rim.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from prolepsis.terms.errors import KnowledgeError

Point = tuple[float, float]
"""Radius and height [m]."""

ARC_POINTS = 16
"""Points along the arc of a bowl: the outline departs from it by less than 0.1 mm in a bowl of 16 cm."""
FOOT = 0.35
"""Radius of a bowl's flat foot over that of its rim [1]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Wall:
    """The wall between the bottom and the rim, along a parameter: the height of a cup, the arc of a bowl [m]."""

    start: float
    """Parameter at the bottom [m]."""
    end: float
    """Parameter at the rim [m]."""
    at: Callable[[float], tuple[Point, Point]]
    """The inner and the outer point at a parameter."""
    parameter: Callable[[float], float]
    """Parameter at which the middle of the wall has a height [m]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Vessel:
    """A round vessel."""

    inner: tuple[Point, ...]
    """Line of the cavity, from the bottom's middle to the rim."""
    outer: tuple[Point, ...]
    """Line of the outside, from the bottom's middle to the rim."""
    wall: Wall
    """The wall without the bottom."""
    lid: float = 0.0
    """Thickness of the flat lid [m]; 0 for an open vessel."""

    @property
    def brim(self) -> float:
        """Height up to which it can be filled [m]."""
        return self.inner[-1][1]

    @property
    def outline(self) -> tuple[Point, ...]:
        """The closed outline of the matter, counter-clockwise. With a lid it ends on the axis at both ends."""
        if not self.lid:
            return (*self.outer, *reversed(self.inner))
        radius, top = self.outer[-1][0], self.brim + self.lid
        return (*self.outer, (radius, top), (0.0, top), (0.0, self.brim), *reversed(self.inner))

    @property
    def volume(self) -> float:
        """Volume of the matter [m^3], holes left out."""
        outline = self.outline
        return abs(swept((*outline, outline[0])))

    @property
    def capacity(self) -> float:
        """Volume of the cavity up to the brim [m^3]."""
        return swept(self.inner)


def swept(line: Sequence[Point]) -> float:
    """Return the volume between a line and the axis that it is turned round [m^3], downward parts counted less."""
    return sum(
        math.pi / 3 * (b[1] - a[1]) * (a[0] ** 2 + a[0] * b[0] + b[0] ** 2)
        for a, b in zip(line[:-1], line[1:], strict=True)
    )


def cup(q: Mapping[str, float]) -> Vessel:
    """Return a round wall of outer ``radius`` and ``height`` on a flat bottom, all of ``thickness`` [m].

    Raises:
        KnowledgeError: If the wall leaves no cavity.
        KeyError: If an extent is missing.
    """
    r, h, t = q["radius"], q["height"], q["thickness"]
    refuse_thick(t, min(r, h), "radius and height")

    def at(height: float) -> tuple[Point, Point]:
        return (r - t, height), (r, height)

    return Vessel(
        inner=((0.0, t), (r - t, t), (r - t, h)),
        outer=((0.0, 0.0), (r, 0.0), (r, h)),
        wall=Wall(start=t, end=h, at=at, parameter=lambda height: height),
        lid=t if q.get("lid") else 0.0,
    )


def bowl(q: Mapping[str, float]) -> Vessel:
    """Return a spherical cap of rim ``radius`` and ``height`` with a wall of ``thickness``, on a flat foot [m].

    Raises:
        KnowledgeError: If the wall leaves no cavity.
        KeyError: If an extent is missing.
    """
    r, h, t = q["radius"], q["height"], q["thickness"]
    refuse_thick(t, min(r, h) / 2, "half its radius and height")
    sphere = (r * r + h * h) / (2 * h)
    foot, middle = FOOT * r, sphere - t / 2

    def at(arc: float) -> tuple[Point, Point]:
        angle = arc / middle
        sine, cosine = math.sin(angle), math.cos(angle)
        return ((sphere - t) * sine, sphere - (sphere - t) * cosine), (sphere * sine, sphere * (1 - cosine))

    def parameter(height: float) -> float:
        return middle * math.acos(min(max((sphere - height) / middle, -1.0), 1.0))

    start, end = middle * math.asin(foot / sphere), middle * math.atan2(r, sphere - h)
    points = [at(start + (end - start) * k / (ARC_POINTS - 1)) for k in range(ARC_POINTS)]
    inner, outer = zip(*points, strict=True)
    return Vessel(
        inner=((0.0, inner[0][1]), *inner),
        outer=((0.0, 0.0), (foot, 0.0), *outer),
        wall=Wall(start=start, end=end, at=at, parameter=parameter),
        lid=t if q.get("lid") else 0.0,
    )


def refuse_thick(thickness: float, limit: float, what: str) -> None:
    """Refuse a wall that fills what it should surround [m].

    Raises:
        KnowledgeError: With what is allowed.
    """
    if not thickness < limit:
        raise KnowledgeError(f"thickness {thickness:g} m leaves no cavity; allowed: less than {what}, here {limit:g} m")


VESSELS: Mapping[str, Callable[[Mapping[str, float]], Vessel]] = {"cup": cup, "bowl": bowl}
"""Round vessels by the ontology's name of the shape."""
