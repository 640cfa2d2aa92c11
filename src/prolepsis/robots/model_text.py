"""A robot's file as a tree that MuJoCo may see: read without entities, of known elements only, every number bounded.

The file may come from a stranger. What is not listed here is refused, or left out where it only says how things look or
what is sensed; MuJoCo never reads the file itself, only what is written anew from this tree.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from prolepsis.system.text_files import is_file, read_bytes
from prolepsis.terms.errors import ScenarioError

MOST_BYTES = 16 * 2**20
"""Longest robot file, what it includes counted too [byte]."""
MOST_ELEMENTS = 20_000
"""Elements of a robot after its replications; a PR2 has some 300."""
DEEPEST = 200
"""Elements within elements."""
GREATEST = 1e18
"""Greatest number: its powers are still finite. Limits of joints without one are written as 1e16."""
LARGEST = 1_000_000
"""Greatest entry of ``<size>``."""
LONGEST_NAME = 250
"""Characters of a name or of a path."""
MOST_SAID = 160
"""Characters of a foreign text that a message repeats at most."""

_SHARED = {"joint", "geom", "site", "mesh", "tendon", "equality", "pair", "material"}
_MOTORS = {
    *("general", "motor", "position", "velocity", "intvelocity", "damper", "cylinder", "muscle", "adhesion", "dcmotor"),
    "orientation",
}
_WITHIN = {"body", "frame", "replicate", "inertial", "joint", "freejoint", "geom", "site"}
_HOLDS = {
    "mujoco": {
        *("compiler", "default", "asset", "worldbody", "actuator", "tendon", "equality", "contact", "keyframe"),
        "include",
    },
    "compiler": {"lengthrange"},
    "default": {"default", *_SHARED, *_MOTORS},
    "asset": {"mesh", "material"},
    "worldbody": _WITHIN,
    "body": _WITHIN,
    "frame": _WITHIN,
    "replicate": _WITHIN,
    "actuator": _MOTORS,
    "tendon": {"fixed", "spatial"},
    "fixed": {"joint"},
    "spatial": {"site", "geom", "pulley"},
    "equality": {"connect", "weld", "joint", "tendon"},
    "contact": {"pair", "exclude"},
    "keyframe": {"key"},
}
"""Elements of an MJCF, and what each may hold; an ``include`` may stand anywhere."""
_LEFT_OUT = {
    *("option", "size", "statistic", "visual", "custom", "sensor", "camera", "light", "texture", "skin", "layer"),
    "deformable",
}
"""What a robot does not need: how it looks, what it senses, how it was once simulated."""
_URDF = {
    *("robot", "link", "joint", "inertial", "origin", "mass", "inertia", "visual", "collision", "geometry", "box"),
    *("sphere", "cylinder", "capsule", "mesh", "material", "color", "parent", "child", "axis", "limit", "dynamics"),
    *("mimic", "mujoco", "compiler"),
}
"""Elements of a URDF that are passed on; all else in one is for other programs."""
_OF_MOTORS = {
    *(
        "name",
        "class",
        "joint",
        "jointinparent",
        "tendon",
        "site",
        "refsite",
        "body",
        "slidersite",
        "cranksite",
        "gear",
    ),
    *("forcerange", "forcelimited", "ctrlrange", "ctrllimited", "cranklength"),
}
"""Of a motor only its effort is read."""
_OF_KEYS = {"name", "class", "qpos"}
"""Of a keyframe only where the joints are is read; what motors and mocap bodies do there goes with them."""
_WANTED = {"key": _OF_KEYS, "material": {"name", "class", "rgba"}}
_LOOKS_OF_MESHES = {"material", "content_type"}
"""Of a mesh how it looks, and what its file is: the ending tells that."""
_OF_MESHES = {
    *("name", "class", "file", "filename", "scale", "refpos", "refquat", "vertex", "normal", "texcoord", "face"),
    *("inertia", "maxhullvert", "smoothnormal"),
}
_NOT_NEGATIVE = {
    *("mass", "density", "diaginertia", "armature", "frictionloss", "size", "radius", "length", "effort"),
    *("ixx", "iyy", "izz"),
}
"""Attributes no number of which may be negative."""
_FIRST_NOT_NEGATIVE = {"damping", "stiffness"}
"""Attributes of which the first may not; what follows bends the line."""
_RANGES = {"range", "forcerange", "ctrlrange", "actuatorfrcrange"}
"""Attributes that are a least and a greatest number."""
_NAMES = {
    *("name", "class", "childclass", "joint", "joint1", "joint2", "jointinparent", "body", "body1", "body2", "site"),
    *("site1", "site2", "refsite", "sidesite", "slidersite", "cranksite", "geom", "geom1", "geom2", "mesh", "material"),
    *("tendon", "tendon1", "tendon2", "file", "filename", "model", "link", "target", "meshdir", "assetdir"),
    *("texturedir", "sep", "prefix"),
}
"""Attributes that are names, so that ``inf`` may be one."""


def read_model_tree(path: Path, folder: Path | None = None) -> Element:
    """Return the robot in an MJCF or URDF file, its includes in their places.

    Args:
        path: The file.
        folder: Where all that it includes must be; see ``home_of``.

    Raises:
        ScenarioError: If it cannot be read, is too large, or holds something that is not allowed.
    """
    content = read_bytes(path, "robot file", most=MOST_BYTES, error=ScenarioError)
    root = _parse(path, content, path)
    if root.tag == "robot":
        _refuse_macros(root, path)
        _only(root, _URDF)
    elif root.tag == "mujoco":
        _include(root, path, home_of(path, folder), path.resolve().parent, [path.resolve()], [len(content)])
        _refuse_sizes(root, path)
        _keep_listed(root, path)
    else:
        raise ScenarioError(f"{path}: the robot cannot be read: it is a <{short(root.tag)}>; allowed: mujoco, robot")
    _refuse_deep(root, path)
    count = _count(root, path)
    if count > MOST_ELEMENTS:
        raise ScenarioError(f"{path}: the robot has {count:.6g} elements; allowed: {MOST_ELEMENTS}")
    above = {child: parent for parent in root.iter() for child in parent}
    for each in root.iter():
        _refuse_numbers(each, path)
        wrong = _impossible(each)
        if wrong:
            named = each
            while not named.get("name") and named in above:
                named = above[named]
            of = "" if named is each else f"{each.tag} of "
            raise ScenarioError(f"{path}: {of}{named.tag} {short(named.get('name', ''))[:60]}: {wrong}")
    return root


def _refuse_deep(root: Element, path: Path) -> None:
    """Refuse elements that are too deep within others once all is included."""
    layer = [root]
    for _ in range(DEEPEST):
        layer = [child for each in layer for child in each]
    if layer:
        raise ScenarioError(f"{path}: the robot has elements within more than {DEEPEST} others")


def short(text: str, most: int = MOST_SAID) -> str:
    """Return a foreign text on one line that is not long."""
    line = " ".join(text.split())
    return line if len(line) <= most else f"{line[: most - 3]}..."


def _parse(file: Path, content: bytes, path: Path) -> Element:
    """Return the tree of an XML text that declares no types and no entities."""
    builder, parser = TreeBuilder(), expat.ParserCreate()
    depth = count = 0

    def start(name: str, attributes: dict[str, str]) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if depth > DEEPEST or count > MOST_ELEMENTS:
            raise ScenarioError(
                f"{path}: the robot has too many elements; allowed: {MOST_ELEMENTS}, {DEEPEST} within each other"
            )
        builder.start(name, attributes)

    def end(name: str) -> None:
        nonlocal depth
        depth -= 1
        builder.end(name)

    def refuse(*_: object) -> None:
        raise ScenarioError(f"{path}: the robot cannot be read: a document type (<!DOCTYPE ...>) is not allowed")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = refuse
    try:
        parser.Parse(content, True)
        return builder.close()
    except (expat.ExpatError, ValueError, LookupError) as error:
        raise ScenarioError(
            f"{path}: the robot cannot be read: XML of {short(file.name)}: {short(str(error))}"
        ) from None


def _include(root: Element, path: Path, folder: Path, own: Path, seen: list[Path], read: list[int]) -> None:
    """Put what is included in the place of each include, each file once, none from outside the robot's folder."""
    for parent in list(root.iter()):
        for index, child in reversed(list(enumerate(parent))):
            if child.tag != "include":
                continue
            named = child.get("file", "")
            # As MuJoCo does: beside the robot's file, else beside the file that includes it.
            found = [inside(folder, beside / named) for beside in (path.resolve().parent, own)]
            file = next((each for each in found if each is not None and is_file(each)), found[0])
            if file is None:
                raise ScenarioError(
                    f"{path}: include {short(named)}: is not in the robot's folder; allowed: files there, or in the "
                    f"one above it that folder in [robot] names"
                )
            if file in seen:
                raise ScenarioError(f"{path}: include {short(named)}: is included twice, or includes itself")
            seen.append(file)
            content = read_bytes(
                file, f"included file {short(named)}", most=MOST_BYTES, error=ScenarioError, called=str(path)
            )
            read.append(len(content))
            if sum(read) > MOST_BYTES:
                raise ScenarioError(f"{path}: the robot's files are too long: more than {MOST_BYTES:,} bytes together")
            included = _parse(file, content, path)
            _include(included, path, folder, file.parent, seen, read)
            parent[index : index + 1] = list(included)


