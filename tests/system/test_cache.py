"""The cache only saves time: whatever is done to it, the answer is the same, and nothing of others is taken from it."""

from __future__ import annotations

import os
import pickle
import re
import shutil
import stat
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from prolepsis.geometry.kept import kept_array
from prolepsis.geometry.shape import FloatArray
from prolepsis.system import cache
from prolepsis.system.cache import keep, keep_newest, read_kept
from prolepsis.system.kernels import BESIDE, ROOMS
from prolepsis.system.sources import sources_in

RIGHT = np.arange(12.0).reshape(3, 4)


@pytest.fixture
def root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    cache._say.cache_clear()  # pyright: ignore[reportPrivateUsage]
    return tmp_path / "home" / "prolepsis"


def array(calls: list[int] | None = None) -> FloatArray:
    def compute() -> FloatArray:
        if calls is not None:
            calls.append(1)
        return RIGHT

    return kept_array("test", [np.zeros(3)], compute)


def flip(file: Path) -> None:
    content = bytearray(file.read_bytes())
    content[-3] ^= 0x40
    file.write_bytes(content)


def another_array(file: Path) -> None:
    """Put another array into a file, in the way that numpy writes it."""
    with file.open("wb") as stream:
        np.save(stream, RIGHT[:1] + 1.0)


def of_another_name(file: Path) -> None:
    """Put into a file what is whole, but was kept for another purpose."""
    keep(file.with_name("other"), b"whole")
    file.write_bytes(file.with_name("other").read_bytes())


def link(file: Path) -> None:
    file.rename(file.with_name("elsewhere"))
    file.symlink_to(file.with_name("elsewhere"))


def pipe(file: Path) -> None:
    file.unlink()
    os.mkfifo(file)


def empty(file: Path) -> None:
    file.write_bytes(b"")


