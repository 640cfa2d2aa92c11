"""Between liquid and walls: adhesion, pinned edges, and what the walls get back, face by face."""

from __future__ import annotations

import math

from prolepsis.geometry.shape import FloatArray
from prolepsis.matter.liquids.walls import WallContacts, read_table
from prolepsis.system.kernels import njit

TOUCHING = 0.8
"""Distance of a particle's centre up to which it lies on a wall [spacings]."""
ALONE, LAYER = 0.318, 0.70
"""Kernel sum of a particle alone, and of one within a single layer on a square lattice [1]."""


@njit(cache=True)
def add_adhesion(
    contacts: WallContacts,
    strength: FloatArray,
    edges: FloatArray,
    wetting: FloatArray,
    pull_table: FloatArray,
    spacing: float,
    force: FloatArray,
) -> None:
    """Add the attraction of the walls to ``force`` [N], shape (n, 3).

    Args:
        contacts: What each particle sees of the walls.
        strength: Attraction between neighbours if all attract each other [N], shape (n,).
        edges: How much each particle belongs to the surface [1], shape (n,).
        wetting: Cosine of the contact angle [1], shape (n,).
        pull_table: Pull of a wall of the liquid's own kind over the distance.
        spacing: [m].
        force: [N], shape (n, 3).
    """
    for i in range(len(force)):
        for f in range(contacts.seen[i]):
            pull = _pull(contacts, i, f, strength, edges, wetting, pull_table, spacing)
            for c in range(3):
                force[i, c] -= pull * contacts.normal[i, f, c]


@njit(cache=True, inline="always")
def _pull(
    contacts: WallContacts,
    i: int,
    f: int,
    strength: FloatArray,
    edges: FloatArray,
    wetting: FloatArray,
    pull_table: FloatArray,
    spacing: float,
) -> float:
    """Return the attraction of a particle by a face that it sees [N]."""
    # Work of adhesion over work of cohesion (Young and Dupre), less the pull of the liquid on this side, which deeper
    # than its surface is left out.
    share = (0.5 * (1.0 + wetting[i]) - (1.0 - edges[i])) * contacts.weight[i, f]
    return share * strength[i] * read_table(pull_table, contacts.distance[i, f] / spacing)


@njit(cache=True)
def pin_edges(
    contacts: WallContacts,
    velocity: FloatArray,
    mass: FloatArray,
    tension: FloatArray,
    pinning: FloatArray,
    density: FloatArray,
    position: FloatArray,
    spacing: float,
    dt: float,
    bodies: FloatArray,
) -> None:
    """Slow down what slides along a wall at the edge of a liquid, up to a stop: an edge of water holds on.

    A particle alone is a drop as wide as a spacing; one that is surrounded in its layer has no edge.

    Args:
        contacts: What each particle sees of the walls.
        velocity: [m/s], changed, shape (n, 3).
        mass: [kg], shape (n,).
        tension: Surface tension [N/m], shape (n,).
        pinning: Range of the cosine of the contact angle [1], shape (n,).
        density: Kernel sum over the liquid alone [1], shape (n,).
        position: [m], shape (n, 3).
        spacing: [m].
        dt: [s].
        bodies: As in ``add_pressure``.

    Source:
        Furmidge, Journal of Colloid Science 17:309 (1962): a drop of width w is held by gamma w times that range.
    """
    for i in range(len(velocity)):
        if contacts.seen[i] == 0 or contacts.distance[i, 0] > TOUCHING * spacing:
            continue
        edge = min(max((LAYER - density[i]) / (LAYER - ALONE), 0.0), 1.0)
        normal, wall = contacts.normal[i, 0], contacts.velocity[i, 0]
        x, y, z = velocity[i, 0] - wall[0], velocity[i, 1] - wall[1], velocity[i, 2] - wall[2]
        into = x * normal[0] + y * normal[1] + z * normal[2]
        x, y, z = x - into * normal[0], y - into * normal[1], z - into * normal[2]
        speed = math.sqrt(x * x + y * y + z * z)
        held = min(tension[i] * pinning[i] * spacing * edge * dt / mass[i], speed)
        if held <= 0.0:
            continue
        x, y, z = x * held / speed, y * held / speed, z * held / speed
        velocity[i, 0] -= x
        velocity[i, 1] -= y
        velocity[i, 2] -= z
        _add(
            bodies[contacts.body[i, 0]],
            position[i],
            normal,
            contacts.distance[i, 0],
            mass[i] * x,
            mass[i] * y,
            mass[i] * z,
        )


