"""Pressure: the impulses that keep the liquid's volume, found row by row.

The kernel sum of a particle may not rise above one. Each particle has a pressure impulse, never negative, that acts
along the gradient of its own sum, on its neighbours, and on the walls it sees; Gauss-Seidel sweeps, up and down in
turn, find those that are needed. The impulses of the last step are the first guess. Pair impulses are equal and
opposite, so momentum is kept exactly.

What is too dense already is moved apart without any velocity, or it would get energy from nothing, and with it what
floats in it.
"""

from __future__ import annotations

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.matter.liquids.neighbours import Neighbours
from prolepsis.matter.liquids.walls import REST_DISTANCE, WallContacts
from prolepsis.matter.liquids.yielding import along, give_way, softness
from prolepsis.system.kernels import njit

CORRECTION = 0.2
"""Share of a compression that one step takes back, and of a gap under pressure that it closes [1]."""
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
    contacts: WallContacts,
    impulse: FloatArray,
    push: FloatArray,
    pressed: FloatArray,
    mobility: FloatArray,
    yielded: FloatArray,
    correcting: bool,
    spacing: float,
    dt: float,
    tolerance: float,
    least_sweeps: int,
    most_sweeps: int,
) -> tuple[int, float]:
    """Change the velocities such that nothing is compressed, and return the sweeps and the remaining compression.

    What is compressed already may stay so: to press it apart would give it energy. If ``correcting``, the velocities
    are those with which the particles move on, and do not keep, and take some of it back; no body yields to that.

    Args:
        velocity: [m/s], shape (n, 3).
        inverse_mass: [1/kg], shape (n,).
        neighbours: The neighbours of each.
        steepness: Gradient of each particle's kernel sum, walls included [1/m], shape (n, 3).
        density: Kernel sum with walls and air [1], shape (n,).
        contacts: What each particle sees of the walls.
        impulse: Pressure impulses; in: first guess, which the velocities contain, out: result [N s m], shape (n,).
        push: Impulses of the walls' surfaces, in and out alike [N s], shape (n, SEEN).
        pressed: Their sum for each particle, out [N s], shape (n, 3).
        mobility: Of the bodies, shape (B, 10).
        yielded: By how much their velocity and spin differ from the walls', changed, shape (B, 6).
        correcting: Whether what is compressed is taken apart.
        spacing: [m].
        dt: [s].
        tolerance: Mean compression per step at which the sweeps end [1].
        least_sweeps: At least so many.
        most_sweeps: At most so many.
    """
    n = len(velocity)
    # Arrays of their own: to fetch one from a tuple, or a row as a view, costs as much as a neighbour.
    start, end, other, gradient, _, _ = neighbours
    seen, bodies, distance, _, normal, wall, arm, _, slope, _ = contacts
    least, taken_back = REST_DISTANCE * spacing, CORRECTION if correcting else 0.0
    # Own part of each row: liquid alone, for what the neighbours' velocities are compared with.
    own, wanted, inverse = np.empty((n, 3)), np.empty(n), np.empty(n)
    for i in range(n):
        kappa = impulse[i]
        sx, sy, sz = steepness[i, 0], steepness[i, 1], steepness[i, 2]
        diagonal = (sx * sx + sy * sy + sz * sz) * inverse_mass[i]
        for f in range(seen[i]):
            nx, ny, nz, k = normal[i, f, 0], normal[i, f, 1], normal[i, f, 2], slope[i, f]
            if not correcting and mobility[bodies[i, f], 0] > 0.0:
                diagonal += k * k * softness(mobility[bodies[i, f]], arm[i, f], normal[i, f])
            sx -= k * nx
            sy -= k * ny
            sz -= k * nz
        own[i, 0], own[i, 1], own[i, 2] = sx, sy, sz
        for p in range(start[i], end[i]):
            gx, gy, gz = gradient[p, 0], gradient[p, 1], gradient[p, 2]
            diagonal += (gx * gx + gy * gy + gz * gz) * inverse_mass[other[p]]
        inverse[i] = 1.0 / max(diagonal, 1e-300)
        excess = density[i] - 1.0
        if excess > 0.0:
            wanted[i] = min(taken_back * excess, GREATEST_CORRECTION) / dt
        else:
            # A gap may close at once; in a liquid under pressure it does so gently.
            wanted[i] = (CORRECTION if kappa > 0.0 else 1.0) * excess / dt
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
            for f in range(seen[i]):
                closing = (
                    normal[i, f, 0] * (vx - wall[i, f, 0])
                    + normal[i, f, 1] * (vy - wall[i, f, 1])
                    + normal[i, f, 2] * (vz - wall[i, f, 2])
                )
                if mobility[bodies[i, f], 0] > 0.0:
                    closing -= along(yielded[bodies[i, f]], arm[i, f], normal[i, f])
                residual += slope[i, f] * closing
            if residual > 0.0:
                error += residual
            elif impulse[i] > 0.0:
                # What presses without need would throw the liquid apart.
                error -= max(residual, -impulse[i] / inverse[i])
            change = max(residual * inverse[i], -impulse[i])
            # Rows that are good enough need not disturb their neighbours.
            if abs(residual) > negligible and change != 0.0:
                impulse[i] += change
                mine = change * inverse_mass[i]
                velocity[i, 0] -= mine * steepness[i, 0]
                velocity[i, 1] -= mine * steepness[i, 1]
                velocity[i, 2] -= mine * steepness[i, 2]
                for p in range(start[i], end[i]):
                    j = other[p]
                    theirs = change * inverse_mass[j]
                    velocity[j, 0] += theirs * gradient[p, 0]
                    velocity[j, 1] += theirs * gradient[p, 1]
                    velocity[j, 2] += theirs * gradient[p, 2]
                for f in range(seen[i]):
                    body = bodies[i, f]
                    if not correcting and mobility[body, 0] > 0.0:
                        give_way(yielded[body], mobility[body], arm[i, f], change * slope[i, f], normal[i, f])
            for f in range(seen[i]):
                gap = distance[i, f] - least
                if gap > spacing:
                    continue
                nx, ny, nz = normal[i, f, 0], normal[i, f, 1], normal[i, f, 2]
                closing = (
                    nx * (velocity[i, 0] - wall[i, f, 0])
                    + ny * (velocity[i, 1] - wall[i, f, 1])
                    + nz * (velocity[i, 2] - wall[i, f, 2])
                )
                limit = -gap / dt if gap > 0.0 else -taken_back * gap / dt
                body, soft = bodies[i, f], inverse_mass[i]
                if mobility[body, 0] > 0.0:
                    closing -= along(yielded[body], arm[i, f], normal[i, f])
                    soft += 0.0 if correcting else softness(mobility[body], arm[i, f], normal[i, f])
                more = max((limit - closing) / soft, -push[i, f])
                if more != 0.0:
                    push[i, f] += more
                    if not correcting and mobility[body, 0] > 0.0:
                        give_way(yielded[body], mobility[body], arm[i, f], -more, normal[i, f])
                    mine = more * inverse_mass[i]
                    velocity[i, 0] += mine * nx
                    velocity[i, 1] += mine * ny
                    velocity[i, 2] += mine * nz
        sweep += 1
        error *= dt / n
        if sweep >= least_sweeps and error < tolerance:
            break
    for i in range(n):
        for c in range(3):
            pressed[i, c] = 0.0
            for f in range(seen[i]):
                pressed[i, c] += push[i, f] * normal[i, f, c]
    return sweep, error


