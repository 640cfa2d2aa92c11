"""The base of what stands: where it touches what bears it, all that lies between included, and how near its edge is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from prolepsis.geometry.rotations import rotate, rotate_back
from prolepsis.geometry.shape import BoolArray, FloatArray
from prolepsis.geometry.solids import Solid

GAP = 0.0005
"""Gap between two faces that lie on each other [m]: contacts sink in by less."""
DEPTHS = (0.1, 0.4, 1.0)
"""So deep within both, as shares of ``GAP``, what touches is looked for: thin things are thinner than that."""
GRID = 64
"""Points along the longer side of what stands, in which its base is looked for."""
DIRECTIONS = 24
"""Directions, evenly about, in which the edge of the base is looked for from the outermost of them."""
EXACT = 1.0e-6
"""So near it is found [m]."""
STEEP = 1.0e-9
"""Least cosine of a way and a normal [1] for which it leads to that side."""
LEAST_BASE = 0.05
"""Least width of a base, as a share of the greatest radius of what stands on it [1]: less is an edge or a point."""

Body = tuple[FloatArray, tuple[Solid, ...]]
"""The pose of a thing, shape (7,), and its solids."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Bearer:
    """One thing that bears what stands."""

    body: Body
    """The thing."""
    point: FloatArray
    """Where it presses, in the frame of what stands [m], shape (3,)."""


def overhang(point: FloatArray, normal: FloatArray, stands: Body, bearers: Sequence[Bearer]) -> float:
    """Return how far a point is from the middle of a base to its edge, where it is nearest to that [1].

    Args:
        point: Where all that bears a thing presses, in its frame [m], shape (3,).
        normal: Unit normal of its base, in its frame, shape (3,).
        stands: The thing.
        bearers: All that bears it, or would if it leant that way. Its base is the hull of where it touches these.
    """
    axes: FloatArray = np.linalg.svd(normal[None])[2][1:]
    several = [_touched(point, normal, axes, stands, bearer) for bearer in bearers]
    outward, ahead = _sides(np.concatenate(several))
    if len(outward) < 3:
        return 0.0
    directions = np.concatenate((_around(DIRECTIONS), outward))
    towards = directions @ outward.T
    # From a point within, each way leads out over the nearest side that is ahead; back, over one that is behind.
    front = np.where(towards > STEEP, ahead / np.maximum(towards, STEEP), np.inf).min(axis=1)
    back = np.where(towards < -STEEP, ahead / np.maximum(-towards, STEEP), np.inf).min(axis=1)
    width = front + back
    if float(width.min()) < LEAST_BASE * radius_of(stands[1]):
        return 0.0  # An edge or a point.
    return float((1 - 2 * front / width).max())


def _around(count: int) -> FloatArray:
    angles = np.arange(count) * (2 * np.pi / count)
    return np.stack((np.cos(angles), np.sin(angles)), axis=1)


