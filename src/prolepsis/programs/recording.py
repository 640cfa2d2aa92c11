"""A recorded stream: where a gripper was, or should have been, over time, read from a CSV or Parquet file."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np
import pyarrow as arrow  # pyright: ignore[reportMissingTypeStubs]
import pyarrow.csv as csv  # pyright: ignore[reportMissingTypeStubs]
import pyarrow.parquet as parquet  # pyright: ignore[reportMissingTypeStubs]

from prolepsis.geometry.rotations import turned
from prolepsis.geometry.shape import FloatArray
from prolepsis.system.text_files import read_bytes
from prolepsis.terms.errors import PlanError, UnknownNameError

LONGEST_GAP = 0.2
"""Two rows may be this far apart [s]: in a longer time a hand does what no row tells."""
LEAST_ROWS = 2
LONGEST = 600.0
"""Longest recording [s]: ten minutes of handling; a longer one is cut in pieces."""
MOST_ROWS, MOST_COLUMNS = 600_001, 200
"""A row a millisecond, as fast as the simulation."""
MOST_BYTES = 256 * 2**20
"""Largest file."""
GREATEST = 1.0e6
"""Greatest number: nothing here is a million metres, newtons or turns away."""
_COLUMN = re.compile(r"[\w ./-]{1,60}")
UNIT_ERROR = 0.01
"""The norm of a quaternion may differ from 1 by this: its numbers are rounded."""
POSITION, DISPLACEMENT = ("x", "y", "z"), ("dx", "dy", "dz")
QUATERNION, ANGLES = ("qw", "qx", "qy", "qz"), ("yaw", "pitch", "roll")
GROUPS = (POSITION, DISPLACEMENT, QUATERNION, ANGLES)
"""Columns of which a file has all or none."""
OTHERS = ("time", "opening", "force")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Recording:
    """What a recorded stream tells; None for what it does not."""

    path: Path
    """The file."""
    time: FloatArray
    """[s], shape (n,), rising, 0 at the first row."""
    positions: FloatArray | None = None
    """Of the gripper's frame in the world [m], shape (n, 3)."""
    displacements: FloatArray | None = None
    """Of the gripper's frame from where it is when the replay begins, world axes [m], shape (n, 3)."""
    orientations: FloatArray | None = None
    """Of the gripper's frame in the world, unit quaternions (w, x, y, z), shape (n, 4)."""
    openings: FloatArray | None = None
    """Gap between the pads [m], shape (n,)."""
    forces: FloatArray | None = None
    """Force of each pad [N], 0 where nothing is gripped, shape (n,)."""
    joints: Mapping[str, FloatArray]
    """Coordinates of the arm's joints [rad or m], each shape (n,)."""

    def row(self, k: int) -> str:
        """Return how messages name the row ``k``."""
        return f"{self.path.name}: row {k + 1} ({self.time[k]:.4g} s)"


def read_recording(path: Path, joints: Collection[str]) -> Recording:
    """Return the stream in a file.

    Args:
        path: CSV with a line of column names, or Parquet.
        joints: Names of the joints that columns may be named after.

    Raises:
        PlanError: If the file cannot be read, has holes or times that do not rise, or lacks columns.
        UnknownNameError: If a column is neither of those that are known nor a joint.
    """
    columns = _columns(path)
    known = (*OTHERS, *(name for group in GROUPS for name in group), *joints)
    for name in columns:
        if name not in known:
            if not _COLUMN.fullmatch(name):
                raise PlanError(f"{path.name}: there is a column {_shown(name)}; known: {', '.join(known[:20])}")
            raise UnknownNameError.of("column or joint", name, known, path.name)
    if "time" not in columns:
        raise PlanError(f"{path.name}: there is no column time [s]")
    time = columns["time"]
    _refuse_holes(path, columns, time)
    groups = {group: _group(path, columns, group) for group in GROUPS}
    driven = {name: columns[name] for name in joints if name in columns}
    given = [", ".join(group) for group in (POSITION, DISPLACEMENT) if groups[group] is not None]
    given += [", ".join(driven)] if driven else []
    if len(given) != 1:
        raise PlanError(
            f"{path.name}: one of x, y, z or dx, dy, dz or the arm's joints must tell where the hand is; "
            f"given: {' and '.join(given) or 'none'}"
        )
    if driven and len(driven) < len(joints):
        missing = next(name for name in joints if name not in driven)
        raise PlanError(
            f"{path.name}: there is no column {missing}; needed: all joints of the arm, {', '.join(joints)}"
        )
    if driven and (groups[QUATERNION] is not None or groups[ANGLES] is not None):
        raise PlanError(
            f"{path.name}: joints and an orientation are both given; the joints tell how the hand is turned"
        )
    return Recording(
        path=path,
        time=time - time[0],
        positions=groups[POSITION],
        displacements=groups[DISPLACEMENT],
        orientations=_orientations(path, groups[QUATERNION], groups[ANGLES]),
        openings=columns.get("opening"),
        forces=columns.get("force"),
        joints=driven,
    )


