"""Digests of what every example comes to, by logical name and value: whether a change left all answers as they were.

    .venv/bin/python tools/digests.py                    compare with tools/digests.json, and list what differs
    .venv/bin/python tools/digests.py --write            write it anew
    .venv/bin/python tools/digests.py dropped_egg pour_a only these

A digest is of content, not of files: poses, contacts, particles, channels, happenings, actions and facts, with the
names of things in the place of their indices, so that rooms, formats and the order of things may change. Numbers
count to the last bit; other versions of the engine or another kind of processor give other digests. When any differs,
the last line tells in what of these the machine is another one than that of the kept digests.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import platform
import sys
import time
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from llvmlite.binding import get_host_cpu_name

import prolepsis
from prolepsis import Log, Timeline

EXAMPLES = Path(__file__).parent.parent / "examples"
KEPT = Path(__file__).parent / "digests.json"
VERSIONS = ("mujoco", "numpy", "scipy", "numba")
NOBODY = {-1: "-", -2: "parked"}
"""What stands for an index that is no thing's."""


def main() -> int:
    """Compare or write the digests; exit status 1 if any differs."""
    read = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    read.add_argument(
        "names", nargs="*", metavar="EXAMPLE", help="names of scenarios in examples/; all if none is given"
    )
    read.add_argument("--write", action="store_true", help="write the digests instead of comparing them")
    read.add_argument("--file", type=Path, default=KEPT, help="where they are kept (tools/digests.json)")
    read.add_argument("--jobs", type=int, default=2, metavar="N", help="scenarios at the same time (2)")
    given = read.parse_args()
    names = given.names or sorted(path.stem for path in EXAMPLES.glob("*.toml"))
    kept: dict[str, Any] = json.loads(given.file.read_text()) if given.file.exists() else {}
    before: dict[str, Any] = kept.get("examples", {})
    found: dict[str, Any] = {}
    changed = 0
    with ProcessPoolExecutor(given.jobs) as pool:
        for name, digest, seconds in pool.map(digest_of, names):
            found[name] = digest
            lines = list(differences(before[name], digest)) if name in before else ["is new"]
            changed += bool(lines)
            says = "CHANGED" if lines else "as before"
            print(f"{name}: {says} ({seconds:.1f} s)", *lines, sep="\n  ", flush=True)
            if given.write:
                write(given.file, {**before, **found})
    if given.write:
        return 0
    others = list(other_makings(kept.get("made_with", {}), made_with()))
    if changed and others:
        print(f"the kept digests were made with other things: {'; '.join(others)}")
    return 1 if changed else 0


def write(file: Path, examples: dict[str, Any]) -> None:
    """Write digests, a line an example, so that a change shows which of them it renews."""
    lines = [f"{json.dumps(name)}: {json.dumps(digest)}" for name, digest in sorted(examples.items())]
    file.write_text(f'{{"made_with": {json.dumps(made_with())}, "examples": {{\n' + ",\n".join(lines) + "\n}}\n")


def made_with() -> dict[str, str]:
    """Return what the last digits hang on: numba compiles for the processor, numpy and BLAS choose kernels by it."""
    extensions: Any = np.show_config(mode="dicts")
    return {
        "machine": platform.machine(),
        "processor": get_host_cpu_name(),
        "extensions": " ".join(sorted(extensions["SIMD Extensions"].get("found", ()))),
        **{name: version(name) for name in VERSIONS},
    }


def other_makings(kept: dict[str, str], here: dict[str, str]) -> Iterable[str]:
    """Yield what the last digits hang on and is not the same."""
    for name in here:
        if kept.get(name) != here[name]:
            yield f"{name} {kept.get(name, 'unknown')}, here {here[name]}"


def digest_of(name: str) -> tuple[str, dict[str, Any], float]:
    """Return an example's name, its digests with the facts as lines, and how long it took [s]."""
    begin = time.perf_counter()
    try:
        projection = prolepsis.project(EXAMPLES / f"{name}.toml")
    except prolepsis.ProlepsisError as error:
        return name, {"refused": str(error)}, time.perf_counter() - begin
    digest = {**digest_of_log(projection.log), **digest_of_timeline(projection.timeline)}
    return name, digest, time.perf_counter() - begin


