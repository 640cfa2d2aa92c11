"""Channels: the scalar series that are logged of a thing, each read from the running simulation, never written.

A new one is a function with ``@monitor`` and a line that says what it measures.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from prolepsis.engine.state import State
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.things import Thing
from prolepsis.matter.shells.breaking import Breaking
from prolepsis.robots.arm_control import ArmHand
from prolepsis.robots.flying_control import FlyingHand
from prolepsis.terms.errors import ScenarioError, UnknownNameError


@dataclass(frozen=True, kw_only=True, slots=True)
class Watched:
    """What a monitor may look at."""

    state: State
    hands: Mapping[str, FlyingHand | ArmHand]
    breaking: Mapping[str, Breaking]
    """Controllers of breakable things by name."""


Reader = Callable[[Watched, Thing], float]


@dataclass(frozen=True, kw_only=True, slots=True)
class Monitor:
    """One quantity that can be logged of a thing."""

    name: str
    doc: str
    """What it measures, with its unit."""
    needs: str | None
    """Role that the thing must have, or None for any."""
    default: bool
    """Whether it is logged of every thing with that role unless something else is chosen."""
    read: Reader


MONITORS: dict[str, Monitor] = {}
"""All monitors by name."""


def monitor(needs: str | None = None, *, default: bool = False) -> Callable[[Reader], Reader]:
    """Register the decorated function as the monitor of its name."""

    def register(read: Reader) -> Reader:
        doc = (read.__doc__ or "").strip().splitlines()[0].removeprefix("Return ").rstrip(".")
        MONITORS[read.__name__] = Monitor(name=read.__name__, doc=doc, needs=needs, default=default, read=read)
        return read

    return register


@monitor("Gripper", default=True)
def opening(watched: Watched, thing: Thing) -> float:
    """Return the gap between the pads [m]."""
    return watched.hands[thing.name].gripper.opening


@monitor("Gripper", default=True)
def gripper(watched: Watched, thing: Thing) -> float:
    """Return 1 while the gripper opens, -1 while it closes, 0 when idle."""
    return float(watched.hands[thing.name].gripper.motion)


@monitor("Gripper", default=True)
def pad_force(watched: Watched, thing: Thing) -> float:
    """Return the smaller of the two pads' normal forces [N]."""
    return watched.hands[thing.name].gripper.pad_force


@monitor("Gripper", default=True)
def command(watched: Watched, thing: Thing) -> float:
    """Return the commanded pad force [N]."""
    return watched.hands[thing.name].gripper.command


@monitor("Breakable", default=True)
def load(watched: Watched, thing: Thing) -> float:
    """Return the greatest bond load over strength [1], or 0 where a screen shows that none can break."""
    return watched.breaking[thing.name].load


@monitor("Breakable", default=True)
def force(watched: Watched, thing: Thing) -> float:
    """Return the sum of the normal forces on it, greatest within the tick [N]."""
    return watched.breaking[thing.name].force


@monitor()
def speed(watched: Watched, thing: Thing) -> float:
    """Return the speed of its frame [m/s], 0 where it is no body of its own."""
    return float(np.linalg.norm(watched.state.velocity(thing.name)))


@monitor()
def height(watched: Watched, thing: Thing) -> float:
    """Return the height of its frame above the ground [m]."""
    return watched.state.place(thing.name)[2]


@monitor("YieldingBowl", default=True)
def dent(watched: Watched, thing: Thing) -> float:
    """Return how far its rim stays out of place where it has given way most [m]."""
    return watched.state.attribute(thing.name, "dent")


def _attribute(name: str, doc: str) -> None:
    def read(watched: Watched, thing: Thing) -> float:
        return watched.state.attribute(thing.name, name)

    MONITORS[name] = Monitor(name=name, doc=doc, needs=None, default=False, read=read)


_attribute("wet", "1 while its surface is wet, else 0")
_attribute("dirty", "1 while stuff sticks to it, else 0")
_attribute("broken", "1 once one of its joints has detached, else 0")
_attribute("temperature", "its temperature [degC]")


def chosen_monitors(
    things: Sequence[Thing], choice: Mapping[str, Sequence[str]] | None = None
) -> tuple[tuple[Thing, Monitor], ...]:
    """Return what is logged of which thing.

    Args:
        things: The things of the scene.
        choice: Thing to the names of its monitors; things that are not named have their defaults. What
            recognition cannot do without, a gripper's state, is always logged.

    Raises:
        UnknownNameError: If a thing or a monitor does not exist.
        ScenarioError: If a monitor does not suit a thing.
    """
    choice = choice or {}
    known = {thing.name for thing in things}
    chosen: list[tuple[Thing, Monitor]] = []
    for name, monitors in choice.items():
        if name not in known:
            raise UnknownNameError.of("object", name, known, "[monitors]")
        for wanted in monitors:
            if wanted not in MONITORS:
                raise UnknownNameError.of("monitor", wanted, MONITORS, f"[monitors] {name}")
    for thing in things:
        for each in MONITORS.values():
            suits = each.needs is None or each.needs in thing.roles
            wanted = each.name in choice.get(thing.name, ())
            if wanted and not suits:
                raise ScenarioError(f"[monitors] {thing.name}: {each.name} is of a {each.needs}, which it is not")
            usual = each.default and suits and (thing.name not in choice or each.needs == "Gripper")
            if wanted or usual:
                chosen.append((thing, each))
    return tuple(chosen)


class Channels:
    """The series of one run."""

    def __init__(self, chosen: Sequence[tuple[Thing, Monitor]]) -> None:
        """Log what is ``chosen``."""
        self._chosen = chosen
        self._rows: list[list[float]] = [[] for _ in chosen]

    def tick(self, watched: Watched) -> None:
        """Read every monitor."""
        for row, (thing, each) in zip(self._rows, self._chosen, strict=True):
            row.append(each.read(watched, thing))

    def columns(self) -> dict[str, FloatArray]:
        """Return the series by ``thing.monitor``, each of shape (T,)."""
        return {
            f"{thing.name}.{each.name}": np.asarray(row)
            for row, (thing, each) in zip(self._rows, self._chosen, strict=True)
        }
