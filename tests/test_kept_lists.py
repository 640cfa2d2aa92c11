"""What `list` and `describe` tell is kept, and told anew once the package is another or something more is declared."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import prolepsis

ADDED = """
from collections.abc import Iterator

from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import fluent
from prolepsis.log.timeline import Fact


@fluent("purple", "o")
def purple(observation: Observation) -> Iterator[Fact]:
    \"\"\"The thing is purple.\"\"\"
    return iter(())
"""
DECLARED = f"{ADDED}\nfrom prolepsis.cli import main\nmain(['list', 'fluents'])"


def told(source: Path, cache: Path, *words: str) -> str:
    environment = {**os.environ, "PYTHONPATH": str(source), "XDG_CACHE_HOME": str(cache)}
    done = subprocess.run([sys.executable, *words], env=environment, capture_output=True, text=True, cwd=source)
    assert not done.stderr
    return done.stdout


def test_lists_are_those_of_the_package_as_it_is(tmp_path: Path) -> None:
    source, cache = tmp_path / "src", tmp_path / "cache"
    shutil.copytree(Path(prolepsis.__file__).parent, source / "prolepsis", ignore=shutil.ignore_patterns("__pycache__"))
    first = told(source, cache, "-m", "prolepsis", "list", "fluents")
    kept = [*(cache / "prolepsis" / "told").iterdir()]
    assert len(kept) == 1
    assert told(source, cache, "-m", "prolepsis", "list", "fluents") == first
    assert "purple" not in first
    assert "purple" in told(source, cache, "-c", DECLARED)
    assert told(source, cache, "-m", "prolepsis", "list", "fluents") == first
    (source / "prolepsis" / "fluents" / "purple.py").write_text(f'"""Purple."""\n{ADDED}')
    assert "purple(o)" in told(source, cache, "-m", "prolepsis", "list", "fluents")
    assert told(source, cache, "-m", "prolepsis", "describe", "purple") == told(
        source, cache, "-m", "prolepsis", "describe", "purple"
    )


def test_what_is_told_without_docstrings_is_not_kept_for_others(tmp_path: Path) -> None:
    source = Path(prolepsis.__file__).parents[1]
    words = ("-m", "prolepsis", "list", "fluents")
    bare, full = told(source, tmp_path, "-OO", *words), told(source, tmp_path, *words)
    assert len(full) > len(bare)
