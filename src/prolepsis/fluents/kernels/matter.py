"""The solids of a rigid shape that consists of several things, as flat arrays for kernels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from prolepsis.fluents.shapes_in_time import Part
from prolepsis.geometry.faces import Solids
from prolepsis.geometry.signed_distance import solids_as_arrays, union_of


def assembled(parts: Sequence[Part], *, plugged: bool = False) -> Solids:
    """Return the union of parts in the frame of their body.

    Args:
        parts: The parts.
        plugged: Whether holes that are drilled through them are left out.
    """
    return union_of([_in_body_frame(part, plugged=plugged) for part in parts])


def _in_body_frame(part: Part, *, plugged: bool) -> Solids:
    solids = solids_as_arrays(replace(part.shape, holes=()) if plugged else part.shape)
    frame = np.empty_like(solids.frame)
    frame[:, :3] = solids.frame[:, :3] @ part.rotation.T + part.displacement
    frame[:, 3:] = (part.rotation @ solids.frame[:, 3:].reshape(-1, 3, 3)).reshape(-1, 9)
    return solids._replace(frame=frame)
