"""Runs a command and prints, as JSON, what it took: elapsed and processor time [s], greatest memory [kB], its output.

A small process of its own: what is started by a large one counts that one's memory as its own.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time

if __name__ == "__main__":
    began = time.perf_counter()
    process = subprocess.Popen(sys.argv[1:], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    printed = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    elapsed = time.perf_counter() - began
    busy = usage.ru_utime + usage.ru_stime
    print(json.dumps({"elapsed": elapsed, "busy": busy, "memory": usage.ru_maxrss, "printed": printed}))
    sys.exit(process.returncode)