@njit(cache=True)
def add_drag(
    contacts: WallContacts,
    velocity: FloatArray,
    slip: FloatArray,
    yielded: FloatArray,
    position: FloatArray,
    bodies: FloatArray,
) -> None:
    """Add to the bodies what viscosity does to the walls.

    Args:
        contacts: What each particle sees of the walls.
        velocity: With viscosity [m/s], shape (n, 3).
        slip: Coefficient of each wall face [kg], shape (n, SEEN).
        yielded: Change of each body's velocity and spin by drag, shape (B, 6).
        position: [m], shape (n, 3).
        bodies: As in ``add_pressure``.
    """
    for i in range(len(velocity)):
        for f in range(contacts.seen[i]):
            normal, wall = contacts.normal[i, f], contacts.velocity[i, f]
            v, arm = yielded[contacts.body[i, f]], contacts.arm[i, f]
            x = velocity[i, 0] - wall[0] - (v[0] + v[4] * arm[2] - v[5] * arm[1])
            y = velocity[i, 1] - wall[1] - (v[1] + v[5] * arm[0] - v[3] * arm[2])
            z = velocity[i, 2] - wall[2] - (v[2] + v[3] * arm[1] - v[4] * arm[0])
            k = slip[i, f]
            _add(
                bodies[contacts.body[i, f]],
                position[i],
                normal,
                contacts.distance[i, f],
                k * x,
                k * y,
                k * z,
            )


@njit(cache=True)
def add_pressure(
    contacts: WallContacts,
    impulse: FloatArray,
    push: FloatArray,
    strength: FloatArray,
    edges: FloatArray,
    wetting: FloatArray,
    pull_table: FloatArray,
    spacing: float,
    dt: float,
    position: FloatArray,
    bodies: FloatArray,
) -> None:
    """Add to the bodies what pressure, contact and adhesion do to the walls.

    Args:
        contacts: What each particle sees of the walls.
        impulse: Pressure impulses, shape (n,).
        push: Impulses of the walls' surfaces on the particles [N s], shape (n, SEEN).
        strength: Attraction between neighbours if all attract each other [N], shape (n,).
        edges: How much each particle belongs to the surface [1], shape (n,).
        wetting: Cosine of the contact angle [1], shape (n,).
        pull_table: Pull of a wall over the distance.
        spacing: [m].
        dt: [s].
        position: [m], shape (n, 3).
        bodies: Impulse [N s] and its moment about the world's origin [N m s], shape (B, 6).
    """
    for i in range(len(impulse)):
        for f in range(contacts.seen[i]):
            pull = _pull(contacts, i, f, strength, edges, wetting, pull_table, spacing)
            size = impulse[i] * contacts.slope[i, f] - push[i, f] + pull * dt
            normal = contacts.normal[i, f]
            _add(
                bodies[contacts.body[i, f]],
                position[i],
                normal,
                contacts.distance[i, f],
                size * normal[0],
                size * normal[1],
                size * normal[2],
            )


@njit(cache=True, inline="always")
def _add(
    body: FloatArray, position: FloatArray, normal: FloatArray, distance: float, x: float, y: float, z: float
) -> None:
    px, py, pz = (
        position[0] - distance * normal[0],
        position[1] - distance * normal[1],
        position[2] - distance * normal[2],
    )
    body[0] += x
    body[1] += y
    body[2] += z
    body[3] += py * z - pz * y
    body[4] += pz * x - px * z
    body[5] += px * y - py * x
