"""Happenings: what kinds of matter report of a run beside series, each at a tick - that a bond has detached, say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from prolepsis.geometry.shape import FloatArray, IntArray


@dataclass(frozen=True, kw_only=True, slots=True)
class HappeningType:
    """What a kind may report."""

    name: str
    """``detachment``"""
    things: tuple[str, ...]
    """Names of its arguments, each of which is a thing."""
    numbers: tuple[str, ...] = ()
    """Names of what is measured, in SI units."""


DETACHMENT = HappeningType(name="detachment", things=("thing", "a", "b"), numbers=("force",))
"""A bond of something breakable gives way: of the whole, between two of its pieces, under a force [N]."""

FILM = HappeningType(name="film", things=("thing", "stuff"), numbers=("wet",))
"""The surface of a thing becomes wet with a stuff (1), or dry again (0), which names the thing twice."""

DROP = 5.0e-8
"""Least volume that makes a film when it touches a surface at once [m^3]: a drop of water, twenty to the millilitre."""
FILM_LEFT = 0.02
"""Share of the greatest area of a film [1] that is left when the surface counts as dry."""

FILM_AREA = HappeningType(name="film_area", things=("thing",), numbers=("area",))
"""The film on the surface of a thing has another area from now on [m^2]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Happening:
    """One of them, as it is reported."""

    type: str
    """Name of its type, ``detachment``."""
    things: Mapping[str, int]
    """Index of the thing that each argument is, by the argument's name."""
    numbers: Mapping[str, float] = field(default_factory=dict[str, float])
    """What was measured, by name, in SI units."""


def detachment(thing: int, a: int, b: int, force: float) -> Happening:
    """Return that a bond between two pieces, a and b, of a whole has detached under a force [N]."""
    return Happening(type=DETACHMENT.name, things={"thing": thing, "a": a, "b": b}, numbers={"force": force})


def film(thing: int, stuff: int, *, wet: bool) -> Happening:
    """Return that the surface of a thing has become wet with a stuff, or dry again."""
    return Happening(type=FILM.name, things={"thing": thing, "stuff": stuff}, numbers={"wet": float(wet)})


def film_area(thing: int, area: float) -> Happening:
    """Return that the film on the surface of a thing has another area [m^2]."""
    return Happening(type=FILM_AREA.name, things={"thing": thing}, numbers={"area": area})


@dataclass(frozen=True, kw_only=True, slots=True)
class Happenings:
    """All of one type, H rows in the order of time."""

    tick: IntArray
    """Tick within which each happened, shape (H,), ascending."""
    things: Mapping[str, IntArray]
    """Index of the thing that each argument is, each of shape (H,)."""
    numbers: Mapping[str, FloatArray] = field(default_factory=dict[str, FloatArray])
    """What was measured, each of shape (H,)."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Happenings({len(self.tick)} rows)"

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.tick)


def happening_columns(rows: Sequence[tuple[int, Happening]]) -> dict[str, Happenings]:
    """Return the happenings of a run, given with their ticks, as columns by type."""
    found: dict[str, Happenings] = {}
    for type in sorted({row.type for _, row in rows}):
        chosen = [(tick, row) for tick, row in rows if row.type == type]
        first = chosen[0][1]
        found[type] = Happenings(
            tick=np.array([tick for tick, _ in chosen], dtype=np.int64),
            things={name: np.array([row.things[name] for _, row in chosen], dtype=np.int64) for name in first.things},
            numbers={name: np.array([row.numbers[name] for _, row in chosen]) for name in first.numbers},
        )
    return found
