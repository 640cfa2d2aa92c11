"""A program: a plan read from a term, checked against the scene, ready to be started."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from prolepsis.robots.commands import ActionFailedError, Behaviour, Command, Sense, is_instant
from prolepsis.terms.terms import Value


@dataclass(frozen=True, kw_only=True, slots=True)
class Program:
    """A checked plan."""

    term: Value
    """The plan, all variables bound."""
    begin: Callable[[Sense], Behaviour]
    """Makes the generator of commands."""

    def start(self, sense: Sense) -> RunningProgram:
        """Return the running program, given what is sensed at the start."""
        return RunningProgram(self.begin(sense))


class RunningProgram:
    """A started program: one step a tick."""

    def __init__(self, behaviour: Behaviour) -> None:
        """Wrap a generator of commands."""
        self._behaviour = behaviour
        self._fresh = True
        self.ended = False
        """True when there is nothing left to do."""

    def step(self, sense: Sense) -> tuple[Command, ...]:
        """Return the commands of this tick."""
        commands: tuple[Command, ...] = ()
        while not self.ended:
            try:
                made = next(self._behaviour) if self._fresh else self._behaviour.send(sense)
            except (StopIteration, ActionFailedError):
                # What failed has said so at its end; what should have come after it is not done.
                self.ended = not commands
                break
            self._fresh = False
            commands += made
            if not is_instant(made):
                break
        return commands
