"""Binding: who looks things up in a model does so anew whenever the model is another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from prolepsis.engine.state import State
from prolepsis.scene.kind import Controller
from prolepsis.terms.errors import InputError


@dataclass(kw_only=True)
class Binding:
    """The controllers of a run, and which model they know."""

    state: State
    going: Sequence[Controller]
    version: int = -1
    """Of the model that they know."""
    splits: int = 0
    """Of the bodies that had fallen apart then."""

    def renew(self) -> bool:
        """Bind all if the model is another than the one that they know, and return whether it was.

        Raises:
            InputError: If one of them rebuilds the model while it is bound.
        """
        state = self.state
        if state.version == self.version:
            return False
        if state.splits != self.splits:
            for each in self.going:
                each.rejoin(state)
        self.version, self.splits = state.version, state.splits
        for each in self.going:
            each.bind(state)
            if state.version != self.version:
                raise InputError(
                    f"{type(each).__name__}.bind rebuilds the model, which others know already; allowed: to join and "
                    "split when it starts, in begin_tick, act, end_tick and rejoin"
                )
        return True
