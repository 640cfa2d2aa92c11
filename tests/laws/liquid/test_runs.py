"""Runs with a liquid: the same seed gives the same bytes, and a warm process compiles nothing."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
from tests.scenes import run

ROOT = Path(__file__).parent.parent.parent.parent
SITUATION = (
    ":floor a :Floor . :table1 a :Table . :cup1 a :Cup ; :on :table1 ; :contains :liq1 . "
    ":liq1 a :Water ; :volume 0.0001 ."
)
SCRIPT = f"""
from numba.core import event
from tests.scenes import run
with event.install_recorder("numba:compile") as compiled:
    log = run({SITUATION!r}, duration=0.05)
assert log.particles is not None
print(len(compiled.buffer))
"""


def test_the_same_seed_gives_the_same_bytes() -> None:
    first, second = (run(SITUATION, duration=0.2, seed=3) for _ in range(2))
    assert first.particles is not None
    assert second.particles is not None
    assert first.particles.position.tobytes() == second.particles.position.tobytes()
    assert first.poses.tobytes() == second.poses.tobytes()
    assert np.array_equal(first.contacts.force, second.contacts.force)


def test_a_warm_process_compiles_nothing() -> None:
    """The first process may have to; the second finds every kernel on disk."""
    counts: list[int] = []
    for _ in range(2):
        done = subprocess.run([sys.executable, "-c", SCRIPT], cwd=ROOT, check=True, capture_output=True, text=True)
        counts.append(int(done.stdout.split()[-1]))
    assert counts[1] == 0
