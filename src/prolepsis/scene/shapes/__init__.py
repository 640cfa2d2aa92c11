"""Shapes: from the name of a family and its extents to convex solids, and to the exact outline where there is one."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from prolepsis.geometry.shape import Shape
from prolepsis.scene.shapes import simple, vessel

SHAPES: Mapping[str, Callable[[Mapping[str, float]], Shape]] = {
    "box": simple.box,
    "cylinder": simple.cylinder,
    "sphere": simple.sphere,
    "ellipsoid": simple.ellipsoid,
    "plane": simple.plane,
    "table": simple.table,
    "cup": vessel.cup,
    "bowl": vessel.bowl,
    "openBox": vessel.open_box,
}
"""Builders by the ontology's name of the shape; a new shape is a function and a line here."""
