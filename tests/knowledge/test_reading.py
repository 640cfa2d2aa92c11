"""What was read of a situation is kept, and read anew when any of it has changed."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from situations import PREFIX, load

from prolepsis.knowledge import KnowledgeBase, kept
from prolepsis.terms.errors import KnowledgeError

EGG = ":egg1 a :Egg ; :mass 0.06 ."
IMPORTED = """
import sys
from prolepsis.knowledge import KnowledgeBase
base = KnowledgeBase.load(sys.argv[1])
print(base.quantity("egg1", "mass"), "rdflib" in sys.modules)
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the folder of what is kept in this test."""
    monkeypatch.setenv("PROLEPSIS_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache" / "read"


def told(base: KnowledgeBase) -> object:
    return base.domain(), base.vocabulary, base.situation, base.describe("egg1")


def test_what_is_kept_says_what_the_files_say(tmp_path: Path, folder: Path) -> None:
    first, heavy = load(tmp_path, EGG), {"egg1.mass": 0.07}
    second = load(tmp_path, EGG)
    assert len([*folder.iterdir()]) == 1
    assert told(second) == told(first)
    assert told(second.with_values(heavy)) == told(first.with_values(heavy))


def test_a_situation_that_was_read_needs_no_reader(tmp_path: Path, folder: Path) -> None:
    load(tmp_path, EGG)
    command = [sys.executable, "-c", IMPORTED, str(tmp_path / "situation.ttl")]
    assert subprocess.run(command, capture_output=True, text=True, check=True).stdout == "0.06 False\n"
    assert len([*folder.iterdir()]) == 1


def test_a_text_that_has_changed_is_read_anew(tmp_path: Path, folder: Path) -> None:
    assert load(tmp_path, EGG).quantity("egg1", "mass") == 0.06
    assert load(tmp_path, EGG.replace("0.06", "0.05")).quantity("egg1", "mass") == 0.05
    assert len([*folder.iterdir()]) == 2


def test_a_value_is_told_with_the_file_that_it_is_from(tmp_path: Path, folder: Path) -> None:
    load(tmp_path, EGG)
    other = tmp_path / "other.ttl"
    other.write_text(PREFIX + EGG)
    assert KnowledgeBase.load(other).value("egg1", "mass").source == f"{other}:4"
    assert len([*folder.iterdir()]) == 2


def test_what_is_wrong_is_told_each_time_and_not_kept(tmp_path: Path, folder: Path) -> None:
    for _ in range(2):
        with pytest.raises(KnowledgeError, match="mass"):
            load(tmp_path, EGG.replace("0.06", "-1.0"))
    assert not folder.exists()


def test_what_is_altered_is_read_anew(tmp_path: Path, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first = load(tmp_path, EGG)
    (file,) = folder.iterdir()
    whole = file.read_bytes()
    file.write_bytes(whole[:-1] + b"x")
    assert told(load(tmp_path, EGG)) == told(first)
    assert "is damaged" in capsys.readouterr().err
    assert file.read_bytes().split(b"\n")[0][:10] == whole[:10]


def test_only_the_newest_are_kept(tmp_path: Path, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept, "MOST_READINGS", 2)
    for mass in (0.05, 0.06, 0.07):
        load(tmp_path, EGG.replace("0.06", str(mass)))
    assert len([*folder.iterdir()]) == 2
