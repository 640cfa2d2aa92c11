"""A bowl whose wall gives way: its panels as things and, in the world, as bodies that are hinged to its foot."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from prolepsis.log.things import Thing
from prolepsis.scene.shapes.panels import panels, resistance
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import KnowledgeError

PANEL = "Panel"
"""Role of a part of a wall that gives way for itself."""
SMOOTHEST = 0.5
"""Greatest phase of a panel's swing in the longest substep [rad]; lighter ones are given more inertia."""
DAMPING_RATIO = 0.3
"""Damping of a panel's swing [1]: paper and clay hardly ring."""
CONTACT_TYPE, CONTACT_AFFINITY = 4, 3
"""Panels touch everything but each other."""


def bowl_things(bowl: Thing) -> tuple[Thing, ...]:
    """Return a bowl and the panels of its wall.

    Raises:
        KnowledgeError: If its wall cannot be divided, or nothing is known of how it resists.
    """
    q = bowl.quantities
    try:
        parts, resists = panels(bowl.shape, q), resistance(q)
    except KnowledgeError as error:
        raise KnowledgeError(f"{bowl.name} ({bowl.kind}): {error}") from None
    known = {name: q[name] for name in ("friction", "surfaceStiffness") if name in q}
    known |= {"lever": resists.lever, "moment": resists.moment, "stiffness": resists.stiffness}
    made = tuple(
        Thing(
            name=f"{bowl.name}/panel{k}",
            kind=PANEL,
            shape=replace(bowl.shape, geoms=part.geoms, profile=()),
            position=bowl.position,
            orientation=bowl.orientation,
            whole=bowl.name,
            roles=frozenset({PANEL}),
            quantities=known,
        )
        for k, part in enumerate(parts)
    )
    return (bowl, *made)


def add_panels(spec: Any, bowl: Thing, parts: tuple[Thing, ...], add_geom: Callable[..., Any], step: float) -> None:
    """Move the wall of a bowl in the spec from its own body to those of its panels.

    Args:
        spec: The world, with the bowl as one rigid body.
        bowl: The bowl.
        parts: Its panels.
        add_geom: Adds a solid of a thing to a body: body, thing, number of the solid, mass [kg].
        step: The longest substep [s].
    """
    q = bowl.quantities
    base = spec.body(bowl.name)
    own = [spec.geom(f"{bowl.name}/{k}") for k in range(1, len(bowl.shape.geoms))]
    mass = sum(float(geom.mass) for geom in own)
    for geom in own:
        # It stays there as what the bowl is called by, but neither weighs nor touches anything.
        geom.mass, geom.contype, geom.conaffinity = 0.0, 0, 0
    for part, panel in zip(parts, panels(bowl.shape, q), strict=True):
        body = base.add_body(name=part.name)
        share = mass / len(own)
        for k in range(len(part.shape.geoms)):
            made = add_geom(body, part, k, mass=share)
            made.contype, made.conaffinity = CONTACT_TYPE, CONTACT_AFFINITY
        stiffness, lever = part.quantities["stiffness"], part.quantities["lever"]
        inertia = share * len(part.shape.geoms) * lever**2 / 3
        needed = max(stiffness * (step / SMOOTHEST) ** 2, inertia)
        body.add_joint(
            name=part.name,
            type=mujoco.mjtJoint.mjJNT_HINGE,
            pos=list(panel.hinge),
            axis=list(panel.axis),
            stiffness=[stiffness, 0, 0],
            damping=[2 * DAMPING_RATIO * float(np.sqrt(stiffness * needed)), 0, 0],
            armature=needed - inertia,
        )
