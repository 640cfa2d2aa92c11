"""A user's program may fork: the child projects and saves as its parent does."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
SCRIPT = """
import os, sys
import prolepsis

scenario, out = sys.argv[1:]
prolepsis.project(scenario, out=f"{out}/parent")
child = os.fork()
if child == 0:
    prolepsis.project(scenario, out=f"{out}/child")
    print([row.error for row in prolepsis.sweep(scenario, {"Time": [0.01]}).rows], flush=True)
    sys.exit(0)
_, status = os.waitpid(child, 0)
print(status)
"""


def test_a_forked_process_projects_to_the_same_bytes(tmp_path: Path) -> None:
    shutil.copy(ROOT / "examples" / "dropped_egg.ttl", tmp_path)
    scenario = tmp_path / "short.toml"
    scenario.write_text(
        'situation = "dropped_egg.ttl"\nplan = "wait(Time)"\nduration = 0.05\n[parameters]\nTime = 0.03\n'
    )
    command = [sys.executable, "-c", SCRIPT, str(scenario), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert (done.stdout, done.stderr) == ("[None]\n0\n", "")
    contents = [{file.name: file.read_bytes() for file in (tmp_path / who).iterdir()} for who in ("parent", "child")]
    assert contents[0] == contents[1]
