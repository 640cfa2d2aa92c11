"""The columns of a log as Parquet tables: floats split into byte streams, zstd, a checksum on every page."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pyarrow as arrow  # pyright: ignore[reportMissingTypeStubs]
import pyarrow.parquet as parquet  # pyright: ignore[reportMissingTypeStubs]

from prolepsis.errors import LogError
from prolepsis.log import Bonds, Contacts, Detachments
from prolepsis.things import FloatArray, IntArray

Columns = Mapping[str, npt.NDArray[Any]]

POSE_COLUMNS = ("x", "y", "z", "qw", "qx", "qy", "qz")


def write_table(file: Path, columns: Columns) -> None:
    """Write columns of equal length. Equal columns give equal bytes."""
    writer = cast(Any, parquet)
    table = cast(Any, arrow).table({name: np.ascontiguousarray(column) for name, column in columns.items()})
    floats = [name for name, column in columns.items() if column.dtype.kind == "f"]
    # Neighbours in a long column of 32-bit whole numbers differ by little.
    steps = [name for name, column in columns.items() if column.dtype == np.int32]
    writer.write_table(
        table,
        file,
        row_group_size=max(1, table.num_rows),
        compression="zstd",
        use_dictionary=[name for name in columns if name not in (*floats, *steps)],
        use_byte_stream_split=floats,
        column_encoding=dict.fromkeys(steps, "DELTA_BINARY_PACKED") or None,
        write_page_checksum=True,
        write_statistics=False,
        store_schema=False,
    )


def read_table(file: Path) -> dict[str, npt.NDArray[Any]]:
    """Return the columns of a table, its page checksums verified.

    Raises:
        LogError: If the file is no such table.
    """
    try:
        table = cast(Any, parquet).read_table(file, page_checksum_verification=True, use_threads=False)
    except (OSError, cast(Any, arrow).ArrowException) as error:
        raise LogError(f"{file}: cannot be read: {str(error).splitlines()[0]}") from None
    return {name: table.column(name).to_numpy() for name in table.column_names}


def pose_columns(poses: FloatArray, carrier: IntArray) -> Columns:
    """Return poses (T, n, 7) and carriers (T, n) as long columns: all ticks of thing 0, then of thing 1 ..."""
    ticks, things, _ = poses.shape
    by_thing = poses.transpose(1, 0, 2).reshape(things * ticks, 7)
    thing: IntArray = np.arange(things, dtype=np.int64).repeat(ticks)
    keys: dict[str, npt.NDArray[Any]] = {"thing": thing, "carrier": carrier.T.reshape(-1)}
    return {**keys, **{name: by_thing[:, i] for i, name in enumerate(POSE_COLUMNS)}}


def poses_from(columns: Columns, ticks: int, things: int) -> tuple[FloatArray, IntArray]:
    """Return poses (T, n, 7) and carriers (T, n) from long columns."""
    by_thing = np.stack([columns[name] for name in POSE_COLUMNS], axis=-1).reshape(things, ticks, 7)
    poses = np.ascontiguousarray(by_thing.transpose(1, 0, 2), dtype=np.float64)
    carrier = np.ascontiguousarray(columns["carrier"].reshape(things, ticks).T, dtype=np.int64)
    return poses, carrier


_VECTORS = ("force", "normal", "point")


def contact_columns(contacts: Contacts) -> Columns:
    """Return contacts as columns, vectors split into ``_x``, ``_y``, ``_z``."""
    vectors: dict[str, FloatArray] = {}
    for name in _VECTORS:
        vector: FloatArray = getattr(contacts, name)
        vectors |= {f"{name}_{axis}": vector[:, i] for i, axis in enumerate("xyz")}
    return {"tick": contacts.tick, "a": contacts.a, "b": contacts.b, **vectors, "peak": contacts.peak}


def contacts_from(columns: Columns) -> Contacts:
    """Return the contacts whose columns these are."""
    vectors = {name: np.stack([columns[f"{name}_{axis}"] for axis in "xyz"], axis=-1) for name in _VECTORS}
    return Contacts(tick=columns["tick"], a=columns["a"], b=columns["b"], peak=columns["peak"], **vectors)


def bond_columns(bonds: Bonds) -> Columns:
    """Return joints between things as columns."""
    return {"a": bonds.a, "b": bonds.b, "start": bonds.start, "end": bonds.end}


def bonds_from(columns: Columns) -> Bonds:
    """Return the joints whose columns these are."""
    return Bonds(a=columns["a"], b=columns["b"], start=columns["start"], end=columns["end"])


def detachment_columns(detached: Detachments) -> Columns:
    """Return broken joints as columns."""
    return {
        "tick": detached.tick,
        "thing": detached.thing,
        "a": detached.a,
        "b": detached.b,
        "force": detached.force,
    }


def detachments_from(columns: Columns) -> Detachments:
    """Return the broken joints whose columns these are."""
    return Detachments(
        tick=columns["tick"], thing=columns["thing"], a=columns["a"], b=columns["b"], force=columns["force"]
    )
