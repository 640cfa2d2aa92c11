"""The columns of a log as Parquet tables: floats split into byte streams, zstd, a checksum on every page."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pyarrow as arrow  # pyright: ignore[reportMissingTypeStubs]
import pyarrow.parquet as parquet  # pyright: ignore[reportMissingTypeStubs]

from prolepsis.geometry.shape import FloatArray, IntArray
from prolepsis.log import particle_tables
from prolepsis.log.checks import check_rows
from prolepsis.log.happenings import Happenings
from prolepsis.log.log import Contacts, Joints
from prolepsis.terms.errors import InputError, LogError, brief

Columns = Mapping[str, npt.NDArray[Any]]
Kinds = Mapping[str, str]
"""What each column of a table consists of."""

_TYPES: Mapping[str, type[np.generic]] = {
    "double": np.float64,
    "float": np.float32,
    "int64": np.int64,
    "int32": np.int32,
    "int16": np.int16,
}
"""What columns may consist of, as Parquet calls it."""
MOST_COLUMNS = 10_000
"""Of a table."""
MOST_BYTES = 2**30
"""Of all tables of a log together once they are unpacked; reading them takes about twice as much memory. The largest
example, 16 s of a PR2 that pours water, has 130 MB; an egg that is grasped has 35."""

POSE_COLUMNS = ("x", "y", "z", "qw", "qx", "qy", "qz")
_VECTORS = ("force", "normal", "point")
_TOUCHING = tuple(f"{name}_{axis}" for name in _VECTORS for axis in "xyz")

POSES: Kinds = {"thing": "int64", "carrier": "int64", **dict.fromkeys(POSE_COLUMNS, "double")}
CONTACTS: Kinds = {**dict.fromkeys(("tick", "a", "b"), "int64"), **dict.fromkeys((*_TOUCHING, "peak"), "double")}
JOINTS: Kinds = dict.fromkeys(("a", "b", "start", "end"), "int64")


def write_table(file: Path, columns: Columns, kinds: Kinds | None = None) -> int:
    """Write columns of equal length, as numbers of some kinds, and return how many bytes they are once unpacked.

    Equal columns give equal bytes.
    """
    writer = cast(Any, parquet)
    if kinds is not None:
        columns = {name: column.astype(_TYPES[kinds[name]], copy=False) for name, column in columns.items()}
    table = cast(Any, arrow).table({name: np.ascontiguousarray(column) for name, column in columns.items()})
    floats = [name for name, column in columns.items() if column.dtype.kind == "f"]
    # Neighbours in a long column of 32-bit whole numbers differ by little.
    steps = [name for name, column in columns.items() if column.dtype == np.int32]
    # Arrow itself opens no file whose name is not UTF-8.
    with file.open("wb") as stream:
        writer.write_table(
            table,
            stream,
            row_group_size=max(1, table.num_rows),
            compression="zstd",
            use_dictionary=[name for name in columns if name not in (*floats, *steps)],
            use_byte_stream_split=floats,
            column_encoding=dict.fromkeys(steps, "DELTA_BINARY_PACKED") or None,
            write_page_checksum=True,
            write_statistics=False,
            store_schema=False,
        )
    return sum(column.nbytes for column in columns.values())


def check_unpacked_sizes(files: Iterable[Path]) -> None:
    """Check by the descriptions of all tables of a log, before one is read, that they are not too large together.

    Raises:
        LogError: If they are, or a file is no table.
    """
    sizes: dict[Path, int] = {}
    for file in files:
        with _opened(file) as table:
            sizes[file] = table.metadata.num_rows * _row_bytes(file, table)
    total = sum(sizes.values())
    if total > MOST_BYTES:
        file = max(sizes, key=lambda each: sizes[each])
        raise LogError(f"{file}: {unpacked(sizes[file], total)} are read")


def refuse_long_run(things: int, ticks: int, particles: int, frames: int) -> None:
    """Refuse a run, before it is computed, whose poses alone make a log that is too large to be saved.

    Raises:
        InputError: If it is too long for so many things and particles.
    """
    size = things * ticks * _bytes_of(POSES) + particles * frames * _bytes_of(particle_tables.WHOLE_POSITIONS)
    if size > MOST_BYTES:
        raise InputError(
            f"the log could not be saved: {ticks:,} ticks of {things} things and {frames:,} frames of {particles:,}"
            f" particles take {size / 1e6:,.0f} MB; at most {MOST_BYTES / 1e6:,.0f} MB could be read again; shorten the"
            " run, or take fewer particles or things"
        )


def _bytes_of(kinds: Kinds) -> int:
    return sum(np.dtype(_TYPES[kind]).itemsize for kind in kinds.values())


def unpacked(size: int, total: int) -> str:
    """Return how a message tells the size of a table, and of all tables of its log, once unpacked [byte]."""
    return (
        f"would take {size / 1e6:,.0f} MB of memory, and all tables of the log {total / 1e6:,.0f} MB; at most"
        f" {MOST_BYTES / 1e6:,.0f} MB"
    )


@contextmanager
def _opened(file: Path) -> Generator[Any]:
    """Yield a Parquet file; whatever is wrong with it is a ``LogError``."""
    try:
        # Arrow itself opens no file whose name is not UTF-8.
        with (
            file.open("rb") as stream,
            cast(Any, parquet).ParquetFile(stream, page_checksum_verification=True) as opened,
        ):
            yield opened
    except (OSError, MemoryError, cast(Any, arrow).ArrowException) as error:
        raise LogError(f"{file}: cannot be read: {(str(error) or type(error).__name__).splitlines()[0]}") from None


def read_table(file: Path, *allowed: Kinds) -> dict[str, npt.NDArray[Any]]:
    """Return the columns of a table, its page checksums verified.

    Args:
        file: Where it is.
        allowed: What its columns may be, one or the other; if none is given, any numbers.

    Raises:
        LogError: If the file is no such table, or would be too large in memory.
    """
    columns: dict[str, npt.NDArray[Any]] = {}
    with _opened(file) as opened:
        _check_kinds(file, opened, allowed)
        rows, row_bytes = opened.metadata.num_rows, _row_bytes(file, opened)
        if rows * row_bytes > MOST_BYTES:
            raise LogError(f"{file}: {unpacked(rows * row_bytes, rows * row_bytes)} are read")
        # One after the other: a page that unpacks to more than it tells then costs that once.
        for name in opened.schema_arrow.names:
            column: Any = opened.read(columns=[name], use_threads=False).column(0)
            if len(column) != rows or column.null_count:
                raise LogError(f"{file}: {brief(name)} does not have a number in each of the {rows} rows")
            columns[str(name)] = column.to_numpy()
    return columns


def _row_bytes(file: Path, opened: Any) -> int:
    """Return what a row of a table takes once unpacked [byte].

    Raises:
        LogError: If the table is not described as ours are: as one part of as many rows, with numbers in each.
    """
    about, names = opened.metadata, opened.schema_arrow.names
    if about.num_row_groups > 1 or len(names) > MOST_COLUMNS:
        raise LogError(
            f"{file}: has {len(names)} columns in {about.num_row_groups} parts; at most {MOST_COLUMNS} and 1 are read"
        )
    parts = [about.row_group(number) for number in range(about.num_row_groups)]
    counts = {part.num_rows for part in parts} | {
        part.column(i).num_values for part in parts for i in range(len(names))
    }
    if counts - {about.num_rows} or (about.num_rows and not parts):
        raise LogError(f"{file}: is described as {about.num_rows} rows, its parts as others")
    kinds = (str(opened.schema_arrow.field(i).type) for i in range(len(names)))
    return sum(np.dtype(_TYPES.get(kind, np.float64)).itemsize for kind in kinds)


def _check_kinds(file: Path, opened: Any, allowed: Sequence[Kinds]) -> None:
    """Check by the description of a table, before it is read, of what its columns consist.

    Raises:
        LogError: If they are not the ones that are allowed, or something else than numbers.
    """
    names = [str(name) for name in opened.schema_arrow.names]
    kinds = {name: str(opened.schema_arrow.field(i).type) for i, name in enumerate(names)}
    for name, kind in kinds.items():
        if kind not in _TYPES:
            raise LogError(f"{file}: {brief(name)} consists of {brief(kind)}; known: {', '.join(_TYPES)}")
    if len(kinds) < len(names):
        raise LogError(f"{file}: two columns have the same name")
    if allowed and kinds not in allowed:
        columns = ", ".join(f"{name} ({kind})" for name, kind in allowed[0].items())
        raise LogError(f"{file}: has other columns than {columns}")


def pose_columns(poses: FloatArray, carrier: IntArray) -> Columns:
    """Return poses (T, n, 7) and carriers (T, n) as long columns: all ticks of thing 0, then of thing 1 ..."""
    ticks, things, _ = poses.shape
    by_thing = poses.transpose(1, 0, 2).reshape(things * ticks, 7)
    thing: IntArray = np.arange(things, dtype=np.int64).repeat(ticks)
    keys: dict[str, npt.NDArray[Any]] = {"thing": thing, "carrier": carrier.T.reshape(-1)}
    return {**keys, **{name: by_thing[:, i] for i, name in enumerate(POSE_COLUMNS)}}


def poses_from(columns: Columns, ticks: int, things: int) -> tuple[FloatArray, IntArray]:
    """Return poses (T, n, 7) and carriers (T, n) from long columns.

    Raises:
        ValueError: If they are not those of so many ticks and things.
    """
    check_rows("poses", "thing", columns["thing"], things, ticks)
    by_thing = np.stack([columns[name] for name in POSE_COLUMNS], axis=-1).reshape(things, ticks, 7)
    poses = np.ascontiguousarray(by_thing.transpose(1, 0, 2))
    carrier = np.ascontiguousarray(columns["carrier"].reshape(things, ticks).T)
    return poses, carrier


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


def joint_columns(joints: Joints) -> Columns:
    """Return joints between things as columns."""
    return {"a": joints.a, "b": joints.b, "start": joints.start, "end": joints.end}


def joints_from(columns: Columns) -> Joints:
    """Return the joints whose columns these are."""
    return Joints(a=columns["a"], b=columns["b"], start=columns["start"], end=columns["end"])


def happening_columns(happenings: Happenings) -> Columns:
    """Return happenings of one type as columns: tick, arguments, numbers."""
    return {"tick": happenings.tick, **happenings.things, **happenings.numbers}


def happening_kinds(things: Iterable[str], numbers: Iterable[str]) -> Kinds:
    """Return what the columns of happenings consist of, by the names of their arguments and numbers."""
    return {**dict.fromkeys(("tick", *things), "int64"), **dict.fromkeys(numbers, "double")}


def happenings_from(columns: Columns, things: Iterable[str], numbers: Iterable[str]) -> Happenings:
    """Return the happenings whose columns these are."""
    return Happenings(
        tick=columns["tick"],
        things={name: columns[name] for name in things},
        numbers={name: columns[name] for name in numbers},
    )