def home_of(path: Path, folder: Path | None) -> Path:
    """Return the folder in which all files that a robot's file names must be.

    Args:
        path: The robot's file.
        folder: The folder that is told; if None it is the nearest above the file with a ``package.xml``, since a
            robot's description often has a folder of models and one of meshes, or else its own.

    Raises:
        ScenarioError: If the file is not in the folder that is told.
    """
    here = path.resolve().parent
    if folder is None:
        return next((each for each in here.parents if (each / "package.xml").is_file()), here)
    told = folder.resolve()
    if not here.is_relative_to(told):
        raise ScenarioError(f"{path}: the robot is not in the folder {short(str(folder))}; allowed: one above it")
    return told


def inside(folder: Path, file: Path) -> Path | None:
    """Return where a file is, links followed, if that is within a folder."""
    try:
        found = (folder / file).resolve()
    except (OSError, ValueError, RuntimeError):
        return None
    return found if found.is_relative_to(folder) else None


def _refuse_sizes(root: Element, path: Path) -> None:
    for size in root.iter("size"):
        for name, value in size.attrib.items():
            number = _number(value.strip().rstrip("kKmMgGtTpPeE"))
            unit = "kmgtpe".find(value.strip()[-1:].lower()) + 1 if value.strip() else 0
            if number is None or not number * 1024.0**unit <= (2.0**30 if name == "memory" else LARGEST):
                raise ScenarioError(
                    f"{path}: size: {short(name)}={short(value)}; allowed: up to {LARGEST}, and 1G of memory"
                )


