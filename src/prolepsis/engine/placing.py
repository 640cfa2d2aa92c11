"""Placing: lower a thing onto what it rests on until they touch."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from prolepsis.log.things import Thing
from prolepsis.scene.extent import support
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import KnowledgeError

TOUCHING = 1.0e-6
"""Gap that is left [m]: no impact to speak of, and no overlap."""


def resting_height(thing: Thing, below: Sequence[Thing]) -> float:
    """Return the height of a thing's frame at which it first touches ``below`` when lowered from above [m].

    Args:
        thing: What is placed; its x, y and orientation are kept.
        below: The bodies it is to rest on.

    Raises:
        KnowledgeError: If it would miss them.
    """
    down = np.array([0.0, 0.0, -1.0])
    planes = [t for t in below if any(g.type == "plane" for g in t.shape.geoms)]
    if planes:
        return planes[0].position[2] + support(thing, down) + TOUCHING
    top = max(t.position[2] + support(t, -down) for t in below)
    bottom = min(t.position[2] - support(t, down) for t in below)
    spec: Any = mujoco.MjSpec()
    spec.compiler.degree = False
    moving = spec.worldbody.add_body(name="moving", mocap=True, quat=list(thing.orientation))
    _add(spec, moving, thing, "moving")
    for k, other in enumerate(below):
        body = spec.worldbody.add_body(name=f"below{k}", pos=list(other.position), quat=list(other.orientation))
        _add(spec, body, other, f"below{k}")
    model = spec.compile()
    data = mujoco.MjData(model)
    height = top + support(thing, down) + TOUCHING
    pairs = [
        (model.geom(f"moving/{i}").id, model.geom(f"below{k}/{j}").id)
        for i in range(len(thing.shape.geoms))
        for k, other in enumerate(below)
        for j in range(len(other.shape.geoms))
    ]
    for _ in range(500):
        data.mocap_pos[0] = (thing.position[0], thing.position[1], height)
        mujoco.mj_kinematics(model, data)
        gap = min(mujoco.mj_geomDistance(model, data, a, b, 1.0, None) for a, b in pairs)
        if gap <= 2 * TOUCHING:
            return height
        # Straight down, the distance shrinks by no more than the way: nothing can be passed through.
        height -= max(gap - TOUCHING, TOUCHING)
        if height + support(thing, -down) < bottom:
            break
    names = ", ".join(sorted({t.whole or t.name for t in below}))
    x, y, _ = thing.position
    raise KnowledgeError(
        f"{thing.name} cannot rest on {names}: there is nothing of it under its place, x = {x:g}, y = {y:g} in the "
        "world; its own :x and :y are from what it is on"
    )


def _add(spec: Any, body: Any, thing: Thing, name: str) -> None:
    for k, geom in enumerate(thing.shape.geoms):
        made = body.add_geom(name=f"{name}/{k}", type=getattr(mujoco.mjtGeom, f"mjGEOM_{geom.type.upper()}"))
        if geom.type == "mesh":
            spec.add_mesh(name=f"{name}/{k}").uservert = np.asarray(geom.vertices).ravel()
            made.meshname = f"{name}/{k}"
        else:
            made.size = list(geom.size)
        made.pos, made.quat = list(geom.position), list(geom.orientation)
