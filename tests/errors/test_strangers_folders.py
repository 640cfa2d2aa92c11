"""A folder of a stranger, sealed as it should be, is refused in one line by whatever reads it."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

import numpy as np
import pyarrow as arrow  # pyright: ignore[reportMissingTypeStubs]
import pyarrow.parquet as parquet  # pyright: ignore[reportMissingTypeStubs]
import pytest
from tests.synthetic import egg_drop_log, wet_log

from prolepsis.cli import main
from prolepsis.log import checks as log_checks
from prolepsis.log import files as log_files
from prolepsis.log import saved as saved_timeline
from prolepsis.log import sealed
from prolepsis.log import tables as log_tables
from prolepsis.log.domain import Domain
from prolepsis.log.files import read_log, write_log, write_log_files
from prolepsis.log.json_text import to_json
from prolepsis.log.log import Log
from prolepsis.log.saved import read_timeline, write_timeline_files
from prolepsis.log.sealed import MANIFEST, read_sealed, write_sealed
from prolepsis.log.tables import read_table, write_table
from prolepsis.log.timeline import Fact, make_timeline
from prolepsis.projection import Projection
from prolepsis.terms.errors import InputError, LogError

Change = Callable[[Path], None]


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("saved") / "run"
    fact = Fact(kind="event", type="falling", args=("egg1",), start=0.2, end=0.5, evidence={"speed": 3.0})
    domain = Domain(instances=(("egg1", "Egg"),), values=(("egg1", "mass", 0.06),))

    def write(path: Path) -> None:
        write_log_files(wet_log(), path)
        write_timeline_files(make_timeline([fact], dt=0.001, duration=0.8, domain=domain), path)

    write_sealed(folder, write)
    return folder


@pytest.fixture
def folder(saved: Path, tmp_path: Path) -> Path:
    return shutil.copytree(saved, tmp_path / "run")


def seal(folder: Path, change: Callable[[dict[str, Any]], None] | None = None) -> None:
    """Seal a folder anew as its writer does, ``change`` made to what its manifest says."""
    manifest = json.loads((folder / MANIFEST).read_text())
    del manifest["sha256"]
    for name in manifest["files"]:
        content = (folder / name).read_bytes()
        manifest["files"][name] = {"bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}
    if change is not None:
        change(manifest)
    digest = hashlib.sha256(to_json(manifest).encode()).hexdigest()
    (folder / MANIFEST).write_text(to_json({**manifest, "sha256": digest}))


NOTHING = hashlib.sha256(b"").hexdigest()


def entry(size: Any = 0, digest: Any = NOTHING) -> dict[str, Any]:
    return {"bytes": size, "sha256": digest}


@pytest.mark.parametrize(
    "name",
    ["/dev/full", "/etc/passwd", "../secret", "a/../../secret", "sub/file", ".", "..", "", "manifest.json", "n" * 300],
)
def test_a_manifest_that_leads_out_of_its_folder_is_refused_by_name(folder: Path, name: str) -> None:
    seal(folder, lambda manifest: manifest["files"].update({name: entry()}))
    with pytest.raises(LogError, match="is no name of a file in the folder"):
        read_sealed(folder)


@pytest.mark.parametrize("kind", ["fifo", "link", "folder", "device"])
def test_what_is_no_plain_file_is_not_opened(folder: Path, kind: str) -> None:
    odd = folder / "odd"
    if kind == "fifo":
        os.mkfifo(odd)
    elif kind == "link":
        odd.symlink_to("/etc/hostname")
    elif kind == "folder":
        odd.mkdir()
    else:
        odd.symlink_to("/dev/zero")
    seal(folder, lambda manifest: manifest["files"].update({"odd": entry()}))
    with pytest.raises(LogError, match="odd: is no plain file"):
        read_sealed(folder)


def test_a_manifest_that_is_no_plain_file_or_huge_is_not_opened(folder: Path) -> None:
    (folder / MANIFEST).unlink()
    os.mkfifo(folder / MANIFEST)
    with pytest.raises(LogError, match="is no plain file of at most"):
        read_sealed(folder)
    (folder / MANIFEST).unlink()
    with (folder / MANIFEST).open("wb") as file:
        file.truncate(2**40)
    with pytest.raises(LogError, match="is no plain file of at most"):
        read_sealed(folder)


def test_a_huge_file_is_refused_by_its_size(folder: Path) -> None:
    with (folder / "log.json").open("wb") as file:
        file.truncate(2**40)
    with pytest.raises(LogError, match=r"log\.json: has 1099511627776 bytes instead of"):
        read_sealed(folder)

    def claim(manifest: dict[str, Any]) -> None:
        manifest["files"]["log.json"] = entry(2**40)

    (folder / "log.json").write_bytes(b"")
    seal(folder, claim)
    with pytest.raises(LogError, match="at most 8589934592 are read"):
        read_sealed(folder)


WRONG_TYPES: list[tuple[Callable[[dict[str, Any]], None], str]] = [
    (lambda manifest: manifest.update(files=[]), "lists no files"),
    (lambda manifest: manifest["files"].update({"log.json": None}), "without its size"),
    (lambda manifest: manifest["files"].update({"log.json": entry("1")}), "without its size"),
    (lambda manifest: manifest["files"].update({"log.json": entry(True)}), "without its size"),
    (lambda manifest: manifest["files"].update({"log.json": entry(-1)}), "without its size"),
    (lambda manifest: manifest["files"].update({"log.json": entry(1, "00")}), "without its size"),
    (lambda manifest: manifest["files"].update({str(i): entry() for i in range(2000)}), "at most 1000"),
    (lambda manifest: manifest.update(version=[1]), r"has format version \[1\]"),
    (lambda manifest: manifest.update(format=["prolepsis"]), "is not a manifest"),
]


@pytest.mark.parametrize(("change", "message"), WRONG_TYPES)
def test_a_manifest_of_wrong_types_is_refused(
    folder: Path, change: Callable[[dict[str, Any]], None], message: str
) -> None:
    seal(folder, change)
    with pytest.raises(LogError, match=message):
        read_sealed(folder)


@pytest.mark.parametrize(
    "text",
    [
        "[" * 100_000,
        '{"a":' * 100_000,
        "[]",
        "NaN",
        '{"format": "prolepsis", "version": 1, "files": {}, "sha256": "\\ud800"}',
        '{"format": "prolepsis", "version": 1, "files": {}, "made_by": NaN, "sha256": ""}',
        f'{{"format": "prolepsis", "version": {"9" * 5000}}}',
        '{"format": "prolepsis", "format": "prolepsis", "version": 1, "files": {}, "sha256": ""}',
    ],
)
def test_a_manifest_that_is_none_is_refused(folder: Path, text: str) -> None:
    (folder / MANIFEST).write_text(text)
    with pytest.raises(LogError) as error:
        read_sealed(folder)
    assert len(str(error.value)) < 300 + len(str(folder))


def in_json(name: str, *keys: Any, value: Any) -> Change:
    """Return the change that puts a value into a file of JSON."""

    def change(folder: Path) -> None:
        place = told = json.loads((folder / name).read_text())
        for key in keys[:-1]:
            place = place[key]
        place[keys[-1]] = value
        (folder / name).write_text(json.dumps(told))

    return change


def text(name: str, content: str) -> Change:
    return lambda folder: cast(None, (folder / name).write_text(content))


def in_table(name: str, column: str, row: int | slice, value: Any) -> Change:
    """Return the change that puts a number into a table."""

    def change(folder: Path) -> None:
        columns = {key: values.copy() for key, values in read_table(folder / name).items()}
        columns[column][row] = value
        write_table(folder / name, columns)

    return change


def with_columns(name: str, **columns: Any) -> Change:
    """Return the change that gives a table other columns; one that is None is dropped."""

    def change(folder: Path) -> None:
        table: dict[str, Any] = {**read_table(folder / name), **columns}
        wanted = {key: values for key, values in table.items() if values is not None}
        cast(Any, parquet).write_table(cast(Any, arrow).table(wanted), folder / name)

    return change


def bomb(folder: Path) -> None:
    """Write a small file that would be 13 GB in memory."""
    part: Any = cast(Any, arrow).table({"time": np.zeros(2**20)})
    whole = cast(Any, arrow).concat_tables([part] * 1700)
    cast(Any, parquet).write_table(whole, folder / "ticks.parquet", row_group_size=2**31 - 1, compression="zstd")


def a_thing_less(folder: Path) -> None:
    things = json.loads((folder / "log.json").read_text())["things"]
    in_json("log.json", "things", value=things[:-1])(folder)


def a_pose_less(folder: Path) -> None:
    columns = read_table(folder / "poses.parquet")
    write_table(folder / "poses.parquet", {name: column[:-1] for name, column in columns.items()})


def poses_of_whole_numbers(folder: Path) -> None:
    x = read_table(folder / "poses.parquet")["x"]
    with_columns("poses.parquet", x=np.zeros(len(x), dtype=np.int64))(folder)


def a_particle_that_is_no_number(folder: Path) -> None:
    columns = read_table(folder / "particles.parquet")
    places = {axis: np.full(len(columns["holder"]), np.nan, dtype=np.float32) for axis in "xyz"}
    write_table(folder / "particles.parquet", {"particle": columns["particle"], "holder": columns["holder"], **places})


def a_particle_less(folder: Path) -> None:
    columns = read_table(folder / "particles.parquet")
    write_table(folder / "particles.parquet", {name: column[:-1] for name, column in columns.items()})


def poses_in_another_order(folder: Path) -> None:
    columns = read_table(folder / "poses.parquet")
    write_table(folder / "poses.parquet", {name: column[::-1] for name, column in columns.items()})


def another_table(folder: Path) -> None:
    write_table(folder / "happenings_yawn.parquet", {"tick": np.zeros(1, dtype=np.int64)})


CORNER = {
    "type": "mesh",
    "size": [0.0, 0.0, 0.0],
    "position": [0.0, 0.0, 0.0],
    "orientation": [1.0, 0.0, 0.0, 0.0],
    "vertices": [[0.0, 0.0, 0.0]],
}
TIMELINES: dict[str, Change] = {
    "a list": text("timeline.json", "[]"),
    "no JSON": text("timeline.json", "{"),
    "too deep": text("timeline.json", '{"facts": ' + "[" * 50_000),
    "no facts": text("timeline.json", '{"dt": 0.001, "duration": 1.0}'),
    "facts that are a text": in_json("timeline.json", "facts", value="falling"),
    "a fact that is a number": in_json("timeline.json", "facts", 0, value=7),
    "a kind that is a list": in_json("timeline.json", "facts", 0, "kind", value=[]),
    "a type that is a number": in_json("timeline.json", "facts", 0, "type", value=7),
    "arguments that are a text": in_json("timeline.json", "facts", 0, "args", value="egg1"),
    "an argument that is an object": in_json("timeline.json", "facts", 0, "args", value=[{}]),
    "a start that is a text": in_json("timeline.json", "facts", 0, "start", value="0"),
    "a start that is true": in_json("timeline.json", "facts", 0, "start", value=True),
    "an end that is not finite": in_json("timeline.json", "facts", 0, "end", value=float("nan")),
    "an end of 400 digits": in_json("timeline.json", "facts", 0, "end", value=10**400),
    "an end before the start": in_json("timeline.json", "facts", 0, "end", value=-1.0),
    "evidence that is a list": in_json("timeline.json", "facts", 0, "evidence", value=[1]),
    "evidence of evidence": in_json("timeline.json", "facts", 0, "evidence", value={"a": {"b": 1}}),
    "a tick of nothing": in_json("timeline.json", "dt", value=0),
    "a tick that is a text": in_json("timeline.json", "dt", value="0.001"),
    "a duration that is none": in_json("timeline.json", "duration", value=None),
    "a domain that is a list": text("domain.json", "[]"),
    "a domain with other keys": in_json("domain.json", "more", value=[]),
    "instances that are a number": in_json("domain.json", "instances", value=7),
    "instances that are a text": in_json("domain.json", "instances", value="ab"),
    "an instance of three": in_json("domain.json", "instances", value=[["egg1", "Egg", "x"]]),
    "an instance that is a number": in_json("domain.json", "instances", value=[["egg1", 7]]),
    "a value that is true": in_json("domain.json", "values", value=[["egg1", "mass", True]]),
    "a value that is a list": in_json("domain.json", "values", value=[["egg1", "mass", []]]),
}
LOGS: dict[str, Change] = {
    "no JSON": text("log.json", "nothing"),
    "too deep": text("log.json", "[" * 100_000),
    "a list": text("log.json", "[]"),
    "a tick of nothing": in_json("log.json", "dt", value=0.0),
    "a tick that is a text": in_json("log.json", "dt", value="1"),
    "gravity of two": in_json("log.json", "gravity", value=[0.0, 0.0]),
    "gravity that is not finite": in_json("log.json", "gravity", value=[0.0, 0.0, float("inf")]),
    "things that are a number": in_json("log.json", "things", value=3),
    "a thing less": a_thing_less,
    "a thing of the same name": in_json("log.json", "things", 0, "name", value="egg1"),
    "a mass that is a text": in_json("log.json", "things", 0, "mass", value="heavy"),
    "a part of itself": in_json("log.json", "things", 1, "whole", value="egg1"),
    "a part of nothing": in_json("log.json", "things", 1, "whole", value="hen1"),
    "an unknown key": in_json("log.json", "things", 1, "soul", value="immortal"),
    "an unknown geom": in_json("log.json", "things", 1, "shape", "geoms", 0, "type", value="hfield"),
    "a size that is negative": in_json("log.json", "things", 1, "shape", "geoms", 0, "size", value=[-1.0, 1.0, 1.0]),
    "a size that is huge": in_json("log.json", "things", 1, "shape", "geoms", 0, "size", value=[1e300, 1.0, 1.0]),
    "a mesh of one corner": in_json("log.json", "things", 1, "shape", "geoms", 0, value=CORNER),
    "a triangle of nothing": in_json("log.json", "things", -2, "shape", "surface", "triangles", 0, value=[0, 1, 99]),
    "an action that is no term": in_json("log.json", "actions", 0, "term", value="((("),
    "an argument that is no term": in_json("log.json", "actions", 0, "arguments", value={"duration": "((("}),
    "an argument that is a number": in_json("log.json", "actions", 0, "arguments", value={"duration": 0.8}),
    "arguments without names": in_json("log.json", "actions", 0, "arguments", value=["0.8"]),
    "an action beyond the end": in_json("log.json", "actions", 0, "end", value=10**9),
    "an action that starts at a text": in_json("log.json", "actions", 0, "start", value="0"),
    "particles that are a list": in_json("log.json", "particles", value=[]),
    "a spacing that is negative": in_json("log.json", "particles", "spacing", value=-1.0),
    "a table that is none": text("poses.parquet", "PAR1 nothing PAR1"),
    "a pose that is no number": in_table("poses.parquet", "x", 5, np.nan),
    "a pose far away": in_table("poses.parquet", "z", 5, 1e200),
    "a quaternion of nothing": in_table("poses.parquet", "qw", 5, 0.0),
    "a carrier that is none": in_table("poses.parquet", "carrier", 5, 99),
    "a pose less": a_pose_less,
    "a particle less": a_particle_less,
    "poses in another order": poses_in_another_order,
    "a table that nobody tells of": another_table,
    "happenings that nobody tells of": in_json("log.json", "happenings", value={}),
    "particles that nobody tells of": in_json("log.json", "particles", value=None),
    "poses of whole numbers": poses_of_whole_numbers,
    "no column of heights": with_columns("poses.parquet", z=None),
    "times that stand still": in_table("ticks.parquet", "time", slice(None), 0.0),
    "times that run backwards": in_table("ticks.parquet", "time", slice(100, 102), [0.101, 0.1]),
    "no times": with_columns("ticks.parquet", time=None),
    "a channel of texts": with_columns("ticks.parquet", **{"egg1.load": ["a"] * 800}),
    "a channel of lists": with_columns("ticks.parquet", **{"egg1.load": [[1.0]] * 800}),
    "a channel with gaps": with_columns("ticks.parquet", **{"egg1.load": [None, *[1.0] * 799]}),
    "a contact with nothing": in_table("contacts.parquet", "b", 0, 1000),
    "a contact before the start": in_table("contacts.parquet", "tick", 0, -1),
    "contacts out of order": in_table("contacts.parquet", "tick", 0, 700),
    "a force that is not finite": in_table("contacts.parquet", "force_z", 0, np.inf),
    "contacts of other columns": with_columns("contacts.parquet", peak=None),
    "a break after the end": in_table("happenings_detachment.parquet", "tick", -1, 10**12),
    "a particle that is no number": a_particle_that_is_no_number,
    "a mass of particles that is no number": in_table("particle_kinds.parquet", "mass", 0, np.nan),
}


def refusal(command: list[str], capfd: pytest.CaptureFixture[str]) -> str:
    """Return the one line by which a command refuses."""
    status = main(command)
    captured = capfd.readouterr()
    assert (status, captured.out) == (2, ""), captured.err
    (line,) = captured.err.splitlines()
    assert len(line) <= 300
    return line


@pytest.mark.parametrize("what", TIMELINES)
def test_ask_and_timeline_refuse_a_sealed_timeline_with(
    folder: Path, what: str, capfd: pytest.CaptureFixture[str]
) -> None:
    TIMELINES[what](folder)
    seal(folder)
    for command in (["ask", str(folder), "true"], ["timeline", str(folder)]):
        assert "its timeline is malformed" in refusal(command, capfd)


@pytest.mark.parametrize("what", LOGS)
def test_render_refuses_a_sealed_log_with(
    folder: Path, tmp_path: Path, what: str, capfd: pytest.CaptureFixture[str]
) -> None:
    LOGS[what](folder)
    seal(folder)
    line = refusal(["render", str(folder), "--strip", str(tmp_path / "a.png")], capfd)
    assert "log" in line or "parquet" in line
    assert not (tmp_path / "a.png").exists()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("a pose less", "poses: 8799 rows; needed: 8800, of 11 things at 800 times"),
        ("a particle less", "particles: "),
        ("poses in another order", "poses: the column thing does not tell"),
        ("a table that nobody tells of", "there is happenings_yawn.parquet, of which log.json does not tell"),
        ("happenings that nobody tells of", "there is happenings_detachment.parquet, of which log.json does not tell"),
    ],
)
def test_what_is_wrong_with_the_tables_is_said_in_their_own_terms(folder: Path, change: str, message: str) -> None:
    LOGS[change](folder)
    seal(folder)
    with pytest.raises(LogError) as raised:
        read_log(folder)
    assert message in str(raised.value)
    assert "reshape" not in str(raised.value)


@pytest.mark.laws
def test_a_table_that_would_be_13_gb_is_refused_before_it_is_read(
    folder: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    bomb(folder)
    seal(folder)
    assert "at most" in refusal(["render", str(folder), "--strip", str(tmp_path / "a.png")], capfd)


def contacts_of(rows: int) -> Change:
    """Return the change that repeats one contact; the file stays small."""

    def change(folder: Path) -> None:
        columns = read_table(folder / "contacts.parquet")
        repeated = {name: np.full(rows, column[0]) for name, column in columns.items()}
        cast(Any, parquet).write_table(
            cast(Any, arrow).table(repeated), folder / "contacts.parquet", row_group_size=rows, compression="zstd"
        )

    return change


def never(*_: Any, **__: Any) -> None:
    raise AssertionError("a table was unpacked")


def test_all_tables_of_a_log_together_are_refused_before_one_is_unpacked(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = 400_000
    contacts_of(rows)(folder)
    assert (folder / "contacts.parquet").stat().st_size < 100_000
    seal(folder)
    assert len(read_log(folder).contacts.tick) == rows
    # Each table alone would do: what bounds them is their sum.
    monkeypatch.setattr(log_tables, "MOST_BYTES", rows * 13 * 8 + 1000)
    monkeypatch.setattr(cast(Any, parquet).ParquetFile, "read", never)
    with pytest.raises(
        LogError, match=r"contacts\.parquet: would take 42 MB of memory, and all tables of the log 4\d MB"
    ):
        read_log(folder)


def test_a_log_that_would_not_be_read_is_not_written(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log = read_log(folder)
    monkeypatch.setattr(log_tables, "MOST_BYTES", 100_000)
    with pytest.raises(InputError, match=r"the log cannot be saved: poses\.parquet would take .* shorten the run"):
        write_log(log, folder)
    monkeypatch.undo()
    assert_same(read_log(folder), log)
    monkeypatch.setattr(log_checks, "MOST_ACTIONS", 0)
    with pytest.raises(InputError, match=r"the log cannot be saved: there are 1 actions; allowed: 0"):
        write_log(log, folder)
    with pytest.raises(LogError, match="there are 1 actions; allowed: 0"):
        read_log(folder)


def test_a_timeline_that_would_not_be_read_is_not_written(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    timeline = read_timeline(folder)
    monkeypatch.setattr(saved_timeline, "MOST_FACTS", 0)
    with pytest.raises(InputError, match="the timeline cannot be saved: it has 1 facts; 0 could be read again"):
        write_timeline_files(timeline, folder)
    monkeypatch.undo()
    monkeypatch.setattr(sealed, "MOST_TEXT_BYTES", 10)
    with pytest.raises(InputError, match=r"domain\.json cannot be saved: it has \d+ bytes"):
        write_timeline_files(timeline, folder)


def assert_same(one: Log, other: Log) -> None:
    assert np.array_equal(one.poses, other.poses) and one.actions == other.actions


def test_a_description_that_claims_fewer_rows_than_it_has_is_refused(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = 400_000
    contacts_of(rows)(folder)
    file = folder / "contacts.parquet"
    content = file.read_bytes()
    start = len(content) - 8 - int.from_bytes(content[-8:-4], "little")
    # Whole numbers are twice as large, in groups of seven bits; the number of all rows is the first of this size.
    claimed = bytes([2 * rows & 0x7F | 0x80, 2 * rows >> 7 & 0x7F | 0x80, 2 * rows >> 14])
    place = content.index(claimed, start)
    file.write_bytes(content[:place] + bytes([20 | 0x80, 0x80, 0]) + content[place + 3 :])
    assert cast(Any, parquet).ParquetFile(file).metadata.num_rows == 10
    seal(folder)
    monkeypatch.setattr(cast(Any, parquet).ParquetFile, "read", never)
    with pytest.raises(LogError, match=r"contacts\.parquet: is described as 10 rows, its parts as others"):
        read_log(folder)


def test_memory_that_runs_short_is_told_in_one_line(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def short(*_: Any) -> None:
        raise MemoryError

    monkeypatch.setattr(log_files, "check_log", short)
    with pytest.raises(LogError, match="memory ran short while its log was read"):
        read_log(folder)


def test_the_folder_itself_is_read(folder: Path) -> None:
    seal(folder)
    assert read_log(folder).tick_count == egg_drop_log().tick_count


@pytest.mark.parametrize(
    "wrong",
    [{"situation": [name]} for name in ("../../etc/passwd", "/etc/passwd", "", 7, None, ["a.ttl"])]
    + [{"drawn": drawn} for drawn in (7, ["egg1.mass"], {"egg1.mass": None}, {"egg1.mass": [0.06]})],
)
def test_a_scenario_that_leads_out_of_its_folder_or_is_none_is_refused(folder: Path, wrong: dict[str, Any]) -> None:
    row: dict[str, Any] = {
        "name": "a.toml",
        "situation": ["a.ttl"],
        "plan": "wait(1)",
        "parameters": {},
        "knowledge": {},
        "robot": None,
    }
    (folder / "scenario.json").write_text(json.dumps({**row, "duration": 1.0, "seed": 0, **wrong}))
    (folder / "world.xml").write_text("<mujoco/>")
    seal_with(folder, "scenario.json", "world.xml")
    with pytest.raises(LogError, match="its scenario is malformed"):
        Projection.load(folder)


def seal_with(folder: Path, *names: str) -> None:
    seal(folder, lambda manifest: manifest["files"].update({name: _entry_of(folder / name) for name in names}))


def _entry_of(file: Path) -> dict[str, Any]:
    return entry(file.stat().st_size, hashlib.sha256(file.read_bytes()).hexdigest())
