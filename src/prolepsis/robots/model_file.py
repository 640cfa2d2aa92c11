"""A robot's file of any origin, MJCF or URDF, as a model that fits into a world: one body carries all, nothing is only
seen, gravity is compensated, its parts do not touch each other."""

from __future__ import annotations

import re
import warnings
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from prolepsis.robots.model_fitting import fit_into_world, name_all, on_one_body
from prolepsis.robots.model_meshes import find_meshes, named_meshes
from prolepsis.robots.model_text import home_of, read_model_tree, short, speed_limit
from prolepsis.robots.trial import try_robot
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import ScenarioError


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


def read_model_file(path: Path, folder: Path | None = None, *, tried: bool = False) -> ModelFile:
    """Return the robot in an MJCF or URDF file.

    Args:
        path: The file.
        folder: Where all files that it names must be; see ``home_of``.
        tried: Whether this is the process in which it is tried, or needs no trial.

    Raises:
        ScenarioError: If it cannot be read, its meshes are missing, or it is built in a way that is not supported.
    """
    tree = read_model_tree(path, folder)
    speeds = _speeds(tree, path)
    text = ElementTree.tostring(tree, encoding="unicode")
    if not tried:
        try_robot(path, folder, text.encode(), named_meshes(tree, path, folder))
    with warnings.catch_warnings():
        # What is old-fashioned in a file is said to its author, not to who uses it.
        warnings.simplefilter("ignore", UserWarning)
        return _built(text, [each.get("class", "") for each in tree.iter("default")], speeds, path, folder)


def _built(
    text: str, classes: Iterable[str], speeds: Mapping[str, float], path: Path, folder: Path | None
) -> ModelFile:
    """Return the robot in a text that holds nothing but what is allowed, and these default classes."""
    try:
        spec: Any = mujoco.MjSpec.from_string(text)
    except (ValueError, OSError) as error:
        raise ScenarioError(f"{path}: the robot cannot be read: {_line(error, path, folder)}") from None
    # A URDF's links without joints would be melted into their parents, and their names with them.
    spec.compiler.fusestatic = False
    _refuse_joints(spec, path)
    fit_into_world(spec, classes, path)
    find_meshes(spec, path, folder)
    try:
        return _fitted(spec, speeds)
    except ValueError as error:
        raise ScenarioError(f"{path}: the robot cannot be built: {_line(error, path, folder)}") from None


def _fitted(spec: Any, speeds: Mapping[str, float]) -> ModelFile:
    """Return a robot that is told and senses nothing any more, with what its motors could do.

    Raises:
        ValueError: If MuJoCo does not build it.
    """
    model: Any = spec.compile()
    name_all(spec)
    names = {int(joint.id): str(joint.name) for joint in spec.joints}
    efforts, home = _efforts(model, names), _home(model, names)
    for part in (*spec.actuators, *spec.keys, *spec.sensors, *spec.cameras, *spec.lights):
        spec.delete(part)
    for body in spec.bodies[1:]:
        body.gravcomp = 1.0
    for joint in spec.joints:
        if joint.name in efforts:
            joint.actfrcrange = [-efforts[joint.name], efforts[joint.name]]
    spec.compile()
    whole = on_one_body(spec)
    if whole is not spec:
        whole.compile()
    return ModelFile(spec=whole, speeds=speeds, efforts=efforts, home=home)


def _refuse_joints(spec: Any, path: Path) -> None:
    """Refuse joints that no motor of a robot here drives."""
    for joint in spec.joints:
        if joint.type not in (mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE):
            kind = joint.type.name.removeprefix("mjJNT_").lower()
            raise ScenarioError(
                f"{path}: {short(joint.name or joint.parent.name)[:60]} is a {kind} joint; allowed: hinge and slide "
                f"(what lies loose belongs in the situation)"
            )


def _efforts(model: Any, names: Mapping[int, str]) -> dict[str, float]:
    """Return what the motors on single joints can do at most."""
    efforts: dict[str, float] = {}
    for joint in range(model.njnt):
        if model.jnt_actfrclimited[joint]:
            efforts[names[joint]] = float(np.abs(model.jnt_actfrcrange[joint]).max())
    for motor in range(model.nu):
        on_joint = int(model.actuator_trntype[motor]) == int(mujoco.mjtTrn.mjTRN_JOINT)
        if on_joint and model.actuator_forcelimited[motor]:
            name = names[int(model.actuator_trnid[motor, 0])]
            force = float(np.abs(model.actuator_forcerange[motor]).max() * abs(model.actuator_gear[motor, 0]))
            efforts[name] = min(force, efforts.get(name, force))
    return efforts


def _home(model: Any, names: Mapping[int, str]) -> dict[str, float]:
    for key in range(model.nkey):
        if model.key(key).name == "home":
            positions = model.key_qpos[key]
            return {names[j]: float(positions[model.jnt_qposadr[j]]) for j in range(model.njnt)}
    return {}


def _speeds(tree: ElementTree.Element, path: Path) -> dict[str, float]:
    """Return the speed limits in a URDF, which MuJoCo does not read."""
    joints = tree.findall("joint") if tree.tag == "robot" else ()
    found = {joint.get("name", ""): speed_limit(joint, path) for joint in joints}
    return {name: speed for name, speed in found.items() if speed is not None}


def _line(error: Exception, path: Path, folder: Path | None) -> str:
    """Return what MuJoCo says, without lines of a text that it alone has seen and the place of the robot's folder."""
    line = " ".join(str(error).split()).removeprefix("Error: ")
    for known in (path.resolve().parent, home_of(path, folder)):
        line = line.replace(f"{known}/", "")
    return short(re.sub(r",? line \d+", "", line))
