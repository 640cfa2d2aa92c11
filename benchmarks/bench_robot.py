"""How fast a whole robot with an egg is: before anything touches the egg, while it is held, and twelve levels of force.

Times are of the processor, which on a quiet machine are those of the clock.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path

from beside import ROOT, Row, alternately, phase_rows, row, used

SCENARIO = ROOT / "examples" / "pr2_grasp.toml"
PHASES = (
    ("PR2, nothing touches the egg but the table", 0.2, 1.4, "", ">= 2.0"),
    ("PR2, a gripper holds the egg", 3.2, 5.2, ">= 0.8", ">= 1.0"),
)
"""The arm reaches until 1.5 s, and holds from 3.1 s on."""
LEVELS = [f"force{number}" for number in range(1, 13)]
OUTCOMES = ("slip", "hold", "crush")


def compared(sources: Sequence[Path]) -> Iterator[Row]:
    """Yield the rows of the table."""
    yield from phase_rows(sources, SCENARIO, PHASES)
    words = ("-m", "prolepsis", "sweep", str(SCENARIO), "--json", "--over")
    # A crushed egg needs all the kernels, which are compiled once and kept.
    alternately(sources, lambda source: used(source, *words, f"Force={LEVELS[-1]}"), 1)
    runs = [run for (run,) in alternately(sources, lambda source: used(source, *words, f"Force={','.join(LEVELS)}"), 1)]
    yield row("PR2, twelve levels on two cores", "under 35 s", [f"{run.elapsed:.0f} s" for run in runs])
    yield row("the same, processor time", "", [f"{run.busy:.0f} s" for run in runs])
    ends = [[json.loads(line).get("outcome") for line in run.printed.splitlines()] for run in runs]
    counts = [" / ".join(str(end.count(outcome)) for outcome in OUTCOMES) for end in ends]
    yield row(f"of them {' / '.join(OUTCOMES)}", "4 / 3 / 5", counts)
