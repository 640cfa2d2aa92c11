"""Matter: which solids of a model can touch which, and from when to when it is that model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from prolepsis.engine.bodies import Bodies
from prolepsis.geometry.shape import BoolArray, Geom, IntArray
from prolepsis.log.things import Thing


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Matter:
    """What can touch something while the model stays the same, G solids of things."""

    thing: IntArray
    """Index of the thing of each, shape (G,)."""
    number: IntArray
    """Which of the thing's solids it is, shape (G,)."""
    fixed: BoolArray
    """Whether it never moves, shape (G,)."""
    tree: IntArray
    """Top of the tree of bodies that it is in, shape (G,)."""
    body: IntArray
    """Its MuJoCo body, shape (G,)."""
    meets: IntArray
    """MuJoCo's contype and conaffinity, shape (G, 2)."""
    geom: IntArray
    """Its MuJoCo geom, shape (G,), ascending."""
    strangers: frozenset[int]
    """Pairs of bodies that are kept from touching, as MuJoCo signs them."""

    @classmethod
    def of(cls, model: Any, things: Sequence[Thing]) -> Matter:
        """Return the solids of a model whose geoms are called after thing and number."""
        index = {thing.name: i for i, thing in enumerate(things)}
        rows: list[tuple[int, int, int]] = []
        for geom in np.flatnonzero(model.geom_contype | model.geom_conaffinity).tolist():
            name, _, number = model.geom(geom).name.rpartition("/")
            if name in index:
                rows.append((index[name], int(number), geom))
        table = np.array(rows, dtype=np.int64).reshape(-1, 3)
        geoms = table[:, 2]
        body = model.geom_bodyid[geoms].astype(np.int64)
        return cls(
            thing=table[:, 0],
            number=table[:, 1],
            fixed=model.body_weldid[body] == 0,
            tree=model.body_rootid[body].astype(np.int64),
            body=body,
            meets=np.stack([model.geom_contype[geoms], model.geom_conaffinity[geoms]], axis=1).astype(np.int64),
            geom=geoms,
            strangers=frozenset(model.exclude_signature.tolist()),
        )

    def meet(self, first: IntArray, second: IntArray) -> BoolArray:
        """Return which solids of one thing, on one body, may touch which of another, shape (first, second)."""
        low, high = sorted((int(self.body[first[0]]), int(self.body[second[0]])))
        if (low << 16) + high in self.strangers:
            return np.zeros((len(first), len(second)), dtype=np.bool_)
        one, other = self.meets[first][:, None], self.meets[second]
        return (one[..., 0] & other[..., 1] | other[..., 0] & one[..., 1]) > 0

    def row(self, geom: int) -> int:
        """Return which solid a MuJoCo geom is."""
        return int(np.flatnonzero(self.geom == geom)[0])

    def solid(self, row: int, things: Sequence[Thing]) -> Geom:
        """Return one of the solids."""
        return things[int(self.thing[row])].shape.geoms[int(self.number[row])]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Stretch:
    """Ticks over which the model stays the same."""

    start: int
    """First tick."""
    end: int
    """First tick no longer."""
    matter: Matter
    """What can touch something meanwhile."""
    bodies: Bodies
    """What moves freely meanwhile, and what is driven."""
