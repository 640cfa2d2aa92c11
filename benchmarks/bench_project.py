"""The whole pipeline from process start to saved folder: time, its stages, memory, and the same bytes every time."""

from __future__ import annotations

import hashlib
import json
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from beside import FOLDER, HERE, ROOT, Row, Used, alternately, row, used

EXAMPLES = ROOT / "examples"
DROP = "dropped_egg"
NAMES = (DROP, "grasp_egg", "pr2_hit")
STAGES = {"recognizing": "under 0.1", "saving": "under 0.05"}
REPEATS = 3


def compared(sources: Sequence[Path]) -> Iterator[Row]:
    """Yield the rows that an earlier state has, too."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "saved"
        for name in NAMES:
            runs = alternately(sources, lambda source, name=name: project_into(source, folder, name), REPEATS)
            busy = [f"{min(run.busy for run in each):.2f} s" for each in runs]
            yield row(f"prolepsis project, {name}, processor time, best of {REPEATS}", "", busy)
            memory = [f"{max(run.memory for run in each) / 1024:.0f} MB" for each in runs]
            yield row("greatest memory of that process", "under 350 MB" if name == DROP else "", memory)
    for name in NAMES:
        words = (str(FOLDER / "stages.py"), str(EXAMPLES / f"{name}.toml"))
        found = alternately(sources, lambda source, words=words: json.loads(used(source, *words).printed), REPEATS)
        for stage, wanted in STAGES.items():
            shares = [min(run[stage] for run in runs) / min(run["simulating"] for run in runs) for runs in found]
            yield row(f"{stage} over simulating, {name}", wanted, [f"{share:.3f}" for share in shares])


def rows() -> Iterator[Row]:
    """Yield the other rows."""
    with tempfile.TemporaryDirectory() as place:
        folders = [Path(place) / f"seed{seed}" for seed in (0, 1, 2)]
        runs = [project_into(HERE, folder, DROP, seed) for seed, folder in enumerate(folders)]
        elapsed = min(run.elapsed for run in runs)
        yield f"{DROP} (2 s), process start to saved folder, best of 3", f"{elapsed:.2f} s", "under 4 s"
        contents = [_digest(folder) for folder in folders]
        same = "yes" if len(set(contents)) == 1 else "NO"
        yield "byte-equal log and timeline in 3 processes with different hash seeds", same, "yes"
        size = sum(file.stat().st_size for file in folders[0].iterdir())
        yield "size of the saved folder", f"{size / 1e6:.2f} MB", ""


def project_into(source: Path, folder: Path, name: str = DROP, seed: int = 0) -> Used:
    """Return what it took to project an example into a folder."""
    scenario = str(EXAMPLES / f"{name}.toml")
    return used(source, "-m", "prolepsis", "project", scenario, "--out", str(folder), hash_seed=seed)


def _digest(folder: Path) -> str:
    """Return one hash of all files of a folder, names included."""
    digest = hashlib.sha256()
    for file in sorted(folder.iterdir()):
        digest.update(file.name.encode() + file.read_bytes())
    return digest.hexdigest()
