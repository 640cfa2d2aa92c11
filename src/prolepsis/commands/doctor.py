"""``prolepsis doctor``: what is missing, and the one command that mends it."""

from __future__ import annotations

import argparse
import importlib
import os
import re
import select
import shutil
import subprocess
import sys
import warnings
from collections.abc import Callable
from typing import IO, Any, cast

from prolepsis.commands.output import add_command, table
from prolepsis.terms.errors import MissingToolError

EXAMPLE = """\
  prolepsis doctor
Exit status 0 if nothing is missing, 2 otherwise.
"""

OLDEST_PYTHON = (3, 11)
OLDEST_PROLOG = (9, 0, 4)


class _Missing(Exception):
    """What is wrong, and the command that mends it."""

    def __init__(self, what: str, cure: str) -> None:
        super().__init__(what)
        self.cure = cure


def add_to(commands: Any) -> None:
    """Add the command."""
    add_command(commands, "doctor", "tell what is missing, and the command that mends it", EXAMPLE, run)


def run(given: argparse.Namespace) -> int:
    """Check everything that prolepsis needs and print a line each."""
    checks: dict[str, Callable[[], str]] = {
        "Python": _python,
        "packages": _packages,
        "SWI-Prolog": _prolog,
        "confinement": _confinement,
        "pictures": _pictures,
        "video": _video,
    }
    rows: list[tuple[str, str, str]] = []
    cures: list[str] = []
    for name, check in checks.items():
        try:
            rows.append(("ok", name, check()))
        except _Missing as missing:
            rows.append(("MISSING", name, f"{missing}: {missing.cure}"))
            cures.append(missing.cure)
    print(table(rows))
    return 2 if cures else 0


def _python() -> str:
    shown = ".".join(map(str, sys.version_info[:3]))
    if sys.version_info < OLDEST_PYTHON:
        raise _Missing(f"Python {shown} is older than 3.11", "apt install python3")
    return shown


def _packages() -> str:
    from importlib.metadata import PackageNotFoundError, requires, version

    missing: list[str] = []
    for line in requires("prolepsis") or []:
        name = re.split(r"[^\w.-]", line)[0]
        try:
            version(name)
        except PackageNotFoundError:
            missing.append(name)
    if missing:
        raise _Missing(f"not installed: {', '.join(missing)}", f"pip install {' '.join(missing)}")
    return f"all {len(requires('prolepsis') or [])} installed"


def _prolog() -> str:
    program = shutil.which("swipl")
    cure = "apt install swi-prolog-nox"
    if program is None:
        raise _Missing("not found on PATH", cure)
    try:
        with subprocess.Popen([program, "--version"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as asked:
            stream = cast("IO[bytes]", asked.stdout)
            ready = select.select([stream], [], [], 20.0)[0]
            said = os.read(stream.fileno(), 4096).decode(errors="replace") if ready else ""
            asked.kill()
    except OSError as error:
        raise _Missing(f"{program} does not start ({error.strerror})", cure) from None
    match = re.search(r"version (\d+)\.(\d+)\.(\d+)", said)
    if match is None:
        raise _Missing(f"{program} tells no version", cure)
    found = tuple(map(int, match.groups()))
    if found < OLDEST_PROLOG:
        raise _Missing(f"{'.'.join(match.groups())} is older than 9.0.4", cure)
    return ".".join(match.groups())


def _confinement() -> str:
    """Start Prolog within its walls and look whether they hold."""
    from prolepsis.logic.confinement import CURE, offered
    from prolepsis.logic.process import PrologProcess

    with warnings.catch_warnings(record=True) as notes:
        warnings.simplefilter("always")
        try:
            PrologProcess().close()
        except MissingToolError as error:
            raise _Missing(str(error), "apt install swi-prolog-nox") from None
    if notes:
        raise _Missing(str(notes[0].message).rpartition("protects: ")[2], CURE)
    return f"Prolog is kept from files, programs and the network by {offered()}"


def _pictures() -> str:
    """Take a small picture of a red sphere and look whether it is there."""
    try:
        import numpy as np

        from prolepsis.report.offscreen import Camera
        from prolepsis.system.mujoco import mujoco

        spec = mujoco.MjSpec()
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=(1.0, 0.0, 0.0), rgba=(1.0, 0.0, 0.0, 1.0))
        model = spec.compile()
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        view = mujoco.MjvCamera()
        view.distance = 4.0
        with Camera(model, width=64, height=48, view=view) as camera:
            picture = camera.take(data).astype(np.int64)
            backend = camera.backend
    except MissingToolError as error:
        what, _, cure = str(error).rpartition("; ")
        raise _Missing(what, cure) from None
    except ImportError as error:
        raise _Missing(str(error), "pip install mujoco numpy") from None
    red, green = picture[24, 32, 0], picture[24, 32, 1]
    if red < 60 or red < 2 * green:
        raise _Missing(f"{backend} draws nothing", "apt install --reinstall libegl-mesa0 libgl1-mesa-dri")
    return f"off-screen OpenGL through {backend}"


def _video() -> str:
    try:
        library = cast(Any, importlib.import_module("imageio_ffmpeg"))
        return f"ffmpeg {library.get_ffmpeg_version()}"
    except (ImportError, RuntimeError) as error:
        raise _Missing(str(error).splitlines()[0], "pip install --force-reinstall imageio-ffmpeg") from None
