"""Reaching through: two things that touch where a third lies between them, which is too thin for soft contacts.

A contact gives way by some tenths of a millimetre, so what lies on a sheet may press on what is under it. Neither has
gone far into the other, yet the one is not on the other: the sheet is between them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from prolepsis.engine.stretches import Matter, Stretch
from prolepsis.geometry.rotations import rotate_back
from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.geometry.solids import Solid, solid_of
from prolepsis.log.log import Contacts
from prolepsis.log.things import Thing

LASTING = 0.1
"""It must last so long [s]; an impact is over sooner."""
EVERY = 10
"""Ticks from one look to the next."""
DEEPEST, STEPS = 0.012, 481
"""How far on either side of a contact the third is looked for [m]: what is thicker cannot be sunk through from both
sides, or is found by how deep that is. And in how many steps."""
BESIDE = 0.002
"""How far from where the two touch the third may begin [m]."""
ACROSS = 0.8
"""It lies between them if its nearest surface from its middle there is at least this share of half its thickness away
[1]: of what stands beside them, the nearest surface is at the side."""
ROUNDING = 1e-9
"""Far more than distances are rounded by [m]."""
EVERYWHERE = np.full(3, -np.inf), np.full(3, np.inf)
MOST = 100_000
"""Points that are placed among solids at once, times solids."""
TOGETHER = 64
"""Lines through a solid that are looked at together: of more, the distances of their points no longer fit a cache."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Reach:
    """Two things that touch through a third."""

    tick: int
    """When they began to."""
    first: int
    """Index of one that is in the third."""
    second: int
    """Index of the other."""
    between: int
    """Index of the third."""
    thickness: float
    """How thick the third is there [m]."""


def reaches(
    things: Sequence[Thing], poses: FloatArray, contacts: Contacts, stretches: Sequence[Stretch], dt: float
) -> Iterator[Reach]:
    """Yield what touches through something that lies between.

    What comes free of a broken whole counts as nothing that lies between: it would have broken.

    Args:
        things: The things of the run.
        poses: Of each thing at each tick, shape (T, n, 7).
        contacts: Who touched whom.
        stretches: What could touch something when.
        dt: Tick [s].
    """
    small = [thing.emerges for thing in things]
    needed = round(LASTING / dt)
    enough = min(needed, poses.shape[0]) - EVERY
    for stretch in stretches:
        if stretch.end - stretch.start < needed:
            continue
        lasting = {
            pair: (rows, ticks)
            for pair, rows in _by_pair(contacts, stretch, len(things))
            if len(rows) >= needed and len(ticks := _distinct(contacts.tick[rows])) >= needed
        }
        near: dict[int, set[int]] = {}
        for a, b in lasting:
            near.setdefault(a, set()).add(b)
            near.setdefault(b, set()).add(a)
        bodies: dict[int, _Body] = {}
        for (a, b), (rows, of_both) in lasting.items():
            for c in sorted(near[a] & near[b]):
                if small[c] or (small[a] and small[b]):
                    continue
                ticks = _common(of_both, lasting[min(a, c), max(a, c)][1])
                ticks = _common(ticks, lasting[min(b, c), max(b, c)][1])[::EVERY]
                if _lasts(ticks, enough) is None:
                    continue
                for thing in {a, b, c} - set(bodies):
                    bodies[thing] = _Body.of(things, stretch.matter, thing)
                some = rows[np.isin(contacts.tick[rows], ticks, kind="table")]
                found = _through(poses, contacts, some, (bodies[a], bodies[b], bodies[c]))
                begin = _lasts(np.array(sorted(found), dtype=np.int64), enough)
                if begin is not None:
                    first, second = (a, b) if found[begin][1] else (b, a)
                    thickness = max(thick for thick, _ in found.values())
                    yield Reach(tick=begin, first=first, second=second, between=c, thickness=thickness)


def _by_pair(contacts: Contacts, stretch: Stretch, count: int) -> Iterator[tuple[tuple[int, int], IntArray]]:
    """Yield each pair of ``count`` things that touch in a stretch, by number, and the rows in which they do."""
    first, last = np.searchsorted(contacts.tick, (stretch.start, stretch.end))
    key = contacts.a[first:last] * count + contacts.b[first:last]
    order = np.argsort(key, kind="stable")
    for rows in np.split(order, np.flatnonzero(np.diff(key[order])) + 1):
        if len(rows):
            yield divmod(int(key[rows[0]]), count), first + rows


def _distinct(ascending: IntArray) -> IntArray:
    return ascending[np.diff(ascending, prepend=-1) > 0]


