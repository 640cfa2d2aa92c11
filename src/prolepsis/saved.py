"""The timeline of a saved projection, read by itself: questions need neither the log's tables nor the physics."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from prolepsis.domain import Domain
from prolepsis.errors import InputError, LogError
from prolepsis.sealed import read_sealed, to_json
from prolepsis.timeline import Timeline

DOMAIN, TIMELINE = "domain.json", "timeline.json"


def read_timeline(folder: str | Path) -> Timeline:
    """Return the timeline of a saved projection.

    Raises:
        LogError: If the folder is not whole, or holds no projection.
    """
    return read_timeline_files(read_sealed(folder))


def read_timeline_files(path: Path) -> Timeline:
    """Return the timeline in a folder whose seal has been checked.

    Raises:
        LogError: If it holds none.
    """
    try:
        rows: dict[str, Any] = json.loads((path / TIMELINE).read_text(encoding="utf-8"))
        domain: dict[str, Any] = json.loads((path / DOMAIN).read_text(encoding="utf-8"))
        known = Domain(**{name: tuple(tuple(row) for row in value) for name, value in domain.items()})
        return Timeline.from_json(rows["facts"], dt=rows["dt"], duration=rows["duration"], domain=known)
    except FileNotFoundError as error:
        name = Path(str(error.filename)).name
        raise LogError(f"{path}: holds a log but no projection (it has no {name})") from None
    except (KeyError, TypeError, ValueError, InputError) as error:
        raise LogError(f"{path}: its timeline is malformed: {type(error).__name__}: {error}") from None


def write_timeline_files(timeline: Timeline, path: Path) -> None:
    """Write a timeline and what is known of its individuals into an existing folder, unsealed."""
    (path / DOMAIN).write_text(to_json(asdict(timeline.domain)), encoding="utf-8")
    facts = {"dt": timeline.dt, "duration": timeline.duration, "facts": timeline.to_json()}
    (path / TIMELINE).write_text(to_json(facts), encoding="utf-8")
