"""A recording from a stranger is refused in one line that repeats nothing of what stands in the file."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow  # pyright: ignore[reportMissingTypeStubs]
import pyarrow.parquet  # pyright: ignore[reportMissingTypeStubs]
import pytest

from prolepsis.programs.recording import read_recording
from prolepsis.terms.errors import InputError

arrow: Any = pyarrow
parquet: Any = pyarrow.parquet
HEAD = b"time,dx,dy,dz\n"
FILES = {
    "huge numbers": (HEAD + b"0,0,0,0\n0.1,1e308,0,0\n", "row 2: dx is 1e+308; allowed: up to 1e+06"),
    "huge times": (HEAD + b"-1e308,0,0,0\n1e308,0,0,0\n", "row 2: time is 1e+308; allowed"),
    "a column twice": (b"time,dx,dx,dy,dz\n0,0,0,0,0\n0.1,0,0,0,0\n", "column dx is there twice"),
    "a column twice but for blanks": (b"time,dx, dx,dy,dz\n0,0,0,0,0\n", "column dx is there twice"),
    "ten minutes": (
        HEAD + b"".join(b"%.2f,0,0,0\n" % (0.19 * k) for k in range(4000)),
        "the recording lasts 759.81 s; allowed 600 s",
    ),
    "words": (HEAD + b"0,0,0,0\n0.1,secret,0,0\n", "column dx holds something that is no number"),
    "no number": (HEAD + b"0,0,0,0\n0.1,nan,0,0\n", "row 2: dx is no finite number"),
    "endless": (HEAD + b"0,0,0,0\n0.1,inf,0,0\n", "row 2: dx is no finite number"),
    "holes": (HEAD + b"0,0,0,0\n0.1,,0,0\n", "row 2: dx is no finite number"),
    "time going backwards": (HEAD + b"0,0,0,0\n0.1,0,0,0\n0.05,0,0,0\n", "row 3: time does not rise"),
    "lines of other lengths": (b"a,b\nroot:x:0:0:secret\n", "cannot read the recording: expected 2 columns, got 1"),
    "another file": (
        b"root:x:0:0:secret:/root:/bin/sh\n" * 9,
        "column with a name that cannot be one holds something that is no number",
    ),
    "rubbish": (bytes(range(256)) * 20, "the recording"),
    "not UTF-8": (b"time,d\xff\xfe,dy,dz\n0,0,0,0\n", "cannot read the recording"),
    "a long name": (b"secret" * 10_000 + b"\n0\n", "with a name that cannot be one"),
    "many columns": (b",".join(b"c%d" % k for k in range(300)) + b"\n", "300 columns; allowed: 600001 rows, 200"),
    "nothing": (b"", "cannot read the recording"),
}


def refusal(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        read_recording(path, ())
    said = str(caught.value)
    assert "\n" not in said and len(said) <= 300 and "secret" not in said
    return said


@pytest.mark.parametrize(("content", "message"), FILES.values(), ids=FILES)
@pytest.mark.filterwarnings("error")
def test_a_bad_stream(tmp_path: Path, content: bytes, message: str) -> None:
    (tmp_path / "r.csv").write_bytes(content)
    assert message in refusal(tmp_path / "r.csv")


def test_a_packed_stream_is_not_unpacked(tmp_path: Path) -> None:
    import gzip

    (tmp_path / "r.csv.gz").write_bytes(gzip.compress(HEAD + b"0,0,0,0\n0.1,0,0,0\n"))
    assert "r.csv.gz" in refusal(tmp_path / "r.csv.gz")


def test_a_table_of_many_rows_is_refused_before_it_is_unpacked(tmp_path: Path) -> None:
    rows = arrow.table({name: np.zeros(2_000_000) for name in ("time", "dx", "dy", "dz")})
    parquet.write_table(rows, tmp_path / "r.parquet")
    assert (tmp_path / "r.parquet").stat().st_size < 100_000
    assert "2000000 rows of 4 columns; allowed: 600001 rows" in refusal(tmp_path / "r.parquet")


def test_a_table_of_texts_is_refused_before_it_is_unpacked(tmp_path: Path) -> None:
    parquet.write_table(arrow.table({"time": [0.0, 0.1], "dx": ["secret" * 1000] * 2}), tmp_path / "r.parquet")
    assert "column dx holds something that is no number" in refusal(tmp_path / "r.parquet")


@pytest.mark.parametrize("content", [b"PAR1", b"PAR1" + bytes(100) + b"PAR1", b""])
def test_a_broken_table(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "r.parquet").write_bytes(content)
    assert "cannot read the recording: it is no table" in refusal(tmp_path / "r.parquet")


def test_devices_pipes_and_folders_are_no_recordings(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.csv")
    for path, kind in ((tmp_path / "pipe.csv", "pipe"), (Path("/dev/zero"), "device"), (tmp_path, "folder")):
        assert f"cannot read the recording: it is a {kind}, not a file" in refusal(path)


def test_times_of_the_clock_are_taken(tmp_path: Path) -> None:
    now = time.time()
    (tmp_path / "r.csv").write_text(f"time,dx,dy,dz\n{now:.3f},0,0,0\n{now + 0.1:.3f},0,0,0\n")
    assert read_recording(tmp_path / "r.csv", ()).time[-1] == pytest.approx(0.1, abs=2e-3)
