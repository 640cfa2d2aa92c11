"""From a model of any origin to one that fits into a world: what moves it from outside or is only seen goes, all is
named, one body carries all, its parts do not touch each other."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import ScenarioError

ROOT = "mount"
"""Body that is added if none carries all others."""
OWN, OTHERS = 2, 1
"""Contact bits of a robot: its geoms touch everything but each other, since neighbouring links overlap in many models.
A world lets its arms touch."""
UNCOLOURED = [0.5, 0.5, 0.5, 1.0]
"""What MuJoCo takes for no colour: only then the material's is seen."""


def fit_into_world(spec: Any, classes: Iterable[str], path: Path) -> None:
    """Leave in a model what a robot is: its links, what they touch with, and how they hang together.

    Args:
        spec: The ``mujoco.MjSpec``, not compiled yet.
        classes: Names of its default classes.
        path: Its file, for messages.

    Raises:
        ScenarioError: If it touches with a shape that is not supported.
    """
    _let_go(spec)
    _touch_others_only(spec, path)
    _drop_looks(spec, classes)


def name_all(spec: Any) -> None:
    """Give each body and each joint a name, since things and servos are known by it."""
    for what, parts in (("body", spec.bodies[1:]), ("joint", spec.joints)):
        taken = {part.name for part in parts}
        for number, part in enumerate(parts):
            if not part.name:
                part.name = free_name(f"{what}{number}", taken)
                taken.add(part.name)


def free_name(name: str, taken: Iterable[str]) -> str:
    """Return a name that is not taken, the given one if it is free."""
    while name in taken:
        name += "_"
    return name


def on_one_body(spec: Any) -> Any:
    """Return a robot in which one body that stands still carries all others."""
    tops = list(spec.worldbody.bodies)
    if len(tops) == 1 and not list(tops[0].joints) and not list(spec.worldbody.geoms):
        # A total mass would be that of a whole world; what is written has masses of its own.
        return spec if spec.compiler.settotalmass <= 0.0 else mujoco.MjSpec.from_string(spec.to_xml())
    root = free_name(ROOT, {body.name for body in spec.bodies})
    tree = ElementTree.fromstring(spec.to_xml())
    world = tree.find("worldbody")
    assert world is not None
    carried = list(world)
    for each in carried:
        world.remove(each)
    ElementTree.SubElement(world, "body", name=root).extend(carried)
    return mujoco.MjSpec.from_string(ElementTree.tostring(tree, encoding="unicode"))


def _let_go(spec: Any) -> None:
    """Take away the marks by which a program drags a robot, with all that ties it to them."""
    for body in list(spec.worldbody.bodies):
        if not body.mocap:
            continue
        if body.find_all("joint"):
            # The robot hangs on it.
            body.mocap = False
        else:
            spec.delete(body)


def _touch_others_only(spec: Any, path: Path) -> None:
    """Have all touch other things that touches anything; drop what is only seen, and the floor."""
    # Pairs touch whatever their bits say, and what a robot is here does not touch itself.
    paired = {name for pair in spec.pairs for name in (pair.geomname1, pair.geomname2)}
    guiding = {wrap.target.name for tendon in spec.tendons for wrap in tendon.path if wrap.type in _WOUND_ABOUT}
    for pair in list(spec.pairs):
        spec.delete(pair)
    weighed = spec.compiler.inertiafromgeom == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
    for geom in list(spec.geoms):
        if geom.type == mujoco.mjtGeom.mjGEOM_PLANE and _stands_still(geom.parent):
            spec.delete(geom)
        elif geom.contype == 0 and geom.conaffinity == 0 and geom.name not in paired:
            # What is only seen may still weigh something.
            weighs = weighed or not geom.parent.explicitinertial
            if geom.name not in guiding and not (weighs and geom.parent.name != "world"):
                spec.delete(geom)
        elif geom.type in _UNTOUCHABLE:
            kind = geom.type.name.removeprefix("mjGEOM_").lower()
            raise ScenarioError(
                f"{path}: {geom.parent.name} has a {kind} to touch with; allowed: box, sphere, capsule, cylinder, "
                f"ellipsoid, mesh"
            )
        else:
            geom.contype, geom.conaffinity = OWN, OTHERS


_UNTOUCHABLE = (mujoco.mjtGeom.mjGEOM_HFIELD, mujoco.mjtGeom.mjGEOM_SDF, mujoco.mjtGeom.mjGEOM_PLANE)
_WOUND_ABOUT = (mujoco.mjtWrap.mjWRAP_SPHERE, mujoco.mjtWrap.mjWRAP_CYLINDER)


def _stands_still(body: Any) -> bool:
    while body.name != "world":
        if list(body.joints):
            return False
        body = body.parent
    return True


def _drop_looks(spec: Any, classes: Iterable[str]) -> None:
    """Keep the colours of geoms, but neither materials nor meshes that nothing uses, also where defaults name them."""
    for geom in spec.geoms:
        material = spec.material(geom.material) if geom.material else None
        if material is not None and list(geom.rgba) == UNCOLOURED:
            geom.rgba = material.rgba
    defaults = [spec.default, *(spec.find_default(name) for name in classes)]
    named = [part for each in defaults if each is not None for part in (each.geom, each.site, each.tendon)]
    for part in (*spec.geoms, *spec.sites, *spec.tendons, *named):
        part.material = ""
    used = {str(geom.meshname) for geom in spec.geoms}
    for each in defaults:
        if each is not None and each.geom.meshname not in used:
            each.geom.meshname = ""
    for mesh in list(spec.meshes):
        if mesh.name not in used:
            spec.delete(mesh)
    for each in (*spec.materials, *spec.textures):
        spec.delete(each)