@njit(cache=True, fastmath=True)
def apply_impulses(
    impulse: FloatArray,
    pressed: FloatArray,
    velocity: FloatArray,
    inverse_mass: FloatArray,
    neighbours: Neighbours,
    steepness: FloatArray,
    contacts: WallContacts,
    spacing: float,
    push: FloatArray,
) -> None:
    """Add to the velocities what the impulses of the last step would do in this one.

    Args:
        impulse: Pressure impulses [N s m], shape (n,).
        pressed: Impulse of all walls' surfaces on each particle [N s], shape (n, 3).
        velocity: As in ``solve_pressure``; so are those that follow.
        inverse_mass: ..
        neighbours: ..
        steepness: ..
        contacts: ..
        spacing: ..
        push: What the surfaces that are near have of ``pressed``, out [N s], shape (n, SEEN).
    """
    start, end, other, gradient, _, _ = neighbours
    seen, _, distance, _, normal, _, _, _, _, _ = contacts
    for i in range(len(velocity)):
        px, py, pz = pressed[i, 0], pressed[i, 1], pressed[i, 2]
        for f in range(seen[i]):
            nx, ny, nz = normal[i, f, 0], normal[i, f, 1], normal[i, f, 2]
            size = max(px * nx + py * ny + pz * nz, 0.0) if distance[i, f] < spacing else 0.0
            push[i, f] = size
            px, py, pz = px - size * nx, py - size * ny, pz - size * nz
            velocity[i, 0] += size * inverse_mass[i] * nx
            velocity[i, 1] += size * inverse_mass[i] * ny
            velocity[i, 2] += size * inverse_mass[i] * nz
        if impulse[i] <= 0.0:
            continue
        mine = impulse[i] * inverse_mass[i]
        velocity[i, 0] -= mine * steepness[i, 0]
        velocity[i, 1] -= mine * steepness[i, 1]
        velocity[i, 2] -= mine * steepness[i, 2]
        for p in range(start[i], end[i]):
            j = other[p]
            theirs = impulse[i] * inverse_mass[j]
            velocity[j, 0] += theirs * gradient[p, 0]
            velocity[j, 1] += theirs * gradient[p, 1]
            velocity[j, 2] += theirs * gradient[p, 2]
