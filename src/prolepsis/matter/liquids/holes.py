"""Holes: the pressure of so few particles fades at a rim, so a liquid is given holes that are wider than they are.

What it sticks to is the hole's own wall: a thick liquid is not held less for that.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import replace

from prolepsis.geometry.shape import Shape
from prolepsis.geometry.signed_distance import Part, placed, union_of
from prolepsis.log.things import Thing
from prolepsis.matter.liquids.walls import Walls
from prolepsis.scenario.scenario import MOST_PARTICLES
from prolepsis.terms.errors import Note

RIM = 0.35
"""By how much the radius of a hole is smaller for the pressure than it is [spacings]: with it, the flow through a hole
does not hang on the spacing (docs/liquids.md)."""
NARROWEST = 1.5
"""Width of the narrowest hole through which the flow is known [spacings]; under it less flows, under one nothing."""


def walls_of(bodies: Sequence[Sequence[Part]], spacing: float) -> Walls:
    """Return the walls of bodies, each of some shapes, for a liquid of a spacing [m]."""
    wider = [[(_widened(shape, RIM * spacing), pose) for shape, pose in parts] for parts in bodies]
    return Walls(
        faces=union_of([placed(parts) for parts in wider]), surfaces=union_of([placed(parts) for parts in bodies])
    )


def stopped(bodies: Sequence[Sequence[Part]]) -> Walls:
    """Return the same with the holes stopped that are drilled through them."""
    return walls_of([[(replace(shape, holes=()), pose) for shape, pose in parts] for parts in bodies], 0.0)


def _widened(shape: Shape, by: float) -> Shape:
    return replace(shape, holes=tuple(replace(hole, radius=hole.radius + by) for hole in shape.holes))


def note_narrow(things: Iterable[Thing], spacing: float, count: int) -> None:
    """Note which holes are too narrow for particles of a spacing [m], of which the largest liquid has ``count``."""
    for thing in things:
        for radius in sorted({hole.radius for hole in thing.shape.holes}):
            wide = 2 * radius / spacing
            if wide < NARROWEST:
                enough = math.ceil(count * (NARROWEST / wide) ** 3)
                finer = f"use particles = {enough}" if enough <= MOST_PARTICLES else "no number of particles is enough"
                what = f"{thing.name}: its hole of {2e3 * radius:.3g} mm is {wide:.2g} particles wide"
                warnings.warn(f"{what}, through which less than is real flows, or nothing; {finer}", Note, 2)
