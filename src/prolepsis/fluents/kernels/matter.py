"""The solids of a rigid shape that consists of several things, as flat arrays for kernels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from prolepsis.fields.faces import Solids
from prolepsis.fields.signed_distance import solids_as_arrays
from prolepsis.fluents.shapes_in_time import Part


def assembled(parts: Sequence[Part], *, plugged: bool = False) -> Solids:
    """Return the union of parts in the frame of their body.

    Args:
        parts: The parts.
        plugged: Whether holes that are drilled through them are left out.
    """
    rows: list[Solids] = []
    end = 0
    for part in parts:
        shape = replace(part.shape, holes=()) if plugged else part.shape
        solids = solids_as_arrays(shape)
        frame = np.empty_like(solids.frame)
        frame[:, :3] = solids.frame[:, :3] @ part.turn.T + part.shift
        frame[:, 3:] = (part.turn @ solids.frame[:, 3:].reshape(-1, 3, 3)).reshape(-1, 9)
        span = solids.span.copy()
        span[:, [0, 2]] += end
        end += len(solids.numbers)
        rows.append(Solids(kind=solids.kind, frame=frame, size=solids.size, span=span, numbers=solids.numbers))
    return Solids(
        kind=np.concatenate([row.kind for row in rows]),
        frame=np.concatenate([row.frame for row in rows]),
        size=np.concatenate([row.size for row in rows]),
        span=np.concatenate([row.span for row in rows]),
        numbers=np.concatenate([row.numbers for row in rows]),
    )
