"""Contacts of a shell: as stiff as it is where it is touched, and the dents where it is pressed in.

It is pressed in at most as far as the membrane inside it stretches. Elastic and perfectly plastic.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.log.things import Thing
from prolepsis.scene.running import Running

DAMPING_RATIO = 0.05
"""Damping of shell contact [1]: a rigid but brittle shell rebounds well."""
IMPEDANCE = 0.1
"""Constant impedance: static and dynamic stiffness then differ by a factor 1 / (1 - 0.1) only."""
SAME = 0.01
"""Smaller changes of stiffness are not passed on [1]."""


class ShellContact:
    """The contact pairs of one thing with an ellipsoidal shell."""

    def __init__(self, state: Running, thing: Thing, plate_stiffness: float, pole_ratio: float) -> None:
        """Look after ``thing``; the stiffnesses are those of ``local_stiffness``."""
        self._thing = thing
        things = state.scene.things
        self._surfaces = {t.name: s for t in things if (s := t.quantities.get("surfaceStiffness")) is not None}
        self._semi_axes = np.array(thing.shape.geoms[0].size)
        self._plate_stiffness, self._pole_ratio = plate_stiffness, pole_ratio
        self._stiffness = 0.0

    def update(self, state: Running, point: FloatArray | None) -> None:
        """Give its contacts the stiffness of the shell at ``point`` [m], or at its lowest point when None."""
        body = state.data.body(self._thing.name)
        rotation = body.xmat.reshape(3, 3)
        position = -rotation[2] * self._semi_axes if point is None else (point - body.xpos) @ rotation
        unit = position / self._semi_axes
        along = abs(unit[0]) / math.sqrt(float(unit @ unit))
        stiffness = local_stiffness(self._semi_axes, along, self._plate_stiffness, self._pole_ratio)
        if abs(stiffness - self._stiffness) < SAME * stiffness:
            return
        self._stiffness = stiffness
        model = state.model
        geom = model.geom(f"{self._thing.name}/0").id
        for p in range(model.npair):
            if geom in (model.pair_geom1[p], model.pair_geom2[p]):
                bodies = (model.geom_bodyid[model.pair_geom1[p]], model.geom_bodyid[model.pair_geom2[p]])
                inverse_mass = model.body_invweight0[bodies[0], 0] + model.body_invweight0[bodies[1], 0]
                other = model.pair_geom1[p] if geom == model.pair_geom2[p] else model.pair_geom2[p]
                soft = self._surfaces.get(model.geom(other).name.rpartition("/")[0])
                # Two springs in series.
                together = stiffness if soft is None else stiffness * soft / (stiffness + soft)
                model.pair_solref[p] = direct_solref(together, inverse_mass)
                model.pair_solimp[p] = (IMPEDANCE, IMPEDANCE, 0.001, 0.5, 2)


def local_stiffness(semi_axes: FloatArray, along: float, plate_stiffness: float, pole_ratio: float) -> float:
    """Return the stiffness of one contact of a spheroidal shell [N/m].

    A plate test has two contacts in series, hence the factor 2; the more a shell is curved, the stiffer it is.

    Args:
        semi_axes: Half lengths, the one along the axis of revolution first and longest [m].
        along: Cosine of the angle from a pole, as a parameter of the ellipsoid: 0 on the girdle, 1 at a pole.
        plate_stiffness: Stiffness between plates, geometric mean of lying and standing [N/m].
        pole_ratio: Stiffness between plates, standing over lying [1].

    Source:
        Reissner's point load on a shallow shell for the dependence on curvature; its strength is the measured ratio.
    """
    longest, other = float(semi_axes[0]), float(semi_axes[1])
    # Radius of the sphere with the same Gaussian curvature.
    girdle, pole = longest, other**2 / longest
    radius = girdle * (1 - along**2) + pole * along**2
    share = math.log(girdle / radius) / math.log(girdle / pole) if girdle != pole else 0.5
    return 2 * plate_stiffness * pole_ratio ** (share - 0.5)


def direct_solref(stiffness: float, inverse_mass: float) -> tuple[float, float]:
    """Return MuJoCo's direct contact reference for a stiffness [N/m] and the bodies' inverse mass [1/kg]."""
    scaled = stiffness * inverse_mass
    return (-scaled, -2 * DAMPING_RATIO * math.sqrt(scaled))


@dataclass(kw_only=True, slots=True)
class Dent:
    """What one body has made of the shell that it presses on, whatever parts of the body touch it."""

    force: float
    """It goes in under this force [N]."""
    distance: float
    """Of the surfaces when last looked at, negative if they overlap [m]."""
    depth: float = 0.0
    """How far it has been pressed in [m]."""


@dataclass(kw_only=True, slots=True)
class Pressed:
    """Contacts with one body."""

    force: float = 0.0
    """Sum of the normal forces [N]."""
    greatest: float = -1.0
    """Greatest of them [N]."""
    point: FloatArray | None = None
    """Where that is, world frame [m], shape (3,)."""
    normal: FloatArray | None = None
    """Unit normal of the surfaces there, shape (3,)."""
    distance: float = math.inf
    """Least distance of the surfaces [m]."""


class ShellDents:
    """The dents in one shell that is one body."""

    def __init__(self, thing: Thing, bears: float, deepest: float) -> None:
        """Look after ``thing``, which ``bears`` a force where it is cracked [N]; dents are at most ``deepest`` [m]."""
        self._thing, self._geom = thing.name, f"{thing.name}/0"
        self._bears, self._deepest = bears, deepest
        self._dents: dict[str, Dent] = {}
        self._others: dict[int, str] = {}
        self._pairs: dict[str, list[int]] = {}

    def __bool__(self) -> bool:
        """Return whether there are any."""
        return bool(self._dents)

    def begin(self, state: Running, contacts: IntArray, forces: FloatArray) -> None:
        """Let the shell be pressed in from now on at contacts, given by their numbers, by no more than forces [N]."""
        for other, force in self._totals(state, contacts, forces).items():
            dent = self._dents.setdefault(other, Dent(force=force, distance=math.inf))
            dent.force = min(dent.force, force)

    def grow(self, state: Running) -> list[FloatArray]:
        """Press it in where more than it bears presses, and return the points where it is pressed through [m].

        A dent that nothing is near any more is forgotten.
        """
        touching = self._touching(state)
        through: list[FloatArray] = []
        for other in self._dents.keys() - touching.keys():
            self._press_in(state, other, 0.0)
            del self._dents[other]
        for other, dent in self._dents.items():
            touch = touching[other]
            first = math.isinf(dent.distance)
            approach = self._approach(state, other, touch) if first else dent.distance - touch.distance
            sinking, dent.distance = max(approach, 0.0), touch.distance
            if touch.force <= dent.force or dent.depth >= self._deepest:
                continue
            # By the next substep it will have come closer by as much as in this one.
            elastic = (-touch.distance - dent.depth) * dent.force / touch.force
            dent.depth = min(max(dent.depth, sinking - touch.distance - elastic), self._deepest)
            self._press_in(state, other, dent.depth)
            if dent.depth >= self._deepest and touch.point is not None:
                through.append(touch.point)
        return through

    def shares(self, state: Running, contacts: IntArray, normal: FloatArray, relief: float | None = None) -> FloatArray:
        """Return which share of their normal forces [N] contacts, given by their numbers, really exert [1], shape (c,).

        The rest is but the overshoot of a dent that grows. With ``relief`` [1] the shell has just cracked: where more
        than a cracked shell bears presses, the force falls to that part of it.
        """
        totals = self._totals(state, contacts, normal)
        share = {other: self._share(total, self._dents.get(other), relief) for other, total in totals.items()}
        return np.array([share[self._other(state, contact)] for contact in contacts.tolist()])

    def _share(self, total: float, dent: Dent | None, relief: float | None) -> float:
        if dent is not None and dent.depth >= self._deepest:
            return 1.0
        most = math.inf if dent is None else dent.force
        if relief is not None and (dent is not None or total > self._bears):
            most = min(most, relief * self._bears)
        return min(1.0, most / max(total, 1e-9))

    def _totals(self, state: Running, contacts: IntArray, forces: FloatArray) -> dict[str, float]:
        """Return the sum of forces [N] at contacts by the body that touches the shell there."""
        totals: dict[str, float] = {}
        for contact, force in zip(contacts.tolist(), forces.tolist(), strict=True):
            other = self._other(state, contact)
            totals[other] = totals.get(other, 0.0) + force
        return totals

    def _approach(self, state: Running, other: str, touch: Pressed) -> float:
        """Return by how much the shell and another body come closer within a substep [m]."""
        if touch.point is None or touch.normal is None:
            return 0.0
        speeds = [state.velocity_at(name, touch.point) for name in (self._thing, other)]
        return abs(float((speeds[1] - speeds[0]) @ touch.normal)) * float(state.model.opt.timestep)

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
            touch.distance = min(touch.distance, float(data.contact.dist[contact]))
            if force > touch.greatest:
                touch.greatest, touch.point = force, data.contact.pos[contact].copy()
                touch.normal = data.contact.frame[contact, :3].copy()
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
            state.model.pair_margin[pair] = -depth

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
