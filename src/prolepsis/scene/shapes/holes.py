"""Holes of a vessel: round ones in the exact shape, and as wide windows between the convex pieces of its wall."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from prolepsis.geometry.shape import Hole
from prolepsis.geometry.turned import Vessel
from prolepsis.terms.errors import KnowledgeError

QUANTITIES = ("holeRadius", "holeHeight", "holeCount", "holeAngle", "bottomHoleRadius")
"""What is said of holes."""
SQUARE = math.sqrt(math.pi) / 2
"""Half the side of a square over the radius of the circle of the same area [1]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Window:
    """A gap in the convex pieces of a wall, of the area of a round hole."""

    rows: tuple[float, float]
    """Where it begins and ends along the wall's parameter [m]."""
    sides: tuple[float, float]
    """Where it begins and ends round the axis [rad]."""


def refuse_holes(q: Mapping[str, float], what: str) -> None:
    """Refuse what is said of holes and lids in a shape that has none.

    Raises:
        KnowledgeError: If anything is said.
    """
    for name in (*QUANTITIES, "lid"):
        if q.get(name):
            raise KnowledgeError(f"{name} is given, but {what} cannot have one; allowed: cups and bowls")


def holes_of(vessel: Vessel, q: Mapping[str, float]) -> tuple[Hole, ...]:
    """Return the round holes of a vessel, drilled outwards from within its cavity.

    Raises:
        KnowledgeError: If a hole has no place in the wall, or not in the bottom.
    """
    made: list[Hole] = []
    bottom = q.get("bottomHoleRadius", 0.0)
    if bottom:
        widest, top = vessel.inner[1][0], vessel.inner[0][1]
        if not bottom < widest:
            raise KnowledgeError(f"bottomHoleRadius {bottom:g} m: allowed: less than {widest:g} m, the flat bottom's")
        made.append(Hole(position=(0.0, 0.0, (top + vessel.brim) / 2), direction=(0.0, 0.0, -1.0), radius=bottom))
    radius = q.get("holeRadius", 0.0)
    if not radius:
        return tuple(made)
    parameter = _parameter(vessel, q)
    (inner_r, inner_z), (outer_r, outer_z) = vessel.wall.at(parameter)
    across = math.hypot(outer_r - inner_r, outer_z - inner_z)
    along, up = (outer_r - inner_r) / across, (outer_z - inner_z) / across
    # From within the cavity, so that the wall on the other side stays whole.
    begin_r, begin_z = inner_r - along * inner_r / 2, inner_z - up * inner_r / 2
    for angle in _angles(q):
        c, s = math.cos(angle), math.sin(angle)
        position, direction = (begin_r * c, begin_r * s, begin_z), (along * c, along * s, up)
        made.append(Hole(position=position, direction=direction, radius=radius))
    return tuple(made)


def windows_of(vessel: Vessel, q: Mapping[str, float]) -> tuple[Window, ...]:
    """Return the gaps that the holes in the side leave in the convex pieces of the wall."""
    half = SQUARE * q.get("holeRadius", 0.0)
    if not half:
        return ()
    parameter = _parameter(vessel, q)
    half_angle = math.asin(half / _mean_radius(vessel, parameter))
    return tuple(
        Window(rows=(parameter - half, parameter + half), sides=(angle - half_angle, angle + half_angle))
        for angle in _angles(q)
    )


def _angles(q: Mapping[str, float]) -> list[float]:
    count = round(q.get("holeCount", 1.0))
    return [(q.get("holeAngle", 0.0) + math.tau * k / count) % math.tau for k in range(count)]


def _mean_radius(vessel: Vessel, parameter: float) -> float:
    return sum(r for r, _ in vessel.wall.at(parameter)) / 2


def _parameter(vessel: Vessel, q: Mapping[str, float]) -> float:
    """Return the parameter of the wall at the middle of the holes [m].

    Raises:
        KnowledgeError: If they do not fit there.
    """
    radius = q["holeRadius"]
    if "holeHeight" not in q:
        raise KnowledgeError("holeRadius is given without holeHeight, the height of the holes' middle")
    wall = vessel.wall
    parameter = wall.parameter(q["holeHeight"])
    low, high = parameter - radius, parameter + radius
    mean = _mean_radius(vessel, parameter)
    count = round(q.get("holeCount", 1.0))
    if low < wall.start or high > wall.end:
        raise KnowledgeError(
            f"a hole of radius {radius:g} m at the height {q['holeHeight']:g} m does not fit into the wall, "
            f"whose height is {wall.at(wall.start)[0][1]:g} to {wall.at(wall.end)[0][1]:g} m"
        )
    if count < 1 or radius >= mean or 2 * count * math.asin(radius / mean) >= math.tau:
        most = math.floor(math.pi / math.asin(min(radius / mean, 1.0)))
        raise KnowledgeError(f"{count} holes of radius {radius:g} m do not fit round the wall; allowed: 1 to {most}")
    return parameter
