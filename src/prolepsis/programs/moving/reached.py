"""Whether what an action aims at was reached, within a tolerance: a hand its place, a force or a speed its size."""

from __future__ import annotations

from prolepsis.log.things import Thing
from prolepsis.robots.commands import Behaviour, Measured, Sense

PLACE_WITHIN = 0.01
"""A hand is where it should be within this [m]: a free one whose base pushes with all its force is 7.5 mm away."""
TURN_WITHIN = 0.05
"""It is turned as it should be within this [rad]."""
COMMANDED = {"N": "commanded_force", "m/s": "commanded_speed"}
"""What evidence calls what was commanded, by its unit."""


def arrived(hand: Thing, sense: Sense) -> Behaviour:
    """Say so if a hand is not where it should be by now."""
    distance, angle = sense.hands[hand.name].away()
    # What an arm cannot get to, it is not even told to.
    distance = max(distance, sense.hands[hand.name].lag)
    if distance > PLACE_WITHIN or angle > TURN_WITHIN:
        reason = f"{hand.name} is {distance * 1000:.0f} mm and {angle:.2f} rad from where it should be"
        sense = yield (Measured(evidence={"away": distance, "reason": reason}, outcome="not_reached"),)
    return sense


def compared(sense: Sense, name: str, value: float, wanted: float, within: float, unit: str) -> Behaviour:
    """Tell what was measured and, of a force or a speed, what was commanded.

    Say so if the two differ by more than ``within``, a share of that [1].
    """
    evidence: dict[str, float | str] = {name: value}
    if unit in COMMANDED:
        evidence[COMMANDED[unit]] = wanted
    if abs(value - wanted) <= within * wanted:
        return (yield (Measured(evidence=evidence),))
    evidence["reason"] = f"{value:.3g} of {wanted:.4g} {unit}"
    return (yield (Measured(evidence=evidence, outcome="not_reached"),))
