"""Dents of a cracked shell: where it is pressed in under the force that it bears.

It is pressed in at most as far as the membrane inside it stretches. Elastic and perfectly plastic; the dent is found
for the forces of the coming substep, so that they never exceed what is borne (an implicit return mapping).

Source: Simo and Hughes, Computational Inelasticity (1998), chapter 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.log.things import Thing
from prolepsis.matter.shells.crushing_front import across
from prolepsis.matter.shells.yielding import ShellPadding
from prolepsis.scene.running import Running

ROUNDS = 20
"""In which a dent is found; two or three are usual, for the force is nearly linear in its depth."""
YIELDED = 1.0e-4
"""What presses on a dent that goes in does so with the force that it bears, to this part of it [1]."""


@dataclass(kw_only=True, slots=True)
class Dent:
    """What one body has made of the shell that it presses on, whatever parts of the body touch it."""

    force: float
    """It goes in under this force [N]."""
    depth: float = 0.0
    """How far it has been pressed in [m]."""
    stiffness: float
    """By which the force falls when the surface gives way, as last seen [N/m]."""


@dataclass(kw_only=True, slots=True)
class Search:
    """For the depth at which a dent bears what presses on it: the secant method, kept between bounds."""

    low: float
    """Here it bears less than what presses, or it was so deep before [m]."""
    high: float
    """Here it bears more, or it goes no deeper [m]."""
    bounded: bool = False
    """Whether it has been tried at the upper bound."""
    last: tuple[float, float] | None = None
    """Depth [m] and force [N] at the last trial."""

    def next(self, dent: Dent, force: float) -> float:
        """Return the depth to try next [m], the present one if that will do, given what presses on the dent now [N]."""
        if self.last is None and force <= dent.force or abs(force - dent.force) < YIELDED * dent.force:
            return dent.depth
        if self.last is not None:
            depth, before = self.last
            if before > 0 < force and (before - force) * (dent.depth - depth) > 0:
                dent.stiffness = (before - force) / (dent.depth - depth)
        self.last = (dent.depth, force)
        if force > dent.force:
            self.low = dent.depth
        else:
            self.high, self.bounded = dent.depth, True
        wanted = min(dent.depth + (force - dent.force) / dent.stiffness, self.high)
        beyond = wanted <= self.low or (self.bounded and wanted >= self.high)
        return (self.low + self.high) / 2 if beyond else wanted


@dataclass(kw_only=True, slots=True)
class Pressed:
    """Contacts with one body."""

    force: float = 0.0
    """Sum of the normal forces [N]."""
    greatest: float = -1.0
    """Greatest of them [N]."""
    contact: int = -1
    """Its number, -1 if none presses."""


class ShellDents:
    """The dents in one shell that is one body."""

    def __init__(self, thing: Thing, padding: ShellPadding, bears: float, deepest: float) -> None:
        """Look after ``thing``, which ``bears`` a force where it is cracked [N]; dents are at most ``deepest`` [m].

        One that nothing lines (0) has none: it is brittle through and through. Its ``padding`` lowers surfaces too.
        """
        self._padding = padding
        self._thing, self._geom = thing.name, f"{thing.name}/0"
        self._bears, self.deepest = bears, deepest
        """How deep one may be [m]."""
        self._dents: dict[str, Dent] = {}
        self._others: dict[int, str] = {}
        self._pairs: dict[str, list[int]] = {}

    def __bool__(self) -> bool:
        """Return whether there are any."""
        return bool(self._dents)

    @property
    def yields(self) -> float:
        """Least force under which one goes in [N]."""
        return min((dent.force for dent in self._dents.values()), default=math.inf)

    @property
    def share(self) -> float:
        """Depth of the deepest, over how deep one may be [1]."""
        return max((dent.depth for dent in self._dents.values()), default=0.0) / self.deepest if self._dents else 0.0

    def begin(self, state: Running, contacts: IntArray, forces: FloatArray, stiffness: float) -> None:
        """Let the shell be pressed in from now on at contacts, given by their numbers, by no more than forces [N].

        Args:
            state: The running scene.
            contacts: Numbers of the contacts, shape (c,).
            forces: What each of them bears [N], shape (c,).
            stiffness: That of the shell there [N/m].
        """
        for other, force in self._totals(state, contacts, forces).items() if self.deepest else ():
            dent = self._dents.setdefault(other, Dent(force=force, stiffness=stiffness))
            dent.force = min(dent.force, force)

    def grow(self, state: Running) -> list[int]:
        """Press it in until it bears what presses in the coming substep; return the contacts at which it is through.

        A dent that nothing is near any more is forgotten.
        """
        touching = self._touching(state)
        for other in self._dents.keys() - touching.keys():
            self._press_in(state, other, 0.0)
            del self._dents[other]
        searches = {other: Search(low=dent.depth, high=self.deepest) for other, dent in self._dents.items()}
        for _ in range(ROUNDS):
            moved = False
            for other, dent in self._dents.items():
                depth = searches[other].next(dent, touching[other].force if other in touching else 0.0)
                if depth != dent.depth:
                    dent.depth, moved = depth, True
                    self._press_in(state, other, depth)
            if not moved:
                break
            state.renew_forces()
            touching = self._touching(state)
        pressed = [touching[other] for other, dent in self._dents.items() if dent.depth >= self.deepest]
        return [touch.contact for touch in pressed if touch.contact >= 0]

    def pressing(self, state: Running) -> list[tuple[int, FloatArray]]:
        """Return what presses a dent, each a thing by its index with the direction in which it does so, shape (3,)."""
        touching, geom = self._touching(state), int(state.model.geom(self._geom).id)
        contacts = [touching[other].contact for other in self._dents if other in touching]
        return [across(state, geom, contact) for contact in contacts if contact >= 0]

    def shares(self, state: Running, contacts: IntArray, normal: FloatArray, relief: float | None = None) -> FloatArray:
        """Return which share of their normal forces [N] contacts, given by their numbers, really exert [1], shape (c,).

        The rest is but the overshoot of a dent that grows. With ``relief`` [1] the shell has just cracked: where more
        than a cracked shell bears presses, the force falls to that part of it.
        """
        totals = self._totals(state, contacts, normal)
        share = {other: self._share(total, self._dents.get(other), relief) for other, total in totals.items()}
        return np.array([share[self._other(state, contact)] for contact in contacts.tolist()])

    def _share(self, total: float, dent: Dent | None, relief: float | None) -> float:
        most = math.inf if dent is None else dent.force
        if relief is not None and self.deepest and (dent is not None or total > self._bears):
            most = min(most, relief * self._bears)
        return min(1.0, most / max(total, 1e-9))

    def _totals(self, state: Running, contacts: IntArray, forces: FloatArray) -> dict[str, float]:
        """Return the sum of forces [N] at contacts by the body that touches the shell there."""
        totals: dict[str, float] = {}
        for contact, force in zip(contacts.tolist(), forces.tolist(), strict=True):
            other = self._other(state, contact)
            totals[other] = totals.get(other, 0.0) + force
        return totals

    def _touching(self, state: Running) -> dict[str, Pressed]:
        data = state.data
        found: dict[str, Pressed] = {}
        geom = int(state.model.geom(self._geom).id)
        for contact, (pair, row) in enumerate(zip(state.touching(), data.contact.efc_address.tolist(), strict=True)):
            if geom not in pair:
                continue
            touch = found.setdefault(self._other(state, contact), Pressed())
            force = float(data.efc_force[row]) if row >= 0 else 0.0
            touch.force += force
            if force > touch.greatest:
                touch.greatest, touch.contact = force, contact
        return found

    def _other(self, state: Running, contact: int) -> str:
        """Return the name of the body that touches the shell at a contact."""
        a, b = state.touching()[contact]
        other = a if a in self._others else b
        if other not in self._others:
            # What emerged later has no pair: a shard of another shell.
            other = b if a == int(state.model.geom(self._geom).id) else a
            self._others[other] = state.model.body(int(state.model.geom_bodyid[other])).name
        return self._others[other]

    def _press_in(self, state: Running, other: str, depth: float) -> None:
        for pair in self._pairs.get(other, ()):
            state.model.pair_margin[pair] = -depth - self._padding.shift(pair)

    def bind(self, state: Running) -> None:
        """Look the contacts up in a model that is new."""
        model, geom = state.model, int(state.model.geom(self._geom).id)
        self._others, self._pairs = {}, {}
        for number, pair in enumerate(zip(model.pair_geom1.tolist(), model.pair_geom2.tolist(), strict=True)):
            if geom in pair:
                other = pair[0] if pair[1] == geom else pair[1]
                name = model.body(int(model.geom_bodyid[other])).name
                self._others[other] = name
                self._pairs.setdefault(name, []).append(number)
