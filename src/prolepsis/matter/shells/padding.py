"""Padding: what gives way under a shell, column by column, until it is pressed flat, and returns part of the energy.

Each column of a soft thing answers to its own compression alone (Winkler's foundation): elastic, then at a constant
stress if it yields, and ever stiffer towards the strain at which it is pressed flat. On its way back it presses with
the share of that force that it returns of the energy.

Source: Johnson, Contact Mechanics (1985), section 4.3; Gibson and Ashby, Cellular Solids (1997), chapter 5, for foams.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.shape import FloatArray

RETURNING = 0.03
"""From this speed on it returns no more than its share [m/s]; slower, the share changes evenly: it comes to rest."""
ROUNDS = 60
"""In which it is found how far a padding has given way; some ten are usual."""
SHALLOW = 0.9
"""Share of the depth from which the nearest way out is on the far side that it is pressed in at most [1]."""
EXACT = 1.0e-9
"""To this depth [m], and to this part of what it is pressed flat at [1]."""
RINGS = 20
"""In which the pressure on a patch of contact is taken."""
WAVES = np.geomspace(1.0e-6, 30.0, 400)
"""Squares of wave numbers of what bends a shell, over those at which the load ends [1]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Padding:
    """A layer of one material on something hard."""

    modulus: float
    """Stress over strain at the beginning [Pa]."""
    thickness: float
    """[m]"""
    yields: float
    """Stress at which it is crushed [Pa]; infinite if it is elastic."""
    flat: float
    """Strain at which it is pressed flat [1]."""
    returned: float
    """Share of the energy that it returns [1]."""

    @property
    def deepest(self) -> float:
        """So far it can be pressed in [m]."""
        return self.flat * self.thickness

    def pressure(self, depth: FloatArray) -> FloatArray:
        """Return the pressure of columns that are pressed in by a depth, less than the deepest [Pa]."""
        return np.minimum(self.modulus * depth / self.thickness, self.yields) / (1.0 - depth / self.deepest)

    def force(self, depth: float, radius: float, height: float) -> tuple[float, float]:
        """Return the force on an ellipsoid that is pressed in [N], and by how much it rises [N/m].

        Args:
            depth: How far its lowest point is [m].
            radius: Half of the increase of its cross section with the depth, over pi, at its lowest point [m].
            height: That of its middle above its lowest point [m].
        """
        # Columns end where the ellipsoid is widest.
        least = max(depth - height, 0.0)
        work, moment = (high - low for high, low in zip(self._work(depth), self._work(least), strict=True))
        rising = float(self.pressure(np.array(depth))) - work / height
        round_it = 2.0 * math.pi * radius
        return round_it * ((1.0 - depth / height) * work + moment / height), round_it * rising

    def _work(self, depth: float) -> tuple[float, float]:
        """Return the integral of the pressure up to a depth [N/m], and of the pressure times the depth [N]."""
        deepest, rate = self.deepest, self.modulus / self.thickness
        elastic = min(depth, self.yields / rate)
        some, most = elastic / deepest, depth / deepest
        log_some, log_most = math.log1p(-some), math.log1p(-most)
        work = -rate * deepest**2 * (log_some + some)
        moment = -rate * deepest**3 * (log_some + some + some**2 / 2.0)
        if depth > elastic:
            work += self.yields * deepest * (log_some - log_most)
            moment += self.yields * deepest**2 * (log_some + some - log_most - most)
        return work, moment

    def gives(
        self, depth: float, stiffness: float, radius: float, height: float, share: float
    ) -> tuple[float, float, float]:
        """Return how far it gives way to an ellipsoid that gives as well [m], and their force [N] and stiffness [N/m].

        Args:
            depth: By which both give way together [m].
            stiffness: That of the ellipsoid [N/m].
            radius: As ``force`` takes it [m].
            height: The same [m].
            share: Of its force that it exerts [1].
        """
        low, high = 0.0, min(depth, self.deepest * (1.0 - EXACT))
        tried, rising = high / 2.0, 0.0
        # Two springs in series bear the same force.
        for _ in range(ROUNDS):
            force, rising = (share * each for each in self.force(tried, radius, height))
            excess = force - stiffness * (depth - tried)
            low, high = (low, tried) if excess > 0.0 else (tried, high)
            step = excess / (stiffness + rising)
            if abs(step) < EXACT or high - low < EXACT:
                break
            tried = tried - step if low < tried - step < high else (low + high) / 2.0
        return tried, stiffness * (depth - tried), stiffness * rising / (stiffness + rising)

    def share(self, approach: float) -> float:
        """Return the share of its force that it exerts on what comes closer at a speed [m/s], or goes if negative."""
        return 1.0 - (1.0 - self.returned) * min(max(-approach / RETURNING, 0.0), 1.0)


def padding_of(quantities: Mapping[str, float], extent: float, turning: float) -> Padding | None:
    """Return the padding that a thing with some quantities is, or None if it is hard.

    Args:
        quantities: What is known of it.
        extent: Its extent along what presses on it [m].
        turning: From this depth on the nearest way out is on its far side [m].
    """
    flat = quantities.get("densificationStrain")
    if flat is None:
        return None
    thickness = quantities.get("paddingThickness", extent)
    return Padding(
        modulus=quantities["youngsModulus"],
        thickness=thickness,
        yields=quantities.get("yieldStress", math.inf),
        flat=min(flat, SHALLOW * turning / thickness),
        returned=quantities.get("restitution", 0.0) ** 2,
    )


def spread_under(padding: Padding, radius: float, height: float, depth: float) -> float:
    """Return the mean square of the distance from the middle of the pressure under an ellipsoid [m^2].

    Args:
        padding: What presses on it.
        radius: As ``Padding.force`` takes it [m].
        height: The same [m].
        depth: By which the padding is pressed in [m].
    """
    rise = min(depth, height) * (np.arange(RINGS) + 0.5) / RINGS
    weight = padding.pressure(depth - rise) * (1.0 - rise / height)
    squared = radius * rise * (2.0 - rise / height)
    return float(weight @ squared / weight.sum())


def concentration(spread: float, length: float) -> float:
    """Return how a load bends a shallow shell in its middle, over load (1 + nu) / 8 pi [1].

    Args:
        spread: Mean square of the distance of the load from its middle [m^2].
        length: Over which bending in the shell dies down, the fourth root of (R t)^2 / 12 (1 - nu^2) [m].

    Source:
        Reissner, J. Math. Phys. 25:80 (1946): a shallow spherical shell is a plate on an elastic foundation. For a
        load that is a Gaussian the integral over its waves is the auxiliary function g of the sine integral, of
        the ratio of the squares z: - log z - 0.5772 for a small one, 1 / z^2 for a large one.
    """
    z = spread / (4.0 * length**2)
    waves = WAVES / z
    return float(np.trapezoid(waves**2 * np.exp(-z * waves) / (waves**2 + 1.0), np.log(waves)))
