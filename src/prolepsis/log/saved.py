"""The timeline of a saved projection, read by itself: questions need neither the log's tables nor the physics."""

from __future__ import annotations

from dataclasses import asdict, fields
from pathlib import Path
from typing import Any, cast

from prolepsis.log.domain import Domain
from prolepsis.log.sealed import read_json, read_sealed, write_json
from prolepsis.log.timeline import Timeline, plain
from prolepsis.terms.errors import InputError, LogError, brief

DOMAIN, TIMELINE = "domain.json", "timeline.json"
MOST_FACTS = 250_000
"""Facts of a timeline; its reading would take more than ten seconds."""
LONGEST = 1e9
"""No run is as long [s]: thirty years."""


def read_timeline(folder: str | Path) -> Timeline:
    """Return the timeline of a saved projection.

    Raises:
        LogError: If the folder is not whole, or holds no projection.
    """
    return read_timeline_files(read_sealed(folder, (DOMAIN, TIMELINE)))


def read_timeline_files(path: Path) -> Timeline:
    """Return the timeline in a folder whose seal has been checked.

    Raises:
        LogError: If it holds none.
    """
    try:
        told: Any = read_json(path / TIMELINE)
        domain = _domain(read_json(path / DOMAIN))
        if not isinstance(told, dict) or not isinstance(told.get("facts"), list):  # pyright: ignore[reportUnknownMemberType]
            raise ValueError(f"{TIMELINE} must be an object with dt, duration and facts")
        table = cast("dict[str, Any]", told)
        nearly = cast("list[Any]", table.get("near_misses", []))  # older folders have none
        if not isinstance(nearly, list):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise ValueError(f"{TIMELINE}: near_misses must be a list of facts")
        if len(table["facts"]) + len(nearly) > MOST_FACTS:
            raise ValueError(f"{TIMELINE} has {len(table['facts'])} facts; at most {MOST_FACTS} are read")
        dt, duration = _time(table.get("dt"), 1e-9), _time(table.get("duration"), 0.0)
        return Timeline.from_json(table["facts"], dt=dt, duration=duration, domain=domain, near_misses=nearly)
    except FileNotFoundError as error:
        name = Path(str(error.filename)).name
        raise LogError(f"{path}: holds a log but no projection (it has no {name})") from None
    except (ValueError, InputError) as error:
        raise LogError(f"{path}: its timeline is malformed: {brief(error, 200)}") from None


def _time(number: Any, least: float) -> float:
    if isinstance(number, bool) or not isinstance(number, int | float) or not least <= number < LONGEST:
        raise ValueError(f"{TIMELINE}: a time of {brief(number)} s is not from {least:g} to {LONGEST:g}")
    return float(number)


def _domain(table: Any) -> Domain:
    """Return the domain whose rows these are; each has as many texts as its kind of row, and values may be numbers."""
    names = [each.name for each in fields(Domain)]
    # Older folders have no classes and units, and do not say whether it was checked: it was, or they would not be.
    later = {"unchecked", "subclasses", "definitions", "subproperties", "units", "inverses", "declared", "untold"}
    if not isinstance(table, dict) or {*later, *cast("dict[str, Any]", table)} != set(names):
        raise ValueError(f"{DOMAIN} must be an object with {', '.join(names)}")
    rows: dict[str, Any] = {**{name: [] for name in later - {"unchecked"}}, **cast("dict[str, Any]", table)}
    unchecked = rows.get("unchecked", "")
    if not isinstance(unchecked, str):
        raise ValueError(f"{DOMAIN}: unchecked must be a text")
    counts = {"values": 3, "relations": 3, "definitions": 3, "untold": 1}
    columns = {name: counts.get(name, 2) for name in names if name != "unchecked"}
    for name, count in columns.items():
        kinds = (str,) * (count - 1) + ((str, int, float) if name == "values" else str,)
        if not isinstance(rows[name], list) or not all(_is_row(row, kinds) for row in rows[name]):
            raise ValueError(f"{DOMAIN}: {name} must be a list of rows of {count}")
    if "declared" not in table:  # They call the parts of a definition what a property may be called.
        rows["definitions"] = [
            [name, "is a" if asked == "is" else asked, "is true" if filler == "true" else filler]
            for name, asked, filler in rows["definitions"]
        ]
    return Domain(**{name: tuple(tuple(row) for row in rows[name]) for name in columns}, unchecked=unchecked)


def _is_row(row: Any, kinds: tuple[Any, ...]) -> bool:
    return (
        isinstance(row, list)
        and len(cast("list[Any]", row)) == len(kinds)
        and all(
            isinstance(cell, kind) and not isinstance(cell, bool)
            for cell, kind in zip(cast("list[Any]", row), kinds, strict=True)
        )
    )


def write_timeline_files(timeline: Timeline, path: Path) -> None:
    """Write a timeline and what is known of its individuals into an existing folder, unsealed.

    Raises:
        InputError: If it is so large that it could not be read.
    """
    if len(timeline.facts) + len(timeline.near_misses) > MOST_FACTS:
        raise InputError(
            f"the timeline cannot be saved: it has {len(timeline.facts):,} facts; {MOST_FACTS:,} could be read again"
        )
    rows = asdict(timeline.domain)
    # A run of our own tells of all that it is asked.
    write_json(path / DOMAIN, rows if rows["untold"] else {name: row for name, row in rows.items() if name != "untold"})
    nearly = [plain(fact) for fact in timeline.near_misses]
    told = {"dt": timeline.dt, "duration": timeline.duration, "facts": timeline.to_json(), "near_misses": nearly}
    write_json(path / TIMELINE, told)
