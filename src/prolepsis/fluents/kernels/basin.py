"""The hollows of a rigid shape as a liquid fills them: where it would stand, whichever way the shape is turned.

As in ``fields.cavity``, spill levels on a grid say how high a liquid can stand at each place. The grid is finer,
since a liquid seeps through small holes and its surface is judged to half a particle; and besides the *pool*, which
keeps a liquid at rest, there is the *hollow*: what is a pool in some position of the shape, its holes plugged. A
film on the wall of a cup that is being emptied is in no pool, yet it is not outside either.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np
from scipy.ndimage import binary_dilation  # pyright: ignore[reportMissingTypeStubs, reportUnknownVariableType]

from prolepsis.fields.cavity import BLOCKED, LEAST_DEPTH
from prolepsis.fields.faces import Solids
from prolepsis.fields.signed_distance import Field
from prolepsis.kernels import njit
from prolepsis.things import BoolArray, FloatArray, IntArray

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
        standing = self.pool(key, plugged=True)
        if not (standing > -np.inf).any():
            return 0.0
        height = heights(self.distance.shape, self.step, self.origin, direction_of(key))
        # Nodes near the wall are blocked, yet the liquid reaches the wall.
        grown = _dilated(standing > -np.inf, self.plugged > 0, 1 + round(self.plug / self.step))
        return float(np.count_nonzero(grown & (height <= standing.max()))) * self.step**3

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
    nodes = origin + step * np.moveaxis(np.indices(tuple(shape.tolist()), dtype=np.float64), 0, -1).reshape(-1, 3)
    distance = Field(solids=solids).distance(nodes).reshape(shape)
    closed = distance
    if plugged is not None and plugged is not solids:
        closed = Field(solids=plugged).distance(nodes).reshape(shape)
    free = closed >= BLOCKED * step
    hollow = np.zeros(tuple(shape.tolist()), dtype=np.bool_)
    for up in _AXES:
        hollow |= pools(closed, step, origin, up) > -np.inf
        if plug > 0:
            standing = pools(closed, step, origin, up, plug)
            grown = _dilated(standing > -np.inf, free, round(plug / step))
            hollow |= grown & (heights(distance.shape, step, origin, up) <= standing.max())
    near = hollow | _dilated(hollow, free, max(1, round(NEAR * spacing / step)))
    return Basin(origin=origin, step=step, distance=distance, plugged=closed, plug=plug, hollow=hollow, round=near)


def _dilated(nodes: BoolArray, free: BoolArray, steps: int) -> BoolArray:
    """Return nodes and all others that free ways of some steps lead to, also across corners."""
    whole = np.ones((3, 3, 3), dtype=np.bool_)
    found: Any = cast(Any, binary_dilation)(nodes, whole, iterations=max(steps, 1), mask=free)
    return np.asarray(found | nodes, dtype=np.bool_)


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
    across, base = step * up, float(origin @ up)
    level = _spill_levels(free, base, across)
    return _real_pools(level, free, base, across, LEAST_DEPTH * step, PASS * step + plug)


@njit(cache=True)
def _spill_levels(free: BoolArray, base: float, across: FloatArray) -> FloatArray:
    """Return, for each node, the least possible greatest height on a way to the edge of the grid.

    Node (i, j, k) is at the height ``base + (i, j, k) @ across``.
    """
    nx, ny, nz = free.shape
    sx, sy, sz = across[0], across[1], across[2]
    level = np.full((nx, ny, nz), np.inf)
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                edge = i == 0 or j == 0 or k == 0 or i == nx - 1 or j == ny - 1 or k == nz - 1
                if edge and free[i, j, k]:
                    level[i, j, k] = base + i * sx + j * sy + k * sz
    changed = True
    backward = False
    while changed:
        changed = False
        for a in range(1, nx - 1):
            i = nx - 1 - a if backward else a
            for b in range(1, ny - 1):
                j = ny - 1 - b if backward else b
                for c in range(1, nz - 1):
                    k = nz - 1 - c if backward else c
                    if not free[i, j, k]:
                        continue
                    least = min(level[i - 1, j, k], level[i + 1, j, k])
                    least = min(least, min(level[i, j - 1, k], level[i, j + 1, k]))
                    least = min(least, min(level[i, j, k - 1], level[i, j, k + 1]))
                    least = max(least, base + i * sx + j * sy + k * sz)
                    if least < level[i, j, k]:
                        level[i, j, k] = least
                        changed = True
        # A pass that changed nothing ends it; else the way back carries levels against the order.
        backward = not backward
    return level


@njit(cache=True)
def _real_pools(
    level: FloatArray, free: BoolArray, base: float, across: FloatArray, least_depth: float, clearance: float
) -> FloatArray:
    """Return the levels of the pools that are deep enough, less the height at which an edge is passed."""
    nx, ny, nz = level.shape
    pool = np.full((nx, ny, nz), -np.inf)
    seen = np.zeros((nx, ny, nz), dtype=np.bool_)
    stack = np.empty((nx * ny * nz, 3), dtype=np.int32)
    sx, sy, sz = across[0], across[1], across[2]
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                if seen[i, j, k] or not free[i, j, k] or level[i, j, k] <= base + i * sx + j * sy + k * sz:
                    continue
                stack[0, 0], stack[0, 1], stack[0, 2] = i, j, k
                seen[i, j, k] = True
                first, count, deepest = 0, 1, 0.0
                while first < count:
                    x, y, z = stack[first, 0], stack[first, 1], stack[first, 2]
                    first += 1
                    deepest = max(deepest, level[x, y, z] - (base + x * sx + y * sy + z * sz))
                    for axis in range(3):
                        for side in (-1, 1):
                            u, v, w = x, y, z
                            if axis == 0:
                                u += side
                            elif axis == 1:
                                v += side
                            else:
                                w += side
                            if u < 0 or v < 0 or w < 0 or u >= nx or v >= ny or w >= nz:
                                continue
                            if seen[u, v, w] or not free[u, v, w] or level[u, v, w] <= base + u * sx + v * sy + w * sz:
                                continue
                            seen[u, v, w] = True
                            stack[count, 0], stack[count, 1], stack[count, 2] = u, v, w
                            count += 1
                if deepest >= least_depth:
                    for s in range(count):
                        x, y, z = stack[s, 0], stack[s, 1], stack[s, 2]
                        pool[x, y, z] = level[x, y, z] - clearance
    return pool
