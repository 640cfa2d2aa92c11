"""The solids of a rigid shape that consists of several things, as flat arrays for kernels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from prolepsis.fluents.shapes_in_time import Part
from prolepsis.geometry.faces import Solids
from prolepsis.geometry.rotations import from_axes
from prolepsis.geometry.signed_distance import placed


def assembled(parts: Sequence[Part], *, plugged: bool = False) -> Solids:
    """Return the union of parts in the frame of their body.

    Args:
        parts: The parts.
        plugged: Whether holes that are drilled through them are left out.
    """
    shapes = [replace(part.shape, holes=()) if plugged else part.shape for part in parts]
    poses = [np.array([*part.displacement, *from_axes(part.rotation)]) for part in parts]
    return placed(list(zip(shapes, poses, strict=True)))
