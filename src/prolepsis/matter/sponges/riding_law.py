"""How high a soft thing rides on a thick liquid over which it slides, and how far that enters its pores meanwhile."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.shape import FloatArray

WATER_VISCOSITY, WATER_TENSION = 1.0e-3, 72.8e-3
"""What the uptake speed of a sponge is told of [Pa s, N/m]."""
WATER_DENSITY = 998.0
"""What the absorbent capacity is told of [kg/m^3]."""
INLET = math.sqrt(2.0) * 6.0 * math.pi / 16.0
"""Integral of Reynolds' equation over a rounded inlet: the pressure there is this times mu U sqrt(r) / h^(3/2) [1]."""
SPLIT = 0.5
"""Share of a film between two surfaces that stays on either when they part [1]: it tears in its middle."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RidingLaw:
    """One soft thing with pores on one of its faces.

    Source:
        Grubin's way to the film between soft bodies (Johnson, Contact Mechanics, 1985): at the inlet, Reynolds'
        equation gives the pressure that the foam, an elastic foundation, has where the film is. Washburn, Physical
        Review 17:273 (1921), for the front in the pores. Arrhenius (1887): the logarithms of viscosities mix, in
        proportion to the molecules.
    """

    stiffness: float
    """Pressure over how far the face gives way [Pa/m]."""
    face: float
    """Area of the face [m^2]."""
    pores: float
    """Volume of all its pores [m^3]."""
    edge_radius: float
    """Of its edge [m]."""
    pore_size: float
    """[m]"""
    porosity: float
    """Share of its volume that pores are [1]."""
    diffusivity: float
    """Square of the depth to which water fills it over the time [m^2/s]."""

    @classmethod
    def of(cls, quantities: Mapping[str, float], smallest: float, thickness: float, face: float) -> RidingLaw | None:
        """Return the law of one face [m^2] of what has a thickness behind it [m]; None if it is not known.

        Args:
            quantities: What is known of it.
            smallest: Its smallest dimension [m], to which the uptake speed refers.
            thickness: [m].
            face: [m^2].
        """
        if not {"poreSize", "edgeRadius"} <= quantities.keys():
            return None
        porosity = min(quantities["absorbentCapacity"] * quantities["density"] / WATER_DENSITY, 1.0)
        return cls(
            stiffness=quantities["youngsModulus"] / thickness,
            face=face,
            pores=porosity * face * thickness,
            edge_radius=quantities["edgeRadius"],
            pore_size=quantities["poreSize"],
            porosity=porosity,
            diffusivity=quantities["uptakeSpeed"] * smallest,
        )

    def height(self, viscosity: float, speed: float, load: float) -> float:
        """Return the thickness of the film on which it rides [m]; 0 if that is within its pores.

        Args:
            viscosity: [Pa s].
            speed: Of its sliding [m/s].
            load: With which it is pressed on [N].
        """
        drive = INLET * viscosity * speed * math.sqrt(self.edge_radius)
        low, high = 0.0, (drive / self.stiffness) ** 0.4
        while high - low > 1e-6 * high:
            middle = (low + high) / 2
            bears = middle**1.5 * (load / self.face + self.stiffness * middle) < drive
            low, high = (middle, high) if bears else (low, middle)
        return low if low > self.pore_size else 0.0

    def depth_after(self, depth: float, viscosity: float, pressure: float, dt: float) -> float:
        """Return how deep a front is in the pores a time later [m].

        Args:
            depth: How deep it was [m].
            viscosity: Of what is behind the front [Pa s].
            pressure: Of the film, beside which the pores draw it in [Pa].
            dt: The time [s].
        """
        capillary = 4 * WATER_TENSION / self.pore_size
        return math.sqrt(depth**2 + self.diffusivity * WATER_VISCOSITY / viscosity * (1 + pressure / capillary) * dt)


def mixed(amounts: FloatArray, viscosities: FloatArray) -> float:
    """Return the viscosity of a mixture [Pa s], given those of what is mixed and the amounts of molecules [any]."""
    return math.exp(float(amounts @ np.log(viscosities) / amounts.sum()))
