"""Crossing: what has gone into or through solid matter, found from the paths of all things once a run is over.

A contact pushes back by the nearest way out. Once the middle of a thing is beyond the middle of what it hit, that
is the far side; and what is fast enough is beyond it within one step, without any contact. So points well inside
every solid are followed from tick to tick, as straight lines in the frame of what they might cross.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from prolepsis.fields.solids import Solid, solid_of
from prolepsis.monitors.matter import Matter, Stretch
from prolepsis.scene.world import HIDDEN_ROLES
from prolepsis.things import BoolArray, FloatArray, Geom, IntArray, Thing

DEEPEST = 0.01
"""A solid may sink into another by so much for a moment [m], or by a quarter of its size if that is more: contacts
are soft, and what meets them at 5 m/s goes in by 9 mm before it turns back."""
CORE = 0.9
"""Nothing may reach this share of the way to the middle of a solid [1]: there the nearest way out turns round."""
PROBED = 0.5
"""The points that are followed lie half way from the middle of a solid to its corners [1], and at its middle."""
BLOCK = 16
"""Ticks that are looked at together before any of them is looked at alone."""
THIRDS = 24
"""Steps in which the deepest point of a line is sought; each leaves two thirds of the line."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Crossing:
    """One thing that went too deep into another."""

    tick: int
    """When."""
    mover: int
    """Index of the thing that did."""
    obstacle: int
    """Index of the thing it went into."""


def crossings(things: Sequence[Thing], poses: FloatArray, stretches: Sequence[Stretch]) -> Iterator[Crossing]:
    """Yield the first crossing of each pair of things while the model stays the same.

    What comes free of a broken whole weighs grams and is thinner than a contact is soft: it is followed through what is
    fixed only.

    Args:
        things: The things of the run.
        poses: Of each thing at each tick, shape (T, n, 7).
        stretches: What could touch something when.
    """
    small = np.array([bool(thing.roles & HIDDEN_ROLES) for thing in things])
    for stretch in stretches:
        motion = _Motion.of(poses[stretch.start : stretch.end + 1], [thing.shape.geoms for thing in things])
        for mover, obstacle in _pairs(stretch.matter, small, motion.reach):
            blocks = motion.near(mover, obstacle)
            if not len(blocks):
                continue
            matter = stretch.matter
            own, other = np.flatnonzero(matter.thing == mover), np.flatnonzero(matter.thing == obstacle)
            ticks = [
                tick
                for a, b, chosen in motion.close(mover, obstacle, blocks, matter.meet(own, other), matter, things)
                if (tick := motion.first_within((mover, obstacle), (a, b), chosen)) is not None
            ]
            if ticks:
                yield Crossing(tick=stretch.start + min(ticks), mover=mover, obstacle=obstacle)


