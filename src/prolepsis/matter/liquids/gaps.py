"""Gaps: where two bodies are so near that no particle gets between them there is liquid all the same, and it presses.

What lies on the bottom of a vessel would else be pressed onto it by all that is above it. No flow is followed in a gap:
it gives what is lacking in what a liquid at rest gives (Archimedes), as far as its area and the pressure at its mouth
can, and less where that is in part dry.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from prolepsis.geometry.faces import MOST_FACES, Solids, faces_of
from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.matter.liquids.walls import Bodies, WallContacts, Walls
from prolepsis.system.kernels import njit

NARROW, MOUTH = 1.5, 2.0
"""Widths up to which a gap is one, since hardly a particle gets into it, and up to which its mouth is [spacings]."""
FINE = 0.5
"""Distance of the places at which a body is looked at [spacings]."""
FEWEST, MOST = 4, 40
"""Least and greatest number of them along each axis."""
HIDDEN = 0.5
"""Weight of a face under which it is behind another one [1]."""
ASIDE = 0.5
"""Cosine of the normals from which on places face each other, or look away from each other [1]."""
SECOND = 0.9
"""Distance from walls from which on a particle has the liquid's pressure: nearer ones are crowded [spacings]."""
NEAR = 1.5
"""Distance up to which a particle wets a place at the mouth of a gap [spacings]."""
BROADER = 1.25
"""How much more a gap may give than its area says [1]: particles press on a face as if it were a little broader."""
SHALLOW = 1.0
"""Depth up to which a film's pressure is not known and it gives nothing; from one more on it gives all [spacings]."""
SMOOTHING = 0.015
"""Time over which what a gap gives is averaged [s]: particles jostle."""


class Skin(NamedTuple):
    """Places on the surface of a body, in its frame."""

    position: FloatArray
    """[m], shape (s, 3)."""
    normal: FloatArray
    """Outwards, shape (s, 3)."""
    area: FloatArray
    """[m^2], shape (s,)."""
    inside: FloatArray
    """Places within the body [m], shape (m, 3)."""
    volume: FloatArray
    """[m^3], shape (m,)."""


class Gaps:
    """The gaps of a running liquid."""

    def __init__(self, spacing: float) -> None:
        """Begin, for a liquid of a spacing [m]."""
        self._spacing = spacing
        self.pushed = np.zeros((0, 6))
        """What the particles did to each body in the last step: force [N] and moment [N m], shape (B, 6)."""
        self._walls: Walls | None = None
        self._skins: dict[int, Skin] = {}
        self._kept: dict[tuple[int, int], FloatArray] = {}

    def forces(
        self,
        position: FloatArray,
        pressure: FloatArray,
        weight: FloatArray,
        contacts: WallContacts,
        walls: Walls,
        bodies: Bodies,
        dt: float,
    ) -> FloatArray:
        """Return force [N] and moment about the world's origin [N m] on each body, shape (B, 6).

        Args:
            position: Of the particles [m], shape (n, 3).
            pressure: [Pa], shape (n,).
            weight: Of the liquid by volume [N/m^3], shape (n, 3).
            contacts: What each particle sees of the walls.
            walls: The walls.
            bodies: The bodies that they belong to.
            dt: Length of the step [s].
        """
        made = np.zeros((len(bodies.position), 6))
        if walls is not self._walls:
            self._walls = walls
            self._skins.clear()
        if self.pushed.shape != made.shape:
            self._kept.clear()
            self.pushed = np.zeros_like(made)
        kept, self._kept = self._kept, {}
        for first, second in _pairs(contacts, bodies.mobility, len(position)).tolist():
            # The smaller one, of those that yield.
            own, other = sorted((first, second), key=lambda b: (bodies.mobility[b, 0] == 0.0, _size(walls, bodies, b)))
            if own not in self._skins:
                begin, end = bodies.first[own : own + 2].tolist()
                self._skins[own] = Skin(*skin_of(walls.surfaces, begin, end, FINE * self._spacing))
            mean = self._kept[own, other] = kept.get((own, other), np.full(2, np.nan))
            _press(
                self._skins[own], own, other, position, pressure, weight, contacts, walls.surfaces, bodies,
                self._spacing, self.pushed, mean, min(dt / SMOOTHING, 1.0), made,
            )  # fmt: skip
        return made


def _size(walls: Walls, bodies: Bodies, b: int) -> float:
    bounds = walls.surfaces.bounds[bodies.first[b] : bodies.first[b + 1]]
    return float((bounds[:, 3:] - bounds[:, :3]).max())


