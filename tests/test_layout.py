"""The house: what is general names no kind, every room is told of, no file is too long or lacks a first sentence."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "prolepsis"
GENERAL = (
    *(f"engine/{file.stem}" for file in sorted((SOURCE / "engine").glob("*.py"))),
    *("scene/compose", "scene/kind", "scene/running", "report/stage", "report/droplets"),
)
"""What knows kinds of matter, of hands and of robots only by the steps of ``scene/kind.py``."""
KINDS = re.compile(
    r"eggs?|shell(s|ed)?|panels?|yolks?|fingers?|palms?|sponges?|bowls?|cups?|coconuts?|kernels?|membranes?|breakable",
    re.IGNORECASE,
)
EVERYDAY = {
    "way": "displacement, distance, travel or path",
    "place": "position, location or index",
    "turn": "orientation, rotation or angle",
}
"""Words that name a quantity by its everyday word, and those by which robotics knows it."""
LONGEST = 400
"""Lines of a file that one can still explain in a sentence."""


def words(file: Path) -> list[tuple[int, str]]:
    """Return the words of a file with their lines, those within names and texts too, but for MuJoCo's own names."""
    parted = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])")
    mujoco = re.compile(r"\bmj\w+")
    lines = enumerate(mujoco.sub("", file.read_text(encoding="utf-8")).splitlines(), 1)
    return [(number, word) for number, line in lines for word in parted.findall(line)]


@pytest.mark.parametrize("name", GENERAL)
def test_what_is_general_names_no_kind(name: str) -> None:
    found = [f"{name}.py:{line}: {word}" for line, word in words(SOURCE / f"{name}.py") if KINDS.fullmatch(word)]
    assert not found


def test_the_scan_finds_a_kind_in_names_and_comments(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text('eggShell = "panelCount"  # as fish_finger\n')
    assert [word for _, word in words(tmp_path / "a.py") if KINDS.fullmatch(word)] == [
        "egg",
        "Shell",
        "panel",
        "finger",
    ]


def test_quantities_are_named_by_the_words_of_the_field() -> None:
    found = [
        f"{file.relative_to(SOURCE)}: {name}: say {EVERYDAY[word]}"
        for file in sorted(SOURCE.rglob("*.py"))
        for name in sorted(names(file))
        if (word := name.strip("_").lower().removesuffix("s")) in EVERYDAY
    ]
    assert not found


def test_the_scan_finds_names_wherever_they_are_given(tmp_path: Path) -> None:
    text = "from a import b as Place\ndef _turn(place, *ways): pass\nclass A:\n    turns: int\nx.way = f'{y}'"
    (tmp_path / "a.py").write_text(text + "\n")
    assert names(tmp_path / "a.py") >= {"Place", "_turn", "place", "ways", "A", "turns", "way", "y"}


def names(file: Path) -> set[str]:
    """Return what is named or given a name in a file: variables, parameters, attributes, functions and classes."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        fields = (getattr(node, field, None) for field in ("id", "arg", "attr", "name", "asname"))
        found |= {field for field in fields if isinstance(field, str)}
    return found


def test_the_house_is_drawn_as_it_is() -> None:
    drawn = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    rooms = [folder.name for folder in SOURCE.iterdir() if (folder / "__init__.py").exists()]
    assert len(rooms) > 10
    assert [room for room in rooms if f"`{room}/`" not in drawn] == []


def test_no_file_is_loose() -> None:
    loose = {file.stem for file in SOURCE.glob("*.py")}
    assert loose == {"__init__", "__main__", "cli", "projection"}


@pytest.mark.parametrize("folder", ["src", "tests", "tools", "benchmarks"])
def test_every_file_says_what_it_is_and_is_short(folder: str) -> None:
    files = list((ROOT / folder).rglob("*.py"))
    assert files
    for file in files:
        text = file.read_text(encoding="utf-8")
        said = ast.get_docstring(ast.parse(text))
        assert said or not text.strip(), f"{file}: no first sentence"
        assert len(text.splitlines()) <= LONGEST or folder != "src", f"{file}: longer than {LONGEST} lines"


def test_tests_mirror_the_rooms() -> None:
    rooms = {folder.name for folder in SOURCE.iterdir() if folder.is_dir()}
    others = {"contract", "errors", "laws", "prolog", "stories"}
    tested = {file.relative_to(ROOT / "tests").parts[0] for file in (ROOT / "tests").rglob("*/*.py")}
    assert tested <= rooms | others


def test_no_files_import_each_other_in_a_circle() -> None:
    files = {module_name(file): file for file in SOURCE.rglob("*.py")}
    needs = {name: imported(file, files.keys()) - {name} for name, file in files.items()}
    left = set(needs)
    while free := {name for name in left if not needs[name] & left}:
        left -= free
    assert not left, "a circle is among these, or leads into one"


def module_name(file: Path) -> str:
    return ".".join(file.relative_to(SOURCE.parent).with_suffix("").parts).removesuffix(".__init__")


def imported(file: Path, modules: Collection[str]) -> set[str]:
    """Return the modules that a file imports when it is imported itself, not those of a call or for types only."""
    found: set[str] = set()
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ImportFrom) and node.module is not None:
            for alias in node.names:
                within = f"{node.module}.{alias.name}"
                found.add(within if within in modules else node.module)
    return found & {*modules}
