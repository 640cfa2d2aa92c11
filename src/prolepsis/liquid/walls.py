"""Walls: the solids that particles touch, where each body is, and what a particle sees of them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from prolepsis.fields.faces import MOST_FACES, Solids, faces_of
from prolepsis.kernels import njit
from prolepsis.liquid.kernel import SUPPORT, TABLE_SIZE
from prolepsis.things import FloatArray, IntArray

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
    reach: FloatArray
    """Centre in the body's frame and radius of the ball around it [m], shape (B, 4)."""
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


class Contacts(NamedTuple):
    """What n particles see of the walls, in up to SEEN faces each."""

    seen: IntArray
    """Shape (n,)."""
    body: IntArray
    """Shape (n, SEEN)."""
    distance: FloatArray
    """[m], shape (n, SEEN)."""
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


def empty_contacts(n: int) -> Contacts:
    """Return contacts of n particles that see nothing."""
    return Contacts(
        seen=np.zeros(n, dtype=np.int64),
        body=np.zeros((n, SEEN), dtype=np.int64),
        distance=np.zeros((n, SEEN)),
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
    place = min(max(q, 0.0), SUPPORT) * ((TABLE_SIZE - 1) / SUPPORT)
    k = min(int(place), TABLE_SIZE - 2)
    return table[k] + (place - k) * (table[k + 1] - table[k])


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
    spacing: float,
    solids: Solids,
    bodies: Bodies,
    share_table: FloatArray,
    slope_table: FloatArray,
    contacts: Contacts,
    side: FloatArray,
) -> None:
    """Fill in what each particle sees of the walls, and in ``side`` the nearest face (normal, distance in spacings)."""
    n, body_count = len(position), len(bodies.first) - 1
    reach = SUPPORT * spacing
    found = np.zeros((MOST_FACES, 4))
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
            for i in range(n):
                if abs(position[i, 2] - mz) > hz or abs(position[i, 0] - mx) > hx or abs(position[i, 1] - my) > hy:
                    continue
                dx, dy, dz = position[i, 0] - ox, position[i, 1] - oy, position[i, 2] - oz
                x = r[0] * dx + r[3] * dy + r[6] * dz
                y = r[1] * dx + r[4] * dy + r[7] * dz
                z = r[2] * dx + r[5] * dy + r[8] * dz
                count = faces_of(solids, k, x, y, z, reach, found)
                for f in range(count):
                    distance = found[f, 0]
                    place = contacts.seen[i]
                    if place == SEEN:
                        if distance >= contacts.distance[i, SEEN - 1]:
                            continue
                        place = SEEN - 1
                    while place > 0 and contacts.distance[i, place - 1] > distance:
                        contacts.distance[i, place] = contacts.distance[i, place - 1]
                        contacts.body[i, place] = contacts.body[i, place - 1]
                        contacts.normal[i, place] = contacts.normal[i, place - 1]
                        contacts.velocity[i, place] = contacts.velocity[i, place - 1]
                        place -= 1
                    contacts.distance[i, place] = distance
                    contacts.body[i, place] = b
                    nx, ny, nz = found[f, 1], found[f, 2], found[f, 3]
                    contacts.normal[i, place, 0] = r[0] * nx + r[1] * ny + r[2] * nz
                    contacts.normal[i, place, 1] = r[3] * nx + r[4] * ny + r[5] * nz
                    contacts.normal[i, place, 2] = r[6] * nx + r[7] * ny + r[8] * nz
                    contacts.velocity[i, place, 0] = ux + wy * dz - wz * dy
                    contacts.velocity[i, place, 1] = uy + wz * dx - wx * dz
                    contacts.velocity[i, place, 2] = uz + wx * dy - wy * dx
                    contacts.seen[i] = min(contacts.seen[i] + 1, SEEN)
    for i in range(n):
        count = contacts.seen[i]
        if count == 0:
            continue
        side[i, :3] = contacts.normal[i, 0]
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
def keep_outside(
    position: FloatArray,
    velocity: FloatArray,
    before: Contacts,
    spacing: float,
    solids: Solids,
    bodies: Bodies,
    dt: float,
) -> None:
    """Move particles that a wall has overtaken back in front of it, on the side where they were.

    Args:
        position: After the step [m], shape (n, 3).
        velocity: [m/s], shape (n, 3).
        before: What they saw before the step.
        spacing: [m].
        solids: The walls.
        bodies: At the end of the step.
        dt: Length of the step [s].
    """
    least = REST_DISTANCE * spacing
    found = np.zeros((MOST_FACES, 4))
    for i in range(len(position)):
        for f in range(before.seen[i]):
            b = before.body[i, f]
            ahead = before.distance[i, f]
            for c in range(3):
                ahead += (velocity[i, c] - before.velocity[i, f, c]) * dt * before.normal[i, f, c]
            if ahead > 1.2 * least:
                continue
            nx, ny, nz = before.normal[i, f, 0], before.normal[i, f, 1], before.normal[i, f, 2]
            r = bodies.rotation[b]
            dx = position[i, 0] - bodies.position[b, 0]
            dy = position[i, 1] - bodies.position[b, 1]
            dz = position[i, 2] - bodies.position[b, 2]
            x = r[0] * dx + r[3] * dy + r[6] * dz
            y = r[1] * dx + r[4] * dy + r[7] * dz
            z = r[2] * dx + r[5] * dy + r[8] * dz
            nearest, mx, my, mz = np.inf, 0.0, 0.0, 0.0
            for k in range(bodies.first[b], bodies.first[b + 1]):
                count = faces_of(solids, k, x, y, z, least, found)
                if count > 0 and found[0, 0] < nearest:
                    nearest, mx, my, mz = found[0, 0], found[0, 1], found[0, 2], found[0, 3]
            if nearest >= least:
                continue
            gx = r[0] * mx + r[1] * my + r[2] * mz
            gy = r[3] * mx + r[4] * my + r[5] * mz
            gz = r[6] * mx + r[7] * my + r[8] * mz
            push = least - nearest
            if gx * nx + gy * ny + gz * nz < -0.3 and f == 0:
                # It has passed the middle of the wall: back to where it came from.
                push, gx, gy, gz = least - ahead, nx, ny, nz
            if push <= 0.0:
                continue
            position[i, 0] += push * gx
            position[i, 1] += push * gy
            position[i, 2] += push * gz
            inward = 0.0
            v = before.velocity[i, f]
            inward = (velocity[i, 0] - v[0]) * gx + (velocity[i, 1] - v[1]) * gy + (velocity[i, 2] - v[2]) * gz
            if inward < 0.0:
                velocity[i, 0] -= inward * gx
                velocity[i, 1] -= inward * gy
                velocity[i, 2] -= inward * gz
