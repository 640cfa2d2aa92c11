"""What this system offers to confine a process with, and what is missing."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass
from functools import lru_cache

from prolepsis.logic.confinement import landlock, system_calls

CURE = "apt install bubblewrap"
"""What helps where the kernel has no Landlock, which came with 5.13."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Walls:
    """The walls that can be put up around Prolog."""

    landlock: int = 0
    """Version of Landlock, 0 for none."""
    calls: bool = False
    """Whether system calls can be filtered."""
    bubblewrap: str | None = None
    """The program ``bwrap``, where Landlock is missing and it works."""

    @property
    def missing(self) -> str:
        """What could be reached, and what is missing; empty when nothing is."""
        if not (self.landlock or self.bubblewrap):
            kept = "programs and the network are out of reach, but " if self.calls else ""
            return f"{kept}files can be read: there is no Landlock (kernel 5.13) and no working bubblewrap"
        if not self.calls:
            return "other programs could be started: this kernel or machine has no known filter of system calls"
        return ""

    def __str__(self) -> str:
        names = [f"Landlock {self.landlock}"] if self.landlock else []
        names += ["bubblewrap"] if self.bubblewrap else []
        names += ["a filter of system calls"] if self.calls else []
        return " and ".join(names) or "nothing"


@lru_cache(maxsize=1)
def offered() -> Walls:
    """Return the walls that this system offers."""
    version = landlock.version()
    return Walls(
        landlock=version,
        calls=system_calls.can_filter(),
        bubblewrap=None if version else _bubblewrap(),
    )


def _bubblewrap() -> str | None:
    program = shutil.which("bwrap")
    if program is None:
        return None
    probe = [program, "--unshare-all", "--ro-bind", "/", "/", "true"]
    try:
        works = subprocess.run(probe, capture_output=True, timeout=10, check=False).returncode == 0
    except (OSError, subprocess.SubprocessError):
        return None
    return program if works else None
