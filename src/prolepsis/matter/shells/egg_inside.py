"""What an egg has inside: the particles of yolk and white, the yolk in the middle, until the shell opens."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.geometry.solids import matrix
from prolepsis.log.things import Thing
from prolepsis.matter.liquids.packing import lattice
from prolepsis.scene.scene import Pool
from prolepsis.terms.errors import KnowledgeError

PARTICLES = 400
"""Particles of an egg in a scene without another liquid: some 5 mm apart."""
CLOSEST = 0.7
"""Least distance of particles over the spacing [1]: more than an egg holds is refused."""
FINER = 0.98
"""Step by which the lattice is made finer [1]."""


def egg_pools(
    egg: Thing, stuffs: Sequence[Thing], spacing: float | None, particles: int = PARTICLES
) -> tuple[tuple[Thing, ...], tuple[Pool, ...]]:
    """Return the stuffs of an egg with their volumes, and their particles.

    Args:
        egg: The egg at its place.
        stuffs: What is inside, from the middle outwards.
        spacing: That of the other liquids of the scene [m], if there are any.
        particles: Else the number of particles of this egg.

    Raises:
        KnowledgeError: If there is more than the egg holds.
    """
    if not stuffs:
        return (), ()
    volumes = [stuff.mass / stuff.quantities["density"] for stuff in stuffs]
    apart = float(np.cbrt(sum(volumes) / particles)) if spacing is None else spacing
    counts = [max(round(volume / apart**3), 1) for volume in volumes]
    points = _packed(np.asarray(egg.shape.geoms[0].size), sum(counts), apart)
    if points is None:
        raise KnowledgeError(
            f"{egg.name} is too small for {1e6 * sum(volumes):.3g} ml of {' and '.join(stuff.name for stuff in stuffs)}"
        )
    world = np.asarray(egg.position) + points @ matrix(np.asarray(egg.orientation)).T
    made: list[Thing] = []
    pools: list[Pool] = []
    start = 0
    for stuff, volume, count in zip(stuffs, volumes, counts, strict=True):
        made.append(replace(stuff, quantities={**stuff.quantities, "volume": volume}))
        chosen = world[start : start + count]
        pools.append(Pool(stuff=stuff.name, position=chosen, spacing=apart, holder=egg.name))
        start += count
    return tuple(made), tuple(pools)


def _packed(semi_axes: FloatArray, count: int, spacing: float) -> FloatArray | None:
    """Return ``count`` lattice points within an ellipsoid, the nearest to its middle first, shape (count, 3)."""
    step = spacing
    while step > CLOSEST * spacing:
        high = np.floor(semi_axes / step) * step
        points = lattice(-high, high, step)
        inside = np.linalg.norm(points / semi_axes, axis=1) <= 1
        if inside.sum() >= count:
            # The yolk is a ball in the middle; round it, all is filled alike.
            layer = np.linalg.norm(points / semi_axes, axis=1)
            points = points[np.argsort(layer, kind="stable")[:count]]
            return points[np.argsort(np.linalg.norm(points, axis=1), kind="stable")]
        step *= FINER
    return None
