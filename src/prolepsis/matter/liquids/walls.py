"""Walls: the solids that particles touch, where each body is, and what a particle sees of them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from prolepsis.geometry.faces import MOST_FACES, Solids, faces_of
from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.matter.liquids.kernel import SUPPORT, TABLE_SIZE
from prolepsis.system.kernels import njit

ENDLESS = 1.0e6
"""What a plane's bounds stand for [m]."""
SEEN = 4
"""Greatest number of faces that act on one particle."""
REST_DISTANCE = 0.5
"""Distance of a particle's centre from the wall that it lies on [spacings]."""


class Bodies(NamedTuple):
    """B rigid bodies with walls."""

    first: IntArray
    """First solid of each body; one more for the end, shape (B + 1,)."""
    thing: IntArray
    """Index of the thing that each is, shape (B,)."""
    rotation: FloatArray
    """Rows of the rotation to the world, shape (B, 9)."""
    position: FloatArray
    """Origin in the world [m], shape (B, 3)."""
    velocity: FloatArray
    """Velocity of the origin [m/s], shape (B, 3)."""
    spin: FloatArray
    """Angular velocity in the world [rad/s], shape (B, 3)."""
    centre: FloatArray
    """Centre of mass in the world [m], shape (B, 3)."""
    mobility: FloatArray
    """Inverse mass [1/kg], then the rows of the inverse inertia in the world [1/(kg m^2)]; zeros for a body that does
    not yield to the liquid, shape (B, 10)."""
    inertia: FloatArray
    """Mass [kg], then the rows of the inertia in the world [kg m^2]; zeros for the same, shape (B, 10)."""


class Walls(NamedTuple):
    """The solids of bodies, one by one, as a liquid meets them."""

    faces: Solids
    """What keeps it out and presses on it."""
    surfaces: Solids
    """What it sticks to, which differs from the faces at holes."""


class WallContacts(NamedTuple):
    """What n particles see of the walls, in up to SEEN faces each."""

    seen: IntArray
    """Shape (n,)."""
    body: IntArray
    """Shape (n, SEEN)."""
    distance: FloatArray
    """[m], shape (n, SEEN)."""
    depth: FloatArray
    """Distance to the surface that it sticks to there [m], shape (n, SEEN)."""
    normal: FloatArray
    """From the wall into the liquid, world frame, shape (n, SEEN, 3)."""
    velocity: FloatArray
    """Velocity of the wall there [m/s], shape (n, SEEN, 3)."""
    arm: FloatArray
    """From the centre of the body's mass to the place on the wall [m], shape (n, SEEN, 3)."""
    weight: FloatArray
    """Share of a face that no nearer face stands for already [1], shape (n, SEEN)."""
    slope: FloatArray
    """Derivative of the walls' share of the kernel sum by the distance [1/m], shape (n, SEEN)."""
    share: FloatArray
    """The walls' share of the kernel sum [1], shape (n,)."""


def empty_contacts(n: int) -> WallContacts:
    """Return contacts of n particles that see nothing."""
    return WallContacts(
        seen=np.zeros(n, dtype=np.int64),
        body=np.zeros((n, SEEN), dtype=np.int64),
        distance=np.zeros((n, SEEN)),
        depth=np.zeros((n, SEEN)),
        normal=np.zeros((n, SEEN, 3)),
        velocity=np.zeros((n, SEEN, 3)),
        arm=np.zeros((n, SEEN, 3)),
        weight=np.zeros((n, SEEN)),
        slope=np.zeros((n, SEEN)),
        share=np.zeros(n),
    )


@njit(cache=True, inline="always")
def read_table(table: FloatArray, q: float) -> float:
    """Return the value of a wall table at ``q`` spacings, interpolated."""
    coordinate = min(max(q, 0.0), SUPPORT) * ((TABLE_SIZE - 1) / SUPPORT)
    k = min(int(coordinate), TABLE_SIZE - 2)
    return table[k] + (coordinate - k) * (table[k + 1] - table[k])


