"""A robot's file is first read in a process of its own: if MuJoCo ends with a crash there, that is a message here.

MuJoCo is native code, and a mesh that it does not expect may end the process that reads it, or use all memory. The
trial takes about a second; that it was passed is kept under all that MuJoCo has seen.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path

from prolepsis.system.cache import cache_root, keep, read_kept
from prolepsis.system.sources import digest_of
from prolepsis.terms.errors import ScenarioError

MEMORY = 4 * 2**30
"""Address space of the process [byte]: MuJoCo itself takes half a gigabyte of it."""
SECONDS = 60
"""Time of the processor that it may take [s]."""
PASSED, REFUSED = 0, 2


def try_robot(path: Path, folder: Path | None, model: bytes, meshes: Iterable[Path]) -> None:
    """Refuse a robot that the process which reads it does not survive.

    Args:
        path: Its file.
        folder: Where all files that it names must be, if that is told.
        model: What MuJoCo is given of it.
        meshes: Files that MuJoCo reads.

    Raises:
        ScenarioError: If the process refuses it, or ends otherwise.
    """
    passed = cache_root() / "robots" / digest_of((2, "mujoco", version("mujoco"), model), set(meshes))
    if read_kept(passed) is not None:
        return
    told = [] if folder is None else [str(folder.absolute())]
    with tempfile.TemporaryDirectory() as scratch:
        # MuJoCo writes its warnings into the working folder.
        ended = subprocess.run(
            [sys.executable, "-m", f"{__name__}_of_one", str(path.absolute()), *told],
            cwd=scratch,
            env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            check=False,
        )
    if ended.returncode == REFUSED:
        raise ScenarioError(ended.stdout.decode(errors="replace").replace(str(path.absolute()), str(path)))
    if ended.returncode != PASSED:
        how = "an error"
        if ended.returncode < 0:
            how = signal.Signals(-ended.returncode).name
        raise ScenarioError(
            f"{path}: the robot cannot be built: reading it in a process of its own ended with {how} (allowed: "
            f"{MEMORY / 2**30:g} GiB and {SECONDS} s); its meshes may be damaged or too fine"
        )
    keep(passed, b"")
