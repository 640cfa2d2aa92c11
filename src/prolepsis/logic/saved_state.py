"""What Prolog has loaded, saved as it is: it starts from that in a twentieth of a second, from its files in a third."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from prolepsis.logic.confinement.start import KEPT_VARIABLES, home_of
from prolepsis.system.cache import cache_root, kept_or_made
from prolepsis.system.sources import digest_of, sources_in
from prolepsis.terms.terms import format_atom

OPTIONS = "class(development), autoload(false), stand_alone(false), foreign(no_save), goal(serve), toplevel(halt)"
"""Libraries are still loaded from Prolog's own folder when a goal needs them."""
MAKING_LIMIT = 60.0
"""Longest time for making it [s]; it takes half a second."""


def saved_state(program: str, code: Path, stack_limit: int, folder: Path) -> bytes | None:
    """Return the saved state of a Prolog that has loaded ``main.pl``, made now if it has not been kept.

    It begins with ``serve``. A Prolog that starts from a state goes by the options with which that was made.

    Args:
        program: Path of ``swipl``.
        code: Folder of the Prolog files.
        stack_limit: Memory that one query may use for terms [MB].
        folder: Where it is made: whoever clears that after a kill clears what was half made, too.

    Returns:
        None if this Prolog cannot make one.
    """
    file = cache_root() / "prolog" / _key(program, code, stack_limit)
    return kept_or_made(file, lambda: _made(program, code, stack_limit, folder))


def _key(program: str, code: Path, stack_limit: int) -> str:
    surroundings = [os.environ.get(name) for name in KEPT_VARIABLES]
    # A state holds Prolog's own libraries, too, which may be mended without the program.
    homes = [Path(home) for home in home_of(program)]
    own = [Path(program).resolve(), *(file for home in homes for file in sources_in(home / "library", "pl"))]
    own += [home / "boot.prc" for home in homes]
    seen = [(str(file), status.st_size, status.st_mtime_ns) for file in sorted(own) for status in [file.stat()]]
    return digest_of((seen, surroundings, str(code), stack_limit), sources_in(code, "pl"))[:32]


def _made(program: str, code: Path, stack_limit: int, folder: Path) -> bytes | None:
    file = folder / "making"
    main, made = format_atom(str(code / "main.pl")), format_atom(str(file))
    goal = f"load_files({main}, []), qsave_program({made}, [{OPTIONS}])"
    words = [program, "-f", "none", "-O", f"--stack-limit={stack_limit}m", "--quiet", "-g", goal, "-t", "halt"]
    kept = {name: os.environ[name] for name in KEPT_VARIABLES if name in os.environ}
    environment = {**kept, "LANG": "C.UTF-8", "HOME": str(folder), "TMPDIR": str(folder)}
    silent = subprocess.DEVNULL
    try:
        subprocess.run(
            words, env=environment, stdin=silent, stdout=silent, stderr=silent, timeout=MAKING_LIMIT, check=True
        )
        return file.read_bytes()
    except (OSError, subprocess.SubprocessError):
        return None
    finally:
        file.unlink(missing_ok=True)
