"""Sinking in: what stays pressed into another thing deeper than a contact may give way."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from prolepsis.engine.stretches import Matter
from prolepsis.geometry.shape import FloatArray, Geom, IntArray
from prolepsis.geometry.solids import solid_of
from prolepsis.log.things import Thing, pressed_in

SHARE = 0.1
"""A thing may stay pressed in by this share of its size [1]: what goes deeper is not on something but in it."""
LEAST_LIMIT, MOST_LIMIT = 0.002, 0.01
"""But by 2 mm however thin it is, and by 10 mm at most [m]: contacts reach their full stiffness within the first
millimetre, and sheets are thinner than that."""
SOFT, SOFT_SHARE = 1.0e6, 0.5
"""What is softer than rubber, by Young's modulus [Pa], may be pressed in by half of its size [1]: foam is."""
LASTING = 0.1
"""It must stay so for this time [s]; an impact is over sooner."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Overlaps:
    """Contacts in which two solids overlap by more than ``LEAST_LIMIT``, R of them."""

    tick: IntArray
    """Ticks, ascending, shape (R,)."""
    version: IntArray
    """Number of the model, shape (R,)."""
    geoms: IntArray
    """MuJoCo geoms, shape (R, 2)."""
    depth: FloatArray
    """[m], shape (R,)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Sinking:
    """Two things that stayed in each other."""

    tick: int
    """When they began to."""
    first: int
    """Index of the one that is in the other: one that can move."""
    second: int
    """Index of the other."""
    depth: float
    """The greatest depth meanwhile [m]."""


def sinkings(things: Sequence[Thing], overlaps: Overlaps, matters: Sequence[Matter], dt: float) -> Iterator[Sinking]:
    """Yield what stayed too deep in something else.

    What comes free of a broken whole is left out: shards are curved, and in contact are as thick as they are high. So
    is what presses on something soft and breaks.

    Args:
        things: The things of the run.
        overlaps: What overlapped when.
        matters: What could touch something in each model.
        dt: Tick [s].
    """
    needed, yielding = round(LASTING / dt), pressed_in(things)
    keys = np.column_stack([overlaps.version, np.sort(overlaps.geoms, axis=1)])
    pairs, pair_of = np.unique(keys, axis=0, return_inverse=True)
    for number, key in enumerate(pairs):
        matter: Matter = matters[int(key[0])]
        rows = sorted((matter.row(int(key[1])), matter.row(int(key[2]))), key=lambda row: bool(matter.fixed[row]))
        pair = frozenset(int(matter.thing[row]) for row in rows)
        if pair in yielding or any(things[i].emerges for i in pair):
            continue
        limit = _limit([(things[int(matter.thing[row])], matter.solid(row, things)) for row in rows])
        chosen = np.flatnonzero((pair_of.ravel() == number) & (overlaps.depth > limit))
        if len(chosen) < needed:
            continue
        ticks, first = np.unique(overlaps.tick[chosen], return_index=True)
        depth = np.maximum.reduceat(overlaps.depth[chosen], first)
        # Consecutive ticks have the same difference from their place in the row.
        begins = np.flatnonzero(np.diff(ticks - np.arange(len(ticks)), prepend=-1))
        for begin, end in zip(begins.tolist(), [*begins[1:].tolist(), len(ticks)], strict=True):
            if end - begin >= needed:
                yield Sinking(
                    tick=int(ticks[begin]),
                    first=int(matter.thing[rows[0]]),
                    second=int(matter.thing[rows[1]]),
                    depth=float(depth[begin:end].max()),
                )


def _limit(pair: Sequence[tuple[Thing, Geom]]) -> float:
    """Return how deep two solids may stay in each other [m]: what is soft gives way, whatever presses it."""
    sizes = [np.inf if geom.type == "plane" else 2.0 * solid_of(geom).half_width for _, geom in pair]
    soft = [thing.quantities.get("youngsModulus", np.inf) < SOFT for thing, _ in pair]
    if any(soft):
        return max(SOFT_SHARE * size for size, gives_way in zip(sizes, soft, strict=True) if gives_way)
    return min(min(max(SHARE * size, LEAST_LIMIT), MOST_LIMIT) for size in sizes)
