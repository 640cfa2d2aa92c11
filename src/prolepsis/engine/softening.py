"""How stiff contacts are: those of pieces softer than those of ordinary things, their friction too while squeezed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray
from prolepsis.log.things import Thing
from prolepsis.system.mujoco import mujoco

STIFF, SOFT = 100.0, 10.0
"""Friction over normal impedance [1]. Static friction is regularized: at 1 what is gripped creeps by 2 mm/s, at 100 by
less than 0.05 to 0.2. While pieces are squeezed the solver diverges at 100, and what grips them creeps more."""
SOLREF = (0.004, 1.0)
"""Of all contacts but smooth ones: the time is four of the longest substeps; at two a pile shakes."""
HARD_SOLIMP = (0.99, 0.99, 0.001, 0.5, 2.0)
"""Contact of hard things: what rests gives by a few micrometres, a thousand times its weight presses it in by less than
a millimetre."""
MARGIN = 2.0e-6
"""Contacts begin at this distance [m]: what is put down leaves half of it, and a tower would fall block by block."""
SMOOTH_TIME, SMOOTH_MOST, SMOOTH_WIDTH = 0.005, 0.95, 0.001
"""Contact of a piece with something hard, solref (0.005, 1) and solimp (0, 0.95, 0.001, 0.5, 2): a smooth onset, so
that it gives by 0.3 mm. What is hard shoots away the light pieces that are squeezed against it, or presses them through
others."""
LEAST = 1.0e-4
"""MuJoCo takes no lower impedance [1]."""
SQUEEZED = 1.0
"""Normal force of a contact with a piece above which it is squeezed [N]; at rest it is half of that."""
LINGERING = 0.1
"""So long after the last such force that still counts [s]: forces among pieces flicker."""


@dataclass(kw_only=True, slots=True)
class Softening:
    """Which solids are of pieces, and until when they count as squeezed."""

    elastic: bool = False
    """Whether there are softer contacts, of their own: their friction would be as soft, and what is gripped creep."""
    pieces: BoolArray = field(default_factory=lambda: np.zeros(0, dtype=np.bool_))
    """Whether each solid of the model is of one, shape (ngeom,)."""
    any_pieces: bool = False
    """Whether there are any."""
    until: float = 0.0
    """[s]"""

    def bind(self, model: Any, body_thing: IntArray, things: Sequence[Thing]) -> None:
        """Look up which solids are of pieces in a model that is new, given which thing each body is."""
        pieces = np.isin(body_thing, [i for i, thing in enumerate(things) if "Piece" in thing.roles])
        self.pieces = pieces[model.geom_bodyid]
        self.any_pieces = bool(pieces.any())
        self.elastic = bool((model.pair_solimp[:, 0] < HARD_SOLIMP[0]).any()) if model.npair else False

    @property
    def applies(self) -> bool:
        """Whether there is anything to do in a substep."""
        return self.any_pieces or self.elastic

    def begin(self, data: Any) -> None:
        """Let pieces that have just come about count as squeezed: a moment ago they were pressed."""
        self.until = float(data.time) + LINGERING

    def renew(self, data: Any) -> None:
        """Look whether pieces are squeezed now."""
        contact = data.contact
        hard = np.flatnonzero(contact.efc_address >= 0)
        hard = hard[data.efc_force[contact.efc_address[hard]] > SQUEEZED]
        if self.pieces[contact.geom[hard]].any():
            self.until = float(data.time) + LINGERING

    def forward(self, model: Any, data: Any) -> None:
        """Find contacts and forces as they are now."""
        mujoco.mj_forward(model, data)
        if self.applies and self.soften(model, data):
            mujoco.mj_fwdConstraint(model, data)

    def soften(self, model: Any, data: Any) -> bool:
        """Soften the contacts of pieces, once MuJoCo has made them for this substep; return whether there are any.

        A contact takes its stiffness from the more slippery of two things, a pair of contacts of its own from nothing
        else, and there are too many pairs for that.
        """
        if not data.ncon:
            return False
        contact = data.contact
        address = contact.efc_address
        firm = self._stick(data)
        chosen = np.flatnonzero((address >= 0) & self.pieces[contact.geom].any(axis=1))
        if not len(chosen):
            return firm
        dim, row = contact.dim[chosen], address[chosen]
        hard = contact.solimp[chosen, 0] == HARD_SOLIMP[0]
        rows, first = _runs(row[hard], dim[hard])
        impedance = _smooth(data.efc_pos[first] - data.efc_margin[first])
        _resist(data, rows, (1.0 - impedance) / impedance / ((1.0 - HARD_SOLIMP[0]) / HARD_SOLIMP[0]))
        # Friction has no stiffness.
        stiffness = np.where(rows == first, 1.0 / (SMOOTH_MOST * SMOOTH_TIME) ** 2, 0.0)
        damping = 2.0 / (SMOOTH_MOST * SMOOTH_TIME)
        data.efc_KBIP[rows, :3] = np.column_stack([stiffness, np.full(len(rows), damping), impedance])
        away = data.efc_pos[rows] - data.efc_margin[rows]
        data.efc_aref[rows] = -damping * data.efc_vel[rows] - stiffness * impedance * away
        if data.time < self.until:
            sliding = dim > 1
            rows, _ = _runs(row[sliding] + 1, dim[sliding] - 1)
            _resist(data, rows, STIFF / SOFT)
            contact.mu[chosen[sliding]] *= np.sqrt(STIFF / SOFT)
        return True

    def _stick(self, data: Any) -> bool:
        """Let what is elastic creep no more than what is hard; return whether there is any such contact."""
        contact = data.contact
        impedance = contact.solimp[:, 0]
        chosen = np.flatnonzero(
            (contact.efc_address >= 0) & (impedance < HARD_SOLIMP[0]) & ~self.pieces[contact.geom].any(axis=1)
        )
        if not len(chosen):
            return False
        softer = (1 / impedance[chosen] - 1) / (1 / HARD_SOLIMP[0] - 1)
        dim = contact.dim[chosen] - 1
        rows, _ = _runs(contact.efc_address[chosen] + 1, dim)
        _resist(data, rows, np.repeat(1 / softer, dim))
        contact.mu[chosen] /= np.sqrt(softer)
        return True


def _runs(first: IntArray, count: IntArray) -> tuple[IntArray, IntArray]:
    """Return numbers that run from each first one on, as many as counted, and the first one of each of them."""
    begins = np.repeat(first, count)
    before = np.repeat(np.cumsum(count) - count, count)
    return begins + np.arange(len(begins)) - before, begins


def _resist(data: Any, rows: IntArray, factor: FloatArray | float) -> None:
    """Multiply the resistance of rows of the constraints, of which MuJoCo keeps a copy in the order of islands."""
    copies = data.map_efc2iefc[rows] if data.nisland else rows
    for resistance, conductance, some in (
        (data.efc_R, data.efc_D, rows),
        *(((data.iefc_R, data.iefc_D, copies),) if data.nisland else ()),
    ):
        resistance[some] *= factor
        conductance[some] /= factor


def _smooth(distance: FloatArray) -> FloatArray:
    """Return the impedance of smooth contacts at distances [m], negative where things are within each other [1]."""
    share = np.minimum(np.abs(distance) / SMOOTH_WIDTH, 1.0)
    rising = np.where(share < 0.5, 2.0 * share**2, 1.0 - 2.0 * (1.0 - share) ** 2)
    return LEAST + (SMOOTH_MOST - LEAST) * rising
