"""The augmented simulation: one controller a file, attached to things by what the ontology says of them."""

from __future__ import annotations

from prolepsis.matter.films import sticking, wetting
from prolepsis.matter.liquids import flowing
from prolepsis.matter.phenomenon import Attach, Detachment, Draw, Phenomenon
from prolepsis.matter.shells import breaking, membrane, opening
from prolepsis.matter.sponges import absorbing
from prolepsis.matter.walls import denting

PHENOMENA: tuple[Attach, ...] = (
    breaking.attach,
    denting.attach,
    flowing.attach,
    opening.attach,
    membrane.attach,
    absorbing.attach,
    wetting.attach,
    sticking.attach,
)
"""All phenomena in the order in which they run; a later one may read what an earlier one did."""

__all__ = ["PHENOMENA", "Attach", "Detachment", "Draw", "Phenomenon"]
