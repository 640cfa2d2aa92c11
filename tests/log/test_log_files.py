"""A log on disk comes back as it was, or not at all."""

from __future__ import annotations

import json
import shutil
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, cast

import numpy as np
import pyarrow.parquet  # pyright: ignore[reportMissingTypeStubs]
import pytest
from tests.synthetic import egg_drop_log, particles, wet_log

from prolepsis.log.files import read_log, write_log
from prolepsis.log.happenings import Happenings
from prolepsis.log.log import FREE, Log
from prolepsis.log.particle_tables import STEP, rounded
from prolepsis.log.sealed import MANIFEST, write_sealed
from prolepsis.log.things import jointed
from prolepsis.terms.errors import InputError, LogError

FILES = (
    *(MANIFEST, "log.json", "ticks.parquet", "poses.parquet", "contacts.parquet", "joints.parquet"),
    *("particles.parquet", "particle_kinds.parquet", "particle_frames.parquet"),
)


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("logs") / "drop"
    write_log(wet_log(), folder)
    return folder


def column_of(file: Path, number: int) -> Any:
    """Return the metadata of a column in a Parquet file."""
    return cast(Any, pyarrow.parquet).ParquetFile(file).metadata.row_group(0).column(number)


def contents(folder: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in folder.iterdir()}


def assert_equal(one: Any, other: Any) -> None:
    assert type(one) is type(other)
    if hasattr(one, "dtype"):
        assert one.dtype == other.dtype
        np.testing.assert_array_equal(one, other)
    elif hasattr(one, "__dataclass_fields__"):
        for each in fields(one):
            assert_equal(getattr(one, each.name), getattr(other, each.name))
    elif isinstance(one, dict):
        assert list(one) == list(other)  # pyright: ignore[reportUnknownArgumentType, reportUnknownVariableType]
        for key in one:  # pyright: ignore[reportUnknownVariableType]
            assert_equal(one[key], other[key])
    else:
        assert one == other


def test_a_log_comes_back_as_it_was(saved: Path) -> None:
    assert_equal(read_log(saved), wet_log())


def test_a_log_without_liquids_comes_back_and_has_no_files_of_theirs(tmp_path: Path) -> None:
    write_log(egg_drop_log(), tmp_path / "dry")
    assert_equal(read_log(tmp_path / "dry"), egg_drop_log())
    assert not list((tmp_path / "dry").glob("particle*"))


def test_particles_that_are_not_rounded_come_back_too(tmp_path: Path) -> None:
    position = particles().position + np.float32(1e-6)
    position[3, 4] = np.float32(1e9)
    log = replace(wet_log(), particles=replace(particles(), position=position))
    write_log(log, tmp_path / "fine")
    assert_equal(read_log(tmp_path / "fine"), log)


