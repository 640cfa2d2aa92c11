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
BACK = np.array([1.0, -1.0, -1.0, -1.0])


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
    for stretch in stretches:
        rows: IntArray = np.arange(*np.searchsorted(contacts.tick, (stretch.start, stretch.end)), dtype=np.int64)
        pairs = {pair: np.unique(contacts.tick[of_pair]) for pair, of_pair in _by_pair(contacts, rows)}
        lasting = {pair: ticks for pair, ticks in pairs.items() if len(ticks) >= needed}
        near: dict[int, set[int]] = {}
        for a, b in lasting:
            near.setdefault(a, set()).add(b)
            near.setdefault(b, set()).add(a)
        for (a, b), of_both in lasting.items():
            for c in sorted(near[a] & near[b]):
                if small[c] or (small[a] and small[b]):
                    continue
                ticks = np.intersect1d(of_both, lasting[min(a, c), max(a, c)], assume_unique=True)
                ticks = np.intersect1d(ticks, lasting[min(b, c), max(b, c)], assume_unique=True)
                found = _through(things, poses, contacts, stretch.matter, (a, b, c), ticks[::EVERY])
                begin = _lasts(found, needed, poses.shape[0])
                if begin is not None:
                    first, second = (a, b) if found[begin][1] else (b, a)
                    thickness = max(thick for thick, _ in found.values())
                    yield Reach(tick=begin, first=first, second=second, between=c, thickness=thickness)


def _by_pair(contacts: Contacts, rows: IntArray) -> Iterator[tuple[tuple[int, int], IntArray]]:
    keys = np.stack([contacts.a[rows], contacts.b[rows]], axis=1)
    pairs, which = np.unique(keys, axis=0, return_inverse=True)
    for number, (a, b) in enumerate(pairs.tolist()):
        yield (a, b), rows[which.ravel() == number]


def _through(
    things: Sequence[Thing],
    poses: FloatArray,
    contacts: Contacts,
    matter: Matter,
    three: tuple[int, int, int],
    ticks: IntArray,
) -> dict[int, tuple[float, bool]]:
    """Return how thick the third is where the first two touch through it, and whether the first is in it, by tick."""
    a, b, _ = three
    solids = [_solids(things, matter, thing) for thing in three]
    bounds = np.array([solid.bounds() for _, solid in solids[2]]).reshape(-1, 2, 3)
    low, high, owner = bounds[:, 0] - DEEPEST, bounds[:, 1] + DEEPEST, [thing for thing, _ in solids[2]]
    steps = np.linspace(-DEEPEST, DEEPEST, STEPS)
    found: dict[int, tuple[float, bool]] = {}
    for tick in ticks.tolist():
        rows: IntArray = np.arange(*np.searchsorted(contacts.tick, (tick, tick + 1)), dtype=np.int64)
        for row in rows[(contacts.a[rows] == a) & (contacts.b[rows] == b)].tolist():
            line = contacts.point[row] + steps[:, None] * contacts.normal[row]
            here = rotate_back(poses[tick, owner, 3:], contacts.point[row] - poses[tick, owner, :3])
            # Most of a vessel's many solids are elsewhere.
            for k in np.flatnonzero(((here >= low) & (here <= high)).all(axis=1)).tolist():
                thing, solid = solids[2][k]
                depth = -solid.distance(_seen_from(poses[tick, thing], line))
                inside = np.flatnonzero(depth > 0.0)
                if not len(inside) or inside[0] == 0 or inside[-1] == STEPS - 1:
                    continue
                first, last = float(steps[inside[0]]), float(steps[inside[-1]])
                middle = line[inside].mean(axis=0)[None]
                across = -float(solid.distance(_seen_from(poses[tick, thing], middle))[0])
                if across < ACROSS * (last - first) / 2 or first > BESIDE or last < -BESIDE:
                    continue
                # The normal points from the first to the second: the third lies on the side of the one that is in it.
                mine = first + last <= 0.0
                own = [s.distance(_seen_from(poses[tick, each], middle)) for each, s in solids[0 if mine else 1]]
                if min(float(gap[0]) for gap in own) < 0.0:
                    found[tick] = last - first + float(steps[1] - steps[0]), mine
    return found


def _solids(things: Sequence[Thing], matter: Matter, carrier: int) -> list[tuple[int, Solid]]:
    """Return the solids of the body that a thing is, each with the thing that it is of."""
    own = np.flatnonzero(matter.thing == carrier)
    rows = np.flatnonzero(matter.body == matter.body[own[0]]) if len(own) else own
    return [(int(matter.thing[row]), solid_of(matter.solid(int(row), things))) for row in rows]


def _seen_from(pose: FloatArray, points: FloatArray) -> FloatArray:
    return rotate_back(pose[None, 3:], points - pose[:3])


def _lasts(found: dict[int, tuple[float, bool]], needed: int, end: int) -> int | None:
    """Return the first tick from which on it is found at each look for long enough."""
    begin = last = None
    for tick in sorted(found):
        if last is None or tick - last > 2 * EVERY:
            begin = tick
        last = tick
        if begin is not None and tick - begin >= min(needed, end) - EVERY:
            return begin
    return None
