"""Viscosity in Pa s, implicit in time: conjugate gradients on the velocities.

Neighbours resist coming nearer or parting (the force acts along the line between them, so angular momentum is kept),
and walls resist sliding along them such that a flow of constant shear is undisturbed, and parting from them as much.

Source: Weiler et al., Computer Graphics Forum 37(8):135 (2018), for the pair force; the walls are our own.
"""

from __future__ import annotations

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.matter.liquids.neighbours import Neighbours
from prolepsis.matter.liquids.walls import WallContacts, read_table
from prolepsis.system.kernels import njit

GENTLE = 0.1
"""Relative change of a velocity below which viscosity needs no iterations [1]."""


@njit(cache=True, fastmath=True)
def solve_viscosity(
    velocity: FloatArray,
    guess: FloatArray,
    mass: FloatArray,
    viscosity: FloatArray,
    neighbours: Neighbours,
    contacts: WallContacts,
    drag_table: FloatArray,
    spacing: float,
    dt: float,
    tolerance: float,
    most: int,
    slip: FloatArray,
    inertia: FloatArray,
    yielded: FloatArray,
) -> int:
    """Change the velocities by the viscous impulses of a step, and return the number of iterations.

    Args:
        velocity: In: without viscosity; out: with it [m/s], shape (n, 3).
        guess: First guess of the change [m/s], shape (n, 3).
        mass: [kg], shape (n,).
        viscosity: [Pa s], shape (n,).
        neighbours: The neighbours of each; their drag becomes that of this step.
        contacts: What each particle sees of the walls.
        drag_table: Drag of a wall over the distance.
        spacing: [m].
        dt: [s].
        tolerance: Residual over right-hand side at which the iterations end [1].
        most: Greatest number of iterations.
        slip: Coefficient of each wall face [kg], written here, shape (n, SEEN).
        inertia: Mass [kg] and the rows of the inertia in the world [kg m^2] of the bodies that yield, zeros for those
            that do not, shape (B, 10).
        yielded: By how much the bodies' velocity and spin differ from the walls', in: without drag, out: with it,
            shape (B, 6).
    """
    n = len(velocity)
    start, end, other, gradient, drag, _ = neighbours
    seen, bodies, _, depth, _, wall, arms, weight, _, _ = contacts
    volume = spacing**3
    found = velocity + guess
    residual, diagonal = np.empty((n, 3)), np.empty((n, 3))
    count = len(inertia)
    body_residual, body_diagonal = np.zeros((count, 6)), np.ones((count, 6))
    for b in range(count):
        for c in range(3):
            body_diagonal[b, c], body_diagonal[b, c + 3] = inertia[b, 0], inertia[b, 1 + 4 * c]
    stiffest, walled, scale = 0.0, False, 1e-30
    for i in range(n):
        x, y, z = found[i, 0], found[i, 1], found[i, 2]
        dx = dy = dz = mass[i]
        rx, ry, rz = -mass[i] * guess[i, 0], -mass[i] * guess[i, 1], -mass[i] * guess[i, 2]
        for p in range(start[i], end[i]):
            j = other[p]
            both = viscosity[i] + viscosity[j]
            mean = 2.0 * viscosity[i] * viscosity[j] / both if both > 0.0 else 0.0
            factor = mean * drag[p] * volume * dt
            drag[p] = factor
            gx, gy, gz = gradient[p, 0], gradient[p, 1], gradient[p, 2]
            along = factor * (gx * (x - found[j, 0]) + gy * (y - found[j, 1]) + gz * (z - found[j, 2]))
            rx -= along * gx
            ry -= along * gy
            rz -= along * gz
            dx += factor * gx * gx
            dy += factor * gy * gy
            dz += factor * gz * gz
        sx, sy, sz = mass[i] * velocity[i, 0], mass[i] * velocity[i, 1], mass[i] * velocity[i, 2]
        for f in range(seen[i]):
            q = depth[i, f] / spacing
            k = weight[i, f] * read_table(drag_table, q) * viscosity[i] * spacing * dt
            slip[i, f] = k
            wx, wy, wz, b = wall[i, f, 0], wall[i, f, 1], wall[i, f, 2], bodies[i, f]
            sx, sy, sz = sx + k * wx, sy + k * wy, sz + k * wz
            dx, dy, dz = dx + k, dy + k, dz + k
            arm = arms[i, f]
            if inertia[b, 0] > 0.0:
                u = yielded[b]
                wx += u[0] + u[4] * arm[2] - u[5] * arm[1]
                wy += u[1] + u[5] * arm[0] - u[3] * arm[2]
                wz += u[2] + u[3] * arm[1] - u[4] * arm[0]
            ux, uy, uz = k * (x - wx), k * (y - wy), k * (z - wz)
            rx, ry, rz = rx - ux, ry - uy, rz - uz
            if inertia[b, 0] > 0.0:
                _add_wrench(body_residual[b], arm, ux, uy, uz)
                square = arm[0] * arm[0] + arm[1] * arm[1] + arm[2] * arm[2]
                for c in range(3):
                    body_diagonal[b, c] += k
                    body_diagonal[b, c + 3] += k * (square - arm[c] * arm[c])
            walled = True
        residual[i, 0], residual[i, 1], residual[i, 2] = rx, ry, rz
        diagonal[i, 0], diagonal[i, 1], diagonal[i, 2] = dx, dy, dz
        scale += sx * sx / dx + sy * sy / dy + sz * sz / dz
        stiffest = max(stiffest, dx / mass[i])
    for b in range(count):
        if inertia[b, 0] == 0.0:
            body_residual[b] = 0.0
            body_diagonal[b] = 1.0
    if stiffest < 1.0 + GENTLE:
        # One Jacobi step is exact enough where viscosity changes the velocities by a few percent.
        for i in range(n):
            for c in range(3):
                guess[i, c] += residual[i, c] / diagonal[i, c]
                velocity[i, c] += guess[i, c]
        for b in range(count):
            for c in range(6):
                yielded[b, c] += body_residual[b, c] / body_diagonal[b, c]
        return 1
    conditioned, body_conditioned = residual / diagonal, body_residual / body_diagonal
    direction, body_direction = conditioned.copy(), body_conditioned.copy()
    product, body_product = np.empty((n, 3)), np.empty((count, 6))
    size = 0.0
    for i in range(n):
        for c in range(3):
            size += residual[i, c] * conditioned[i, c]
    for b in range(count):
        for c in range(6):
            size += body_residual[b, c] * body_conditioned[b, c]
    limit = tolerance * tolerance * scale
    iteration = 0
    while iteration < most and size > limit:
        _multiply(direction, body_direction, mass, inertia, neighbours, contacts, slip, product, body_product)
        curvature = 0.0
        for b in range(count):
            for c in range(6):
                curvature += body_direction[b, c] * body_product[b, c]
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
        for b in range(count):
            for c in range(6):
                yielded[b, c] += step * body_direction[b, c]
                body_residual[b, c] -= step * body_product[b, c]
                body_conditioned[b, c] = body_residual[b, c] / body_diagonal[b, c]
                after += body_residual[b, c] * body_conditioned[b, c]
        share = after / size
        for b in range(count):
            for c in range(6):
                body_direction[b, c] = body_conditioned[b, c] + share * body_direction[b, c]
        for i in range(n):
            for c in range(3):
                direction[i, c] = conditioned[i, c] + share * direction[i, c]
        size = after
        iteration += 1
    # What the iterations leave over sums up to a push on the whole, which is given back if no wall has it.
    for c in range(3):
        left, total = 0.0, 0.0
        for i in range(n):
            left += residual[i, c]
            total += mass[i]
        if walled:
            left = 0.0
        for i in range(n):
            found[i, c] += left / total
            guess[i, c] = found[i, c] - velocity[i, c]
            velocity[i, c] = found[i, c]
    return iteration


