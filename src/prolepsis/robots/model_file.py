"""A robot's file of any origin, MJCF or URDF, as a model that fits into a world: one body carries all, nothing is only
seen, gravity is compensated, its parts do not touch each other."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from prolepsis.robots.model_text import inside, read_model_tree, short, speed_limit
from prolepsis.robots.trial import try_robot
from prolepsis.system.mujoco import mujoco
from prolepsis.system.text_files import is_file
from prolepsis.terms.errors import ScenarioError

ROOT = "mount"
"""Body that is added if none carries all others."""
OWN, OTHERS = 2, 1
"""Contact bits of a robot: its geoms touch everything but each other, since neighbouring links overlap in many models.
A world lets its arms touch."""
_NAME = re.compile(r"[\w-]+")
MESHES = (".msh", ".obj", ".stl")
"""Files that MuJoCo reads."""
SHOWN_MESHES, MOST_OF_A_NAME = 2, 60
"""So many missing files are named in a message, each with so many characters."""
MOST_BYTES_OF_MESHES = 256 * 2**20
"""Meshes that touch something, together [byte]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ModelFile:
    """What is read from a robot's file."""

    spec: Any
    """The ``mujoco.MjSpec``, made to fit; it may be edited."""
    speeds: Mapping[str, float]
    """Greatest speed of the joints of which a URDF tells it [rad/s or m/s]."""
    efforts: Mapping[str, float]
    """Greatest effort of the joints whose motors an MJCF limits [N m or N]."""
    home: Mapping[str, float]
    """Coordinates of the joints at the keyframe called home, if there is one [rad or m]."""


def read_model_file(path: Path, *, tried: bool = False) -> ModelFile:
    """Return the robot in an MJCF or URDF file.

    Args:
        path: The file.
        tried: Whether this is the process in which it is tried, or needs no trial.

    Raises:
        ScenarioError: If it cannot be read, its meshes are missing, or it is built in a way that is not supported.
    """
    tree = read_model_tree(path)
    speeds = _speeds(tree, path)
    text = ElementTree.tostring(tree, encoding="unicode")
    if not tried:
        try_robot(path, text.encode(), _named_meshes(tree, path))
    try:
        spec: Any = mujoco.MjSpec.from_string(text)
    except (ValueError, OSError) as error:
        raise ScenarioError(f"{path}: the robot cannot be read: {_line(error)}") from None
    # A URDF's links without joints would be melted into their parents, and their names with them.
    spec.compiler.fusestatic = False
    _drop_what_is_only_seen(spec, path)
    _find_meshes(spec, path)
    try:
        model: Any = spec.compile()
    except ValueError as error:
        raise ScenarioError(f"{path}: the robot cannot be built: {_line(error)}") from None
    _refuse_joints(model, path)
    efforts, home = _efforts(model), _home(model)
    for part in (*spec.actuators, *spec.keys, *spec.sensors, *spec.cameras, *spec.lights):
        spec.delete(part)
    for number, body in enumerate(spec.bodies[1:]):
        body.gravcomp = 1.0
        body.name = body.name or f"body{number}"
    for joint in spec.joints:
        if joint.name in efforts:
            joint.actfrcrange = [-efforts[joint.name], efforts[joint.name]]
    spec.compile()
    return ModelFile(spec=_on_one_body(spec), speeds=speeds, efforts=efforts, home=home)


def _named_meshes(tree: ElementTree.Element, path: Path) -> list[Path]:
    """Return the files of meshes that a model names, as far as they are there."""
    folders = [each.get(name, "") for each in tree.iter("compiler") for name in ("meshdir", "assetdir")]
    names = [each.get(name, "") for each in tree.iter("mesh") for name in ("file", "filename")]
    found = [_mesh_file(name, path, folder) for name in names if name for folder in (*folders, "")]
    return [
        candidate for candidate in found if candidate is not None and candidate.stat().st_size <= MOST_BYTES_OF_MESHES
    ]


def _find_meshes(spec: Any, path: Path) -> None:
    """Give each mesh the path at which its file is.

    Raises:
        ScenarioError: If some are nowhere, or too large.
    """
    missing: list[str] = []
    size = 0
    for mesh in spec.meshes:
        if not mesh.file:
            continue
        if Path(mesh.file).suffix.lower() not in MESHES:
            raise ScenarioError(f"{path}: the mesh {short(mesh.file)} cannot be read; allowed: {', '.join(MESHES)}")
        found = _mesh_file(str(mesh.file), path, str(spec.meshdir))
        if found is None:
            missing.append(short(mesh.file)[:MOST_OF_A_NAME])
            continue
        size += found.stat().st_size
        if size > MOST_BYTES_OF_MESHES:
            raise ScenarioError(f"{path}: its meshes are larger than {MOST_BYTES_OF_MESHES / 2**20:g} MiB together")
        mesh.file = str(found)
    if missing:
        more = f" and {len(missing) - SHOWN_MESHES} more" if len(missing) > SHOWN_MESHES else ""
        shown = ", ".join(missing[:SHOWN_MESHES])
        raise ScenarioError(
            f"{path}: meshes are missing: {shown}{more}; looked for beside the file, in its mesh folder, and for "
            f"package:// in the folders above it, links followed, nowhere else"
        )


