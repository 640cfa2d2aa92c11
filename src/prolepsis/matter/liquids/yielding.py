"""Bodies that yield: a light one gives way to the liquid within a step, or each would answer the other's last push.

What a body will do is known from how it moved last, which the last push of the liquid is part of. Within a step it
changes its velocity by what the push differs from that one: nothing when both are in balance.
"""

from __future__ import annotations

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.system.kernels import njit


@njit(cache=True, inline="always")
def give_way(yielded: FloatArray, mobility: FloatArray, arm: FloatArray, size: float, normal: FloatArray) -> None:
    """Change a body's velocity and spin, shape (6,), by an impulse [N s] along ``normal`` at the end of ``arm``."""
    x, y, z = size * normal[0], size * normal[1], size * normal[2]
    yielded[0] += mobility[0] * x
    yielded[1] += mobility[0] * y
    yielded[2] += mobility[0] * z
    tx, ty, tz = arm[1] * z - arm[2] * y, arm[2] * x - arm[0] * z, arm[0] * y - arm[1] * x
    give_spin(yielded, mobility, tx, ty, tz)


@njit(cache=True, inline="always")
def give_spin(yielded: FloatArray, mobility: FloatArray, tx: float, ty: float, tz: float) -> None:
    """Change a body's spin by an angular impulse [N m s]."""
    yielded[3] += mobility[1] * tx + mobility[2] * ty + mobility[3] * tz
    yielded[4] += mobility[4] * tx + mobility[5] * ty + mobility[6] * tz
    yielded[5] += mobility[7] * tx + mobility[8] * ty + mobility[9] * tz


@njit(cache=True, inline="always")
def along(yielded: FloatArray, arm: FloatArray, normal: FloatArray) -> float:
    """Return the speed along ``normal`` with which a place on the body has given way [m/s]."""
    x = yielded[0] + yielded[4] * arm[2] - yielded[5] * arm[1]
    y = yielded[1] + yielded[5] * arm[0] - yielded[3] * arm[2]
    z = yielded[2] + yielded[3] * arm[1] - yielded[4] * arm[0]
    return normal[0] * x + normal[1] * y + normal[2] * z


@njit(cache=True, inline="always")
def softness(mobility: FloatArray, arm: FloatArray, normal: FloatArray) -> float:
    """Return the speed along ``normal`` that a unit impulse along it gives to a place on the body [1/kg]."""
    tx = arm[1] * normal[2] - arm[2] * normal[1]
    ty = arm[2] * normal[0] - arm[0] * normal[2]
    tz = arm[0] * normal[1] - arm[1] * normal[0]
    spun = tx * (mobility[1] * tx + mobility[2] * ty + mobility[3] * tz)
    spun += ty * (mobility[4] * tx + mobility[5] * ty + mobility[6] * tz)
    spun += tz * (mobility[7] * tx + mobility[8] * ty + mobility[9] * tz)
    return mobility[0] + spun


@njit(cache=True)
def response(mobility: FloatArray, wrench: FloatArray) -> FloatArray:
    """Return the changes of velocity and spin by impulses and their moments about the centres of mass, shape (B, 6)."""
    made = np.zeros_like(wrench)
    for b in range(len(wrench)):
        w = wrench[b]
        made[b, :3] = mobility[b, 0] * w[:3]
        give_spin(made[b], mobility[b], w[3], w[4], w[5])
    return made


@njit(cache=True)
def about(centre: FloatArray, wrench: FloatArray) -> FloatArray:
    """Return impulses and moments about the world's origin with the moments about ``centre``, shape (B, 6)."""
    moved = wrench.copy()
    for b in range(len(wrench)):
        c, push = centre[b], wrench[b]
        moved[b, 3] -= c[1] * push[2] - c[2] * push[1]
        moved[b, 4] -= c[2] * push[0] - c[0] * push[2]
        moved[b, 5] -= c[0] * push[1] - c[1] * push[0]
    return moved
