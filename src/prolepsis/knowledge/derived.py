"""Values that follow from others: the volume of a solid from its shape and extents."""

from __future__ import annotations

import math
from collections.abc import Callable

Get = Callable[[str], float | None]
"""Value of a property by name, in SI units, or None."""


def volume(shape: str, get: Get) -> tuple[float, str] | None:
    """Return the volume of matter [m^3] and its formula, or None if an extent is not known.

    Source:
        Elementary geometry. A bowl is a thin spherical cap, a cup a cylindrical wall on a flat bottom.
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
    if shape == "cup" and radius and height and thickness and thickness < min(radius, height):
        inner = math.pi * (radius - thickness) ** 2 * (height - thickness)
        return math.pi * radius**2 * height - inner, "cylinder minus cavity"
    if shape == "bowl" and radius and height and thickness:
        return math.pi * (radius**2 + height**2) * thickness, "spherical cap times thickness"
    return None
