"""The built wheel works from another folder: ontology, Prolog files and examples are inside."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from email.parser import Parser
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent.parent
pytestmark = pytest.mark.laws


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "build", "--no-isolation", "--wheel", "--outdir", str(out), str(ROOT)]
    subprocess.run(command, check=True, capture_output=True)
    return next(out.glob("prolepsis-*.whl"))


def test_the_wheel_holds_what_is_no_python(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    for pattern in ("prolepsis/knowledge/ontology/", "prolepsis/logic/prolog/", "prolepsis/examples/"):
        assert any(name.startswith(pattern) and not name.endswith(".py") for name in names), pattern
    assert "prolepsis/py.typed" in names
    assert any(name.endswith("LICENSE") for name in names)


def test_the_metadata_is_complete(wheel: Path) -> None:
    archive = zipfile.ZipFile(wheel)
    name = next(name for name in archive.namelist() if name.endswith("METADATA"))
    metadata = Parser().parsestr(archive.read(name).decode())
    assert metadata["Name"] == "prolepsis"
    assert metadata["License-Expression"] == "Apache-2.0"
    assert metadata["Author"] == "The prolepsis developers"
    assert metadata["Description-Content-Type"] == "text/markdown"
    assert metadata["Requires-Python"] == ">=3.11"


def test_the_wheel_works_from_another_folder(wheel: Path, tmp_path: Path) -> None:
    # The dependencies are those of the running environment; prolepsis itself is the wheel's.
    zipfile.ZipFile(wheel).extractall(tmp_path / "site")
    environment = {**os.environ, "PYTHONPATH": str(tmp_path / "site")}
    work = tmp_path / "work"
    work.mkdir()

    def prolepsis(*arguments: str) -> str:
        command = [sys.executable, "-m", "prolepsis", *arguments]
        return subprocess.run(command, cwd=work, env=environment, check=True, capture_output=True, text=True).stdout

    home = subprocess.run(
        [sys.executable, "-c", "import prolepsis; print(prolepsis.__file__)"],
        cwd=work,
        env=environment,
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    assert home.startswith(str(tmp_path / "site"))
    example = next(line.split()[0] for line in prolepsis("list", "examples").splitlines() if "dropped_egg" in line)
    assert example.startswith(str(tmp_path / "site"))
    prolepsis("project", example, "--out", "drop")
    assert "egg1" in prolepsis("ask", "drop", "occurs(falling(egg1), T), holds(supports(_, egg1), 0.0), E = egg1")
