"""Contact of an intact shell: as stiff as the shell is where it is touched."""

from __future__ import annotations

import math

import numpy as np

from prolepsis.geometry.shape import FloatArray
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
        turn = body.xmat.reshape(3, 3)
        place = -turn[2] * self._semi_axes if point is None else (point - body.xpos) @ turn
        unit = place / self._semi_axes
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
