"""Crossing: what has gone into or through solid matter, found from the paths of all things once a run is over.

A contact pushes back by the nearest way out. Once the middle of a thing is beyond the middle of what it hit, that
is the far side; and what is fast enough is beyond it within one step, without any contact. So points well inside
every solid are followed from tick to tick, as straight lines in the frame of what they might cross.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from prolepsis.engine.stretches import Matter, Stretch
from prolepsis.geometry.rotations import matrices
from prolepsis.geometry.shape import BoolArray, FloatArray, Geom, IntArray
from prolepsis.geometry.solids import Solid, solid_of
from prolepsis.log.things import Thing, pressed_in

DEEPEST = 0.02
"""A solid may sink into another by so much for a moment [m], or by a quarter of its size if that is more: contacts
are soft, and what meets them at 6 m/s goes in by 10 mm, at 10 m/s by 16 mm, before it turns back."""
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
    thickness: float
    """How thick the thinner of the two solids is [m]."""


def crossings(things: Sequence[Thing], poses: FloatArray, stretches: Sequence[Stretch]) -> Iterator[Crossing]:
    """Yield the first crossing of each pair of things while the model stays the same.

    What comes free of a broken whole weighs grams and is thinner than a contact is soft: it is not followed through
    what is driven, as the pads that have just crushed it, nor through its like. What is soft has a law of its own for
    what breaks, under which it cannot be passed.

    Args:
        things: The things of the run.
        poses: Of each thing at each tick, shape (T, n, 7).
        stretches: What could touch something when.
    """
    small, yielding = np.array([thing.emerges for thing in things]), pressed_in(things)
    reach = np.array([_reach(thing.shape.geoms) for thing in things])
    # By number: to hash a mesh takes longer than to look at it.
    solids: dict[tuple[int, int], _Followed] = {}
    for stretch in stretches:
        matter = stretch.matter
        keys: list[tuple[int, int]] = list(zip(matter.thing.tolist(), matter.number.tolist(), strict=True))
        for thing, number in set(keys) - set(solids):
            solids[thing, number] = _Followed.of(things[thing].shape.geoms[number])
        followed = [solids[key] for key in keys]
        motion = _Motion.of(poses[stretch.start : stretch.end + 1], reach)
        for mover, obstacle in _pairs(matter, stretch.bodies.driven, small, reach):
            blocks = motion.near(mover, obstacle)
            if not len(blocks) or frozenset((mover, obstacle)) in yielding:
                continue
            own, other = np.flatnonzero(matter.thing == mover), np.flatnonzero(matter.thing == obstacle)
            solid_pairs = list(
                motion.close(
                    (mover, obstacle),
                    blocks,
                    [followed[row] for row in own.tolist()],
                    [followed[row] for row in other.tolist()],
                    matter.meet(own, other),
                )
            )
            if not solid_pairs:
                continue
            course = motion.course((mover, obstacle), np.unique(np.concatenate([row[2] for row in solid_pairs])))
            found = [
                (tick, 2.0 * min(one.half, wall.half))
                for one, wall, chosen in solid_pairs
                if (tick := course.first_within(one, wall, chosen)) is not None
            ]
            if found:
                tick, thickness = min(found)
                yield Crossing(tick=stretch.start + tick, mover=mover, obstacle=obstacle, thickness=thickness)


def _pairs(matter: Matter, driven: BoolArray, small: BoolArray, reach: FloatArray) -> Iterator[tuple[int, int]]:
    """Yield the pairs of a thing that moves and one that it might cross: one that is fixed, or at least as large."""
    rows = {int(thing): int(row) for thing, row in zip(*np.unique(matter.thing, return_index=True), strict=True)}
    for mover, own in rows.items():
        for obstacle, other in rows.items():
            apart = matter.tree[own] != matter.tree[other] and not small[obstacle]
            smaller = (reach[mover], mover) < (reach[obstacle], obstacle)
            apart = apart and (not driven[obstacle] if small[mover] else smaller)
            if mover != obstacle and not matter.fixed[own] and (matter.fixed[other] or apart):
                yield mover, obstacle


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Followed:
    """One solid in its thing's frame, and what is followed of it."""

    distance: Callable[[FloatArray], FloatArray]
    """Signed distance of points to its surface [m], (N, 3) to (N,)."""
    half: float
    """Its half-width [m], infinity for a plane."""
    middle: FloatArray
    """Middle of a ball round it [m], shape (3,)."""
    radius: float
    """Radius of that [m]."""
    points: FloatArray
    """What is followed, the middle first [m], shape (K, 3)."""
    inner: FloatArray
    """How deep within the solid each is [m], shape (K,)."""
    spread: float
    """Greatest distance of one from the middle [m]."""

    @classmethod
    def of(cls, geom: Geom) -> _Followed:
        """Return what is followed of a solid."""
        solid = solid_of(geom)
        # Once for all: to look up the planes of a mesh takes longer than to use them.
        distance = partial(_from_planes, solid.planes, solid) if geom.type == "mesh" else solid.distance
        inside = solid.corners.mean(axis=0)
        spread = solid.corners - inside
        if len(spread) > 8:
            signs = np.indices((2, 2, 2)).reshape(3, -1).T * 2.0 - 1.0
            spread = spread[np.unique(np.argmax(spread @ signs.T, axis=0))]
        points = np.concatenate([inside[None], inside + PROBED * spread]) @ solid.rotation.T + solid.position
        middle, radius = _ball(geom)
        return cls(
            distance=distance,
            half=np.inf if geom.type == "plane" else solid.half_width,
            middle=middle,
            radius=radius,
            points=points,
            inner=np.maximum(-distance(points), 0.0),
            spread=float(PROBED * np.linalg.norm(spread, axis=1).max()),
        )

    def most(self, wall: _Followed) -> FloatArray:
        """Return how deep in another solid each of the points may be [m], shape (K,)."""
        return np.minimum(CORE * wall.half, np.maximum(DEEPEST - self.inner, 0.0))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Motion:
    """How things move over a stretch of T ticks, of which B blocks are looked at."""

    poses: FloatArray
    """Shape (T, n, 7)."""
    starts: IntArray
    """First ticks of the blocks, shape (B,)."""
    turned: FloatArray
    """Rotation matrices at those, shape (B, n, 3, 3)."""
    travel: FloatArray
    """How far each frame gets within each block [m], shape (B, n)."""
    angles: FloatArray
    """How far it turns at most [rad], shape (B, n)."""
    reach: FloatArray
    """How far no solid of each thing is from its frame [m], infinity for a plane, shape (n,)."""

    @classmethod
    def of(cls, poses: FloatArray, reach: FloatArray) -> _Motion:
        """Return the motion of things that reach so far."""
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
            turned=matrices(poses[starts][:, :, 3:]),
            travel=np.add.reduceat(np.concatenate([shift, still]), starts),
            angles=np.pi * np.add.reduceat(np.concatenate([np.sqrt(chord), still]), starts),
            reach=reach,
        )

    def near(self, mover: int, obstacle: int) -> IntArray:
        """Return the blocks in which two things may meet."""
        offset = self.poses[self.starts, mover, :3] - self.poses[self.starts, obstacle, :3]
        slack = self.reach[mover] + self.travel[:, mover] + self.travel[:, obstacle]
        if np.isinf(self.reach[obstacle]):
            # A plane is level in the frame of its thing.
            return np.flatnonzero(np.einsum("bc,bc->b", offset, self.turned[:, obstacle, :, 2]) < slack)
        return np.flatnonzero(np.einsum("bc,bc->b", offset, offset) < (slack + self.reach[obstacle]) ** 2)

    def close(
        self,
        things: tuple[int, int],
        blocks: IntArray,
        solids: Sequence[_Followed],
        walls: Sequence[_Followed],
        meet: BoolArray,
    ) -> Iterator[tuple[_Followed, _Followed, IntArray]]:
        """Yield the solids of two things that come too close, and the blocks in which they may.

        Args:
            things: What moves, and what it might cross.
            blocks: The blocks to look at, shape (B,).
            solids: Of the first, S of them.
            walls: Of the second, W of them.
            meet: Which may touch which, shape (S, W).
        """
        mover, obstacle = things
        position, turned = _relative(
            self.poses[self.starts[blocks], mover, :3],
            self.turned[blocks, mover],
            self.poses[self.starts[blocks], obstacle, :3],
            self.turned[blocks, obstacle],
        )
        travel = (
            self.travel[blocks, mover] + self.travel[blocks, obstacle] + self.angles[blocks, mover] * self.reach[mover]
        )
        travel += self.angles[blocks, obstacle] * (np.linalg.norm(position, axis=1) + self.reach[mover] + travel)
        middles = position + np.einsum("bij,sj->sbi", turned, np.array([each.points[0] for each in solids]))
        spread = np.array([each.spread for each in solids])
        centres, radius = np.array([each.middle for each in walls]), np.array([each.radius for each in walls])
        for s, own in enumerate(solids):
            apart = middles[s] - centres[:, None]
            near = np.einsum("wbc,wbc->wb", apart, apart) < (radius[:, None] + spread[s] + travel) ** 2
            near &= meet[s, :, None]
            for w in np.flatnonzero(near.any(axis=1)).tolist():
                wall, some = walls[w], np.flatnonzero(near[w])
                most = own.most(wall)
                some = some[wall.distance(middles[s, some]) - own.spread - travel[some] < -most.min()]
                if len(some):
                    there = position[some][:, None] + own.points @ turned[some].transpose(0, 2, 1)
                    gaps = wall.distance(there.reshape(-1, 3)).reshape(len(some), -1)
                    some = some[(gaps - travel[some, None] < -most).any(axis=1)]
                if len(some):
                    yield own, wall, blocks[some]

    def course(self, things: tuple[int, int], blocks: IntArray) -> _Course:
        """Return how one thing moves in the frame of the other in some blocks."""
        ticks = np.minimum(self.starts[blocks][:, None] + np.arange(BLOCK + 1), len(self.poses) - 1)
        own, other = (self.poses[ticks.ravel(), thing] for thing in things)
        position, turned = _relative(own[:, :3], matrices(own[:, 3:]), other[:, :3], matrices(other[:, 3:]))
        return _Course(
            blocks=blocks,
            ticks=ticks,
            position=position.reshape(*ticks.shape, 1, 3),
            turned=turned.reshape(*ticks.shape, 3, 3),
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Course:
    """How one thing moves in the frame of another in B blocks, to the first tick after each."""

    blocks: IntArray
    """Their numbers, ascending, shape (B,)."""
    ticks: IntArray
    """Shape (B, BLOCK + 1); after the last tick that again."""
    position: FloatArray
    """Shape (B, BLOCK + 1, 1, 3)."""
    turned: FloatArray
    """Shape (B, BLOCK + 1, 3, 3)."""

    def first_within(self, own: _Followed, wall: _Followed, blocks: IntArray) -> int | None:
        """Return the first tick in some blocks at which one solid is too deep in the other, if there is one."""
        most = own.most(wall)
        some = np.searchsorted(self.blocks, blocks)
        paths = self.position[some] + own.points @ self.turned[some].swapaxes(2, 3)
        begin, end = paths[:, :-1].reshape(-1, *own.points.shape), paths[:, 1:].reshape(-1, *own.points.shape)
        gaps = wall.distance(begin.reshape(-1, 3)).reshape(begin.shape[:2])
        rows, columns = np.nonzero(gaps - np.linalg.norm(end - begin, axis=2) < -most)
        if not len(rows):
            return None
        deepest = _deepest(wall, begin[rows, columns], end[rows, columns])
        within = np.flatnonzero(deepest < -most[columns])
        return int(self.ticks[some, :-1].ravel()[rows[within[0]]]) if len(within) else None


def _relative(
    position: FloatArray, turned: FloatArray, origin: FloatArray, frame: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return positions, shape (N, 3), and rotations, shape (N, 3, 3), in frames that are given likewise."""
    back = frame.transpose(0, 2, 1)
    return (back @ (position - origin)[:, :, None])[:, :, 0], back @ turned


def _deepest(wall: _Followed, begin: FloatArray, end: FloatArray) -> FloatArray:
    """Return the least signed distance on each of some lines [m], shape (N,): of a convex solid it is convex."""
    low, high = np.zeros(len(begin)), np.ones(len(begin))
    displacement = end - begin
    for _ in range(THIRDS):
        left, right = low + (high - low) / 3, high - (high - low) / 3
        nearer = wall.distance(begin + left[:, None] * displacement) < wall.distance(
            begin + right[:, None] * displacement
        )
        high, low = np.where(nearer, right, high), np.where(nearer, low, left)
    return wall.distance(begin + ((low + high) / 2)[:, None] * displacement)


def _from_planes(planes: FloatArray, solid: Solid, points: FloatArray) -> FloatArray:
    local = (points - solid.position) @ solid.rotation
    return (local @ planes[:, :3].T - planes[:, 3]).max(axis=1)


def _reach(geoms: Sequence[Geom]) -> float:
    """Return how far solids reach from the origin of their frame [m]; infinity for a plane."""
    balls = [_ball(geom) for geom in geoms]
    return max((float(np.linalg.norm(middle)) + radius for middle, radius in balls), default=0.0)


def _ball(geom: Geom) -> tuple[FloatArray, float]:
    """Return middle [m], shape (3,), and radius [m] of a ball round a solid; that round a plane has no end."""
    if geom.type == "plane":
        return np.zeros(3), np.inf
    low, high = solid_of(geom).bounds()
    return (low + high) / 2, float(np.linalg.norm(high - low)) / 2