@njit(cache=True)
def _world_box(
    frame: FloatArray,
    bounds: FloatArray,
    rotation: FloatArray,
    position: FloatArray,
    margin: float,
    middle: FloatArray,
    half: FloatArray,
) -> None:
    """Write middle and half extents of the upright box around a solid, widened by a margin [m], shape (3,) each."""
    least, greatest = np.empty(3), np.empty(3)
    for c in range(3):
        least[c], greatest[c] = max(bounds[c], -ENDLESS), min(bounds[c + 3], ENDLESS)
    for row in range(3):
        centre, extent = position[row], margin
        for column in range(3):
            turned = 0.0
            for m in range(3):
                turned += rotation[3 * row + m] * frame[3 + 3 * m + column]
            centre += turned * (least[column] + greatest[column]) / 2 + rotation[3 * row + column] * frame[column]
            extent += abs(turned) * (greatest[column] - least[column]) / 2
        middle[row], half[row] = centre, extent


@njit(cache=True)
def find_walls(
    position: FloatArray,
    rider: IntArray,
    spacing: float,
    walls: Walls,
    bodies: Bodies,
    share_table: FloatArray,
    slope_table: FloatArray,
    contacts: WallContacts,
    side: FloatArray,
) -> None:
    """Fill in what each particle sees of the walls, and in ``side`` the nearest face (normal, distance in spacings).

    What rides on a particle, the thing that ``rider`` tells, lies on it as a face against the wall that it is on.
    """
    n, body_count, solids = len(position), len(bodies.first) - 1, walls.faces
    reach = SUPPORT * spacing
    local, which = np.empty((n, 3)), np.empty(n, dtype=np.int64)
    found, count = np.empty((n, MOST_FACES, 4)), np.empty(n, dtype=np.int64)
    own, own_count = np.empty((n, MOST_FACES, 4)), np.zeros(n, dtype=np.int64)
    for i in range(n):
        contacts.seen[i] = 0
        contacts.share[i] = 0.0
        side[i, 3] = SUPPORT
    middle, half = np.zeros(3), np.zeros(3)
    for b in range(body_count):
        r = bodies.rotation[b]
        ox, oy, oz = bodies.position[b, 0], bodies.position[b, 1], bodies.position[b, 2]
        ux, uy, uz = bodies.velocity[b, 0], bodies.velocity[b, 1], bodies.velocity[b, 2]
        wx, wy, wz = bodies.spin[b, 0], bodies.spin[b, 1], bodies.spin[b, 2]
        for k in range(bodies.first[b], bodies.first[b + 1]):
            _world_box(solids.frame[k], solids.bounds[k], r, bodies.position[b], reach, middle, half)
            mx, my, mz = middle[0], middle[1], middle[2]
            hx, hy, hz = half[0], half[1], half[2]
            near = 0
            for i in range(n):
                if rider[i] == bodies.thing[b]:
                    continue
                if abs(position[i, 2] - mz) > hz or abs(position[i, 0] - mx) > hx or abs(position[i, 1] - my) > hy:
                    continue
                dx, dy, dz = position[i, 0] - ox, position[i, 1] - oy, position[i, 2] - oz
                local[near, 0] = r[0] * dx + r[3] * dy + r[6] * dz
                local[near, 1] = r[1] * dx + r[4] * dy + r[7] * dz
                local[near, 2] = r[2] * dx + r[5] * dy + r[8] * dz
                which[near] = i
                near += 1
            faces_of(solids, k, local, near, reach, found, count)
            drilled = solids.span[k, 3] > 0
            if drilled:
                faces_of(walls.surfaces, k, local, near, reach, own, own_count)
            for m in range(near):
                i = which[m]
                dx, dy, dz = position[i, 0] - ox, position[i, 1] - oy, position[i, 2] - oz
                for f in range(count[m]):
                    distance = found[m, f, 0]
                    slot = contacts.seen[i]
                    if slot == SEEN:
                        if distance >= contacts.distance[i, SEEN - 1]:
                            continue
                        slot = SEEN - 1
                    while slot > 0 and contacts.distance[i, slot - 1] > distance:
                        contacts.distance[i, slot] = contacts.distance[i, slot - 1]
                        contacts.depth[i, slot] = contacts.depth[i, slot - 1]
                        contacts.body[i, slot] = contacts.body[i, slot - 1]
                        for c in range(3):
                            contacts.normal[i, slot, c] = contacts.normal[i, slot - 1, c]
                            contacts.velocity[i, slot, c] = contacts.velocity[i, slot - 1, c]
                        slot -= 1
                    contacts.distance[i, slot] = distance
                    contacts.depth[i, slot] = _depth(found[m, f], own[m], own_count[m]) if drilled else distance
                    contacts.body[i, slot] = b
                    nx, ny, nz = found[m, f, 1], found[m, f, 2], found[m, f, 3]
                    contacts.normal[i, slot, 0] = r[0] * nx + r[1] * ny + r[2] * nz
                    contacts.normal[i, slot, 1] = r[3] * nx + r[4] * ny + r[5] * nz
                    contacts.normal[i, slot, 2] = r[6] * nx + r[7] * ny + r[8] * nz
                    contacts.velocity[i, slot, 0] = ux + wy * dz - wz * dy
                    contacts.velocity[i, slot, 1] = uy + wz * dx - wx * dz
                    contacts.velocity[i, slot, 2] = uz + wx * dy - wy * dx
                    contacts.seen[i] = min(contacts.seen[i] + 1, SEEN)
    for i in range(n):
        if rider[i] >= 0:
            _lay_rider(position, i, rider[i], spacing, bodies, contacts)
        count = contacts.seen[i]
        if count == 0:
            continue
        for c in range(3):
            side[i, c] = contacts.normal[i, 0, c]
        side[i, 3] = contacts.distance[i, 0] / spacing
        room = 1.0
        for f in range(count):
            weight = 1.0
            for g in range(f):
                aligned = 0.0
                for c in range(3):
                    aligned += contacts.normal[i, f, c] * contacts.normal[i, g, c]
                weight *= 1.0 - max(aligned, 0.0)
            contacts.weight[i, f] = weight
            room *= 1.0 - weight * read_table(share_table, contacts.distance[i, f] / spacing)
        for f in range(count):
            q = contacts.distance[i, f] / spacing
            rest = room / (1.0 - contacts.weight[i, f] * read_table(share_table, q))
            contacts.slope[i, f] = rest * contacts.weight[i, f] * read_table(slope_table, q) / spacing
            b = contacts.body[i, f]
            for c in range(3):
                foot = position[i, c] - contacts.distance[i, f] * contacts.normal[i, f, c]
                contacts.arm[i, f, c] = foot - bodies.centre[b, c]
        contacts.share[i] = 1.0 - room