@njit(cache=True, inline="always")
def _add_wrench(wrench: FloatArray, arm: FloatArray, x: float, y: float, z: float) -> None:
    wrench[0] += x
    wrench[1] += y
    wrench[2] += z
    wrench[3] += arm[1] * z - arm[2] * y
    wrench[4] += arm[2] * x - arm[0] * z
    wrench[5] += arm[0] * y - arm[1] * x


@njit(cache=True, fastmath=True)
def _multiply(
    vector: FloatArray,
    bodies: FloatArray,
    mass: FloatArray,
    inertia: FloatArray,
    neighbours: Neighbours,
    contacts: WallContacts,
    slip: FloatArray,
    product: FloatArray,
    body_product: FloatArray,
) -> None:
    """Multiply velocities of particles and of bodies with masses and drags."""
    start, end, other, gradient, factor, _ = neighbours
    seen, walls, _, _, _, _, arms, _, _, _ = contacts
    for b in range(len(bodies)):
        m, v = inertia[b], bodies[b]
        for c in range(3):
            body_product[b, c] = m[0] * v[c]
            row = 1 + 3 * c
            body_product[b, c + 3] = m[row] * v[3] + m[row + 1] * v[4] + m[row + 2] * v[5]
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
        for f in range(seen[i]):
            k, b = slip[i, f], walls[i, f]
            if inertia[b, 0] == 0.0:
                sx, sy, sz = sx + k * x, sy + k * y, sz + k * z
                continue
            v, arm = bodies[b], arms[i, f]
            ux = k * (x - v[0] - v[4] * arm[2] + v[5] * arm[1])
            uy = k * (y - v[1] - v[5] * arm[0] + v[3] * arm[2])
            uz = k * (z - v[2] - v[3] * arm[1] + v[4] * arm[0])
            sx, sy, sz = sx + ux, sy + uy, sz + uz
            _add_wrench(body_product[b], arm, -ux, -uy, -uz)
        product[i, 0], product[i, 1], product[i, 2] = sx, sy, sz
