"""What a phenomenon is: a controller that adds to rigid-body physics what it does not cover."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from prolepsis.scene.running import MAX_STEP, Running


@dataclass(frozen=True, kw_only=True, slots=True)
class Detachment:
    """One bond that gave way."""

    thing: int
    """Index of the whole."""
    a: int
    """Index of the first piece."""
    b: int
    """Index of the second piece."""
    force: float
    """Greatest contact force on the body [N]."""


class Phenomenon:
    """A controller in a running simulation; by default it does nothing and needs nothing."""

    def substep(self, state: Running) -> float:
        """Return the longest substep that it can do with in the coming tick [s]."""
        del state
        return MAX_STEP

    def is_steady(self) -> bool:
        """Return whether the substeps of the coming tick need no look one by one."""
        return True

    def bind(self, state: Running) -> None:
        """Give a model that is new, since something has fallen apart, what it needs in the next substep."""
        del state

    def act(self, state: Running) -> list[Detachment]:
        """Do its work after a substep, and return the bonds that gave way."""
        del state
        return []

    def tick(self, state: Running) -> None:
        """Do its work after a tick: what need not be done every substep."""
        del state


@dataclass(frozen=True, kw_only=True, slots=True)
class Draw:
    """How uncertain quantities get their values in one run."""

    rng: np.random.Generator
    """Source of randomness."""
    spread: bool
    """Whether to draw from the distributions; otherwise the means are taken."""

    def value(self, mean: float, deviation: float) -> float:
        """Return a positive quantity: its mean, or a normal draw that is at least a fifth of the mean."""
        return mean if not self.spread else float(max(self.rng.normal(mean, deviation), 0.2 * mean))


Attach = Callable[[Running, Draw], Sequence[Phenomenon]]
"""Makes the controllers of one phenomenon for a scene, by what is known of its things."""