def _columns(path: Path) -> dict[str, FloatArray]:
    """Return the columns of a file as numbers, empty cells as NaN."""
    known = cast(Any, arrow)
    content = known.BufferReader(read_bytes(path, "recording", most=MOST_BYTES, error=PlanError, called=path.name))
    try:
        table: Any = _parquet(path, content) if path.suffix == ".parquet" else cast(Any, csv).read_csv(content)
        names = [str(name).strip() for name in table.column_names]
    except (OSError, UnicodeError, known.ArrowException) as error:
        raise PlanError(f"{path.name}: cannot read the recording: {_reason(str(error))}") from None
    twice = next((name for k, name in enumerate(names) if name in names[:k]), None)
    if twice is not None:
        raise PlanError(f"{path.name}: column {_shown(twice)} is there twice")
    _refuse_large(path, table.num_rows, len(names))
    columns: dict[str, FloatArray] = {}
    for k, name in enumerate(names):
        try:
            column: Any = table.column(k).cast(known.float64()).to_numpy()
        except (known.ArrowInvalid, known.ArrowNotImplementedError):
            raise PlanError(f"{path.name}: column {_shown(name)} holds something that is no number") from None
        columns[name] = np.array(column, dtype=np.float64)
    return columns


def _parquet(path: Path, content: Any) -> Any:
    """Return the table in a Parquet file, whose size it tells before anything is unpacked."""
    file = cast(Any, parquet).ParquetFile(content)
    _refuse_large(path, file.metadata.num_rows, file.metadata.num_columns)
    for field in file.schema_arrow:
        kinds = cast(Any, arrow).types
        if not (kinds.is_integer(field.type) or kinds.is_floating(field.type)):
            raise PlanError(f"{path.name}: column {_shown(str(field.name))} holds something that is no number")
    return file.read()


def _refuse_large(path: Path, rows: int, columns: int) -> None:
    if rows > MOST_ROWS or columns > MOST_COLUMNS:
        raise PlanError(
            f"{path.name}: {rows} rows of {columns} columns; allowed: {MOST_ROWS} rows, {MOST_COLUMNS} columns"
        )


def _reason(message: str) -> str:
    """Return what is wrong with a file that cannot be read, without what stands in it."""
    counts = re.search(r"Expected \d+ columns, got \d+", message)
    return counts.group().lower() if counts else "it is no table of numbers under a line of names"


def _shown(name: str) -> str:
    """Return a column's name, or that it is none: the file may be any."""
    return name if _COLUMN.fullmatch(name) else "with a name that cannot be one"


def _refuse_holes(path: Path, columns: Mapping[str, FloatArray], time: FloatArray) -> None:
    """Refuse streams that leave open where the hand was."""
    if len(time) < LEAST_ROWS:
        raise PlanError(f"{path.name}: {len(time)} rows; at least {LEAST_ROWS} are needed")
    for name, values in columns.items():
        wrong = np.flatnonzero(~np.isfinite(values))
        if len(wrong):
            raise PlanError(f"{path.name}: row {wrong[0] + 1}: {name} is no finite number")
        with np.errstate(over="ignore"):
            huge = np.flatnonzero(np.abs(values - (time[0] if name == "time" else 0.0)) > GREATEST)
        if len(huge):
            k = int(huge[0])
            raise PlanError(f"{path.name}: row {k + 1}: {name} is {values[k]:.4g}; allowed: up to {GREATEST:g}")
    if time[-1] - time[0] > LONGEST:
        raise PlanError(f"{path.name}: the recording lasts {time[-1] - time[0]:.6g} s; allowed {LONGEST:g} s")
    steps = np.diff(time)
    back, wide = np.flatnonzero(steps <= 0.0), np.flatnonzero(steps > LONGEST_GAP + 1e-9)
    if len(back):
        k = int(back[0])
        raise PlanError(f"{path.name}: row {k + 2}: time does not rise: {time[k + 1]:g} s after {time[k]:g} s")
    if len(wide):
        k = int(wide[0])
        raise PlanError(
            f"{path.name}: a gap of {steps[k]:.3g} s from {time[k]:g} s to {time[k + 1]:g} s; allowed {LONGEST_GAP:g} s"
        )


def _group(path: Path, columns: Mapping[str, FloatArray], group: tuple[str, ...]) -> FloatArray | None:
    """Return columns that belong together, shape (n, k), or None if there are none."""
    there = [name for name in group if name in columns]
    if not there:
        return None
    if len(there) < len(group):
        missing = next(name for name in group if name not in columns)
        raise PlanError(
            f"{path.name}: there is {there[0]} but no {missing}; needed: {', '.join(group)} or none of them"
        )
    return np.stack([columns[name] for name in group], axis=1)


def _orientations(path: Path, quaternions: FloatArray | None, angles: FloatArray | None) -> FloatArray | None:
    """Return unit quaternions, of which each is the nearer one to that before it."""
    if quaternions is not None and angles is not None:
        raise PlanError(f"{path.name}: {', '.join(QUATERNION)} and {', '.join(ANGLES)} are both given; one is enough")
    if angles is not None:
        level = (1.0, 0.0, 0.0, 0.0)
        quaternions = np.array([turned(level, (float(y), float(p), float(r))) for y, p, r in angles])
    if quaternions is None:
        return None
    norms = np.linalg.norm(quaternions, axis=1)
    wrong = np.flatnonzero(np.abs(norms - 1.0) > UNIT_ERROR)
    if len(wrong):
        raise PlanError(f"{path.name}: row {wrong[0] + 1}: the quaternion's norm is {norms[wrong[0]]:.4g}, not 1")
    units = quaternions / norms[:, None]
    signs = np.where((units[1:] * units[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)
    units[1:] *= np.cumprod(signs)[:, None]
    return units
