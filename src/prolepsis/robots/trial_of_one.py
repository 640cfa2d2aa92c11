"""The process in which a robot is tried: within limits, and with its own end."""

from __future__ import annotations

import resource
import sys
from pathlib import Path

from prolepsis.robots.trial import MEMORY, PASSED, REFUSED, SECONDS
from prolepsis.terms.errors import InputError


def main(path: Path, folder: Path | None = None) -> int:
    """Read a robot within limits; print why, if it is refused."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    # MuJoCo is loaded within the limits, too.
    from prolepsis.robots.model_file import read_model_file

    try:
        read_model_file(path, folder, tried=True)
    except InputError as error:
        sys.stdout.write(str(error))
        return REFUSED
    return PASSED


if __name__ == "__main__":
    sys.exit(main(*map(Path, sys.argv[1:])))