def _mesh_file(file: str, path: Path, folder: str) -> Path | None:
    """Return where a mesh is: beside the robot's file, in its mesh folder, or in a package somewhere above it."""
    here = path.resolve().parent
    if not file.startswith("package://"):
        name = file.removeprefix("file://")
        # A robot's description often has a folder of models and one of meshes, and a package.xml above both.
        home = next((each for each in here.parents if (each / "package.xml").is_file()), here)
        candidates = [inside(home, here / folder / name), inside(home, here / name)]
    else:
        package, _, name = file.removeprefix("package://").partition("/")
        above = [here, *here.parents]
        candidates = [inside(each / package, Path(name)) for each in above] if _NAME.fullmatch(package) else []
        homes = [each for each in above if each.name == package or (each / "package.xml").is_file()]
        candidates += [inside(each, Path(name)) for each in homes]
    return next((candidate for candidate in candidates if candidate is not None and is_file(candidate)), None)


def _refuse_joints(model: Any, path: Path) -> None:
    """Refuse joints that no motor of a robot here drives."""
    single = (int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE))
    for joint in range(model.njnt):
        if int(model.jnt_type[joint]) not in single:
            kind = mujoco.mjtJoint(int(model.jnt_type[joint])).name.removeprefix("mjJNT_").lower()
            name = model.joint(joint).name or model.body(int(model.jnt_bodyid[joint])).name
            raise ScenarioError(f"{path}: {name} is a {kind} joint; allowed: hinge and slide")


def _efforts(model: Any) -> dict[str, float]:
    """Return what the motors on single joints can do at most."""
    efforts: dict[str, float] = {}
    for joint in range(model.njnt):
        if model.jnt_actfrclimited[joint]:
            efforts[model.joint(joint).name] = float(np.abs(model.jnt_actfrcrange[joint]).max())
    for motor in range(model.nu):
        on_joint = int(model.actuator_trntype[motor]) == int(mujoco.mjtTrn.mjTRN_JOINT)
        if on_joint and model.actuator_forcelimited[motor]:
            name = model.joint(int(model.actuator_trnid[motor, 0])).name
            force = float(np.abs(model.actuator_forcerange[motor]).max() * abs(model.actuator_gear[motor, 0]))
            efforts[name] = min(force, efforts.get(name, force))
    return efforts


def _home(model: Any) -> dict[str, float]:
    for key in range(model.nkey):
        if model.key(key).name == "home":
            positions = model.key_qpos[key]
            return {model.joint(j).name: float(positions[model.jnt_qposadr[j]]) for j in range(model.njnt)}
    return {}


def _speeds(tree: ElementTree.Element, path: Path) -> dict[str, float]:
    """Return the speed limits in a URDF, which MuJoCo does not read."""
    joints = tree.findall("joint") if tree.tag == "robot" else ()
    found = {joint.get("name", ""): speed_limit(joint, path) for joint in joints}
    return {name: speed for name, speed in found.items() if speed is not None}


def _drop_what_is_only_seen(spec: Any, path: Path) -> None:
    """Delete geoms that touch nothing, and keep the colours of the others but not their materials."""
    for geom in list(spec.geoms):
        if geom.contype == 0 and geom.conaffinity == 0:
            # What is only seen may still weigh something.
            if geom.parent.explicitinertial or geom.parent.name == "world":
                spec.delete(geom)
            continue
        if geom.type == mujoco.mjtGeom.mjGEOM_PLANE and geom.parent.name == "world":
            spec.delete(geom)
            continue
        if geom.type in (mujoco.mjtGeom.mjGEOM_HFIELD, mujoco.mjtGeom.mjGEOM_SDF, mujoco.mjtGeom.mjGEOM_PLANE):
            kind = geom.type.name.removeprefix("mjGEOM_").lower()
            raise ScenarioError(
                f"{path}: {geom.parent.name} has a {kind} to touch with; allowed: box, sphere, capsule, cylinder, "
                f"ellipsoid, mesh"
            )
        geom.contype, geom.conaffinity = OWN, OTHERS
        if geom.material:
            material = spec.material(geom.material)
            geom.rgba = material.rgba
            geom.material = ""
    used = {str(geom.meshname) for geom in spec.geoms}
    for geom in spec.geoms:
        geom.material = ""
    for mesh in list(spec.meshes):
        if mesh.name not in used:
            spec.delete(mesh)
    for each in (*spec.materials, *spec.textures):
        spec.delete(each)


def _on_one_body(spec: Any) -> Any:
    """Return a robot in which one body that stands still carries all others."""
    tops = list(spec.worldbody.bodies)
    if len(tops) == 1 and not list(tops[0].joints) and not list(spec.worldbody.geoms):
        return spec
    tree = ElementTree.fromstring(spec.to_xml())
    world = tree.find("worldbody")
    assert world is not None
    carried = list(world)
    for each in carried:
        world.remove(each)
    ElementTree.SubElement(world, "body", name=ROOT).extend(carried)
    return mujoco.MjSpec.from_string(ElementTree.tostring(tree, encoding="unicode"))


def _line(error: Exception) -> str:
    return short(" ".join(str(error).split()).removeprefix("Error: "))
