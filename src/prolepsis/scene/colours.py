"""The colour of an individual, for pictures only."""

from __future__ import annotations

from prolepsis.geometry.shape import Colour, Shape
from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.terms.errors import KnowledgeError, brief


def colour_of(kb: KnowledgeBase, name: str) -> Colour:
    """Return the colour of an individual, grey if none is known.

    Raises:
        KnowledgeError: If what is stated is no colour.
    """
    text = kb.text(name, "colour")
    if text is None:
        return Shape().colour
    try:
        parts = [float(part) for part in text.split()]
    except ValueError:
        parts = []
    if len(parts) not in (3, 4) or not all(0.0 <= part <= 1.0 for part in parts):
        allowed = "red, green, blue and opacity, each from 0 to 1"
        raise KnowledgeError(f"{kb.location(name)}: {name}: colour {brief(repr(text))}; allowed: {allowed}")
    red, green, blue, *opacity = parts
    return (red, green, blue, opacity[0] if opacity else 1.0)
