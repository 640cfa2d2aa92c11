"""The meshes of a robot's file: where they are, and that none is read from outside the folder that it may use."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

from prolepsis.robots.model_text import home_of, inside, short
from prolepsis.system.text_files import is_file
from prolepsis.terms.errors import ScenarioError

PACKAGE = "package://"
"""How a URDF names a file of a package, which is a folder with a ``package.xml``."""
_NAME = re.compile(r"[\w-]+")
MESHES = (".msh", ".obj", ".stl")
"""Files that MuJoCo reads."""
SHOWN_MESHES, MOST_OF_A_NAME = 2, 60
"""So many missing files are named in a message, each with so many characters."""
MOST_BYTES_OF_MESHES = 256 * 2**20
"""Meshes that touch something, together [byte]."""


def named_meshes(tree: Element, path: Path, folder: Path | None) -> list[Path]:
    """Return the files of meshes that a model names, as far as they are there."""
    within = home_of(path, folder)
    folders = [each.get(name, "") for each in tree.iter("compiler") for name in ("meshdir", "assetdir")]
    names = [each.get(name, "") for each in tree.iter("mesh") for name in ("file", "filename")]
    names += [Path(name).name for name in names]
    found = [_mesh_file(name, path, within, beside) for name in names if name for beside in (*folders, "")]
    return [
        candidate for candidate in found if candidate is not None and candidate.stat().st_size <= MOST_BYTES_OF_MESHES
    ]


def find_meshes(spec: Any, path: Path, folder: Path | None) -> None:
    """Give each mesh the path at which its file is.

    Raises:
        ScenarioError: If some are nowhere, outside the folder that the robot may use, or too large.
    """
    within = home_of(path, folder)
    # MuJoCo, told so, looks for the last part of a name only.
    stripped, spec.strippath = bool(spec.strippath), False
    missing: list[str] = []
    outside: list[str] = []
    size = 0
    for mesh in spec.meshes:
        if not mesh.file:
            continue
        if Path(mesh.file).suffix.lower() not in MESHES:
            raise ScenarioError(f"{path}: the mesh {short(mesh.file)} cannot be read; allowed: {', '.join(MESHES)}")
        found = _mesh_file(str(mesh.file), path, within, str(spec.meshdir))
        if found is None and stripped:
            found = _mesh_file(Path(mesh.file).name, path, within, str(spec.meshdir))
        if found is None:
            (outside if _leads_out(str(mesh.file), path, within, str(spec.meshdir)) else missing).append(mesh.file)
            continue
        size += found.stat().st_size
        if size > MOST_BYTES_OF_MESHES:
            raise ScenarioError(f"{path}: its meshes are larger than {MOST_BYTES_OF_MESHES / 2**20:g} MiB together")
        mesh.file = str(found)
    if outside:
        raise ScenarioError(
            f"{path}: meshes are outside the robot's folder: {_listed(outside)}; allowed: files there, or in the one "
            f"above it that folder in [robot] names"
        )
    if missing:
        raise ScenarioError(
            f"{path}: meshes are missing: {_listed(missing)}; looked for beside the file, in its mesh folder, and for "
            f"package:// in the folders above it, links followed, nowhere else"
        )


def _listed(names: list[str]) -> str:
    """Return some names and how many more there are; of a long one its end, which tells the files of a folder apart."""
    lines = [short(name[-1000:], most=1000) for name in names[:SHOWN_MESHES]]
    shown = ", ".join(line if len(line) <= MOST_OF_A_NAME else f"...{line[3 - MOST_OF_A_NAME :]}" for line in lines)
    return f"{shown} and {len(names) - SHOWN_MESHES} more" if len(names) > SHOWN_MESHES else shown


def _mesh_file(file: str, path: Path, within: Path, folder: str) -> Path | None:
    """Return where a mesh is: beside the robot's file, in its mesh folder, or in a package somewhere above it."""
    here = path.resolve().parent
    if not file.startswith(PACKAGE):
        name = file.removeprefix("file://")
        candidates = [inside(within, here / folder / name), inside(within, here / name)]
    else:
        package, _, name = file.removeprefix(PACKAGE).partition("/")
        above = [here, *here.parents]
        candidates = [inside(each / package, Path(name)) for each in above] if _NAME.fullmatch(package) else []
        homes = [each for each in above if each.name == package or (each / "package.xml").is_file()]
        candidates += [inside(each, Path(name)) for each in homes]
    return next((candidate for candidate in candidates if candidate is not None and is_file(candidate)), None)


def _leads_out(file: str, path: Path, within: Path, folder: str) -> bool:
    """Return whether a mesh is named outside a folder; nothing is looked at there."""
    named = os.path.normpath(path.resolve().parent / folder / file.removeprefix("file://"))
    return not file.startswith(PACKAGE) and not Path(named).is_relative_to(within)