def _common(first: IntArray, second: IntArray) -> IntArray:
    # Ticks are few numbers close together.
    return first[np.isin(first, second, kind="table")]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Body:
    """The S solids of the body that a thing is."""

    solids: Sequence[Solid]
    """Each in the frame of the thing that it is of."""
    owner: IntArray
    """Index of that thing, shape (S,)."""
    low: FloatArray
    """Least coordinates [m], shape (S, 3)."""
    high: FloatArray
    """Greatest coordinates [m], shape (S, 3)."""

    @classmethod
    def of(cls, things: Sequence[Thing], matter: Matter, carrier: int) -> _Body:
        """Return the body that a thing is."""
        own = np.flatnonzero(matter.thing == carrier)
        rows = np.flatnonzero(matter.body == matter.body[own[0]]) if len(own) else own
        solids = [solid_of(matter.solid(int(row), things)) for row in rows]
        bounds = np.array([EVERYWHERE if solid.type == "plane" else solid.bounds() for solid in solids])
        bounds = bounds.reshape(-1, 2, 3)
        return cls(solids=solids, owner=matter.thing[rows], low=bounds[:, 0], high=bounds[:, 1])

    def within(
        self, margin: float, poses: FloatArray, ticks: IntArray, points: FloatArray
    ) -> Iterator[tuple[int, IntArray]]:
        """Yield the numbers of the solids that are nearer than a margin to some of R points, and to which of them.

        Args:
            margin: [m]
            poses: Of each thing at each tick, shape (T, n, 7).
            ticks: Of the points, shape (R,).
            points: In the world [m], shape (R, 3).
        """
        seen = {owner: _seen_from(poses[ticks, owner], points) for owner in set(self.owner.tolist())}
        there = np.array([seen[owner] for owner in self.owner.tolist()]).reshape(len(self.owner), len(points), 3)
        # Most of a vessel's many solids are elsewhere.
        beside = np.maximum(self.low[:, None] - there, there - self.high[:, None])
        near = beside.max(axis=2) < margin + ROUNDING
        for k in np.flatnonzero(near.any(axis=1)).tolist():
            some = np.flatnonzero(near[k])
            some = some[self.solids[k].distance(there[k, some]) < margin]
            if len(some):
                yield k, some

    def distance(self, k: int, poses: FloatArray, ticks: IntArray, points: FloatArray) -> FloatArray:
        """Return the distances [m] of points, each at its tick, to one of the solids, shape (R, ...)."""
        seen = _seen_from(poses[ticks, self.owner[k]], points)
        return self.solids[k].distance(seen.reshape(-1, 3)).reshape(seen.shape[:-1])


def _through(
    poses: FloatArray, contacts: Contacts, rows: IntArray, three: tuple[_Body, _Body, _Body]
) -> dict[int, tuple[float, bool]]:
    """Return how thick the third is where the first two touch through it, and whether the first is in it, by tick."""
    third = three[2]
    hits: list[tuple[int, int, float, bool]] = []
    for part in np.array_split(rows, len(rows) * len(third.solids) // MOST + 1):
        # What the line is in near the contact is no further from it; no estimate from outside is above the distance.
        for k, near in third.within(BESIDE + ROUNDING, poses, contacts.tick[part], contacts.point[part]):
            some = part[near]
            tick, point, normal = contacts.tick[some], contacts.point[some], contacts.normal[some]
            ends = np.stack([point - DEEPEST * normal, point + DEEPEST * normal], axis=1)
            some = some[(third.distance(k, poses, tick, ends) >= 0.0).all(axis=1)]
            for begin in range(0, len(some), TOGETHER):
                hits += _thin(poses, contacts, some[begin : begin + TOGETHER], three, k)
    # Of several in a tick the last counts.
    return {int(contacts.tick[row]): (thickness, mine) for row, _, thickness, mine in sorted(hits)}


def _thin(
    poses: FloatArray, contacts: Contacts, rows: IntArray, three: tuple[_Body, _Body, _Body], k: int
) -> Iterator[tuple[int, int, float, bool]]:
    """Yield the rows in which one of the third's solids lies between, with its number and what is found of it."""
    first, second, third = three
    tick, point, normal = contacts.tick[rows], contacts.point[rows], contacts.normal[rows]
    steps = np.linspace(-DEEPEST, DEEPEST, STEPS)
    inside = third.distance(k, poses, tick, point[:, None] + steps[:, None] * normal[:, None]) < 0.0
    begin, end = inside.argmax(axis=1), STEPS - 1 - inside[:, ::-1].argmax(axis=1)
    low, high = steps[begin], steps[end]
    middle = point + (low + high)[:, None] / 2 * normal
    across = -third.distance(k, poses, tick, middle)
    chosen = inside.any(axis=1) & (begin > 0) & (end < STEPS - 1) & (low <= BESIDE) & (high >= -BESIDE)
    chosen &= across >= ACROSS * (high - low) / 2
    # The normal points from the first to the second: the third lies on the side of the one that is in it.
    mine = low + high <= 0.0
    for body, its in ((first, mine), (second, ~mine)):
        some, held = np.flatnonzero(chosen & its), np.zeros(len(rows), dtype=np.bool_)
        for _, within in body.within(0.0, poses, tick[some], middle[some]):
            held[some[within]] = True
        chosen &= held | ~its
    for row in np.flatnonzero(chosen).tolist():
        yield int(rows[row]), k, float(high[row] - low[row] + (steps[1] - steps[0])), bool(mine[row])


def _seen_from(poses: FloatArray, points: FloatArray) -> FloatArray:
    """Return points in frames of shape (R, 7); of each frame one, shape (R, 3), or several, shape (R, P, 3)."""
    frames = poses if points.ndim == 2 else poses[:, None]
    return rotate_back(frames[..., 3:], points - frames[..., :3])


def _lasts(ticks: IntArray, enough: int) -> int | None:
    """Return the first of some looks, ascending, from which on there is one again and again for enough ticks."""
    since = np.maximum.accumulate(np.where(np.diff(ticks, prepend=-3 * EVERY) > 2 * EVERY, ticks, 0))
    lasting = np.flatnonzero(ticks - since >= enough)
    return int(since[lasting[0]]) if len(lasting) else None