def cut(file: Path) -> None:
    os.truncate(file, file.stat().st_size // 2)


@pytest.mark.parametrize("damage", [flip, empty, cut, another_array, of_another_name, link, pipe])
def test_a_damaged_array_is_made_anew_with_one_note(
    root: Path, capfd: pytest.CaptureFixture[str], damage: Callable[[Path], None]
) -> None:
    array()
    (file,) = (root / "arrays").iterdir()
    damage(file)
    calls: list[int] = []
    assert (array(calls) == RIGHT).all()
    (line,) = capfd.readouterr().err.splitlines()
    assert line == f"prolepsis: note: {file}: is damaged, so what it held is made anew"
    assert (array(calls) == RIGHT).all()
    assert len(calls) == 1


def test_only_this_user_may_read_and_write_the_cache(root: Path) -> None:
    array()
    assert all(stat.S_IMODE(folder.stat().st_mode) == 0o700 for folder in (root.parent, root, root / "arrays"))


@pytest.mark.parametrize("depth", [0, 1, 2])
@pytest.mark.parametrize("mode", [0o777, 0o770])
def test_a_cache_in_which_others_may_write_is_not_used(
    root: Path, capfd: pytest.CaptureFixture[str], depth: int, mode: int
) -> None:
    array()
    open_to_all = [root / "arrays", root, root.parent][depth]
    open_to_all.chmod(mode)
    calls: list[int] = []
    assert (array(calls) == RIGHT).all()
    assert calls == [1]
    assert f"{open_to_all}: others may write there" in capfd.readouterr().err


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a folder away")
@pytest.mark.parametrize("what", ["folder", "file"])
def test_a_cache_that_belongs_to_somebody_else_is_not_used(
    root: Path, capfd: pytest.CaptureFixture[str], what: str
) -> None:
    array()
    (file,) = (root / "arrays").iterdir()
    os.chown(file if what == "file" else file.parent, 12345, 12345)
    calls: list[int] = []
    assert (array(calls) == RIGHT).all()
    assert calls == [1]
    assert "prolepsis: note: " in capfd.readouterr().err


def test_a_cache_that_cannot_be_written_only_costs_time_and_says_so_once(
    root: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    root.parent.write_text("a file where the cache should be")
    assert (array() == RIGHT).all()
    assert (array() == RIGHT).all()
    (line,) = capfd.readouterr().err.splitlines()
    assert line.startswith(f"prolepsis: note: {root / 'arrays'}: nothing can be kept there (")
    assert line.endswith("so what takes long is computed at each run; XDG_CACHE_HOME names another folder")


def test_a_full_disk_only_costs_time_and_leaves_no_part(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(one: object, other: object) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(os, "replace", full)
        assert (array() == RIGHT).all()
        assert list((root / "arrays").iterdir()) == []
    keep(root / "arrays" / "b", b"b")
    assert read_kept(root / "arrays" / "b") == b"b"


def test_a_note_that_cannot_be_said_changes_nothing() -> None:
    told = "from prolepsis.system.cache import note; note('this'); print('done')"
    with open("/dev/full", "w") as full:
        done = subprocess.run([sys.executable, "-c", told], stdout=subprocess.PIPE, stderr=full, text=True, check=False)
    assert done.stdout == "done\n"


def test_what_is_not_of_the_cache_is_never_removed(root: Path) -> None:
    folder = root / "read"
    for number in range(5):
        keep(folder / f"kept{number}", b"kept")
        os.utime(folder / f"kept{number}", (number, number))
    (folder / "book").write_text("precious")
    os.utime(folder / "book", (0, 0))
    keep_newest(folder, 2)
    assert sorted(file.name for file in folder.iterdir()) == ["book", "kept3", "kept4"]


def test_a_part_that_a_killed_process_left_is_removed_and_one_that_is_written_is_not(root: Path) -> None:
    keep(root / "read" / "a", b"a")
    old, new = root / "read" / f".old{cache.PART}", root / "read" / f".new{cache.PART}"
    for part in (old, new):
        part.write_bytes(b"half")
    os.utime(old, (0, 0))
    keep(root / "read" / "b", b"b")
    assert not old.exists() and new.exists()


def test_what_an_editor_leaves_beside_sources_is_none(tmp_path: Path) -> None:
    (tmp_path / "room").mkdir()
    (tmp_path / "room" / "a.py").write_text("a")
    (tmp_path / "room" / ".#a.py").symlink_to("nobody@host.1:1")
    (tmp_path / "room" / "gone.py").symlink_to("nowhere")
    (tmp_path / "room" / "folder.py").mkdir()
    assert sources_in(tmp_path, "py") == [tmp_path / "room" / "a.py"]


def test_constants_of_kernels_are_of_what_their_key_is_made_of() -> None:
    package = Path(cache.__file__).parents[1]
    rooms = [package / room for room in ROOMS]
    for file in (each for room in rooms for each in sources_in(room, "py")):
        text = file.read_text(encoding="utf-8")
        if "@njit" not in text:
            continue
        body = text.partition("@njit")[2]
        for source, names in re.findall(r"^from prolepsis\.(\S+) import ([^()\n]+)$", text, re.MULTILINE):
            constants = [n for n in re.findall(r"\b[A-Z][A-Z_]+\b", names) if re.search(rf"\b{n}\b", body)]
            known = package / f"{source.replace('.', '/')}.py"
            is_known = known in map(package.joinpath, BESIDE) or any(room in known.parents for room in rooms)
            assert is_known or not constants, file


KERNEL = """
import sys
import numpy as np
from prolepsis.system.kernels import njit

@njit(cache=True)
def total(numbers):
    found = 0.0
    for each in numbers:
        found += each
    return found

print(total(np.arange(5.0)), sum(total.stats.cache_hits.values()))
"""


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a script that calls a kernel, and the cache after it has run once."""
    folder = tmp_path_factory.mktemp("kernels")
    (folder / "script.py").write_text(KERNEL)
    assert run(folder) == ("10.0 0\n", "")
    return folder


def run(folder: Path, **more: str) -> tuple[str, str]:
    environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "home"), **more}
    command = [sys.executable, str(folder / "script.py")]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return done.stdout, done.stderr


def test_a_kernel_is_kept_apart_for_other_settings_of_the_compiler(compiled: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(compiled, tmp_path / "kernels")
    assert run(folder, NUMBA_OPT="0") == ("10.0 0\n", "")
    assert run(folder, NUMBA_OPT="0") == run(folder) == ("10.0 1\n", "")


class Malice:
    """What runs a program when it is unpickled."""

    def __reduce__(self) -> tuple[Callable[..., None], tuple[str]]:
        return exec, ("print('harm')",)


@pytest.mark.parametrize("damage", ["none", "flip", "cut", "pickle"])
def test_an_altered_kernel_is_never_loaded_but_compiled_anew(compiled: Path, tmp_path: Path, damage: str) -> None:
    folder = shutil.copytree(compiled, tmp_path / "kernels")
    (file,) = (folder / "home" / "prolepsis").glob("kernels-*/*")
    if damage == "flip":
        flip(file)
    elif damage == "cut":
        cut(file)
    elif damage == "pickle":
        file.write_bytes(pickle.dumps(Malice()))
    answer, notes = run(folder)
    assert answer == ("10.0 1\n" if damage == "none" else "10.0 0\n")
    assert ("is damaged, so what it held is made anew" in notes) == (damage != "none")
    assert run(folder) == ("10.0 1\n", "")
