"""Slow cracks: what presses on a brittle shell for a short time breaks it at a greater force, up to a limit.

Below the load that tears it at once, cracks creep through a mineral with a high power of the load. So a shell under a
load r, over that at which the test of its breaking force breaks it, has a part r^n dt (n + 1) / t of its life less in
each dt, where that test is a steady rise in a time t; it breaks when nothing is left of it. A rise in a tenth of the
time takes it to a load higher by 10^(1/n).

Source:
    R. J. Charles, Dynamic fatigue of glass, J. Appl. Phys. 29:1657 (1958); ASTM C1368 for the test at a steady rise;
    C. Henry, J. Paquet and J. P. Tancrez, Int. J. Rock Mech. 14:85 (1977) for calcite.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

BEYOND = 10.0
"""Load over its strength [1] that no shell bears for a microsecond."""


@dataclass(kw_only=True, slots=True)
class SlowCracks:
    """How much of its life a shell has left under the loads that it has borne; without an exponent it has no memory."""

    exponent: float = math.inf
    """Power of the load with which cracks grow [1]."""
    time: float = 1.0
    """Time in which the load rises to 1 in the test [s]."""
    most: float = 1.0
    """Load that it does not bear for any time [1]."""
    spent: float = 0.0
    """Part of its life that it has had [1]."""
    peak: float = 0.0
    """Greatest load so far [1]."""

    @classmethod
    def of(cls, quantities: Mapping[str, float]) -> SlowCracks:
        """Return those of a shell by its quantities."""
        if "crackGrowthExponent" not in quantities:
            return cls()
        return cls(
            exponent=quantities["crackGrowthExponent"],
            time=quantities["breakingTime"],
            most=quantities.get("briefForceRatio", math.inf),
        )

    def bear(self, before: float, load: float, duration: float) -> None:
        """Let the load [1] go steadily from what it was ``before`` to another in a duration [s]."""
        self.spent = self._after(before, load, duration)
        self.peak = max(self.peak, load)

    def share(self, load: float) -> float:
        """Return a load over what the shell bears of its kind [1]: at 1 it breaks.

        What it bears is found as if all loads so far had been greater in the same proportion.
        """
        return self._share(load, self.spent)

    def share_after(self, before: float, load: float, duration: float) -> float:
        """Return what the share would be after ``bear`` [1]."""
        return self._share(load, self._after(before, load, duration), max(self.peak, load))

    def renew(self) -> None:
        """Begin anew: the shell has cracked, and what now bears has not borne this before."""
        self.spent = self.peak = 0.0

    def _share(self, load: float, spent: float, peak: float | None = None) -> float:
        greatest = self.peak if peak is None else peak
        slow = spent ** (1 / self.exponent) * load / greatest if spent > 0 else 0.0
        return max(load / self.most, slow)

    def _after(self, before: float, load: float, duration: float) -> float:
        if math.isinf(self.exponent):
            return 0.0
        # Far beyond what it bears it breaks anyway, and the power would overflow.
        low, high = sorted((min(before, BEYOND), min(load, BEYOND)))
        power = self.exponent + 1
        if high - low > 1e-6 * high:
            mean = (high**power - low**power) / (power * (high - low))
        else:
            mean = high**self.exponent
        return self.spent + power * duration / self.time * mean
