"""Values that follow from a shape and its extents: the volume of its matter, and what it holds."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from prolepsis.geometry.turned import VESSELS, Vessel
from prolepsis.terms.errors import KnowledgeError

Get = Callable[[str], float | None]
"""Value of a property by name, in SI units, or None."""
EXTENTS = ("radius", "height", "thickness", "lid")
"""What the outline of a round vessel follows from."""


def volume(shape: str, get: Get, file: Callable[[], str | None] = lambda: None) -> tuple[float, str] | None:
    """Return the volume of matter [m^3] and its formula, or None if an extent is not known.

    Args:
        shape: The ontology's name of the shape.
        get: Extents.
        file: File of a mesh.

    Raises:
        KnowledgeError: If the file of a mesh encloses no volume.

    Source:
        Elementary geometry; round vessels are turned outlines, less their holes.
    """
    length, width, height, radius = get("length"), get("width"), get("height"), get("radius")
    breadth, thickness = get("breadth"), get("thickness")
    if shape == "box" and length and width and height:
        return length * width * height, "length * width * height"
    if shape == "sphere" and radius:
        return 4 / 3 * math.pi * radius**3, "4/3 pi radius^3"
    if shape == "cylinder" and radius and height:
        return math.pi * radius**2 * height, "pi radius^2 height"
    if shape == "ellipsoid" and length and breadth:
        return math.pi / 6 * length * breadth**2, "pi/6 length breadth^2"
    cavity = _cavity_of_box(get) if shape == "openBox" else None
    if cavity is not None and length and width and height:
        return length * width * height - cavity, "length * width * height minus cavity"
    vessel = _vessel(shape, get)
    if vessel is not None and thickness:
        bottom, side = get("bottomHoleRadius") or 0.0, get("holeRadius") or 0.0
        holes = math.pi * (bottom**2 * vessel.inner[0][1] + side**2 * thickness * (get("holeCount") or 1.0))
        # One that is all hole is refused, with its name, when its shape is built.
        return (vessel.volume - holes, "volume of its turned outline") if holes < vessel.volume else None
    path = file() if shape == "mesh" else None
    if path is not None:
        from prolepsis.geometry.meshes import enclosed_volume, read_surface

        return enclosed_volume(read_surface(Path(path), get("scale") or 1.0)), "volume of its mesh"
    return None


def capacity(shape: str, get: Get) -> float | None:
    """Return what a vessel holds up to the brim [m^3], its holes stopped, or None if an extent is not known."""
    if shape == "openBox":
        return _cavity_of_box(get)
    vessel = _vessel(shape, get)
    return None if vessel is None else vessel.capacity


def _cavity_of_box(get: Get) -> float | None:
    length, width, height, thickness = (get(extent) or 0.0 for extent in ("length", "width", "height", "thickness"))
    inner = (length - 2 * thickness, width - 2 * thickness, height - thickness)
    # One whose walls meet is refused, with its name, when its shape is built.
    return math.prod(inner) if thickness and min(inner) > 0.0 else None


def _vessel(shape: str, get: Get) -> Vessel | None:
    extents = {name: value for name in EXTENTS if (value := get(name)) is not None}
    if shape not in VESSELS or not {*EXTENTS[:3]} <= {*extents}:
        return None
    try:
        return VESSELS[shape](extents)
    except KnowledgeError:
        return None  # Refused, with its name, when its shape is built.