@njit(cache=True)
def _depth(face: FloatArray, own: FloatArray, count: int) -> float:
    """Return how far the surface is that a face stands for [m], of those that are seen, shape (MOST_FACES, 4)."""
    depth, most = face[0], 0.5
    for g in range(count):
        if own[g, 0] <= 0.0:
            return 0.0
        aligned = face[1] * own[g, 1] + face[2] * own[g, 2] + face[3] * own[g, 3]
        if aligned > most:
            depth, most = own[g, 0], aligned
    return depth


@njit(cache=True)
def _lay_rider(
    position: FloatArray, i: int, thing: int, spacing: float, bodies: Bodies, contacts: WallContacts
) -> None:
    """Let a particle see what rides on it, where it rests between that and the nearest other wall."""
    slot = contacts.seen[i]
    if slot == 0 or slot == SEEN:
        return
    for b in range(len(bodies.thing)):
        if bodies.thing[b] != thing:
            continue
        arm, spin = position[i] - bodies.position[b], bodies.spin[b]
        contacts.distance[i, slot] = contacts.depth[i, slot] = REST_DISTANCE * spacing
        contacts.body[i, slot] = b
        for c in range(3):
            contacts.normal[i, slot, c] = -contacts.normal[i, 0, c]
        contacts.velocity[i, slot, 0] = bodies.velocity[b, 0] + spin[1] * arm[2] - spin[2] * arm[1]
        contacts.velocity[i, slot, 1] = bodies.velocity[b, 1] + spin[2] * arm[0] - spin[0] * arm[2]
        contacts.velocity[i, slot, 2] = bodies.velocity[b, 2] + spin[0] * arm[1] - spin[1] * arm[0]
        contacts.seen[i] = slot + 1
        return


