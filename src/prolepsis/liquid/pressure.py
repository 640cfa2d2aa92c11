"""Pressure: the impulses that keep the liquid's volume, found row by row.

The kernel sum of a particle may not rise above one. Each particle has a pressure impulse, never negative, that acts
along the gradient of its own sum, on its neighbours, and on the walls it sees; Gauss-Seidel sweeps, up and down in
turn, find those that are needed. The impulses of the last step are the first guess. Pair impulses are equal and
opposite, so momentum is kept exactly.
"""

from __future__ import annotations

import numpy as np

from prolepsis.kernels import njit
from prolepsis.liquid.neighbours import Neighbours
from prolepsis.liquid.walls import REST_DISTANCE, Contacts
from prolepsis.liquid.yielding import along, give_way, softness
from prolepsis.things import FloatArray

CORRECTION = 0.2
"""Share of a compression that one step takes back [1]."""
NEGLIGIBLE = 1.0
"""Compression of one particle that is left alone [tolerances]."""
GREATEST_CORRECTION = 0.02
"""Compression that one step takes back at most [1]."""


@njit(cache=True, fastmath=True)
def solve_pressure(
    velocity: FloatArray,
    inverse_mass: FloatArray,
    neighbours: Neighbours,
    steepness: FloatArray,
    density: FloatArray,
    contacts: Contacts,
    impulse: FloatArray,
    push: FloatArray,
    mobility: FloatArray,
    yielded: FloatArray,
    spacing: float,
    dt: float,
    tolerance: float,
    least_sweeps: int,
    most_sweeps: int,
) -> tuple[int, float]:
    """Change the velocities such that nothing is compressed, and return the sweeps and the remaining compression.

    Args:
        velocity: [m/s], shape (n, 3).
        inverse_mass: [1/kg], shape (n,).
        neighbours: The neighbours of each.
        steepness: Gradient of each particle's kernel sum, walls included [1/m], shape (n, 3).
        density: Kernel sum with walls and air [1], shape (n,).
        contacts: What each particle sees of the walls.
        impulse: Pressure impulses; in: first guess, which the velocities contain, out: result [N s m], shape (n,).
        push: Impulses of the walls' surfaces, out [N s], shape (n, SEEN).
        mobility: Of the bodies, shape (B, 10).
        yielded: By how much their velocity and spin differ from the walls', changed, shape (B, 6).
        spacing: [m].
        dt: [s].
        tolerance: Mean compression per step at which the sweeps end [1].
        least_sweeps: At least so many.
        most_sweeps: At most so many.
    """
    n = len(velocity)
    start, end, other, gradient, _ = neighbours
    least = REST_DISTANCE * spacing
    # Own part of each row: liquid alone, for what the neighbours' velocities are compared with.
    own, wanted, inverse = np.empty((n, 3)), np.empty(n), np.empty(n)
    for i in range(n):
        kappa = impulse[i]
        sx, sy, sz = steepness[i, 0], steepness[i, 1], steepness[i, 2]
        diagonal = (sx * sx + sy * sy + sz * sz) * inverse_mass[i]
        for f in range(contacts.seen[i]):
            push[i, f] = 0.0
            slope, normal = contacts.slope[i, f], contacts.normal[i, f]
            body = contacts.body[i, f]
            if mobility[body, 0] > 0.0:
                diagonal += slope * slope * softness(mobility[body], contacts.arm[i, f], normal)
            sx -= slope * normal[0]
            sy -= slope * normal[1]
            sz -= slope * normal[2]
        own[i, 0], own[i, 1], own[i, 2] = sx, sy, sz
        for p in range(start[i], end[i]):
            gx, gy, gz = gradient[p, 0], gradient[p, 1], gradient[p, 2]
            diagonal += (gx * gx + gy * gy + gz * gz) * inverse_mass[other[p]]
        inverse[i] = 1.0 / max(diagonal, 1e-300)
        excess = density[i] - 1.0
        # A gap may close at once; in a liquid under pressure it does so as gently as a compression opens.
        share = CORRECTION if excess > 0.0 or kappa > 0.0 else 1.0
        wanted[i] = min(share * excess, GREATEST_CORRECTION) / dt
    negligible = NEGLIGIBLE * tolerance / dt
    sweep, error = 0, 0.0
    while sweep < most_sweeps:
        error = 0.0
        for step in range(n):
            i = step if sweep % 2 == 0 else n - 1 - step
            vx, vy, vz = velocity[i, 0], velocity[i, 1], velocity[i, 2]
            residual = wanted[i] + own[i, 0] * vx + own[i, 1] * vy + own[i, 2] * vz
            for p in range(start[i], end[i]):
                j = other[p]
                residual -= (
                    gradient[p, 0] * velocity[j, 0] + gradient[p, 1] * velocity[j, 1] + gradient[p, 2] * velocity[j, 2]
                )
            seen = contacts.seen[i]
            for f in range(seen):
                normal, wall = contacts.normal[i, f], contacts.velocity[i, f]
                closing = normal[0] * (vx - wall[0]) + normal[1] * (vy - wall[1]) + normal[2] * (vz - wall[2])
                body = contacts.body[i, f]
                if mobility[body, 0] > 0.0:
                    closing -= along(yielded[body], contacts.arm[i, f], normal)
                residual += contacts.slope[i, f] * closing
            if residual > 0.0:
                error += residual
            change = max(residual * inverse[i], -impulse[i])
            # Rows that are good enough need not disturb their neighbours.
            if abs(residual) > negligible and change != 0.0:
                impulse[i] += change
                _apply(i, change, velocity, inverse_mass, neighbours, steepness)
                for f in range(seen):
                    body = contacts.body[i, f]
                    if mobility[body, 0] > 0.0:
                        normal, size = contacts.normal[i, f], change * contacts.slope[i, f]
                        give_way(
                            yielded[body],
                            mobility[body],
                            contacts.arm[i, f],
                            size * normal[0],
                            size * normal[1],
                            size * normal[2],
                        )
            for f in range(seen):
                gap = contacts.distance[i, f] - least
                if gap > spacing:
                    continue
                normal, wall = contacts.normal[i, f], contacts.velocity[i, f]
                closing = 0.0
                for c in range(3):
                    closing += normal[c] * (velocity[i, c] - wall[c])
                limit = -gap / dt if gap > 0.0 else -CORRECTION * gap / dt
                body, soft = contacts.body[i, f], inverse_mass[i]
                if mobility[body, 0] > 0.0:
                    closing -= along(yielded[body], contacts.arm[i, f], normal)
                    soft += softness(mobility[body], contacts.arm[i, f], normal)
                more = max((limit - closing) / soft, -push[i, f])
                if more != 0.0:
                    push[i, f] += more
                    if mobility[body, 0] > 0.0:
                        give_way(
                            yielded[body],
                            mobility[body],
                            contacts.arm[i, f],
                            -more * normal[0],
                            -more * normal[1],
                            -more * normal[2],
                        )
                    for c in range(3):
                        velocity[i, c] += more * inverse_mass[i] * normal[c]
        sweep += 1
        error *= dt / n
        if sweep >= least_sweeps and error < tolerance:
            break
    return sweep, error


