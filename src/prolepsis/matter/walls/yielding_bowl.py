"""A bowl whose wall gives way: its panels as things and, in the world, as bodies that are hinged to its foot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from prolepsis.log.things import Thing, jointed
from prolepsis.matter.walls.panels import panels, resistance
from prolepsis.scene.kind import Building, Made
from prolepsis.scene.parts import Panel
from prolepsis.scene.running import MAX_STEP
from prolepsis.terms.errors import KnowledgeError

PANEL = "Panel"
"""Role of a part of a wall that gives way for itself."""
SMOOTHEST = 0.5
"""Greatest phase of a panel's swing in the longest substep [rad]; lighter ones are given more inertia."""
DAMPING_RATIO = 0.3
"""Damping of a panel's swing [1]: paper and clay hardly ring."""
CONTACT_TYPE, CONTACT_AFFINITY = 4, 3
"""Panels touch everything but each other."""


def bowl_parts(bowl: Thing) -> Made:
    """Return a bowl and the panels of its wall.

    Raises:
        KnowledgeError: If its wall cannot be divided, or nothing is known of how it resists.
    """
    q = bowl.quantities
    try:
        parts, resists = panels(bowl.shape, q), resistance(bowl)
    except KnowledgeError as error:
        raise KnowledgeError(f"{bowl.name} ({bowl.kind}): {error}") from None
    made = tuple(
        Thing(
            name=f"{bowl.name}/panel{k}",
            kind=PANEL,
            shape=replace(bowl.shape, geoms=part.geoms, profile=()),
            position=bowl.position,
            orientation=bowl.orientation,
            whole=bowl.name,
            roles=frozenset({PANEL}),
            mount=jointed(bowl.name),
            quantities={name: q[name] for name in ("friction", "surfaceStiffness") if name in q},
        )
        for k, part in enumerate(parts)
    )
    known = tuple(
        Panel(
            name=part.name,
            whole=bowl.name,
            lever=resists.lever,
            moment=resists.moment,
            stiffness=resists.stiffness,
        )
        for part in made
    )
    return Made(things=(bowl, *made), parts=known)


def hinge_panels(building: Building, bowl: Thing, parts: Sequence[Panel]) -> None:
    """Let the panels of a bowl in a world weigh and touch in the place of its wall, each on its hinge."""
    spec, scene = building.spec, building.scene
    own = [spec.geom(f"{bowl.name}/{k}") for k in range(1, len(bowl.shape.geoms))]
    mass = sum(float(geom.mass) for geom in own)
    for geom in own:
        # It stays there as what the bowl is called by, but neither weighs nor touches anything.
        geom.mass, geom.contype, geom.conaffinity = 0.0, 0, 0
    share = mass / len(own)
    for part, panel in zip(parts, panels(bowl.shape, bowl.quantities), strict=True):
        count = len(scene.thing(part.name).shape.geoms)
        for k in range(count):
            made = spec.geom(f"{part.name}/{k}")
            made.mass, made.contype, made.conaffinity = share, CONTACT_TYPE, CONTACT_AFFINITY
        inertia = share * count * part.lever**2 / 3
        needed = max(part.stiffness * (MAX_STEP / SMOOTHEST) ** 2, inertia)
        damping = 2 * DAMPING_RATIO * float(np.sqrt(part.stiffness * needed))
        building.add_hinge(part.name, panel.hinge, panel.axis, part.stiffness, damping, needed - inertia)
