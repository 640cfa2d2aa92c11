"""What docs/paper.md says of the paper's queries is what they come to."""

from __future__ import annotations

import re
import shlex
from itertools import groupby
from pathlib import Path

import pytest

from prolepsis.cli import main

ROOT = Path(__file__).parents[2]


NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?![\w.])")


def numbers(text: str) -> list[float]:
    """Return the numbers of a text, those in names left out."""
    return [float(each) for each in NUMBER.findall(text)]


def consoles() -> list[str]:
    """Return the commands of the page with their answers; those that ask of one folder are together."""
    page = (ROOT / "docs" / "paper.md").read_text(encoding="utf-8")
    lines = "".join(re.findall(r"```console\n(.*?)```", page, re.DOTALL)).splitlines()
    commands = [f"{line[2:]}\n" for line in lines if line.startswith("$ ")]
    number = -1
    for line in lines:
        if line.startswith("$ "):
            number += 1
        else:
            commands[number] += f"{line}\n"
    commands.sort(key=_folder)
    return ["\0".join(group) for _, group in groupby(commands, key=_folder)]


def _folder(command: str) -> str:
    found = re.search(r"out/\w+", command)
    assert found is not None
    return found[0]


@pytest.mark.parametrize("console", consoles(), ids=_folder)
def test_the_page_tells_what_the_commands_answer(
    console: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    asked = 0
    for each in console.split("\0"):
        command, _, answer = each.partition("\n")
        words = shlex.split(command)
        assert words[0] == "prolepsis"
        main(words[1:])
        if words[1] == "ask":
            asked += 1
            found = capsys.readouterr().out
            assert NUMBER.sub("#", found) == NUMBER.sub("#", answer)
            # Processors round differently, and a liquid's last drops tell: a time may be off by some frames of it.
            assert numbers(found) == pytest.approx(numbers(answer), rel=0.02, abs=0.1)
        capsys.readouterr()
    assert asked
