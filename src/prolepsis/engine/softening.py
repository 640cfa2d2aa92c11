"""How stiff contacts are: all softer once there are pieces, and static friction while these are squeezed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from prolepsis.geometry.shape import BoolArray, IntArray
from prolepsis.log.things import Thing

STIFF, SOFT = 100.0, 10.0
"""Friction over normal impedance [1]. Static friction is regularized: at 1 what is gripped creeps by 2 mm/s, at 100 by
less than 0.05 to 0.2. While pieces are squeezed the solver diverges at 100, and what is gripped creeps more."""
HARD_SOLREF = (0.004, 1.0)
HARD_SOLIMP = (0.99, 0.99, 0.001, 0.5, 2.0)
"""Contact of hard things: what rests gives by a few micrometres, a thousand times its weight presses it in by less than
a millimetre. The time is four of the longest substeps; at two a pile shakes."""
MARGIN = 2.0e-6
"""Contacts begin at this distance [m]: what is put down leaves half of it, and a tower would fall block by block."""
SMOOTH_SOLREF = (0.005, 1.0)
SMOOTH_SOLIMP = (0.0, 0.95, 0.001, 0.5, 2.0)
"""Contact of things among which there are pieces: a smooth onset, so that it gives by 0.3 mm. What is hard shoots away
the light pieces that are squeezed against it, or presses them through others."""
SQUEEZED = 1.0
"""Normal force of a contact with a piece above which it is squeezed [N]; at rest it is half of that."""
LINGERING = 0.1
"""So long after the last such force that still counts [s]: forces among pieces flicker."""


@dataclass(kw_only=True, slots=True)
class Softening:
    """Which bodies are pieces, and until when they count as squeezed."""

    pieces: BoolArray = field(default_factory=lambda: np.zeros(0, dtype=np.bool_))
    """Whether each body of the model is one, shape (nbody,)."""
    until: float = 0.0
    """[s]"""

    def bind(self, model: Any, body_thing: IntArray, things: Sequence[Thing]) -> None:
        """Look up which bodies are pieces in a model that is new, given which thing each body is."""
        self.pieces = np.isin(body_thing, [i for i, thing in enumerate(things) if "Piece" in thing.roles])
        if self.pieces.any():
            hard = (model.geom_solimp == HARD_SOLIMP).all(axis=1)
            model.geom_solref[hard], model.geom_solimp[hard] = SMOOTH_SOLREF, SMOOTH_SOLIMP
            model.geom_margin[hard] = 0.0

    def begin(self, model: Any, data: Any) -> None:
        """Let pieces that have just come about count as squeezed: a moment ago they were pressed."""
        self.until = float(data.time) + LINGERING
        model.opt.impratio = SOFT

    def renew(self, model: Any, data: Any) -> None:
        """Give a model the stiffness that it needs now."""
        if not self.pieces.any():
            return
        contact = data.contact
        hard = np.flatnonzero(contact.efc_address >= 0)
        hard = hard[data.efc_force[contact.efc_address[hard]] > SQUEEZED]
        if self.pieces[model.geom_bodyid[contact.geom[hard]]].any():
            self.until = float(data.time) + LINGERING
        model.opt.impratio = SOFT if data.time < self.until else STIFF