def _pairs(matter: Matter, small: BoolArray, reach: FloatArray) -> Iterator[tuple[int, int]]:
    """Yield the pairs of a thing that moves and one that it might cross: one that is fixed, or at least as large."""
    rows = {int(thing): int(row) for thing, row in zip(*np.unique(matter.thing, return_index=True), strict=True)}
    for mover, own in rows.items():
        for obstacle, other in rows.items():
            apart = matter.tree[own] != matter.tree[other] and not (small[mover] or small[obstacle])
            apart = apart and (reach[mover], mover) < (reach[obstacle], obstacle)
            if mover != obstacle and not matter.fixed[own] and (matter.fixed[other] or apart):
                yield mover, obstacle


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Motion:
    """How things move over a stretch of T ticks, of which B blocks are looked at."""

    poses: FloatArray
    """Shape (T, n, 7)."""
    starts: IntArray
    """First ticks of the blocks, shape (B,)."""
    turned: FloatArray
    """Rotation matrices at those, shape (B, n, 3, 3)."""
    ways: FloatArray
    """How far each frame gets within each block [m], shape (B, n)."""
    turns: FloatArray
    """How far it turns at most [rad], shape (B, n)."""
    reach: FloatArray
    """How far no solid of each thing is from its frame [m], infinity for a plane, shape (n,)."""

    @classmethod
    def of(cls, poses: FloatArray, shapes: Sequence[tuple[Geom, ...]]) -> _Motion:
        """Return the motion of things with the given solids."""
        starts = np.arange(0, len(poses), BLOCK)
        step = np.diff(poses, axis=0)
        shift = np.sqrt(np.einsum("tnc,tnc->tn", step[:, :, :3], step[:, :, :3]))
        # The angle is at most pi / 2 of twice the chord, whichever of its two signs the quaternion has.
        other = poses[1:, :, 3:] + poses[:-1, :, 3:]
        chord = np.minimum(
            np.einsum("tnc,tnc->tn", step[:, :, 3:], step[:, :, 3:]), np.einsum("tnc,tnc->tn", other, other)
        )
        still = np.zeros((1, poses.shape[1]))
        return cls(
            poses=poses,
            starts=starts,
            turned=_matrices(poses[starts][:, :, 3:]),
            ways=np.add.reduceat(np.concatenate([shift, still]), starts),
            turns=np.pi * np.add.reduceat(np.concatenate([np.sqrt(chord), still]), starts),
            reach=np.array([_reach(geoms) for geoms in shapes]),
        )

    def near(self, mover: int, obstacle: int) -> IntArray:
        """Return the blocks in which two things may meet."""
        way = self.poses[self.starts, mover, :3] - self.poses[self.starts, obstacle, :3]
        slack = self.reach[mover] + self.reach[obstacle] + self.ways[:, mover] + self.ways[:, obstacle]
        return np.flatnonzero(np.einsum("bc,bc->b", way, way) < slack**2)

    def close(
        self,
        mover: int,
        obstacle: int,
        blocks: IntArray,
        pairs: Sequence[tuple[int, int]],
        matter: Matter,
        things: Sequence[Thing],
    ) -> Iterator[tuple[Geom, Geom, IntArray]]:
        """Yield the solids of two things that come too close, and the blocks in which they may."""
        place, turned = _relative(
            self.poses[self.starts[blocks], mover, :3],
            self.turned[blocks, mover],
            self.poses[self.starts[blocks], obstacle, :3],
            self.turned[blocks, obstacle],
        )
        ways = self.ways[blocks, mover] + self.ways[blocks, obstacle] + self.turns[blocks, mover] * self.reach[mover]
        ways += self.turns[blocks, obstacle] * (np.linalg.norm(place, axis=1) + self.reach[mover] + ways)
        solids = {row: matter.solid(row, things) for row in {row for pair in pairs for row in pair}}
        middles = {a: place + turned @ _points(solids[a])[0][0] for a in {a for a, _ in pairs}}
        balls = {b: _ball(solids[b]) for b in {b for _, b in pairs}}
        for a, b in pairs:
            points, _, spread = _points(solids[a])
            middle, radius = balls[b]
            apart = middles[a] - middle
            some = np.flatnonzero(np.einsum("bc,bc->b", apart, apart) < (radius + spread + ways) ** 2)
            if not len(some):
                continue
            wall, most = solid_of(solids[b]), _most(solids[a], solids[b])
            some = some[wall.distance(middles[a][some]) - spread - ways[some] < -most.min()]
            if len(some):
                there = place[some][:, None] + points @ turned[some].transpose(0, 2, 1)
                gaps = wall.distance(there.reshape(-1, 3)).reshape(len(some), -1)
                some = some[(gaps - ways[some, None] < -most).any(axis=1)]
            if len(some):
                yield solids[a], solids[b], blocks[some]

    def first_within(self, things: tuple[int, int], solids: tuple[Geom, Geom], blocks: IntArray) -> int | None:
        """Return the first tick in some blocks at which one solid is too deep in the other, if there is one."""
        points, wall, most = _points(solids[0])[0], solid_of(solids[1]), _most(*solids)
        ticks = (self.starts[blocks][:, None] + np.arange(BLOCK)).ravel()
        ticks = ticks[ticks < len(self.poses)]
        begin = self._paths(things, points, ticks)
        end = self._paths(things, points, np.minimum(ticks + 1, len(self.poses) - 1))
        gaps = wall.distance(begin.reshape(-1, 3)).reshape(begin.shape[:2])
        rows, columns = np.nonzero(gaps - np.linalg.norm(end - begin, axis=2) < -most)
        if not len(rows):
            return None
        deepest = _deepest(wall, begin[rows, columns], end[rows, columns])
        within = np.flatnonzero(deepest < -most[columns])
        return int(ticks[rows[within[0]]]) if len(within) else None

    def _paths(self, things: tuple[int, int], points: FloatArray, ticks: IntArray) -> FloatArray:
        """Return where points of the first thing are in the frame of the second, shape (ticks, points, 3)."""
        own, other = (self.poses[ticks, thing] for thing in things)
        place, turned = _relative(own[:, :3], _matrices(own[:, 3:]), other[:, :3], _matrices(other[:, 3:]))
        return place[:, None] + points @ turned.transpose(0, 2, 1)


