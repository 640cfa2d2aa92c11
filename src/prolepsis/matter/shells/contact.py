"""Contacts of a shell: as stiff as it is where it is touched; what presses there, and how fast something comes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.log.things import Thing
from prolepsis.scene.running import Running

NEAR = 0.01
"""Contacts of breakable things are detected at this distance [m], so that the substep shrinks before the impact."""
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
        self.stiffness = 0.0
        """Of the shell where it is touched [N/m]."""
        self.padded: frozenset[int] = frozenset()
        """Pairs that are left to the law of padding."""
        self._damping: float = DAMPING_RATIO

    def update(self, state: Running, contact: int, damping: float = DAMPING_RATIO) -> None:
        """Give its contacts a damping [1], and the shell's stiffness at one of them, at its lowest point if -1."""
        body = state.data.body(self._thing.name)
        rotation = body.xmat.reshape(3, 3)
        lowest = -rotation[2] * self._semi_axes
        position = lowest if contact < 0 else (state.data.contact.pos[contact] - body.xpos) @ rotation
        unit = position / self._semi_axes
        along = abs(unit[0]) / math.sqrt(float(unit @ unit))
        stiffness = local_stiffness(self._semi_axes, along, self._plate_stiffness, self._pole_ratio)
        if abs(stiffness - self.stiffness) < SAME * stiffness and damping == self._damping:
            return
        self.stiffness, self._damping = stiffness, damping
        model = state.model
        geom = model.geom(f"{self._thing.name}/0").id
        for p in range(model.npair):
            if p not in self.padded and geom in (model.pair_geom1[p], model.pair_geom2[p]):
                other = model.pair_geom1[p] if geom == model.pair_geom2[p] else model.pair_geom2[p]
                soft = self._surfaces.get(model.geom(other).name.rpartition("/")[0])
                # Two springs in series.
                together = stiffness if soft is None else stiffness * soft / (stiffness + soft)
                stiffen(model, p, together, damping)


def stiffen(model: Any, pair: int, stiffness: float, damping: float) -> None:
    """Give a contact pair of a model, by its number, a stiffness [N/m] and damping [1]."""
    bodies = model.geom_bodyid[[model.pair_geom1[pair], model.pair_geom2[pair]]]
    inverse_mass = float(model.body_invweight0[bodies, 0].sum())
    model.pair_solref[pair] = direct_solref(stiffness, inverse_mass, damping)
    model.pair_solimp[pair] = (IMPEDANCE, IMPEDANCE, 0.001, 0.5, 2)


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


def direct_solref(stiffness: float, inverse_mass: float, damping: float) -> tuple[float, float]:
    """Return MuJoCo's direct reference for a stiffness [N/m], the bodies' inverse mass [1/kg] and damping [1]."""
    scaled = stiffness * inverse_mass
    return (-scaled, -2 * damping * math.sqrt(scaled))


def closing_speed(state: Running, geom: int) -> float:
    """Return the greatest speed with which something near comes closer to a geom [m/s]."""
    fastest = 0.0
    contact, body_of = state.data.contact, state.model.geom_bodyid
    for k, pair in enumerate(state.touching()):
        if geom in pair:
            first, second = (state.velocity_at(state.model.body(body_of[g]).name, contact.pos[k]) for g in pair)
            fastest = max(fastest, float((first - second) @ contact.frame[k, :3]))
    return fastest


def shares_before(
    state: Running, geom: int, before: Sequence[tuple[int, int, int, float]], contacts: IntArray
) -> FloatArray:
    """Return which share of their forces contacts had in an earlier substep [1], body by body, shape (c,).

    Args:
        state: The running scene.
        geom: Number of the geom whose contacts they are.
        before: The forces then, as ``Running.normal_forces`` lists them.
        contacts: Numbers of the contacts now, shape (c,).
    """
    own = int(state.model.geom_bodyid[geom])
    then, now = (_by_other(own, forces) for forces in (before, state.normal_forces()))
    bodies: list[list[int]] = state.model.geom_bodyid[state.data.contact.geom[contacts]].tolist()
    others = [b if a == own else a for a, b in bodies]
    return np.array([then.get(other, 0.0) / max(now[other], 1e-9) for other in others])


def _by_other(own: int, forces: Sequence[tuple[int, int, int, float]]) -> dict[int, float]:
    """Return the sum of the normal forces of each body on a body [N]."""
    sums: dict[int, float] = {}
    for _, first, second, force in forces:
        if own in (first, second):
            other = second if first == own else first
            sums[other] = sums.get(other, 0.0) + force
    return sums
