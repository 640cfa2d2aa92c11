"""Runs every ``bench_*.py`` of this folder and prints one table: what was measured, and what it should be.

A benchmark is a module with ``rows()`` that yields ``(what, measured, wanted)``, three texts, or with
``compared(sources)``, whose rows have one more text for an earlier state, or with both. Nothing here passes or fails:
times depend on the machine, so the figures that matter are ratios within one run.
"""

from __future__ import annotations

import argparse
import importlib.util
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from beside import HERE, Row, archived
from prolepsis.commands.output import table

FOLDER = Path(__file__).parent
EXAMPLE = """examples:
  make bench                                       all of them
  make bench ARGS='simulate robot'                 only these
  make bench ARGS='project --against v1.0'         beside the package of an earlier commit, run in turn with this one
The processor should have nothing else to do. Where the earlier state compiles kernels anew, that counts for none of
what is the best of several."""


def main() -> None:
    """Run the benchmarks whose names are given, or all."""
    known = {file.stem.removeprefix("bench_"): file for file in sorted(FOLDER.glob("bench_*.py"))}
    read = argparse.ArgumentParser(
        description="Measure, and print one table: what was measured, and what it should be.",
        epilog=EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    read.add_argument("names", nargs="*", metavar="NAME", help=f"all if none is given: {', '.join(known)}")
    read.add_argument(
        "--against", metavar="REV", help="an earlier commit, of which the same is measured where it can be"
    )
    given = read.parse_args()
    unknown = sorted({*given.names} - {*known})
    if unknown:
        read.error(f"no benchmark named {', '.join(unknown)}; known: {', '.join(known)}")
    chosen = {name: file for name, file in known.items() if not given.names or name in given.names}
    with tempfile.TemporaryDirectory() as folder:
        sources = [HERE]
        title: Row = ("what", "measured", "wanted")
        if given.against is not None:
            try:
                sources.append(archived(given.against, Path(folder)))
            except (LookupError, subprocess.CalledProcessError) as error:
                read.error(f"--against {given.against}: {error}")
            title = (*title, f"at {given.against}")
        print(table([title, *_measured(chosen, sources, len(title))]))


def _measured(chosen: dict[str, Path], sources: Sequence[Path], width: int) -> Iterator[Row]:
    for name, file in chosen.items():
        print(f"measuring: {name}", file=sys.stderr, flush=True)
        try:
            for what, *texts in _rows(file, sources):
                print(f"  {what}: {' | '.join(texts)}", file=sys.stderr, flush=True)
                yield (f"{name}: {what}", *texts, *[""] * (width - 1 - len(texts)))
        # Whatever one benchmark comes to, the figures of the others took long.
        except Exception as error:
            yield (name, f"{type(error).__name__}: {error}", *[""] * (width - 2))


def _rows(file: Path, sources: Sequence[Path]) -> Iterator[Row]:
    # A benchmark may import its neighbours, and scenes from the tests.
    sys.path[:0] = [str(FOLDER), str(FOLDER.parent)]
    spec = importlib.util.spec_from_file_location(file.stem, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[file.stem] = module
    spec.loader.exec_module(module)
    if hasattr(module, "compared"):
        yield from module.compared(sources)
    if hasattr(module, "rows"):
        yield from module.rows()


if __name__ == "__main__":
    # A run that is ended leaves nothing behind.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