def _keep_listed(root: Element, path: Path) -> None:
    """Leave out what a robot does not need, and refuse what is not known."""
    for parent in root.iter():
        for child in list(parent):
            if child.tag in _LEFT_OUT:
                parent.remove(child)
            elif child.tag not in _HOLDS.get(parent.tag, ()):
                allowed = ", ".join(sorted(_HOLDS.get(parent.tag, {"nothing"})))
                raise ScenarioError(f"{path}: {parent.tag} holds a {short(child.tag)[:40]}; allowed: {allowed}")
        wanted = _OF_MOTORS if parent.tag in _MOTORS else _WANTED.get(parent.tag)
        if wanted is not None:
            parent.attrib = {name: value for name, value in parent.attrib.items() if name in wanted}
        if parent.tag == "dcmotor":
            # Without its windings it is a motor like others.
            parent.tag = "motor"
        if parent.tag == "mesh":
            parent.attrib = {name: value for name, value in parent.attrib.items() if name not in _LOOKS_OF_MESHES}
        if parent.tag == "mesh" and not parent.attrib.keys() <= _OF_MESHES:
            unknown = short(min(parent.attrib.keys() - _OF_MESHES))
            raise ScenarioError(f"{path}: mesh has {unknown}; allowed: {', '.join(sorted(_OF_MESHES))}")


