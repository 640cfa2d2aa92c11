"""How much a sponge holds, and how fast it takes liquid up, drips and is pressed out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from prolepsis.geometry.shape import FloatArray

WATER_VISCOSITY = 1.0e-3
"""What the uptake speed of a sponge is told of [Pa s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SpongeLaw:
    """One sponge; masses are those of the liquid that it holds.

    Source:
        Washburn, Physical Review 17:273 (1921): a front in pores slows down as it gets deeper, and with viscosity.
        Pores close in proportion to the strain of the foam, which is taken as pressure over its modulus.
    """

    capacity: float
    """Greatest mass [kg]."""
    retained: float
    """What it keeps when it hangs freely until it drips no more [kg]."""
    squeezed: float
    """What a hand does not press out [kg]."""
    modulus: float
    """Pressure at which the foam would be flat, were it linear so far [Pa]."""
    uptake_speed: float
    """Mean speed at which it fills with water through its thickness when it is laid in it, dry [m/s]."""
    thickness: float
    """Its smallest dimension [m]."""
    pressing_time: float
    """In this time what it cannot keep under pressure becomes less by a factor e [s]."""
    recovery_time: float
    """In this time the pressure that it still feels when it is no longer pressed becomes less by a factor e [s]."""
    dripping_time: float
    """In this time what it cannot keep when it hangs freely becomes less by a factor e [s]."""

    @classmethod
    def of(cls, quantities: Mapping[str, float], mass: float, thickness: float) -> SpongeLaw:
        """Return the law of a sponge with a dry mass [kg] and a thickness [m].

        Raises:
            KeyError: If one of its quantities is not known.
        """
        capacity = quantities["absorbentCapacity"] * mass
        return cls(
            capacity=capacity,
            retained=quantities["drippingRetention"] * capacity,
            squeezed=min(quantities["squeezedCapacity"] * mass, capacity),
            modulus=quantities["youngsModulus"],
            uptake_speed=quantities["uptakeSpeed"],
            thickness=thickness,
            pressing_time=quantities["pressingTime"],
            recovery_time=quantities["recoveryTime"],
            dripping_time=quantities["drippingTime"],
        )

    def pressure_after(self, pressure: float, now: float, dt: float) -> float:
        """Return the pressure that the foam feels a time later [Pa]: it gives way at once and springs back slowly.

        Args:
            pressure: What it felt before [Pa].
            now: What presses on it now [Pa].
            dt: The time [s].
        """
        return max(now, now + (min(pressure, self.modulus) - now) * math.exp(-dt / self.recovery_time))

    def capacity_under(self, pressure: float) -> float:
        """Return how much it can hold under a pressure [Pa] of the solids that touch it [kg]."""
        return max(self.capacity * (1 - pressure / self.modulus), self.squeezed)

    def front_speed(self, held: float, viscosity: FloatArray, least: float) -> FloatArray:
        """Return how fast liquids of given viscosities [Pa s] enter its surface [m/s].

        Args:
            held: What it holds already [kg].
            viscosity: Shape (n,).
            least: Depth of the front at least [m]: the resolution of the liquid.
        """
        depth = max(self.thickness * held / self.capacity, least)
        return self.uptake_speed * self.thickness / (2 * depth) * WATER_VISCOSITY / viscosity
