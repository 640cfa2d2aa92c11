"""A closed surface of triangles from a file: read, checked to be watertight, and measured."""

from __future__ import annotations

from functools import lru_cache
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from prolepsis.geometry.shape import Surface
from prolepsis.system.text_files import is_file, read_bytes
from prolepsis.terms.errors import KnowledgeError

FORMATS = (".stl", ".obj", ".ply", ".off")
"""Files of triangles that are read."""
GREATEST_EXTENT = 10.0
"""Longest side of a mesh [m]: beyond it, the file is in millimetres."""
MOST_BYTES = 64 * 2**20
"""Largest file: as much as the triangles below take, written out at length."""
MOST_TRIANGLES = 200_000
"""More are refused: they take minutes and tell a simulation nothing."""


def read_surface(path: Path, scale: float = 1.0) -> Surface:
    """Return the closed surface in a file, its triangles seen counter-clockwise from outside.

    Args:
        path: The file.
        scale: Metres for each unit of length in it.

    Raises:
        KnowledgeError: If it cannot be read, is not watertight, encloses nothing, or is far too large.
    """
    changed = path.stat().st_mtime_ns if is_file(path) else 0
    return _read(path, scale, changed)


@lru_cache(maxsize=16)
def _read(path: Path, scale: float, changed: int) -> Surface:
    del changed  # A file that is written anew is read anew.
    if path.suffix.lower() not in FORMATS:
        raise KnowledgeError(f"{path}: cannot read the mesh: {path.suffix or 'no'} format; known: {', '.join(FORMATS)}")
    content = read_bytes(path, "mesh", most=MOST_BYTES, error=KnowledgeError)
    # The import takes longer than a scene without meshes.
    import trimesh

    library: Any = trimesh
    try:
        mesh: Any = library.load_mesh(BytesIO(content), file_type=path.suffix[1:].lower())
        mesh.merge_vertices()
        triangles, vertices = np.asarray(mesh.faces), scale * np.asarray(mesh.vertices, dtype=np.float64)
    except Exception as error:  # A reader of foreign files fails in as many ways as there are files.
        # Its words may repeat what stands in the file.
        raise KnowledgeError(
            f"{path}: cannot read the mesh: {type(error).__name__} on reading it as {path.suffix[1:].upper()}"
        ) from None
    if not len(triangles) or not np.isfinite(vertices).all():
        raise KnowledgeError(f"{path}: the mesh has no triangles with finite corners")
    if len(triangles) > MOST_TRIANGLES:
        raise KnowledgeError(f"{path}: the mesh has {len(triangles)} triangles; allowed: {MOST_TRIANGLES}")
    if not (mesh.is_watertight and mesh.is_winding_consistent):
        raise KnowledgeError(f"{path}: the mesh is not watertight; allowed: a closed surface")
    extent = float(np.ptp(vertices, axis=0).max())
    if extent > GREATEST_EXTENT:
        raise KnowledgeError(
            f"{path}: the mesh is {extent:g} m long; allowed: {GREATEST_EXTENT:g} m; state :scale 0.001 if it is in mm"
        )
    surface = _surface(vertices, triangles)
    volume = enclosed_volume(surface)
    if not abs(volume) > 1e-9 * extent**3:
        raise KnowledgeError(f"{path}: the mesh encloses no volume")
    return surface if volume > 0 else _surface(vertices, triangles[:, ::-1])


def _surface(vertices: Any, triangles: Any) -> Surface:
    return Surface(
        vertices=tuple((float(x), float(y), float(z)) for x, y, z in vertices),
        triangles=tuple((int(a), int(b), int(c)) for a, b, c in triangles),
    )


def enclosed_volume(surface: Surface) -> float:
    """Return the volume that a closed surface encloses [m^3]; negative if it is inside out."""
    corners = np.array(surface.vertices)[np.array(surface.triangles)]
    return float(np.einsum("ni,ni->n", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6)