@njit(cache=True)
def keep_outside(
    position: FloatArray,
    rider: IntArray,
    velocity: FloatArray,
    before: WallContacts,
    spacing: float,
    solids: Solids,
    bodies: Bodies,
    dt: float,
) -> None:
    """Move particles that a wall has overtaken back in front of it, on the side where they were.

    Args:
        position: After the step [m], shape (n, 3).
        rider: What rides on each, in which it may be, shape (n,).
        velocity: With which they have moved [m/s], shape (n, 3).
        before: What they saw before the step.
        spacing: [m].
        solids: The walls.
        bodies: At the end of the step.
        dt: Length of the step [s].
    """
    least = REST_DISTANCE * spacing
    body_count = len(bodies.first) - 1
    # Particles that will be near a face, in the order of the face's rank and its body.
    begin = np.zeros(SEEN * body_count + 1, dtype=np.int64)
    for i in range(len(position)):
        for f in range(before.seen[i]):
            if bodies.thing[before.body[i, f]] != rider[i] and _ahead(before, i, f, velocity, dt) <= 1.2 * least:
                begin[f * body_count + before.body[i, f] + 1] += 1
    # Sums of numpy's would load numba's linear algebra, and with it scipy's, in each process.
    for k in range(1, len(begin)):
        begin[k] += begin[k - 1]
    total, filled = begin[-1], begin.copy()
    which, ahead = np.empty(total, dtype=np.int64), np.empty(total)
    for i in range(len(position)):
        for f in range(before.seen[i]):
            distance = _ahead(before, i, f, velocity, dt)
            if bodies.thing[before.body[i, f]] != rider[i] and distance <= 1.2 * least:
                slot = filled[f * body_count + before.body[i, f]]
                which[slot], ahead[slot] = i, distance
                filled[f * body_count + before.body[i, f]] += 1
    local, found = np.empty((total, 3)), np.empty((total, MOST_FACES, 4))
    count = np.empty(total, dtype=np.int64)
    # Distance to the body and its normal there.
    nearest = np.empty((total, 4))
    for f in range(SEEN):
        for b in range(body_count):
            r, here = bodies.rotation[b], begin[f * body_count + b]
            near = begin[f * body_count + b + 1] - here
            for m in range(near):
                i = which[here + m]
                dx = position[i, 0] - bodies.position[b, 0]
                dy = position[i, 1] - bodies.position[b, 1]
                dz = position[i, 2] - bodies.position[b, 2]
                local[m, 0] = r[0] * dx + r[3] * dy + r[6] * dz
                local[m, 1] = r[1] * dx + r[4] * dy + r[7] * dz
                local[m, 2] = r[2] * dx + r[5] * dy + r[8] * dz
                nearest[m, 0] = np.inf
            if near == 0:
                continue
            for k in range(bodies.first[b], bodies.first[b + 1]):
                faces_of(solids, k, local, near, least, found, count)
                for m in range(near):
                    if count[m] > 0 and found[m, 0, 0] < nearest[m, 0]:
                        for c in range(4):
                            nearest[m, c] = found[m, 0, c]
            for m in range(near):
                i = which[here + m]
                if nearest[m, 0] >= least:
                    continue
                mx, my, mz = nearest[m, 1], nearest[m, 2], nearest[m, 3]
                gx = r[0] * mx + r[1] * my + r[2] * mz
                gy = r[3] * mx + r[4] * my + r[5] * mz
                gz = r[6] * mx + r[7] * my + r[8] * mz
                push = least - nearest[m, 0]
                nx, ny, nz = before.normal[i, f, 0], before.normal[i, f, 1], before.normal[i, f, 2]
                if gx * nx + gy * ny + gz * nz < -0.3 and f == 0:
                    # It has passed the middle of the wall: back to where it came from.
                    push, gx, gy, gz = least - ahead[here + m], nx, ny, nz
                if push <= 0.0:
                    continue
                position[i, 0] += push * gx
                position[i, 1] += push * gy
                position[i, 2] += push * gz


@njit(cache=True, inline="always")
def _ahead(before: WallContacts, i: int, f: int, velocity: FloatArray, dt: float) -> float:
    """Return how far a particle will be from a face that it sees now [m]."""
    ahead = before.distance[i, f]
    for c in range(3):
        ahead += (velocity[i, c] - before.velocity[i, f, c]) * dt * before.normal[i, f, c]
    return ahead
