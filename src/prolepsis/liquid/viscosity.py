"""Viscosity in Pa s, implicit in time: conjugate gradients on the velocities.

Neighbours resist coming nearer or parting (the force acts along the line between them, so angular momentum is kept),
and walls resist sliding along them such that a flow of constant shear is undisturbed.

Source: Weiler et al., Computer Graphics Forum 37(8):135 (2018), for the pair force; the walls are our own.
"""

from __future__ import annotations

import numpy as np
from numba import njit  # pyright: ignore[reportMissingTypeStubs, reportUnknownVariableType]

from prolepsis.liquid.kernel import Counts, Indices, Singles
from prolepsis.liquid.walls import Contacts, read_table
from prolepsis.things import FloatArray

GENTLE = 0.1
"""Relative change of a velocity below which viscosity needs no iterations [1]."""


@njit(cache=True, fastmath=True)
def solve_viscosity(
    velocity: FloatArray,
    guess: FloatArray,
    mass: FloatArray,
    viscosity: FloatArray,
    start: Counts,
    end: Counts,
    other: Indices,
    gradient: Singles,
    drag: Singles,
    contacts: Contacts,
    drag_table: FloatArray,
    spacing: float,
    dt: float,
    tolerance: float,
    most: int,
    slip: FloatArray,
) -> int:
    """Change the velocities by the viscous impulses of a step, and return the number of iterations.

    Args:
        velocity: In: without viscosity; out: with it [m/s], shape (n, 3).
        guess: First guess of the change [m/s], shape (n, 3).
        mass: [kg], shape (n,).
        viscosity: [Pa s], shape (n,).
        start: First neighbour of each particle, shape (n,).
        end: The one after its last, shape (n,).
        other: Neighbours.
        gradient: Volume times gradient of the kernel for each neighbour [1/m].
        drag: Factor of the pair force for each neighbour.
        contacts: What each particle sees of the walls.
        drag_table: Drag of a wall over the distance.
        spacing: [m].
        dt: [s].
        tolerance: Residual over right-hand side at which the iterations end [1].
        most: Greatest number of iterations.
        slip: Coefficient of each wall face [kg], written here, shape (n, SEEN).
    """
    n = len(velocity)
    volume = spacing**3
    right = np.zeros((n, 3))
    diagonal = np.zeros((n, 3))
    # Factor of (v . g) g of each pair, with the time step in it.
    factor: Singles = np.zeros(len(other), dtype=np.float32)
    for i in range(n):
        for c in range(3):
            right[i, c] = mass[i] * velocity[i, c]
            diagonal[i, c] = mass[i]
        for p in range(start[i], end[i]):
            j = other[p]
            both = viscosity[i] + viscosity[j]
            mean = 2.0 * viscosity[i] * viscosity[j] / both if both > 0.0 else 0.0
            factor[p] = mean * drag[p] * volume * dt
            for c in range(3):
                diagonal[i, c] += factor[p] * gradient[p, c] * gradient[p, c]
        for f in range(contacts.seen[i]):
            q = contacts.distance[i, f] / spacing
            k = contacts.weight[i, f] * read_table(drag_table, q) * viscosity[i] * spacing * dt
            slip[i, f] = k
            normal, wall = contacts.normal[i, f], contacts.velocity[i, f]
            along = normal[0] * wall[0] + normal[1] * wall[1] + normal[2] * wall[2]
            for c in range(3):
                right[i, c] += k * (wall[c] - along * normal[c])
                diagonal[i, c] += k * (1.0 - normal[c] * normal[c])
    stiffest = 0.0
    for i in range(n):
        stiffest = max(stiffest, diagonal[i, 0] / mass[i])
    gentle = stiffest < 1.0 + GENTLE
    found = velocity + guess
    product = np.zeros((n, 3))
    _multiply(found, mass, start, end, other, gradient, factor, contacts, slip, product)
    residual = right - product
    if gentle:
        # One Jacobi step is exact enough where viscosity changes the velocities by a few percent.
        for i in range(n):
            for c in range(3):
                guess[i, c] += residual[i, c] / diagonal[i, c]
                velocity[i, c] += guess[i, c]
        return 1
    conditioned = residual / diagonal
    direction = conditioned.copy()
    size = 0.0
    scale = 1e-30
    for i in range(n):
        for c in range(3):
            size += residual[i, c] * conditioned[i, c]
            scale += right[i, c] * right[i, c] / diagonal[i, c]
    limit = tolerance * tolerance * scale
    iteration = 0
    while iteration < most and size > limit:
        _multiply(direction, mass, start, end, other, gradient, factor, contacts, slip, product)
        curvature = 0.0
        for i in range(n):
            for c in range(3):
                curvature += direction[i, c] * product[i, c]
        step = size / max(curvature, 1e-300)
        after = 0.0
        for i in range(n):
            for c in range(3):
                found[i, c] += step * direction[i, c]
                residual[i, c] -= step * product[i, c]
                conditioned[i, c] = residual[i, c] / diagonal[i, c]
                after += residual[i, c] * conditioned[i, c]
        share = after / size
        for i in range(n):
            for c in range(3):
                direction[i, c] = conditioned[i, c] + share * direction[i, c]
        size = after
        iteration += 1
    # What the iterations leave over sums up to a push on the whole, which is given back.
    for c in range(3):
        left, total = 0.0, 0.0
        for i in range(n):
            left += residual[i, c]
            total += mass[i]
        for i in range(n):
            found[i, c] += left / total
            guess[i, c] = found[i, c] - velocity[i, c]
            velocity[i, c] = found[i, c]
    return iteration


@njit(cache=True, fastmath=True)
def _multiply(
    vector: FloatArray,
    mass: FloatArray,
    start: Counts,
    end: Counts,
    other: Indices,
    gradient: Singles,
    factor: Singles,
    contacts: Contacts,
    slip: FloatArray,
    product: FloatArray,
) -> None:
    for i in range(len(vector)):
        x, y, z = vector[i, 0], vector[i, 1], vector[i, 2]
        sx, sy, sz = mass[i] * x, mass[i] * y, mass[i] * z
        for p in range(start[i], end[i]):
            j = other[p]
            gx, gy, gz = gradient[p, 0], gradient[p, 1], gradient[p, 2]
            along = factor[p] * (gx * (x - vector[j, 0]) + gy * (y - vector[j, 1]) + gz * (z - vector[j, 2]))
            sx += along * gx
            sy += along * gy
            sz += along * gz
        for f in range(contacts.seen[i]):
            normal, k = contacts.normal[i, f], slip[i, f]
            into = normal[0] * x + normal[1] * y + normal[2] * z
            sx += k * (x - into * normal[0])
            sy += k * (y - into * normal[1])
            sz += k * (z - into * normal[2])
        product[i, 0], product[i, 1], product[i, 2] = sx, sy, sz
