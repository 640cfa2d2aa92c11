"""A log on disk: Parquet tables and one JSON file in a sealed folder, byte-equal for equal logs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, cast

import numpy as np

from prolepsis import log_tables as tables
from prolepsis import particle_tables
from prolepsis.errors import InputError, LogError
from prolepsis.log import Action, Log, Particles
from prolepsis.sealed import read_sealed, to_json, write_sealed
from prolepsis.terms import Term, format_value, parse_term
from prolepsis.things import Geom, Hole, Shape, Surface, Thing

HEAD = "log.json"
"""Tick, gravity, things, actions and the spacing of the particles: what is no column."""
_FRAMES, _KINDS, _PLACES = "particle_frames.parquet", "particle_kinds.parquet", "particles.parquet"


def write_log(log: Log, folder: str | Path) -> None:
    """Write ``log`` into a sealed folder; an earlier one of ours is replaced.

    Raises:
        InputError: If ``folder`` holds something that is not ours.
    """
    write_sealed(folder, lambda path: write_log_files(log, path))


def read_log(folder: str | Path) -> Log:
    """Return the log saved in ``folder``, which may be a whole projection.

    Raises:
        LogError: If the folder is not whole, is no log, or is of another version.
    """
    return read_log_files(read_sealed(folder))


def write_log_files(log: Log, path: Path) -> None:
    """Write the files of a log into an existing folder, unsealed."""
    head = {
        "dt": log.dt,
        "gravity": log.gravity,
        "things": [_plain(thing) for thing in log.things],
        "actions": [_plain_action(action) for action in log.actions],
        "particles": {"spacing": log.particles.spacing} if _has_particles(log) else None,
    }
    (path / HEAD).write_text(to_json(head), encoding="utf-8")
    tables.write_table(path / "ticks.parquet", {"time": log.time, **dict(sorted(log.channels.items()))})
    tables.write_table(path / "poses.parquet", tables.pose_columns(log.poses, log.carrier))
    tables.write_table(path / "contacts.parquet", tables.contact_columns(log.contacts))
    tables.write_table(path / "bonds.parquet", tables.bond_columns(log.bonds))
    tables.write_table(path / "detachments.parquet", tables.detachment_columns(log.detachments))
    if _has_particles(log):
        tables.write_table(path / _FRAMES, particle_tables.frame_columns(log.particles))
        tables.write_table(path / _KINDS, particle_tables.kind_columns(log.particles))
        tables.write_table(path / _PLACES, particle_tables.place_columns(log.particles))


def read_log_files(path: Path) -> Log:
    """Return the log of a folder whose seal has been checked.

    Raises:
        LogError: If its files do not hold a log.
    """
    try:
        head: dict[str, Any] = json.loads((path / HEAD).read_text(encoding="utf-8"))
        things = tuple(_thing(row) for row in head["things"])
        ticks = tables.read_table(path / "ticks.parquet")
        time = ticks.pop("time")
        poses, carrier = tables.poses_from(tables.read_table(path / "poses.parquet"), len(time), len(things))
        return Log(
            dt=head["dt"],
            things=things,
            time=time,
            poses=poses,
            carrier=carrier,
            contacts=tables.contacts_from(tables.read_table(path / "contacts.parquet")),
            bonds=tables.bonds_from(tables.read_table(path / "bonds.parquet")),
            detachments=tables.detachments_from(tables.read_table(path / "detachments.parquet")),
            particles=_particles(head.get("particles"), path, len(things), len(time)),
            channels=ticks,
            actions=tuple(_action(row) for row in head["actions"]),
            gravity=_numbers(head["gravity"]),
        )
    except FileNotFoundError as error:
        raise LogError(f"{path}: holds no log (it has no {Path(str(error.filename)).name})") from None
    except (KeyError, TypeError, ValueError, IndexError, InputError) as error:
        if isinstance(error, LogError):
            raise
        raise LogError(f"{path}: its log is malformed: {type(error).__name__}: {error}") from None


def _has_particles(log: Log) -> bool:
    return bool(len(log.particles.stuff) or len(log.particles.tick))


def _particles(head: dict[str, Any] | None, path: Path, thing_count: int, tick_count: int) -> Particles:
    if head is None:
        return Particles()
    frames, kinds, places = (tables.read_table(path / name) for name in (_FRAMES, _KINDS, _PLACES))
    return particle_tables.particles_from(
        frames, kinds, places, spacing=float(head["spacing"]), thing_count=thing_count, tick_count=tick_count
    )


def _plain(value: Any) -> Any:
    """Return a thing or what its shape consists of as JSON values, fields at their defaults included."""
    if isinstance(value, Thing | Shape | Geom | Hole | Surface):
        return {each.name: _plain(getattr(value, each.name)) for each in fields(value)}
    if isinstance(value, frozenset):
        return sorted(cast("frozenset[str]", value))
    if isinstance(value, tuple):
        return [_plain(item) for item in cast("tuple[Any, ...]", value)]
    if isinstance(value, Mapping):
        return {str(key): float(number) for key, number in cast("Mapping[str, float]", value).items()}
    return cast(Any, value).item() if isinstance(value, np.generic) else value


def _plain_action(action: Action) -> dict[str, Any]:
    return {
        "term": format_value(action.term),
        "start": int(action.start),
        "end": int(action.end),
        "outcome": action.outcome,
        "evidence": dict(action.evidence),
    }


def _numbers(row: list[float]) -> Any:
    return tuple(row)


def _geom(row: dict[str, Any]) -> Geom:
    lists = {name: _numbers(row[name]) for name in ("size", "position", "orientation")}
    return Geom(type=row["type"], vertices=tuple(_numbers(vertex) for vertex in row["vertices"]), **lists)


def _hole(row: dict[str, Any]) -> Hole:
    return Hole(position=_numbers(row["position"]), direction=_numbers(row["direction"]), radius=row["radius"])


def _surface(row: dict[str, Any]) -> Surface:
    return Surface(
        vertices=tuple(_numbers(vertex) for vertex in row["vertices"]),
        triangles=tuple(_numbers(triangle) for triangle in row["triangles"]),
    )


def _shape(row: dict[str, Any]) -> Shape:
    surface = row.get("surface")
    return Shape(
        geoms=tuple(_geom(geom) for geom in row["geoms"]),
        profile=tuple(_numbers(point) for point in row.get("profile", ())),
        surface=None if surface is None else _surface(surface),
        holes=tuple(_hole(hole) for hole in row.get("holes", ())),
        colour=_numbers(row["colour"]),
    )


def _thing(row: dict[str, Any]) -> Thing:
    decoded: dict[str, Any] = {"shape": _shape(row["shape"]), "roles": frozenset(row["roles"])}
    decoded |= {name: _numbers(row[name]) for name in ("position", "orientation")}
    return Thing(**(row | decoded))


def _action(row: dict[str, Any]) -> Action:
    term = parse_term(row["term"], where=HEAD)
    decoded: dict[str, Any] = {"term": term if isinstance(term, Term) else Term(str(term))}
    return Action(**(row | decoded))
