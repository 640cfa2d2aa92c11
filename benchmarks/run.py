"""Runs every ``bench_*.py`` of this folder and prints one table: what was measured, and what it should be.

A benchmark is a module with ``rows()`` that yields ``(what, measured, wanted)``, three texts. Nothing here passes or
fails: times depend on the machine, so the figures that matter are ratios within one run.
"""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

from prolepsis.commands.output import table
from prolepsis.terms.errors import ProlepsisError

Rows = Iterable[tuple[str, str, str]]


def main(chosen: list[str]) -> None:
    """Run the benchmarks whose names are given, or all."""
    measured: list[tuple[str, str, str]] = [("what", "measured", "wanted")]
    for file in sorted(Path(__file__).parent.glob("bench_*.py")):
        name = file.stem.removeprefix("bench_")
        if chosen and name not in chosen:
            continue
        print(f"measuring: {name}", file=sys.stderr, flush=True)
        try:
            measured += [(f"{name}: {what}", value, wanted) for what, value, wanted in _rows(file)()]
        except ProlepsisError as error:
            measured.append((name, f"{type(error).__name__}: {error}", ""))
    print(table(measured))


def _rows(file: Path) -> Callable[[], Rows]:
    # A benchmark may import its neighbours, and scenes from the tests.
    sys.path[:0] = [str(file.parent), str(file.parent.parent)]
    spec = importlib.util.spec_from_file_location(file.stem, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[file.stem] = module
    spec.loader.exec_module(module)
    return module.rows


if __name__ == "__main__":
    main(sys.argv[1:])
