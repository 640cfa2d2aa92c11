"""What a user waits for besides projection: help, lists, questions of a saved projection."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from bench_project import project_into
from beside import Row, alternately, row, used

REPEATS = 5
QUESTION = "holds(broken(X), T)"


def compared(sources: Sequence[Path]) -> Iterator[Row]:
    """Yield the rows of the table."""
    with tempfile.TemporaryDirectory() as folder:
        saved = {source: str(Path(folder) / f"drop{number}") for number, source in enumerate(sources)}
        for source in sources:
            project_into(source, Path(saved[source]))
        commands = {
            ("--help",): 0.15,
            ("list",): 0.15,
            ("list", "events"): 0.15,
            ("describe", "Egg"): 0.15,
            ("ask", "DIR", QUESTION): 0.3,
            ("timeline", "DIR"): 0.3,
        }
        for words, most in commands.items():

            def processor_time(source: Path, words: tuple[str, ...] = words) -> float:
                return used(source, "-m", "prolepsis", *(saved[source] if w == "DIR" else w for w in words)).busy

            runs = alternately(sources, processor_time, 1 + REPEATS)
            shown = " ".join(words)
            best = [f"{min(again):.2f} s" for _, *again in runs]
            yield row(f"prolepsis {shown}, processor time, best of {REPEATS}", f"under {most:g} s", best)
            yield row(f"prolepsis {shown}, the first time", "", [f"{first:.2f} s" for first, *_ in runs])
