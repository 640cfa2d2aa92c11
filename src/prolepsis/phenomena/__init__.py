"""The augmented simulation: one controller a file, attached to things by what the ontology says of them."""

from __future__ import annotations

from prolepsis.phenomena import absorbing, breaking, denting, flowing, membrane, opening, sticking, wetting
from prolepsis.phenomena.phenomenon import Attach, Detachment, Draw, Phenomenon

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
