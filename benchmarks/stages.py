"""Processor time [s] of the stages of one projection, by what it tells of its progress, as JSON.

PYTHONPATH=src python benchmarks/stages.py examples/dropped_egg.toml
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from pathlib import Path

from prolepsis import project


def main(scenario: str) -> None:
    """Print the stages of a scenario, from its beginning to the saved folder."""
    spent: dict[str, float] = {}
    doing, since = "", time.process_time()

    def tell(text: str) -> None:
        nonlocal doing, since
        now = time.process_time()
        spent[doing] = spent.get(doing, 0.0) + now - since
        doing, since = text.split(maxsplit=1)[0].rstrip(":"), now

    with tempfile.TemporaryDirectory() as folder:
        project(scenario, out=Path(folder) / "saved", progress=tell)
        tell("ended")
    print(json.dumps(spent))


if __name__ == "__main__":
    main(sys.argv[1])
