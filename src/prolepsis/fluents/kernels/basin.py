"""The hollows of a rigid shape as a liquid fills them: where it would stand, whichever way the shape is turned.

As in ``fields.cavity``, spill levels on a grid say how high a liquid can stand at each place. The grid is finer,
since a liquid seeps through small holes and its surface is judged to half a particle; and besides the *pool*, which
keeps a liquid at rest, there is the *hollow*: what is a pool in some position of the shape, its holes plugged. A
film on the wall of a cup that is being emptied is in no pool, yet it is not outside either.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from prolepsis.fluents.kernels.distances import node_distances
from prolepsis.fluents.kernels.pools import standing
from prolepsis.fluents.kernels.spreading import spread
from prolepsis.geometry.cavity import BLOCKED, LEAST_DEPTH
from prolepsis.geometry.faces import Solids
from prolepsis.geometry.shape import BoolArray, FloatArray, IntArray

NODE_COUNT = 80_000
"""Nodes of a grid: 2 mm apart for a cup of 10 cm."""
LEAST_STEP = 0.0008
"""Shortest step [m]: that of a thimble."""
ORIENTATIONS = 30
"""Gravity's direction in the shape's frame is rounded to this fraction of one: at most 1.4 degrees off. Heights are
taken along the same direction, so that near the lip, where it matters, nothing is lost."""
NEAR = 1.5
"""A particle within this many spacings of the hollow, round the rim, has not left it yet [1]."""
PASS = 1.25
"""Height above an edge at which the grid's way out passes it [grid steps]: the nodes next to the edge are blocked,
and the way bends round them. Within half a step for cups at all tilts."""
PLUG = 0.008
"""Holes of a mesh are not known as such: gaps narrower than twice this [m] count as holes."""
_MARGIN = 3.0
_AXES: FloatArray = np.concatenate((np.eye(3), -np.eye(3)))

POOL, HOLLOW, ROUND = 1, 2, 4
"""Bits that say where a particle is: in the pool, in the hollow, or near the hollow round its rim."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Basin:
    """The free space in and around one rigid shape."""

    origin: FloatArray
    """Position of the first node in the shape's frame [m], shape (3,)."""
    step: float
    """Distance between nodes [m]."""
    distance: FloatArray
    """Signed distance of each node to the shape [m], shape (nx, ny, nz)."""
    plugged: FloatArray
    """The same of the shape without its holes, as far as they are known."""
    plug: float
    """Clearance by which other holes are closed [m]; 0 if all are known."""
    hollow: BoolArray
    """Nodes in the hollow."""
    round: BoolArray
    """Nodes in the hollow or near it."""
    _pools: dict[tuple[int, int, int, bool], FloatArray] = field(
        default_factory=dict[tuple[int, int, int, bool], FloatArray]
    )

    def pool(self, key: tuple[int, int, int], *, plugged: bool = False) -> FloatArray:
        """Return how high a liquid would stand at each node [m] along a rounded direction up, or minus infinity.

        Args:
            key: The direction up in the shape's frame in parts of ``ORIENTATIONS``.
            plugged: Whether holes are closed.
        """
        known = (*key, plugged)
        if known not in self._pools:
            distance, plug = (self.plugged, self.plug) if plugged else (self.distance, 0.0)
            self._pools[known] = pools(distance, self.step, self.origin, direction_of(key), plug)
        return self._pools[known]

    def capacity(self, key: tuple[int, int, int]) -> float:
        """Return the volume of all pools along a rounded direction up, holes plugged [m^3]."""
        pool = self.pool(key, plugged=True)
        if not (pool > -np.inf).any():
            return 0.0
        height = heights(self.distance.shape, self.step, self.origin, direction_of(key))
        # Nodes near the wall are blocked, yet the liquid reaches the wall.
        grown = spread(pool > -np.inf, self.plugged > 0, 1 + round(self.plug / self.step))
        return float(np.count_nonzero(grown & (height <= pool.max()))) * self.step**3

    @property
    def holds(self) -> bool:
        """Whether the shape could hold anything in any position."""
        return bool(self.hollow.any())


def basin_of(solids: Solids, plugged: Solids | None, low: FloatArray, high: FloatArray, spacing: float) -> Basin:
    """Return the hollows of a rigid shape.

    Args:
        solids: The shape.
        plugged: The shape without holes, the same object if it has none; None if its holes are not known.
        low: Least coordinates of the shape [m], shape (3,).
        high: Greatest coordinates [m], shape (3,).
        spacing: Distance of neighbours in the liquid [m].
    """
    step = max(float(np.prod(np.maximum(high - low, 1e-4)) / NODE_COUNT) ** (1 / 3), LEAST_STEP)
    plug = PLUG if plugged is None else 0.0
    margin = max(_MARGIN * step, NEAR * spacing + 2 * step, plug + 2 * step)
    origin = low - margin
    shape = np.ceil((high + margin - origin) / step).astype(np.int64) + 1
    distance = node_distances(solids, origin, step, shape)
    closed = distance
    if plugged is not None and plugged is not solids:
        closed = node_distances(plugged, origin, step, shape)
    free = closed >= BLOCKED * step
    hollow = np.zeros(tuple(shape.tolist()), dtype=np.bool_)
    for up in _AXES:
        hollow |= pools(closed, step, origin, up) > -np.inf
        if plug > 0:
            plugged_pool = pools(closed, step, origin, up, plug)
            highest = float(plugged_pool.max())
            if highest > -np.inf:
                grown = spread(plugged_pool > -np.inf, free, max(1, round(plug / step)))
                hollow |= grown & (heights(distance.shape, step, origin, up) <= highest)
    near = spread(hollow, free, max(1, round(NEAR * spacing / step)))
    return Basin(origin=origin, step=step, distance=distance, plugged=closed, plug=plug, hollow=hollow, round=near)


def key_of(up: FloatArray) -> IntArray:
    """Return directions up, shape (..., 3), in parts of ``ORIENTATIONS``."""
    return np.rint(up * ORIENTATIONS).astype(np.int64)


def direction_of(key: tuple[int, int, int]) -> FloatArray:
    """Return the unit vector that a key stands for, shape (3,)."""
    vector = np.array(key, dtype=np.float64)
    return vector / np.linalg.norm(vector)


def heights(shape: tuple[int, ...], step: float, origin: FloatArray, up: FloatArray) -> FloatArray:
    """Return the height of each node [m]."""
    x, y, z = (step * up[axis] * np.arange(shape[axis]) for axis in range(3))
    return float(origin @ up) + x[:, None, None] + y[None, :, None] + z[None, None, :]


def pools(distance: FloatArray, step: float, origin: FloatArray, up: FloatArray, plug: float = 0.0) -> FloatArray:
    """Return how high a liquid would stand at each node along ``up`` [m], minus infinity where none would stay.

    In a closed hollow it is infinite.

    Args:
        distance: Signed distance of each node to the shape [m], shape (nx, ny, nz).
        step: Distance between nodes [m].
        origin: Position of the first node [m], shape (3,).
        up: Unit vector, shape (3,).
        plug: Clearance that a way out needs on all sides [m].
    """
    free = distance >= max(BLOCKED * step, plug)
    return standing(free, float(origin @ up), step * up, LEAST_DEPTH * step, PASS * step + plug)