def digest_of_log(log: Log) -> dict[str, Any]:
    """Return a digest of each part of a log."""
    names = [thing.name for thing in log.things]
    order = sorted(range(len(names)), key=names.__getitem__)
    frames = log.particles
    kinds = [(names[i], float(m), float(v)) for i, m, v in zip(frames.stuff, frames.mass, frames.volume, strict=True)]
    own = [part for name, column in sorted(frames.columns.items()) for part in (name, column)]
    return {
        "things": _digest(names[i] for i in order),
        "poses": _digest([log.dt, log.time, *(part for i in order for part in (names[i], log.poses[:, i]))]),
        "carriers": _digest(part for i in order for part in (names[i], *_named(log.carrier[:, i], names))),
        "contacts": _rows(log.contacts, names, named=("a", "b")),
        "joints": _rows(log.joints, names, named=("a", "b")),
        "happenings": _happenings(log, names),
        "particles": _digest(
            [frames.tick, frames.position, frames.spacing, *_named(frames.holder, names), *kinds, *own]
        ),
        "channels": _digest(part for name in sorted(log.channels) for part in (name, log.channels[name])),
        "arguments": _digest((str(a.term), a.start, sorted(a.arguments.items())) for a in log.actions),
        "actions": _digest((str(a.term), a.start, a.end, a.outcome, sorted(a.evidence.items())) for a in log.actions),
    }


def digest_of_timeline(timeline: Timeline) -> dict[str, Any]:
    """Return a digest of the evidence, and the facts themselves, to be listed when they change."""
    return {
        "evidence": _digest((str(fact.term), fact.start, sorted(fact.evidence.items())) for fact in timeline.facts),
        "facts": [f"{fact.start:.3f} {fact.end:.3f} {fact.kind} {fact.term}" for fact in timeline.facts],
    }


def differences(before: dict[str, Any], after: dict[str, Any]) -> Iterable[str]:
    """Yield what differs: the parts by name, and the facts that went and came."""
    for part in sorted({*before, *after} - {"facts"}):
        if before.get(part) != after.get(part):
            yield f"{part}: {before.get(part, 'none')} -> {after.get(part, 'none')}"
    yield from (f"- {line}" for line in before.get("facts", []) if line not in after.get("facts", []))
    yield from (f"+ {line}" for line in after.get("facts", []) if line not in before.get("facts", []))


def _rows(table: Any, names: list[str], named: tuple[str, ...]) -> str:
    columns = {name: getattr(table, name) for name in type(table).__dataclass_fields__}
    parts = [part for name in named for part in _named(columns[name], names)]
    return _digest([*parts, *(columns[name] for name in sorted(columns) if name not in named)])


def _happenings(log: Log, names: list[str]) -> str:
    parts: list[Any] = []
    for type, each in sorted(log.happenings.items()):
        parts += [type, each.tick]
        for argument, index in sorted(each.things.items()):
            parts += [argument, *_named(index, names)]
        for number, column in sorted(each.numbers.items()):
            parts += [number, column]
    return _digest(parts)


def _named(index: Any, names: list[str]) -> list[Any]:
    """Return an array of indices as the names that are in it, sorted, and an array of positions among these."""
    values, place = np.unique(index, return_inverse=True)
    shown = [NOBODY.get(value) or names[value] for value in values.tolist()]
    order = np.argsort(np.argsort(shown, kind="stable"), kind="stable")
    return [index.shape, *sorted(shown), order[place].astype(np.int64)] if len(shown) else [index.shape]


def _digest(parts: Iterable[Any]) -> str:
    seal = hashlib.sha256()
    for part in parts:
        if isinstance(part, np.ndarray):
            seal.update(f"{part.dtype.kind}{part.dtype.itemsize}{part.shape}".encode())
            seal.update(np.ascontiguousarray(part).tobytes())
        else:
            seal.update(repr(part).encode() + b"\0")
    return seal.hexdigest()[:16]


if __name__ == "__main__":
    sys.exit(main())
