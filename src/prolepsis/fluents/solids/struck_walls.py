"""What a brittle wall bears, and with which force it is struck: vessels are rigid in the engine, and never break.

A blow on a wall of thickness t and radius R bends it. It breaks at a force that goes with the square of the thickness,
whatever the size and form of the piece, and gives way like a pinched cylinder whose one end is open.

Source:
    ASTM C368 (2020), note 1, for the square of the thickness. For the factor balls that fell on panes of 4 and 6 mm
    (British Manufacturing Industries, 1876), and an egg shell of 0.36 mm and 292 MPa that breaks at 36 N. For the
    stiffness pinched cylinders of R/t 100 with held ends and of R/t 53 with free ones (MacNeal and Harder 1985;
    Timoshenko and Woinowsky-Krieger): 1 / 0.164 and 1 / 2.94 of E t (t / R)^(3/2). Hertz's contact.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

BRIEF = 1.4
"""A blow of a millisecond breaks glass and ware at more stress than a pull of a second does [1]: the root of the ratio
of the times, of an order of some 20, as they weaken slowly in moist air."""
GIVE = 0.7
"""Give of a wall whose one end is open, between one with held ends and one with free ones [1]."""
HALVINGS = 60
"""In which the force is found: to rounding."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Wall:
    """A brittle wall."""

    bears: float
    """Force of a blow at which it breaks [N]."""
    stiffness: float
    """Against a force at a point [N/m]."""
    radius: float
    """[m]"""


def wall_of(quantities: Mapping[str, float]) -> Wall | None:
    """Return the wall of a thing, by its material and thickness; None if it is not known to have a brittle one."""
    strength, modulus = quantities.get("bendingStrength"), quantities.get("youngsModulus")
    thickness, radius = quantities.get("thickness"), quantities.get("radius")
    if strength is None or modulus is None or thickness is None or radius is None:
        return None
    return Wall(
        bears=BRIEF * strength * thickness**2,
        stiffness=modulus * thickness * (thickness / radius) ** 1.5 / GIVE,
        radius=radius,
    )


def blow(wall: Wall, own: Mapping[str, float], other: Mapping[str, float], mass: float, speed: float) -> float:
    """Return the greatest force of a blow on a wall [N].

    Args:
        wall: The wall.
        own: Quantities of what has it.
        other: Quantities of what strikes it, or what it strikes.
        mass: What the blow sees of both [kg].
        speed: Closing speed [m/s].
    """
    give = 1 / wall.stiffness
    struck = wall_of(other)
    give += 1 / struck.stiffness if struck is not None else 0.0
    give += 1 / other["surfaceStiffness"] if "surfaceStiffness" in other else 0.0
    softness = sum(1 / each["youngsModulus"] for each in (own, other) if each.get("youngsModulus"))
    contact = 4 / 3 / softness * math.sqrt(wall.radius)
    energy = mass * speed**2 / 2
    low, high = 0.0, math.sqrt(2 * energy / give)
    for _ in range(HALVINGS):
        force = (low + high) / 2
        # The wall's and the contact's.
        stored = give * force**2 / 2 + 0.4 * force ** (5 / 3) / contact ** (2 / 3)
        low, high = (force, high) if stored < energy else (low, force)
    return high
