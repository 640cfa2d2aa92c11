"""A shape from a mesh: its closed surface is exact, and convex pieces of it are what MuJoCo collides."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from prolepsis.geometry.kept import kept_array
from prolepsis.geometry.meshes import read_surface
from prolepsis.geometry.shape import FloatArray, Geom, Shape, Surface
from prolepsis.terms.errors import KnowledgeError

CONCAVITY = 0.05
"""Depth of a hollow that pieces may cover [share of the mesh's extent]: a cup's cavity is cut free."""
SEED = 1
"""The search for cuts is random; the same seed finds the same."""
SEARCH = {"mcts_nodes": 10, "mcts_iterations": 40, "mcts_max_depth": 2, "resolution": 600}
"""Effort of the search: a quarter of the library's usual time, and no more pieces."""
MOST_CORNERS = 64
"""Vertices of one convex piece."""


def mesh(path: Path, scale: float) -> Shape:
    """Return the shape of a mesh file; its frame is that of the file.

    Args:
        path: STL, OBJ, PLY or OFF.
        scale: Metres for each unit of length in it.

    Raises:
        KnowledgeError: If it cannot be read or does not enclose a volume.
    """
    surface = read_surface(path, scale)
    try:
        pieces = convex_pieces(surface)
    except RuntimeError as error:
        raise KnowledgeError(f"{path}: the mesh cannot be cut into convex pieces: {error}") from None
    return Shape(geoms=tuple(Geom(type="mesh", vertices=piece) for piece in pieces), surface=surface)


def convex_pieces(surface: Surface) -> tuple[tuple[tuple[float, float, float], ...], ...]:
    """Return the vertices of convex pieces whose union is nearly the body within a surface [m]."""
    vertices, triangles = np.array(surface.vertices, dtype=np.float64), np.array(surface.triangles, dtype=np.int64)
    settings = np.array([CONCAVITY, SEED, MOST_CORNERS, *SEARCH.values()])
    rows = kept_array("pieces", (vertices, triangles, settings), lambda: _cut(vertices, triangles))
    return tuple(
        tuple((float(x), float(y), float(z)) for _, x, y, z in rows[rows[:, 0] == k])
        for k in range(int(rows[:, 0].max()) + 1)
    )


def _cut(vertices: FloatArray, triangles: Any) -> FloatArray:
    """Return the number of its piece and the position of every vertex, shape (V, 4)."""
    import coacd  # pyright: ignore[reportMissingTypeStubs]

    library: Any = coacd
    library.set_log_level("error")
    pieces = library.run_coacd(
        library.Mesh(vertices, triangles),
        threshold=CONCAVITY,
        preprocess_mode="off",
        max_ch_vertex=MOST_CORNERS,
        seed=SEED,
        **SEARCH,
    )
    if not pieces:
        raise RuntimeError("no piece was found")
    return np.concatenate([np.column_stack((np.full(len(v), float(k)), v)) for k, (v, _) in enumerate(pieces)])