def _refuse_macros(root: Element, path: Path) -> None:
    """Refuse a URDF that is still to be written out, which would be read as a robot without what its macros make."""
    for each in root.iter():
        if each.tag.startswith("xacro:"):
            raise ScenarioError(
                f"{path}: robot holds a {short(each.tag)[:40]}; allowed: a URDF that xacro has written out"
            )


def _only(root: Element, allowed: set[str]) -> None:
    for parent in root.iter():
        for child in list(parent):
            if child.tag not in allowed:
                parent.remove(child)


def _count(each: Element, path: Path) -> float:
    """Return how many elements there are when all are replicated."""
    inner = sum(_count(child, path) for child in each)
    if each.tag != "replicate":
        return 1.0 + inner
    times = _number(each.get("count", "1"))
    if times is None or not times >= 1.0:
        raise ScenarioError(f"{path}: replicate: count={short(each.get('count', ''))}: is no whole number above 0")
    return 1.0 + times * max(inner, 1.0)


def _refuse_numbers(each: Element, path: Path) -> None:
    for name, value in each.attrib.items():
        if name in _NAMES:
            if len(value) > LONGEST_NAME:
                raise ScenarioError(f"{path}: {each.tag[:40]}: {name} is longer than {LONGEST_NAME} characters")
        else:
            for number in _numbers(value):
                if not abs(number) <= GREATEST:
                    owner = f"{each.tag} {each.get('name', '')}".strip()
                    raise ScenarioError(
                        f"{path}: {short(owner)[:60]}: {short(name)[:40]} holds {number:g}; "
                        f"allowed: numbers up to {GREATEST:g}"
                    )


def _impossible(each: Element) -> str:
    """Return what nothing can have and what is allowed, or else nothing: MuJoCo takes some of it without a word."""
    for name, value in each.attrib.items():
        numbers, shown = list(_numbers(value)), f"{name} is {short(value)[:60]}"
        weighs = each.tag == "mass" and name == "value"
        few = numbers[:1] if name in _FIRST_NOT_NEGATIVE else numbers if name in _NOT_NEGATIVE or weighs else []
        if any(number < 0.0 for number in few):
            return f"{shown}; allowed: numbers of at least 0"
        if name in _RANGES and len(numbers) == 2 and numbers[0] > numbers[1]:
            return f"{shown}; allowed: the lesser number first"
    lower, upper = (_number(each.get(name, "0")) for name in ("lower", "upper"))
    if each.tag == "limit" and lower is not None and upper is not None and lower > upper:
        return f"lower is {lower:g}, upper {upper:g}; allowed: the lesser number as lower"
    return ""


def _numbers(value: str) -> Iterator[float]:
    for token in value.split():
        number = _number(token)
        if number is not None:
            yield number


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


def speed_limit(joint: Element, path: Path) -> float | None:
    """Return the greatest speed of a joint of a URDF [rad/s or m/s], or None if it tells none.

    Raises:
        ScenarioError: If it is no number.
    """
    limit = joint.find("limit")
    text = None if limit is None else limit.get("velocity")
    if text is None:
        return None
    speed = _number(text)
    if speed is None or not 0.0 <= speed < math.inf:
        name = short(joint.get("name", ""))[:60]
        raise ScenarioError(f"{path}: joint {name}: velocity={short(text)[:60]!r}: is no speed; allowed: 0 or more")
    return speed or None