@njit(cache=True)
def _pairs(contacts: WallContacts, mobility: FloatArray, n: int) -> IntArray:
    """Return the bodies that particles see two of, one of which yields, each pair once, shape (k, 2)."""
    count = len(mobility)
    seen = np.zeros((count, count), dtype=np.bool_)
    for i in range(n):
        for f in range(contacts.seen[i]):
            for g in range(f):
                b, c = contacts.body[i, f], contacts.body[i, g]
                if min(contacts.weight[i, f], contacts.weight[i, g]) < HIDDEN:
                    continue
                if b != c and (mobility[b, 0] > 0.0 or mobility[c, 0] > 0.0):
                    seen[min(b, c), max(b, c)] = True
    pairs = np.empty((count * count, 2), dtype=np.int64)
    k = 0
    for b in range(count):
        for c in range(b + 1, count):
            if seen[b, c]:
                pairs[k, 0], pairs[k, 1] = b, c
                k += 1
    return pairs[:k]


@njit(cache=True)
def skin_of(
    solids: Solids, first: int, last: int, step: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return a ``Skin``'s columns for the union of some solids, from a grid of about ``step`` [m].

    A cell is inside in part, and a part of the surface, by how far its middle is from that over its width across it.
    """
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for k in range(first, last):
        for corner in range(8):
            for c in range(3):
                at = solids.frame[k, c]
                for a in range(3):
                    at += solids.frame[k, 3 + 3 * c + a] * solids.bounds[k, a + 3 * (corner >> a & 1)]
                low[c], high[c] = min(low[c], at), max(high[c], at)
    counts, cell = np.empty(3, dtype=np.int64), np.empty(3)
    for c in range(3):
        counts[c] = min(max(int((high[c] - low[c]) / step) + 1, FEWEST), MOST)
        cell[c] = (high[c] - low[c]) / counts[c]
    # A layer more on each side.
    nx, ny, nz = counts[0] + 2, counts[1] + 2, counts[2] + 2
    cells = np.empty((nx * ny * nz, 3))
    for m in range(len(cells)):
        cells[m, 0] = low[0] + (m // (ny * nz) - 0.5) * cell[0]
        cells[m, 1] = low[1] + (m // nz % ny - 0.5) * cell[1]
        cells[m, 2] = low[2] + (m % nz - 0.5) * cell[2]
    nearest = np.zeros((len(cells), 4))
    nearest[:, 0] = np.inf
    found, seen = np.empty((len(cells), MOST_FACES, 4)), np.empty(len(cells), dtype=np.int64)
    for k in range(first, last):
        faces_of(solids, k, cells, len(cells), 2 * step, found, seen)
        for i in range(len(cells)):
            if seen[i] > 0 and found[i, 0, 0] < nearest[i, 0]:
                for c in range(4):
                    nearest[i, c] = found[i, 0, c]
    width = np.empty(len(cells))
    for i in range(len(cells)):
        width[i] = 0.0
        for c in range(3):
            width[i] += abs(nearest[i, c + 1]) * cell[c]
    near = np.flatnonzero(np.abs(nearest[:, 0]) < width)
    inside = np.flatnonzero(nearest[:, 0] < width / 2)
    volume = cell[0] * cell[1] * cell[2]
    position, area = np.empty((len(near), 3)), np.empty(len(near))
    for s in range(len(near)):
        i = near[s]
        area[s] = volume / width[i] * (1.0 - abs(nearest[i, 0]) / width[i])
        for c in range(3):
            position[s, c] = cells[i, c] - nearest[i, 0] * nearest[i, c + 1]
    part = np.empty(len(inside))
    for s in range(len(inside)):
        i = inside[s]
        part[s] = volume * min(max(0.5 - nearest[i, 0] / width[i], 0.0), 1.0)
    return position, nearest[near, 1:].copy(), area, cells[inside], part


@njit(cache=True)
def _press(
    skin: Skin,
    own: int,
    other: int,
    position: FloatArray,
    pressure: FloatArray,
    weight: FloatArray,
    contacts: WallContacts,
    solids: Solids,
    bodies: Bodies,
    spacing: float,
    pushed: FloatArray,
    kept: FloatArray,
    part: float,
    made: FloatArray,
) -> None:
    """Add what the gap between two bodies gives to ``made``: force and moment, shape (B, 6).

    ``kept`` are the means over time of the pressure at its mouth [Pa] and of what is lacking [N], shape (2,), of which
    ``part`` is renewed.
    """
    n = len(position)
    mouth = np.empty(n, dtype=np.int64)
    count, total, mean = 0, 0.0, 0.0
    middle, heavy = np.zeros(3), np.zeros(3)
    for i in range(n):
        near, far = False, False
        for f in range(contacts.seen[i]):
            if contacts.weight[i, f] > HIDDEN:
                near = near or contacts.body[i, f] == own
                far = far or contacts.body[i, f] == other
        if not near or not far:
            continue
        mouth[count] = i
        count += 1
        # Those by a wall count where there are no others.
        counts = 1.0 if contacts.distance[i, 0] > SECOND * spacing else 1e-6
        total += counts
        mean += counts * pressure[i]
        for c in range(3):
            middle[c] += counts * position[i, c]
            heavy[c] += counts * weight[i, c]
    if count == 0:
        return
    mean = _renewed(kept, 0, mean / total, part)
    middle /= total
    heavy /= total
    samples = len(skin.area)
    outward, world = np.empty((samples, 3)), np.empty((samples, 3))
    nearest, facing = np.empty(samples), np.empty(samples)
    _see(skin, own, other, solids, bodies, MOUTH * spacing, world, outward, nearest, facing)
    wet, rim, most = 0.0, 0.0, 0.0
    gap, centre = np.zeros(3), np.zeros(3)
    for s in range(samples):
        value = mean
        for c in range(3):
            value += heavy[c] * (world[s, c] - middle[c])
        push = max(value, 0.0) * skin.area[s]
        if nearest[s] < NARROW * spacing and facing[s] < -ASIDE:
            most += push
            for c in range(3):
                gap[c] -= push * outward[s, c]
                centre[c] += push * world[s, c]
        elif nearest[s] < MOUTH * spacing and facing[s] < ASIDE:
            rim += skin.area[s]
            for m in range(count):
                if _square(position[mouth[m]], world[s]) < (NEAR * spacing) ** 2:
                    wet += skin.area[s]
                    break
    if most == 0.0 or rim == 0.0:
        return
    # What it displaces, under the surface.
    down = math.sqrt(heavy[0] ** 2 + heavy[1] ** 2 + heavy[2] ** 2)
    r, o, displaced = bodies.rotation[own], bodies.position[own], 0.0
    for s in range(len(skin.volume)):
        value = mean
        for c in range(3):
            at = o[c] - middle[c]
            for a in range(3):
                at += r[3 * c + a] * skin.inside[s, a]
            value += heavy[c] * at
        displaced += skin.volume[s] * min(max(0.5 + value / max(down * FINE * spacing, 1e-300), 0.0), 1.0)
    # What the particles and other gaps do not give of what a liquid at rest gives, as far as this gap can.
    size, along = max(math.sqrt(gap[0] ** 2 + gap[1] ** 2 + gap[2] ** 2), 1e-300), 0.0
    for c in range(3):
        centre[c] /= most
        along += (-displaced * heavy[c] - pushed[own, c] - made[own, c]) * gap[c] / size
    deep = min(max(mean / max(down * spacing, 1e-300) - SHALLOW, 0.0), 1.0)
    given = deep * wet / rim * min(max(_renewed(kept, 1, along, part), 0.0), BROADER * size) / size
    x, y, z = given * gap[0], given * gap[1], given * gap[2]
    for body, sign in ((own, 1.0), (other, -1.0)):
        made[body, 0] += sign * x
        made[body, 1] += sign * y
        made[body, 2] += sign * z
        made[body, 3] += sign * (centre[1] * z - centre[2] * y)
        made[body, 4] += sign * (centre[2] * x - centre[0] * z)
        made[body, 5] += sign * (centre[0] * y - centre[1] * x)


@njit(cache=True, inline="always")
def _renewed(kept: FloatArray, k: int, value: float, part: float) -> float:
    """Return the mean with a new value in it; the first one is taken as it is."""
    kept[k] = value if math.isnan(kept[k]) else kept[k] + part * (value - kept[k])
    return kept[k]


@njit(cache=True, inline="always")
def _square(first: FloatArray, second: FloatArray) -> float:
    x, y, z = first[0] - second[0], first[1] - second[1], first[2] - second[2]
    return x * x + y * y + z * z


@njit(cache=True)
def _see(
    skin: Skin,
    own: int,
    other: int,
    solids: Solids,
    bodies: Bodies,
    reach: float,
    world: FloatArray,
    outward: FloatArray,
    nearest: FloatArray,
    facing: FloatArray,
) -> None:
    """Write where places of a skin are, how far the other body is, and the cosine of its normal and theirs."""
    size = len(skin.area)
    r, o = bodies.rotation[own], bodies.position[own]
    q, t = bodies.rotation[other], bodies.position[other]
    local = np.empty((size, 3))
    for s in range(size):
        nearest[s], facing[s] = np.inf, 1.0
        for c in range(3):
            world[s, c], outward[s, c] = o[c], 0.0
            for a in range(3):
                world[s, c] += r[3 * c + a] * skin.position[s, a]
                outward[s, c] += r[3 * c + a] * skin.normal[s, a]
        for c in range(3):
            local[s, c] = 0.0
            for a in range(3):
                local[s, c] += q[3 * a + c] * (world[s, a] - t[a])
    found, seen = np.empty((size, MOST_FACES, 4)), np.empty(size, dtype=np.int64)
    for k in range(bodies.first[other], bodies.first[other + 1]):
        faces_of(solids, k, local, size, reach, found, seen)
        for s in range(size):
            if seen[s] > 0 and found[s, 0, 0] < nearest[s]:
                nearest[s], facing[s] = found[s, 0, 0], 0.0
                for c in range(3):
                    for a in range(3):
                        facing[s] += outward[s, c] * q[3 * c + a] * found[s, 0, a + 1]