def _relative(
    place: FloatArray, turned: FloatArray, origin: FloatArray, frame: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return places, shape (N, 3), and rotations, shape (N, 3, 3), in frames that are given likewise."""
    back = frame.transpose(0, 2, 1)
    return (back @ (place - origin)[:, :, None])[:, :, 0], back @ turned


def _most(geom: Geom, wall: Geom) -> FloatArray:
    """Return how deep in another solid each of the points of one may be [m], shape (K,)."""
    half = np.inf if wall.type == "plane" else solid_of(wall).half_width
    return np.minimum(CORE * half, np.maximum(DEEPEST - _points(geom)[1], 0.0))


def _deepest(wall: Solid, begin: FloatArray, end: FloatArray) -> FloatArray:
    """Return the least signed distance on each of some lines [m], shape (N,): of a convex solid it is convex."""
    low, high = np.zeros(len(begin)), np.ones(len(begin))
    way = end - begin
    for _ in range(THIRDS):
        left, right = low + (high - low) / 3, high - (high - low) / 3
        nearer = wall.distance(begin + left[:, None] * way) < wall.distance(begin + right[:, None] * way)
        high, low = np.where(nearer, right, high), np.where(nearer, low, left)
    return wall.distance(begin + ((low + high) / 2)[:, None] * way)


@lru_cache(maxsize=4096)
def _points(geom: Geom) -> tuple[FloatArray, FloatArray, float]:
    """Return what is followed of a solid, in its thing's frame.

    Returns:
        Points, the middle first [m], shape (K, 3); how deep in the solid each is [m], shape (K,); the greatest distance
        of one from the middle [m].
    """
    solid = solid_of(geom)
    middle = solid.corners.mean(axis=0)
    spread = solid.corners - middle
    if len(spread) > 8:
        signs = np.indices((2, 2, 2)).reshape(3, -1).T * 2.0 - 1.0
        spread = spread[np.unique(np.argmax(spread @ signs.T, axis=0))]
    local = np.concatenate([middle[None], middle + PROBED * spread])
    points = local @ solid.rotation.T + solid.position
    return points, np.maximum(-solid.distance(points), 0.0), float(PROBED * np.linalg.norm(spread, axis=1).max())


@lru_cache(maxsize=4096)
def _ball(geom: Geom) -> tuple[FloatArray, float]:
    """Return middle [m], shape (3,), and radius [m] of a ball round a solid; that round a plane has no end."""
    if geom.type == "plane":
        return np.zeros(3), np.inf
    low, high = solid_of(geom).bounds()
    return (low + high) / 2, float(np.linalg.norm(high - low)) / 2


@lru_cache(maxsize=4096)
def _reach(geoms: tuple[Geom, ...]) -> float:
    """Return how far solids reach from the origin of their frame [m]; infinity for a plane."""
    balls = [_ball(geom) for geom in geoms]
    return max((float(np.linalg.norm(middle)) + radius for middle, radius in balls), default=0.0)


def _matrices(quaternions: FloatArray) -> FloatArray:
    """Return rotation matrices, shape (..., 3, 3), of unit quaternions, shape (..., 4)."""
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    rows = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
