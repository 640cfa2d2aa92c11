"""Which tests notice when the code is broken on purpose: each change in tools/mutations.toml, one at a time.

    .venv/bin/python tools/mutations.py                        all of them
    .venv/bin/python tools/mutations.py --only squeeze-share   only this one (may be given several times)
    .venv/bin/python tools/mutations.py --unbroken             the same tests without any change: all must pass

A change is made in a copy of src, never in the working tree. The copy has caches of its own: answers of the reasoner
are kept under what was asked, so that a broken question of the same words would be answered by the sound code. Compiled
kernels are kept under the sources that they come from, so they may be shared (NUMBA_CACHE_DIR names where).
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent
TABLE = Path(__file__).with_suffix(".toml")
LONGEST = 900.0
"""A test that has not ended by then [s] has noticed: the broken code does not end."""
FIRST = re.compile(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", re.MULTILINE)


@dataclass(frozen=True, kw_only=True, slots=True)
class Mutation:
    """One change that breaks the code."""

    name: str
    """How it is called, ``squeeze-share``."""
    file: str
    """File, seen from ``src/prolepsis``."""
    old: str
    """What stands there, exactly once."""
    new: str
    """What is put in its place."""
    breaks: str
    """What is no longer so, in words."""
    tests: tuple[str, ...]
    """Files and folders of tests that ought to notice, and options of pytest."""

    def broken(self, text: str) -> str:
        """Return the text of the file with the change.

        Raises:
            ValueError: If what is to be replaced does not stand there exactly once.
        """
        count = text.count(self.old)
        if count != 1:
            raise ValueError(f"{self.name}: {self.old!r} stands {count} times in {self.file}; needed: once")
        return text.replace(self.old, self.new)


def mutations() -> tuple[Mutation, ...]:
    """Return all changes of the table."""
    table: dict[str, dict[str, Any]] = tomllib.loads(TABLE.read_text(encoding="utf-8"))
    return tuple(Mutation(name=name, tests=tuple(row.pop("tests")), **row) for name, row in table.items())


def first_to_notice(mutation: Mutation | None, tests: Sequence[str], kernels: Path) -> str | None:
    """Return the first test that fails in a copy of src with a change, or None if all pass.

    Args:
        mutation: The change; none if None.
        tests: Arguments of pytest.
        kernels: Folder in which compiled kernels are kept.

    Raises:
        ValueError: If what is to be replaced does not stand there exactly once.
        RuntimeError: If the tests cannot be run.
    """
    with tempfile.TemporaryDirectory(prefix="mutation-") as folder:
        copy = Path(folder) / "src"
        shutil.copytree(ROOT / "src", copy, ignore=shutil.ignore_patterns("__pycache__"))
        (Path(folder) / "examples").symlink_to(ROOT / "examples")
        if mutation is not None:
            file = copy / "prolepsis" / mutation.file
            file.write_text(mutation.broken(file.read_text(encoding="utf-8")), encoding="utf-8")
        environment = {name: value for name, value in os.environ.items() if name != "PROLEPSIS_CACHE"}
        environment |= {
            "PYTHONPATH": str(copy),
            "XDG_CACHE_HOME": str(Path(folder) / "cache"),
            "NUMBA_CACHE_DIR": str(kernels),
            "HYPOTHESIS_STORAGE_DIRECTORY": str(Path(folder) / "hypothesis"),
        }
        words = [sys.executable, "-m", "pytest", "-x", "-q", "-rfE", "--tb=no", "-p", "no:cacheprovider", *tests]
        try:
            done = subprocess.run(
                words, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=LONGEST, check=False
            )
        except subprocess.TimeoutExpired:
            return f"not ended after {LONGEST:g} s"
    if done.returncode == 0:
        return None
    found = FIRST.search(done.stdout)
    if found is None:
        raise RuntimeError(f"{' '.join(words)}: status {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return found.group(1)


def main() -> int:
    """Make the changes and tell what notices; exit status 1 if one survives."""
    read = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    read.add_argument("--only", action="append", metavar="NAME", help="only this change; may be given several times")
    read.add_argument("--jobs", type=int, default=1, metavar="N", help="changes at the same time (1)")
    read.add_argument("--unbroken", action="store_true", help="run the tests without any change")
    given = read.parse_args()
    known = {each.name: each for each in mutations()}
    for name in given.only or ():
        if name not in known:
            read.error(f"no change named {name!r}; known: {', '.join(known)}")
    chosen = [known[name] for name in given.only or known]
    for each in chosen:
        try:
            each.broken((ROOT / "src" / "prolepsis" / each.file).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            read.error(str(error))

    def tell(mutation: Mutation) -> bool:
        begin = time.perf_counter()
        by = first_to_notice(None if given.unbroken else mutation, mutation.tests, kernels)
        says = ("passes" if given.unbroken else "SURVIVED") if by is None else by
        print(f"{mutation.name}: {says} ({time.perf_counter() - begin:.0f} s)", flush=True)
        return (by is None) == given.unbroken

    with tempfile.TemporaryDirectory(prefix="kernels-") as folder, ThreadPoolExecutor(given.jobs) as pool:
        kernels = Path(os.environ.get("NUMBA_CACHE_DIR") or folder).absolute()
        return 0 if all(list(pool.map(tell, chosen))) else 1


if __name__ == "__main__":
    sys.exit(main())
