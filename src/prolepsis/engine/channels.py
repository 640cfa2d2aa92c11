"""Channels: the scalar series that are logged of a thing, as the kinds of a scene declare them and measure them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from prolepsis.engine.whereabouts import whereabouts
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.things import Thing
from prolepsis.scene.kind import Channel, Kind
from prolepsis.scene.running import Running
from prolepsis.scene.scene import Scene
from prolepsis.terms.errors import ScenarioError, UnknownNameError


def _speed(state: Running, thing: Thing) -> float:
    return float(np.linalg.norm(whereabouts(state, thing)[1]))


def _height(state: Running, thing: Thing) -> float:
    return float(whereabouts(state, thing)[0][2])


CHANNELS = (
    Channel(
        name="speed", doc="the speed of its frame, or of its middle where it fell apart or flows [m/s]", read=_speed
    ),
    Channel(
        name="height", doc="the height of its frame, or of its middle where it fell apart or flows [m]", read=_height
    ),
    Channel(name="temperature", doc="its temperature [K]"),
)
"""Those that all things have, whatever the kinds."""


def known_channels(kinds: Sequence[Kind]) -> dict[str, Channel]:
    """Return all channels that there may be in a scene of these kinds, by name."""
    return {each.name: each for each in (*CHANNELS, *(each for kind in kinds for each in kind.channels))}


def chosen_channels(
    scene: Scene, choice: Mapping[str, Sequence[str]] | None = None
) -> tuple[tuple[Thing, Channel], ...]:
    """Return what is logged of which thing.

    Args:
        scene: The scene.
        choice: Thing to the names of its channels; things that are not named have their defaults. What
            recognition cannot do without is always logged.

    Raises:
        UnknownNameError: If a thing or a monitor does not exist.
        ScenarioError: If a monitor does not suit a thing.
    """
    choice, things, channels = choice or {}, scene.things, known_channels(scene.kinds)
    known = {thing.name for thing in things}
    chosen: list[tuple[Thing, Channel]] = []
    for name, monitors in choice.items():
        if name not in known:
            raise UnknownNameError.of("object", name, known, "[monitors]")
        for wanted in monitors:
            if wanted not in channels:
                raise UnknownNameError.of("monitor", wanted, channels, f"[monitors] {name}")
    for thing in things:
        for each in channels.values():
            suits = each.role is None or each.role in thing.roles
            wanted = each.name in choice.get(thing.name, ())
            if wanted and not suits:
                raise ScenarioError(f"[monitors] {thing.name}: {each.name} is of a {each.role}, which it is not")
            usual = each.default and suits and (thing.name not in choice or each.needed)
            if wanted or usual:
                chosen.append((thing, each))
    return tuple(chosen)


class Channels:
    """The series of one run."""

    def __init__(self, chosen: Sequence[tuple[Thing, Channel]]) -> None:
        """Log what is ``chosen``."""
        self._chosen = chosen
        self._rows: list[list[float]] = [[] for _ in chosen]

    def tick(self, state: Running) -> None:
        """Read all of them."""
        for row, (thing, channel) in zip(self._rows, self._chosen, strict=True):
            row.append(channel.read(state, thing) if channel.read else state.attribute(thing.name, channel.name))

    def columns(self) -> dict[str, FloatArray]:
        """Return the series by ``thing.channel``, each of shape (T,)."""
        return {
            f"{thing.name}.{channel.name}": np.asarray(row)
            for row, (thing, channel) in zip(self._rows, self._chosen, strict=True)
        }
