"""Shapes that are read from a MuJoCo model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray, Geom, Shape, quaternion, triple
from prolepsis.system.mujoco import mujoco

_GEOM_NAMES = {
    int(mujoco.mjtGeom.mjGEOM_PLANE): "plane",
    int(mujoco.mjtGeom.mjGEOM_SPHERE): "sphere",
    int(mujoco.mjtGeom.mjGEOM_CAPSULE): "capsule",
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID): "ellipsoid",
    int(mujoco.mjtGeom.mjGEOM_CYLINDER): "cylinder",
    int(mujoco.mjtGeom.mjGEOM_BOX): "box",
    int(mujoco.mjtGeom.mjGEOM_MESH): "mesh",
}


def shape_of(model: Any, body: int) -> Shape:
    """Return the shape of a body: its geoms that can touch something."""
    geoms = [g for g in range(model.ngeom) if int(model.geom_bodyid[g]) == body]
    return shape_of_geoms(model, [g for g in geoms if touches(model, g)])


def touches(model: Any, geom: int) -> bool:
    """Return whether a geom can touch anything."""
    return bool(model.geom_contype[geom] or model.geom_conaffinity[geom])


def shape_of_geoms(model: Any, geoms: Sequence[int]) -> Shape:
    """Return the shape of some geoms of one body."""
    solids = tuple(_geom(model, geom) for geom in geoms if int(model.geom_type[geom]) in _GEOM_NAMES)
    if not solids:
        return Shape()
    red, green, blue, alpha = (float(value) for value in model.geom_rgba[geoms[0]])
    return Shape(geoms=solids, colour=(red, green, blue, alpha))


def _geom(model: Any, geom: int) -> Geom:
    kind = _GEOM_NAMES[int(model.geom_type[geom])]
    vertices = _hull_vertices(model, int(model.geom_dataid[geom])) if kind == "mesh" else np.zeros((0, 3))
    return Geom(
        type=kind,
        size=triple(model.geom_size[geom]),
        position=triple(model.geom_pos[geom]),
        orientation=quaternion(model.geom_quat[geom]),
        vertices=tuple(triple(vertex) for vertex in vertices),
    )


def _hull_vertices(model: Any, mesh: int) -> FloatArray:
    first, count = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    vertices = np.asarray(model.mesh_vert[first : first + count], dtype=np.float64)
    graph = int(model.mesh_graphadr[mesh])
    if graph < 0:
        return np.unique(vertices, axis=0)
    # The hull graph: vertex count, face count, edge addresses, then the vertices' numbers in the mesh.
    hull_count = int(model.mesh_graph[graph])
    chosen = model.mesh_graph[graph + 2 + hull_count : graph + 2 + 2 * hull_count]
    return vertices[np.asarray(chosen, dtype=np.int64)]
