"""The surface: what is missing in the kernel sums near it or a wall is made up for; its particles attract others."""

from __future__ import annotations

import math

from prolepsis.geometry.shape import FloatArray
from prolepsis.matter.liquids.kernel import TABLE_SIZE, edge
from prolepsis.matter.liquids.neighbours import Neighbours
from prolepsis.matter.liquids.walls import WallContacts
from prolepsis.system.kernels import njit


@njit(cache=True)
def complete_density(
    contacts: WallContacts,
    density: FloatArray,
    steepness: FloatArray,
    air_table: FloatArray,
    steepest: float,
    spacing: float,
    edges: FloatArray,
) -> None:
    """Add the walls' share and the air's to the kernel sums, and the walls' to their gradients.

    A liquid whose upmost layers are only held apart once their incomplete sums reach one would sink together. Near a
    flat surface of the liquid the sum's gradient is as long as that of a wall's share at the same distance, which
    tells how much of the kernel is air.

    Args:
        contacts: What each particle sees of the walls.
        density: Kernel sum over the liquid, changed [1], shape (n,).
        steepness: Its gradient, changed [1/m], shape (n, 3).
        air_table: ``air`` of the tables.
        steepest: Greatest steepness of a wall's share [1 / spacing].
        spacing: [m].
        edges: How much each particle belongs to the surface, written here, shape (n,).
    """
    for i in range(len(density)):
        for f in range(contacts.seen[i]):
            for c in range(3):
                steepness[i, c] += contacts.slope[i, f] * contacts.normal[i, f, c]
        s = steepness[i]
        gradient = math.sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) * spacing
        density[i] += contacts.share[i]
        edges[i] = edge(density[i])
        density[i] += _air_share(gradient, steepest, air_table)


@njit(cache=True, fastmath=True)
def add_tension(
    neighbours: Neighbours, strength: FloatArray, edges: FloatArray, spacing: float, force: FloatArray
) -> None:
    """Add the attraction between neighbours of which one belongs to the surface; deeper it would only order them.

    Args:
        neighbours: The neighbours of each.
        strength: Attraction between neighbours [N], shape (n,).
        edges: How much each particle belongs to the surface [1], shape (n,).
        spacing: [m].
        force: [N], shape (n, 3).
    """
    start, end, other, gradient, _, attraction = neighbours
    for i in range(len(force)):
        for p in range(start[i], end[i]):
            j = other[p]
            both = edges[i] + edges[j]
            if both > 0.0:
                pull = 0.25 * both * (strength[i] + strength[j]) * attraction[p] * spacing
                force[i, 0] += pull * gradient[p, 0]
                force[i, 1] += pull * gradient[p, 1]
                force[i, 2] += pull * gradient[p, 2]


@njit(cache=True, inline="always")
def _air_share(gradient: float, steepest: float, table: FloatArray) -> float:
    """Return a wall's share where its derivative is ``-gradient`` [1 / spacing]."""
    coordinate = math.sqrt(max(1.0 - gradient / steepest, 0.0)) * (TABLE_SIZE - 1)
    k = min(int(coordinate), TABLE_SIZE - 2)
    return table[k] + (coordinate - k) * (table[k + 1] - table[k])