def _sides(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the sides of the hull of points, shape (n, 2): outward normals, (m, 2), and distances from 0, (m,)."""
    ordered = [tuple(each) for each in np.unique(points, axis=0).tolist()]
    chains: list[list[tuple[float, ...]]] = []
    for several in (ordered, ordered[::-1]):
        chain: list[tuple[float, ...]] = []
        for x, y in several:
            while len(chain) > 1:
                (ax, ay), (bx, by) = chain[-2:]
                if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0:
                    break
                chain.pop()
            chain.append((x, y))
        chains.append(chain[:-1])
    corners = np.array(chains[0] + chains[1]).reshape(-1, 2)
    along = np.roll(corners, -1, axis=0) - corners
    length = np.linalg.norm(along, axis=1)
    kept = length > EXACT
    outward = np.stack((along[:, 1], -along[:, 0]), axis=1)[kept] / length[kept, None]
    # What presses beyond the edge, by rounding, presses at it.
    return outward, np.maximum(np.einsum("mc,mc->m", corners[kept], outward), 0.0)


def radius_of(solids: Sequence[Solid]) -> float:
    """Return the greatest distance of solids from the origin of their frame [m]."""
    return max(float(np.abs(np.concatenate(solid.bounds())).max()) for solid in solids)


def _touched(point: FloatArray, normal: FloatArray, axes: FloatArray, stands: Body, bearer: Bearer) -> FloatArray:
    """Return the edge of where a thing touches one that bears it, in the plane of its base from a point on, (n, 2)."""

    level = float(normal @ bearer.point)
    own, low, high = _between(stands, stands, (level, level + GAP), normal, axes)
    theirs, lowest, highest = _between(bearer.body, stands, (level - GAP, level), normal, axes)
    if not own or not theirs:
        return np.zeros((0, 2))
    low, high = np.maximum(low, lowest) - axes @ point, np.minimum(high, highest) - axes @ point
    if (high <= low).any():
        return np.zeros((0, 2))

    def touching(flat: FloatArray) -> BoolArray:
        points = point + flat @ axes + (level - normal @ point) * normal
        return _touching(points, normal, (stands[0], own), (bearer.body[0], theirs))

    step = float((high - low).max()) / GRID
    sides = [np.arange(low[k] + step / 2, high[k], step) for k in range(2)]
    grid = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 2)
    grid = np.concatenate((grid, (axes @ (bearer.point - point))[None]))
    known = grid[touching(grid)]
    if not len(known):
        return known
    directions = _around(DIRECTIONS)
    known = known[np.unique(np.argmax(known @ directions.T, axis=0))]
    offsets = step * directions
    inside, beyond = np.zeros((len(known), DIRECTIONS)), np.ones((len(known), DIRECTIONS))
    # Where the next point touches, too, the edge lies further on.
    beyond[touching((known[:, None] + offsets).reshape(-1, 2)).reshape(beyond.shape)] = 0.0
    while step * float((beyond - inside).max()) > EXACT:
        middle = (inside + beyond) / 2
        there = touching((known[:, None] + middle[..., None] * offsets).reshape(-1, 2)).reshape(middle.shape)
        inside, beyond = np.where(there, middle, inside), np.where(there, beyond, middle)
    return (known[:, None] + inside[..., None] * offsets).reshape(-1, 2)


def _between(
    body: Body, frame: Body, levels: tuple[float, float], normal: FloatArray, axes: FloatArray
) -> tuple[tuple[Solid, ...], FloatArray, FloatArray]:
    """Return the solids of a body that come between two levels along a normal, and how far they reach along two axes.

    Args:
        body: The body.
        frame: In whose frame all else is given.
        levels: The lower and the upper one [m].
        normal: Shape (3,).
        axes: Shape (2, 3).
    """
    kept: list[Solid] = []
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    for solid in body[1]:
        if solid.type == "plane":
            low, high = np.full(2, -np.inf), np.full(2, np.inf)
        else:
            corners = np.stack(np.meshgrid(*np.stack(solid.bounds(), axis=1), indexing="ij"), axis=-1).reshape(-1, 3)
            world = rotate(body[0][3:], corners) + body[0][:3]
            corners = rotate_back(frame[0][3:], world - frame[0][:3])
            heights, across = corners @ normal, corners @ axes.T
            if heights.min() > levels[1] or heights.max() < levels[0]:
                continue
            low, high = np.minimum(low, across.min(axis=0)), np.maximum(high, across.max(axis=0))
        kept.append(solid)
    return tuple(kept), low, high


def _touching(points: FloatArray, normal: FloatArray, stands: Body, bears: Body) -> BoolArray:
    """Return at which points, in the frame of what stands, both bodies are, one above and one below, shape (n,)."""
    mine, theirs = np.zeros((2, len(points)), dtype=np.bool_)
    for share in DEPTHS:
        above, below = points + share * GAP * normal, points - share * GAP * normal
        world = rotate(stands[0][3:], below) + stands[0][:3]
        local = rotate_back(bears[0][3:], world - bears[0][:3])
        mine |= np.min([solid.distance(above) for solid in stands[1]], axis=0) <= 0.0
        theirs |= np.min([solid.distance(local) for solid in bears[1]], axis=0) <= 0.0
    return mine & theirs
