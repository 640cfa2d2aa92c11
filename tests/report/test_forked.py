"""A process that is forked after pictures were drawn draws the same ones, and does not disturb those of its parent."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from tests.synthetic import egg_drop_log

from prolepsis.log.files import write_log

SCRIPT = """
import os, sys
from prolepsis.log.files import read_log
from prolepsis.report.render import pictures, render_strip

log = read_log(sys.argv[1])

def draw(name):
    render_strip(log, f"{sys.argv[2]}/{name}.png", times=[0.1], size=(64, 64))

draw("before")
open_one = pictures(log, [0, 100], size=(64, 64))
next(open_one)
child = os.fork()
if child == 0:
    draw("child")
    sys.exit(0)
_, status = os.waitpid(child, 0)
assert status == 0
next(open_one)
draw("after")
"""


def test_a_forked_process_draws_with_what_is_its_own(tmp_path: Path) -> None:
    write_log(egg_drop_log(), tmp_path / "log")
    command = [sys.executable, "-c", SCRIPT, str(tmp_path / "log"), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    before, child, after = ((tmp_path / f"{name}.png").read_bytes() for name in ("before", "child", "after"))
    assert before == child == after
