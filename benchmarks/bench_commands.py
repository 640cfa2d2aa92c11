"""What a user waits for besides projection: help, lists, questions of a saved projection."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from bench_project import processor_time, project_into

REPEATS = 5
QUESTION = "holds(broken(X), T)"


def rows() -> Iterator[tuple[str, str, str]]:
    """Yield the rows of the table."""
    with tempfile.TemporaryDirectory() as folder:
        saved = str(Path(folder) / "drop")
        project_into(Path(saved), 0)
        commands = {
            ("--help",): 0.15,
            ("list",): 0.15,
            ("list", "events"): 0.15,
            ("describe", "Egg"): 0.15,
            ("ask", saved, QUESTION): 0.3,
            ("timeline", saved): 0.3,
        }
        for words, most in commands.items():
            first, *again = (processor_time("-m", "prolepsis", *words) for _ in range(1 + REPEATS))
            shown = " ".join(word for word in words if word != saved)
            yield f"prolepsis {shown}, processor time, best of {REPEATS}", f"{min(again):.2f} s", f"under {most:g} s"
            yield f"prolepsis {shown}, the first time", f"{first:.2f} s", ""
