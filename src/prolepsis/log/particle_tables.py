"""The particles of a log as columns: positions in whole hundredths of a millimetre, which pack into a byte or two.

A solver's positions carry far more digits than the resolution of a particle liquid means, and digits are what a
file is made of. So the recorder rounds them (``rounded``), once, and a log comes back from its file as it was.
Positions of other origin that are not so rounded are kept as they are, in larger files.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from prolepsis.geometry.shape import IntArray
from prolepsis.log.checks import check_rows
from prolepsis.log.log import PARKED, Particles

STEP = 1e-5
"""What recorded positions are whole multiples of [m]: a hundredth of a millimetre, some 1/500 of a particle."""

Column = npt.NDArray[Any]
_AXES = ("x", "y", "z")
_WHOLE_AXES = tuple(f"{axis}_in_10_um" for axis in _AXES)

FRAMES: Mapping[str, str] = {"tick": "int64"}
KINDS: Mapping[str, str] = {"stuff": "int64", "mass": "double", "volume": "double"}
_KEYS = {"particle": "int64", "holder": "int16"}
WHOLE_POSITIONS: Mapping[str, str] = {**_KEYS, **dict.fromkeys(_WHOLE_AXES, "int32")}
FINE_POSITIONS: Mapping[str, str] = {**_KEYS, **dict.fromkeys(_AXES, "float")}
"""What the columns of the tables consist of, as ``log_tables`` has it."""


def rounded(position: npt.NDArray[np.floating[Any]]) -> npt.NDArray[np.float32]:
    """Return positions [m] rounded to ``STEP``, of any shape."""
    return (np.rint(position.astype(np.float64) / STEP) * STEP).astype(np.float32)


def frame_columns(particles: Particles) -> Mapping[str, Column]:
    """Return the ticks of the frames as a column."""
    return {"tick": particles.tick}


def kind_columns(particles: Particles) -> Mapping[str, Column]:
    """Return what stays the same of each particle as columns."""
    return {"stuff": particles.stuff, "mass": particles.mass, "volume": particles.volume}


def position_columns(particles: Particles) -> Mapping[str, Column]:
    """Return positions and holders as long columns: all frames of particle 0, then of particle 1 ..."""
    frames, count, _ = particles.position.shape
    number: IntArray = np.arange(count, dtype=np.int64).repeat(frames)
    by_particle = particles.position.transpose(1, 0, 2).reshape(count * frames, 3)
    holder = particles.holder.T.reshape(-1)
    keys: dict[str, Column] = {"particle": number, "holder": holder}
    whole = _whole(by_particle)
    if whole is None:
        return keys | {axis: by_particle[:, i] for i, axis in enumerate(_AXES)}
    return keys | {axis: whole[:, i] for i, axis in enumerate(_WHOLE_AXES)}


def own_columns(particles: Particles) -> Mapping[str, Column]:
    """Return what kinds of matter know beside as long columns, in the order of ``position_columns``."""
    return {name: column.T.reshape(-1) for name, column in sorted(particles.columns.items())}


def position_kinds(columns: Mapping[str, Column]) -> Mapping[str, str]:
    """Return what the columns of ``position_columns`` consist of."""
    return WHOLE_POSITIONS if _WHOLE_AXES[0] in columns else FINE_POSITIONS


def particles_from(
    frames: Mapping[str, Column],
    kinds: Mapping[str, Column],
    positions: Mapping[str, Column],
    own: Mapping[str, Column],
    *,
    spacing: float,
    thing_count: int,
    tick_count: int,
) -> Particles:
    """Return the particles whose columns these are.

    Raises:
        ValueError: If they do not fit each other or the log.
    """
    tick, stuff = frames["tick"], kinds["stuff"]
    shape = len(stuff), len(tick)
    check_rows("particles", "particle", positions["particle"], *shape)
    for name, column in own.items():
        if len(column) != len(positions["particle"]):
            raise ValueError(f"particles: {name} has {len(column)} rows, their places {len(positions['particle'])}")
    if _WHOLE_AXES[0] in positions:
        whole = np.stack([positions[axis] for axis in _WHOLE_AXES], axis=-1)
        by_particle = (whole * STEP).astype(np.float32)
    else:
        by_particle = np.stack([positions[axis] for axis in _AXES], axis=-1).astype(np.float32)
    holder = positions["holder"].reshape(shape)
    if len(tick) and (tick[0] < 0 or tick[-1] >= tick_count or (np.diff(tick) <= 0).any()):
        raise ValueError("the frames of the particles are not at ascending ticks of the log")
    if len(stuff) and not (stuff.min() >= 0 and stuff.max() < thing_count):
        raise ValueError("a particle is of a stuff that is no thing of the log")
    if holder.size and not (holder.min() >= PARKED and holder.max() < thing_count):
        raise ValueError("a particle is held by what is no thing of the log")
    return Particles(
        tick=tick,
        position=np.ascontiguousarray(by_particle.reshape(*shape, 3).transpose(1, 0, 2)),
        holder=np.ascontiguousarray(holder.T, dtype=np.int16),
        stuff=stuff,
        mass=kinds["mass"],
        volume=kinds["volume"],
        columns={name: np.ascontiguousarray(column.reshape(shape).T, dtype=np.float32) for name, column in own.items()},
        spacing=spacing,
    )


def _whole(positions: npt.NDArray[np.float32]) -> npt.NDArray[np.int32] | None:
    """Return positions as multiples of ``STEP``, or None if not all of them are."""
    steps = np.rint(positions.astype(np.float64) / STEP)
    # Not finite, or too far away, counts as not whole.
    if not (np.abs(steps) < 2**31 - 1).all():
        return None
    return steps.astype(np.int32) if ((steps * STEP).astype(np.float32) == positions).all() else None