def test_rounding_departs_by_half_a_step_and_takes_two_bytes_a_number(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    way = np.cumsum(random.normal(scale=0.002, size=(200, 500, 3)), axis=0)
    kept = rounded(way)
    assert np.abs(kept - way).max() <= 0.5 * STEP + 1e-7
    count = way.shape[1]
    moving = replace(
        particles(count=count),
        tick=np.arange(200),
        position=kept,
        holder=np.full((200, count), FREE, dtype=np.int16),
    )
    write_log(replace(wet_log(), particles=moving), tmp_path / "moving")
    assert (tmp_path / "moving" / "particles.parquet").stat().st_size < 2 * way.size


@pytest.mark.parametrize(
    ("name", "column", "value"),
    [
        ("particle_frames.parquet", "tick", 100_000),
        ("particle_kinds.parquet", "stuff", 77),
        ("particles.parquet", "holder", -5),
        ("particles.parquet", "holder", 11),
    ],
)
def test_particles_that_do_not_fit_the_log_are_refused(tmp_path: Path, name: str, column: str, value: int) -> None:
    from prolepsis.log.files import read_log_files, write_log_files
    from prolepsis.log.tables import read_table, write_table

    write_log_files(wet_log(), tmp_path)
    columns = {key: values.copy() for key, values in read_table(tmp_path / name).items()}
    columns[column][-1] = value
    write_table(tmp_path / name, columns)
    with pytest.raises(LogError, match="its log is malformed"):
        read_log_files(tmp_path)


def test_a_lost_particle_is_noticed(tmp_path: Path) -> None:
    from prolepsis.log.files import read_log_files, write_log_files
    from prolepsis.log.tables import read_table, write_table

    write_log_files(wet_log(), tmp_path)
    columns = read_table(tmp_path / "particles.parquet")
    write_table(tmp_path / "particles.parquet", {key: values[:-1] for key, values in columns.items()})
    with pytest.raises(LogError, match="its log is malformed"):
        read_log_files(tmp_path)


def test_an_empty_log_comes_back(tmp_path: Path) -> None:
    whole = egg_drop_log()
    no_rows = {each.name: getattr(whole.contacts, each.name)[:0] for each in fields(whole.contacts)}
    empty = replace(
        whole,
        time=whole.time[:0],
        poses=whole.poses[:0],
        carrier=whole.carrier[:0],
        contacts=replace(whole.contacts, **no_rows),
        happenings={},
        channels={},
        actions=(),
    )
    write_log(empty, tmp_path / "empty")
    assert_equal(read_log(tmp_path / "empty"), empty)


def test_equal_logs_give_equal_bytes(saved: Path, tmp_path: Path) -> None:
    write_log(wet_log(), tmp_path / "again")
    assert contents(tmp_path / "again") == contents(saved)


def test_the_tables_have_page_checksums_and_zstd(saved: Path) -> None:
    column = column_of(saved / "poses.parquet", 4)
    assert column.compression == "ZSTD"
    assert "BYTE_STREAM_SPLIT" in column.encodings


def test_the_manifest_tells_the_versions_and_no_time(saved: Path) -> None:
    manifest = json.loads((saved / MANIFEST).read_text())
    assert set(manifest["made_by"]) == {"prolepsis", "mujoco", "numpy"}
    assert set(manifest) == {"format", "version", "made_by", "files", "sha256"}


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("place", [0.0, 0.1, 0.37, 0.5, 0.77, 1.0])
def test_a_flipped_byte_is_noticed(saved: Path, tmp_path: Path, name: str, place: float) -> None:
    folder = shutil.copytree(saved, tmp_path / "log")
    content = bytearray((folder / name).read_bytes())
    content[round(place * (len(content) - 1))] ^= 0x10
    (folder / name).write_bytes(content)
    with pytest.raises(LogError, match=name) as error:
        read_log(folder)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("left", [0.0, 0.5, 0.99])
def test_a_truncated_file_is_noticed(saved: Path, tmp_path: Path, name: str, left: float) -> None:
    folder = shutil.copytree(saved, tmp_path / "log")
    content = (folder / name).read_bytes()
    (folder / name).write_bytes(content[: int(left * len(content))])
    with pytest.raises(LogError, match=name):
        read_log(folder)


def test_every_byte_of_the_manifest_counts(saved: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(saved, tmp_path / "log")
    whole = (folder / MANIFEST).read_bytes()
    for i in range(len(whole)):
        changed = bytearray(whole)
        changed[i] ^= 0x01
        (folder / MANIFEST).write_bytes(changed)
        with pytest.raises(LogError):
            read_log(folder)


@pytest.mark.parametrize("name", FILES[1:])
def test_a_missing_file_is_named(saved: Path, tmp_path: Path, name: str) -> None:
    folder = shutil.copytree(saved, tmp_path / "log")
    (folder / name).unlink()
    with pytest.raises(LogError, match=f"{name}: is missing"):
        read_log(folder)


def test_a_page_checksum_guards_a_table_read_by_itself(saved: Path, tmp_path: Path) -> None:
    from prolepsis.log.tables import read_table

    content = bytearray((saved / "contacts.parquet").read_bytes())
    column = column_of(saved / "contacts.parquet", 5)
    content[column.data_page_offset + column.total_compressed_size - 3] ^= 0x04
    (tmp_path / "contacts.parquet").write_bytes(content)
    with pytest.raises(LogError, match=r"contacts\.parquet: cannot be read"):
        read_table(tmp_path / "contacts.parquet")


def test_another_version_is_refused(saved: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(saved, tmp_path / "log")
    text = (folder / MANIFEST).read_text().replace('"version": 2', '"version": 3')
    (folder / MANIFEST).write_text(text)
    with pytest.raises(LogError, match="format version 3; this prolepsis reads 2"):
        read_log(folder)


def test_a_folder_that_is_no_log_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="no folder that prolepsis wrote"):
        read_log(tmp_path)
    with pytest.raises(LogError, match="no such folder"):
        read_log(tmp_path / "absent")
    write_sealed(tmp_path / "other", lambda path: (path / "a.txt").touch())
    with pytest.raises(LogError, match=r"holds no log \(it has no log\.json\)"):
        read_log(tmp_path / "other")


def test_a_folder_of_someone_else_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(InputError, match="left alone"):
        write_log(egg_drop_log(), tmp_path)
    assert contents(tmp_path) == {"notes.txt": b"mine"}


def test_an_earlier_log_is_replaced_and_nothing_else_remains(saved: Path, tmp_path: Path) -> None:
    shutil.copytree(saved, tmp_path / "log")
    shorter = replace(egg_drop_log(), actions=())
    write_log(shorter, tmp_path / "log")
    assert read_log(tmp_path / "log").actions == ()
    assert [file.name for file in tmp_path.iterdir()] == ["log"]


@pytest.mark.parametrize("failure", [KeyboardInterrupt, OSError])
def test_a_failure_while_writing_leaves_the_earlier_log(
    saved: Path, tmp_path: Path, failure: type[BaseException]
) -> None:
    shutil.copytree(saved, tmp_path / "log")

    def fail(path: Path) -> None:
        (path / "half.txt").write_text("half")
        raise failure

    with pytest.raises(failure):
        write_sealed(tmp_path / "log", fail)
    assert [file.name for file in tmp_path.iterdir()] == ["log"]
    assert isinstance(read_log(tmp_path / "log"), Log)


def test_what_could_not_be_read_is_not_written(tmp_path: Path) -> None:
    log = egg_drop_log()
    odd = Happenings(tick=np.array([3]), things={"tick": np.array([1])})
    with pytest.raises(InputError, match="puffs: a column is there twice"):
        write_log(replace(log, happenings={"puff": odd}), tmp_path / "puff")
    circle = tuple(replace(thing, mount=jointed(thing.name)) if k == 1 else thing for k, thing in enumerate(log.things))
    with pytest.raises(InputError, match="egg1: hangs on egg1, which is no thing or hangs on itself"):
        write_log(replace(log, things=circle), tmp_path / "circle")
    assert not any(tmp_path.iterdir())
