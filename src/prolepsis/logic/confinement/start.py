"""The launcher: limits and walls are put up around a process, which then becomes SWI-Prolog."""

from __future__ import annotations

import ctypes
import json
import os
import resource
import shutil
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from prolepsis.logic.confinement import landlock, system_calls
from prolepsis.logic.confinement.offer import Walls

LIBRARIES = ("/lib", "/lib32", "/lib64", "/usr/lib", "/usr/lib32", "/usr/lib64", "/usr/local/lib", "/nix/store")
"""Where programs find their libraries; a wall lets nothing else of the system be read but the next."""
SYSTEM_FILES = ("/etc/ld.so.cache", "/etc/localtime", "/usr/share/zoneinfo", "/usr/share/locale", "/dev/null")
COMPUTING = ("/dev/urandom", "/sys/devices/system/cpu")
KEPT_VARIABLES = ("LD_LIBRARY_PATH", "SWI_HOME_DIR", "TZ")
"""What Prolog gets of the environment: nothing that is anybody's secret."""
LONGEST_FILE = 1 << 20
"""Longest file that it may write, which is what it says on standard error [bytes]."""
OPEN_FILES = 512
PR_SET_PDEATHSIG = 1
MOST_LIBRARIES = 1000
"""Most libraries in the folders of LD_LIBRARY_PATH that are made readable, one by one."""

_ENTER = "import sys; sys.path.insert(0, sys.argv.pop(1)); from prolepsis.logic.confinement.start import main; main()"


def command(
    program: str, arguments: Sequence[str], *, walls: Walls, folder: Path, code: Path, memory: int
) -> list[str]:
    """Return the command that starts a confined SWI-Prolog.

    Args:
        program: Path of ``swipl``.
        arguments: Its arguments.
        walls: The walls to put up.
        folder: The one folder whose files it reads and where it makes its socket.
        code: Folder of the Prolog files that it loads.
        memory: Greatest address space [bytes]; a lower limit of this process stays.
    """
    plan = {
        "program": program,
        "arguments": list(arguments),
        "landlock": bool(walls.landlock),
        "calls": walls.calls,
        "bubblewrap": walls.bubblewrap,
        "folder": str(folder),
        "code": str(code),
        "memory": memory,
        "parent": os.getpid(),
    }
    root = str(Path(__file__).resolve().parents[3])
    return [_python(), "-I", "-S", "-c", _ENTER, root, json.dumps(plan)]


def _python() -> str:
    """Return a Python to run the launcher; the running program may be one that has Python built in."""
    own = "" if getattr(sys, "frozen", False) else sys.executable
    return own or shutil.which("python3") or "python3"


def main() -> None:
    """Put up the walls that the command line asks for, and become the program. A wall that fails ends it."""
    plan: dict[str, Any] = json.loads(sys.argv[1])
    program, folder, code = plan["program"], plan["folder"], plan["code"]
    # Prolog notices that its standard input is closed only when its threads let it: what is busy ends at once.
    landlock.libc().prctl(PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
    if os.getppid() != plan["parent"]:
        sys.exit("the program that started this is gone")
    _limit(resource.RLIMIT_AS, plan["memory"])
    _limit(resource.RLIMIT_CORE, 0)
    _limit(resource.RLIMIT_FSIZE, LONGEST_FILE)
    _limit(resource.RLIMIT_NOFILE, OPEN_FILES)
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    kept = {name: os.environ[name] for name in KEPT_VARIABLES if name in os.environ}
    environment = {**kept, "LANG": "C.UTF-8", "HOME": folder, "TMPDIR": folder, "PATH": "/nonexistent"}
    os.chdir(folder)
    readable = _readable(program, code, environment.get("LD_LIBRARY_PATH", ""))
    if plan["bubblewrap"]:
        _become_inside(plan, readable, environment)
    if plan["landlock"]:
        landlock.confine(
            {
                **dict.fromkeys(readable, landlock.READ),
                program: landlock.READ | landlock.EXECUTE,
                **dict.fromkeys(_loaders(), landlock.READ | landlock.EXECUTE),
                folder: landlock.READ | landlock.MAKE_SOCKET,
            }
        )
    # The filter tells the one permitted execution from others by where its path stands in memory.
    path = ctypes.create_string_buffer(os.fsencode(program))
    words = _strings([program, *plan["arguments"]])
    settings = _strings([f"{name}={value}" for name, value in environment.items()])
    if plan["calls"]:
        system_calls.confine(system_calls.program(os.getpid(), ctypes.addressof(path)))
    landlock.libc().execve(path, words, settings)
    sys.exit(f"{program}: {os.strerror(ctypes.get_errno())}")


def _become_inside(plan: dict[str, Any], readable: Sequence[str], environment: dict[str, str]) -> None:
    words = [plan["bubblewrap"], "--unshare-all", "--as-pid-1", "--die-with-parent", "--new-session", "--dev", "/dev"]
    for path in readable:
        if os.path.islink(path):
            words += ["--symlink", os.readlink(path), path]
        else:
            words += ["--ro-bind-try", path, path]
    words += ["--ro-bind-try", plan["program"], plan["program"], "--bind", plan["folder"], plan["folder"]]
    words += ["--chdir", plan["folder"]]
    if plan["calls"]:
        # Inside, it is process 1 of its own space of processes.
        filter_file = os.memfd_create("filter", 0)
        os.write(filter_file, system_calls.program(1, None))
        os.lseek(filter_file, 0, os.SEEK_SET)
        words += ["--seccomp", str(filter_file)]
    os.execve(plan["bubblewrap"], [*words, "--", plan["program"], *plan["arguments"]], environment)


def _limit(kind: int, most: int) -> None:
    """Set a limit, unless a lower one is set already."""
    now, hard = resource.getrlimit(kind)
    limits = [limit for limit in (now, hard, most) if limit != resource.RLIM_INFINITY]
    resource.setrlimit(kind, (min(limits), min(limits)))


def _readable(program: str, code: str, library_path: str) -> list[str]:
    named = [str(file) for path in library_path.split(":") if path for file in Path(path).glob("*.so*")]
    return [*LIBRARIES, *SYSTEM_FILES, *COMPUTING, *home_of(program), code, *named[:MOST_LIBRARIES]]


def home_of(program: str) -> list[str]:
    """Return the folder of Prolog's own libraries: the nearest one about the program that holds its boot file."""
    named = [Path(folder) for folder in [os.environ.get("SWI_HOME_DIR")] if folder]
    for folder in (*named, *Path(program).resolve().parents):
        if (folder / "boot.prc").is_file():
            return [str(folder)]
    return []


def _loaders() -> list[str]:
    """Return what loads programs with shared libraries: to execute one is to execute its loader."""
    return [str(path) for folder in ("/lib", "/lib64") for path in Path(folder).glob("ld-linux*.so*")]


def _strings(texts: Sequence[str]) -> Any:
    return (ctypes.c_char_p * (len(texts) + 1))(*map(os.fsencode, texts), None)
