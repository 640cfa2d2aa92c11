"""Calming: the jitter of single particles is damped, and the flow that they share is not.

Particles that are kept apart by pressure jostle each other like the molecules of a gas, which would make a liquid
more viscous than it is. Neighbours therefore exchange the part of their difference in velocity that the gradient of
the flow around them does not explain. A flow of constant shear or rotation is left as it is, and momentum is kept.
"""

from __future__ import annotations

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.matter.liquids.neighbours import Neighbours
from prolepsis.system.kernels import njit

THINNEST = 0.02
"""Determinant of the neighbours' spread [1] below which they are too much in a plane to tell a gradient."""


@njit(cache=True, fastmath=True)
def calm(
    position: FloatArray,
    velocity: FloatArray,
    mass: FloatArray,
    neighbours: Neighbours,
    share: float,
) -> None:
    """Change the velocities.

    Args:
        position: [m], shape (n, 3).
        velocity: [m/s], shape (n, 3).
        mass: [kg], shape (n,).
        neighbours: The neighbours of each.
        share: Share of the jitter that is exchanged [1].
    """
    n = len(velocity)
    start, end, other, gradient, _, _ = neighbours
    flow = np.zeros((n, 9))
    known = np.zeros(n, dtype=np.bool_)
    for i in range(n):
        xx = xy = xz = yy = yz = zz = 0.0
        a0 = a1 = a2 = a3 = a4 = a5 = a6 = a7 = a8 = 0.0
        for p in range(start[i], end[i]):
            j = other[p]
            gx, gy, gz = gradient[p, 0], gradient[p, 1], gradient[p, 2]
            dx, dy, dz = (
                position[j, 0] - position[i, 0],
                position[j, 1] - position[i, 1],
                position[j, 2] - position[i, 2],
            )
            ux, uy, uz = (
                velocity[j, 0] - velocity[i, 0],
                velocity[j, 1] - velocity[i, 1],
                velocity[j, 2] - velocity[i, 2],
            )
            xx += dx * gx
            xy += dx * gy
            xz += dx * gz
            yy += dy * gy
            yz += dy * gz
            zz += dz * gz
            a0 += ux * gx
            a1 += ux * gy
            a2 += ux * gz
            a3 += uy * gx
            a4 += uy * gy
            a5 += uy * gz
            a6 += uz * gx
            a7 += uz * gy
            a8 += uz * gz
        # In the bulk the spread is the unit matrix.
        c0, c1, c2 = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
        determinant = xx * c0 + xy * c1 + xz * c2
        if determinant < THINNEST:
            continue
        known[i] = True
        c0, c1, c2 = c0 / determinant, c1 / determinant, c2 / determinant
        c4, c5 = (xx * zz - xz * xz) / determinant, (xz * xy - xx * yz) / determinant
        c8 = (xx * yy - xy * xy) / determinant
        flow[i, 0], flow[i, 1], flow[i, 2] = (
            a0 * c0 + a1 * c1 + a2 * c2,
            a0 * c1 + a1 * c4 + a2 * c5,
            a0 * c2 + a1 * c5 + a2 * c8,
        )
        flow[i, 3], flow[i, 4], flow[i, 5] = (
            a3 * c0 + a4 * c1 + a5 * c2,
            a3 * c1 + a4 * c4 + a5 * c5,
            a3 * c2 + a4 * c5 + a5 * c8,
        )
        flow[i, 6], flow[i, 7], flow[i, 8] = (
            a6 * c0 + a7 * c1 + a8 * c2,
            a6 * c1 + a7 * c4 + a8 * c5,
            a6 * c2 + a7 * c5 + a8 * c8,
        )
    change = np.zeros((n, 3))
    for i in range(n):
        if not known[i]:
            continue
        f = flow[i]
        cx = cy = cz = 0.0
        for p in range(start[i], end[i]):
            j = other[p]
            if not known[j]:
                continue
            h = flow[j]
            dx, dy, dz = (
                position[j, 0] - position[i, 0],
                position[j, 1] - position[i, 1],
                position[j, 2] - position[i, 2],
            )
            # These weights sum to one in the bulk.
            weight = (gradient[p, 0] * dx + gradient[p, 1] * dy + gradient[p, 2] * dz) / 3.0
            weight *= mass[j] / (mass[i] + mass[j])
            cx += weight * (
                velocity[j, 0] - velocity[i, 0] - 0.5 * ((f[0] + h[0]) * dx + (f[1] + h[1]) * dy + (f[2] + h[2]) * dz)
            )
            cy += weight * (
                velocity[j, 1] - velocity[i, 1] - 0.5 * ((f[3] + h[3]) * dx + (f[4] + h[4]) * dy + (f[5] + h[5]) * dz)
            )
            cz += weight * (
                velocity[j, 2] - velocity[i, 2] - 0.5 * ((f[6] + h[6]) * dx + (f[7] + h[7]) * dy + (f[8] + h[8]) * dz)
            )
        change[i, 0], change[i, 1], change[i, 2] = cx, cy, cz
    for i in range(n):
        for c in range(3):
            velocity[i, c] += 2.0 * share * change[i, c]
