"""Walls and air in the kernel sums: what is missing near a wall or a free surface is made up for."""

from __future__ import annotations

import math

from prolepsis.kernels import njit
from prolepsis.liquid.walls import Contacts
from prolepsis.things import FloatArray


@njit(cache=True)
def complete_density(
    contacts: Contacts,
    density: FloatArray,
    steepness: FloatArray,
    share_table: FloatArray,
    slope_table: FloatArray,
    spacing: float,
) -> None:
    """Add the walls' share and the air's to the kernel sums, and the walls' to their gradients.

    A liquid whose upmost layers are only held apart once their incomplete sums reach one would sink together. Near a
    flat surface of the liquid the sum's gradient is as long as that of a wall's share at the same distance, which
    tells how much of the kernel is air.

    Args:
        contacts: What each particle sees of the walls.
        density: Kernel sum over the liquid, changed [1], shape (n,).
        steepness: Its gradient, changed [1/m], shape (n, 3).
        share_table: A wall's share of the kernel sum over the distance.
        slope_table: Its derivative.
        spacing: [m].
    """
    for i in range(len(density)):
        for f in range(contacts.seen[i]):
            for c in range(3):
                steepness[i, c] += contacts.slope[i, f] * contacts.normal[i, f, c]
        s = steepness[i]
        gradient = math.sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) * spacing
        density[i] += contacts.share[i] + _air_share(gradient, share_table, slope_table)


@njit(cache=True)
def _air_share(gradient: float, share_table: FloatArray, slope_table: FloatArray) -> float:
    """Return a wall's share where its derivative is ``-gradient`` [1 / spacing]."""
    if gradient >= -slope_table[0]:
        return share_table[0]
    low, high = 0, len(slope_table) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if -slope_table[middle] > gradient:
            low = middle
        else:
            high = middle
    part = (-slope_table[low] - gradient) / max(slope_table[high] - slope_table[low], 1e-12)
    return share_table[low] + part * (share_table[high] - share_table[low])