@njit(cache=True, fastmath=True)
def apply_impulses(
    impulse: FloatArray,
    velocity: FloatArray,
    inverse_mass: FloatArray,
    neighbours: Neighbours,
    steepness: FloatArray,
) -> None:
    """Add to the velocities what the pressure impulses do; arguments as in ``solve_pressure``."""
    for i in range(len(velocity)):
        if impulse[i] > 0.0:
            _apply(i, impulse[i], velocity, inverse_mass, neighbours, steepness)


@njit(cache=True, fastmath=True, inline="always")
def _apply(
    i: int,
    kappa: float,
    velocity: FloatArray,
    inverse_mass: FloatArray,
    neighbours: Neighbours,
    steepness: FloatArray,
) -> None:
    start, end, other, gradient, _ = neighbours
    own = kappa * inverse_mass[i]
    velocity[i, 0] -= own * steepness[i, 0]
    velocity[i, 1] -= own * steepness[i, 1]
    velocity[i, 2] -= own * steepness[i, 2]
    for p in range(start[i], end[i]):
        j = other[p]
        theirs = kappa * inverse_mass[j]
        velocity[j, 0] += theirs * gradient[p, 0]
        velocity[j, 1] += theirs * gradient[p, 1]
        velocity[j, 2] += theirs * gradient[p, 2]
