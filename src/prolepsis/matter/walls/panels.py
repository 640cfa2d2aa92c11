"""The wall of a bowl that gives way: panels, each hinged to the foot, and the moment that each bears.

A paper wall folds when its rim is pushed with ``bucklingForce``. A clay wall yields all along: on both sides of a panel
the hoop bears the yield stress, which pushes the panel back by ``2 sin(pi / n) sigma t`` per length, and at its foot
the wall bends plastically, ``sigma w t^2 / 4``.

Source: limit analysis of thin shells (any text on plasticity).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from prolepsis.geometry import turned
from prolepsis.geometry.shape import Geom, Shape, Triple
from prolepsis.log.things import Thing
from prolepsis.scene.shapes.holes import refuse_holes
from prolepsis.scene.shapes.vessel import SEGMENTS
from prolepsis.terms.errors import KnowledgeError

NEEDED = {"BucklingBowl": ("bucklingForce", "bucklingDisplacement"), "DentingBowl": ("yieldStress", "youngsModulus")}
"""What must be known of how a wall gives way, by what it is."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PanelShape:
    """One part of a wall, in the vessel's frame."""

    geoms: tuple[Geom, ...]
    """Its solids."""
    hinge: Triple
    """A point on its hinge [m]."""
    axis: Triple
    """Unit vector along its hinge, about which it turns outwards."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Resistance:
    """How a panel resists being turned about its hinge."""

    lever: float
    """Distance of the rim from the hinge [m]."""
    moment: float
    """Moment at which it gives way [N m]."""
    stiffness: float
    """Moment over angle until then [N m/rad]."""


def panels(shape: Shape, q: Mapping[str, float]) -> tuple[PanelShape, ...]:
    """Return the panels of a bowl's wall; the bowl's first solid is its foot.

    Raises:
        KnowledgeError: If the wall cannot be divided so.
    """
    refuse_holes(q, "a bowl whose wall gives way")
    count = round(q["panelCount"])
    if SEGMENTS % count:
        raise KnowledgeError(f"panelCount {count}: allowed: 4, 5, 10 or 20")
    each = SEGMENTS // count
    radius, height = _foot(q)
    made: list[PanelShape] = []
    for k in range(count):
        middle = math.tau * (k + 0.5) / count
        c, s = math.cos(middle), math.sin(middle)
        geoms = tuple(geom for j, geom in enumerate(shape.geoms[1:]) if j % SEGMENTS // each == k)
        made.append(PanelShape(geoms=geoms, hinge=(radius * c, radius * s, height), axis=(-s, c, 0.0)))
    return tuple(made)


def resistance(bowl: Thing) -> Resistance:
    """Return how each panel of a yielding bowl's wall resists.

    Raises:
        KnowledgeError: If nothing is known of that.
    """
    q = bowl.quantities
    radius, foot = _foot(q)
    along, up = q["radius"] - radius, q["height"] - foot
    lever = math.hypot(along, up)
    for role, needed in NEEDED.items():
        if role in bowl.roles and (missing := [name for name in needed if name not in q]):
            raise KnowledgeError(f"it is a {role}, but its {missing[0]} is not known")
    if "BucklingBowl" in bowl.roles:
        moment = q["bucklingForce"] * lever
        return Resistance(lever=lever, moment=moment, stiffness=moment * lever / q["bucklingDisplacement"])
    if "DentingBowl" not in bowl.roles:
        raise KnowledgeError("its wall gives way, but neither its bucklingForce nor its yieldStress is known")
    stress, thickness, count = q["yieldStress"], q["thickness"], q["panelCount"]
    wall = turned.bowl(q).wall
    rings = 50
    # Of a push towards the axis the lever is the height over the hinge.
    heights = [wall.at(wall.start + (wall.end - wall.start) * (k + 0.5) / rings)[0][1] - foot for k in range(rings)]
    hoop = 2 * math.sin(math.pi / count) * stress * thickness * (wall.end - wall.start) * sum(heights) / rings
    bend = stress * math.tau * radius / count * thickness**2 / 4
    # The rim yields when its circle has changed by the material's yield strain.
    angle = stress / q["youngsModulus"] * q["radius"] / up
    return Resistance(lever=lever, moment=hoop + bend, stiffness=(hoop + bend) / angle)


def _foot(q: Mapping[str, float]) -> tuple[float, float]:
    """Return radius and height of the middle of the wall where it leaves the foot [m]."""
    wall = turned.bowl(q).wall
    inner, outer = wall.at(wall.start)
    return (inner[0] + outer[0]) / 2, (inner[1] + outer[1]) / 2
