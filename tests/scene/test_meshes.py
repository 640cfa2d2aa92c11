"""Meshes: read from files, refused when they enclose nothing, cut into convex pieces, and filled like other vessels."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from prolepsis.engine.composing import compose_scene
from prolepsis.geometry import turned
from prolepsis.geometry.meshes import enclosed_volume, read_surface
from prolepsis.geometry.solids import solid_of
from prolepsis.knowledge import KnowledgeBase
from prolepsis.scene.shapes.mesh import mesh
from prolepsis.terms.errors import KnowledgeError

CUP = turned.cup({"radius": 0.04, "height": 0.06, "thickness": 0.006})
SIDES = 24
SHARE = SIDES / math.tau * math.sin(math.tau / SIDES)
"""Area of a regular polygon over that of the circle round it [1]."""
library: Any = trimesh


def written(folder: Path, made: Any, name: str = "cup.stl") -> Path:
    """Return the file of a mesh."""
    path = folder / name
    made.export(str(path))
    return path


def cup(scale: float = 1.0) -> Any:
    """Return a cup with 24 sides as a mesh."""
    line = np.array([*CUP.outline, CUP.outline[0]])
    made = library.creation.revolve(line, sections=SIDES)
    made.apply_scale(scale)
    return made


def test_a_mesh_has_the_volume_that_its_surface_encloses(tmp_path: Path) -> None:
    surface = read_surface(written(tmp_path, cup()))
    assert enclosed_volume(surface) == pytest.approx(SHARE * CUP.volume, rel=1e-5)
    millimetres = read_surface(written(tmp_path, cup(1000.0), "mm.stl"), 0.001)
    assert enclosed_volume(millimetres) == pytest.approx(enclosed_volume(surface), rel=1e-5)


def test_a_mesh_that_is_inside_out_is_turned(tmp_path: Path) -> None:
    made = cup()
    made.invert()
    assert enclosed_volume(read_surface(written(tmp_path, made))) > 0


def test_a_mesh_with_a_gap_or_without_a_volume_is_refused(tmp_path: Path) -> None:
    open_one = cup()
    open_one.update_faces(np.arange(len(open_one.faces)) > 0)
    with pytest.raises(KnowledgeError, match=r"gap\.stl: the mesh is not watertight; allowed: a closed surface"):
        read_surface(written(tmp_path, open_one, "gap.stl"))
    flat = library.Trimesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 1, 2), (2, 1, 3), (0, 2, 1), (2, 3, 1)])
    with pytest.raises(KnowledgeError, match="the mesh"):
        read_surface(written(tmp_path, flat, "flat.stl"))
    (tmp_path / "text.stl").write_text("no mesh at all")
    with pytest.raises(KnowledgeError, match=r"text\.stl: "):
        read_surface(tmp_path / "text.stl")
    with pytest.raises(KnowledgeError, match=r"the mesh is 80 m long; allowed: 10 m; state :scale 0\.001"):
        read_surface(written(tmp_path, cup(1000.0), "mm.stl"))


def test_the_convex_pieces_of_a_mesh_leave_its_cavity_open(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    path = written(tmp_path, cup())
    shape = mesh(path, 1.0)
    inside = np.array([(0.0, 0.0, 0.03), (0.02, 0.0, 0.01), (0.0, -0.02, 0.05)])
    wall = np.array([(0.0369, 0.001, 0.03), (0.001, -0.0369, 0.05), (0.005, 0.005, 0.003)])

    def nearest(points: Any) -> Any:
        return np.min([solid_of(geom).distance(points) for geom in shape.geoms], axis=0)

    assert (nearest(inside) > 0.003).all()
    assert (nearest(wall) < 0.0005).all()
    assert list((tmp_path / "cache").rglob("pieces-*"))
    assert mesh(path, 1.0) == shape


def test_a_mesh_is_a_vessel_that_is_weighed_and_filled(tmp_path: Path) -> None:
    written(tmp_path, cup())
    (tmp_path / "s.ttl").write_text(
        "@prefix : <https://w3id.org/prolepsis#> . :table1 a :Table . "
        ':pot1 a :Vessel ; :shape :mesh ; :file "cup.stl" ; :density 2300.0 ; :on :table1 ; :contains :liq1 . '
        ":liq1 a :Water ; :fill 0.5 ."
    )
    made = compose_scene(KnowledgeBase.load(tmp_path / "s.ttl"), particles=500)
    assert made.thing("pot1").mass == pytest.approx(2300.0 * SHARE * CUP.volume, rel=1e-4)
    (pool,) = made.pools
    # The distances of a mesh lie on a grid of 1.2 mm, which rounds its edges off.
    assert made.thing("liq1").quantities["volume"] == pytest.approx(0.5 * SHARE * CUP.capacity, rel=0.03)
    away = np.hypot(pool.position[:, 0], pool.position[:, 1])
    assert len(pool.position) == 500 and away.max() < 0.034
    assert pool.position[:, 2].min() > made.thing("pot1").position[2] + 0.006
