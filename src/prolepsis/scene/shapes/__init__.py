"""Shapes: from the name of a family and its extents to convex solids, and to the exact outline where there is one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from prolepsis.geometry.shape import Shape
from prolepsis.scene.shapes import simple, vessel
from prolepsis.scene.shapes.holes import QUANTITIES

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
EXTENTS = frozenset({"length", "width", "height", "breadth", "radius", "thickness", "scale", "lid", *QUANTITIES})
"""Quantities that are of use to a builder only."""


class Extents(Mapping[str, float]):
    """Quantities while a shape is built of them, which notes those that were asked for."""

    def __init__(self, known: Mapping[str, float]) -> None:
        """Give what is ``known``."""
        self._known = known
        self.asked: set[str] = set()

    def __getitem__(self, name: str) -> float:
        """Return a quantity, and note that it was asked for."""
        self.asked.add(name)
        return self._known[name]

    def __iter__(self) -> Iterator[str]:
        """Yield the names of all."""
        return iter(self._known)

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self._known)
