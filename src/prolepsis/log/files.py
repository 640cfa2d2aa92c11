"""A log on disk: Parquet tables and one JSON file in a sealed folder, byte-equal for equal logs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, cast

import numpy as np
from pydantic import BaseModel, ConfigDict, ValidationError

from prolepsis.geometry.shape import Geom, Hole, Patch, Shape, Surface, Triple
from prolepsis.log import particle_tables, tables
from prolepsis.log.checks import check_columns, check_log, check_types
from prolepsis.log.happenings import Happenings
from prolepsis.log.log import Action, Log, Particles
from prolepsis.log.outcomes import Outcome
from prolepsis.log.sealed import read_sealed, read_text, write_json, write_sealed
from prolepsis.log.things import Mount, Thing
from prolepsis.terms.errors import InputError, LogError, brief
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import Term, format_value

HEAD = "log.json"
"""Tick, gravity, things, actions and the spacing of the particles: what is no column."""
# Built when a log is read, which most runs never do.
_EXACTLY = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, defer_build=True)
_TICKS, _POSES, _CONTACTS = "ticks.parquet", "poses.parquet", "contacts.parquet"
_JOINTS, _HAPPENINGS = "joints.parquet", "happenings_{}.parquet"
_FRAMES, _KINDS, _POSITIONS = "particle_frames.parquet", "particle_kinds.parquet", "particles.parquet"
_OWN = "particle_columns.parquet"


class _Action(BaseModel):
    model_config = _EXACTLY
    term: str
    arguments: dict[str, str]
    start: int
    end: int
    outcome: Outcome
    evidence: dict[str, float | str]


class _Particles(BaseModel):
    model_config = _EXACTLY
    spacing: float
    columns: tuple[str, ...]


class _Happenings(BaseModel):
    model_config = _EXACTLY
    things: tuple[str, ...]
    numbers: tuple[str, ...]


class _Head(BaseModel):
    """What the JSON file of a log says."""

    model_config = _EXACTLY
    dt: float
    gravity: Triple
    things: tuple[Thing, ...]
    actions: tuple[_Action, ...]
    happenings: dict[str, _Happenings]
    particles: _Particles | None = None


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
    """Write the files of a log into an existing folder, unsealed.

    Raises:
        InputError: If the log is none, so that it could not be read.
    """
    try:
        check_log(log)
    except ValueError as error:
        raise InputError(f"the log cannot be saved: {error}") from None
    head = {
        "dt": log.dt,
        "gravity": log.gravity,
        "things": [_plain(thing) for thing in log.things],
        "actions": [_plain_action(action) for action in log.actions],
        "happenings": {
            type: {"things": list(each.things), "numbers": list(each.numbers)}
            for type, each in sorted(log.happenings.items())
        },
        "particles": _plain_particles(log.particles) if _has_particles(log) else None,
    }
    write_json(path / HEAD, head)
    sizes: dict[str, int] = {}
    for name, columns, kinds in _tables_of(log):
        sizes[name] = tables.write_table(path / name, columns, kinds)
        if sum(sizes.values()) > tables.MOST_BYTES:
            raise InputError(
                f"the log cannot be saved: {name} {tables.unpacked(sizes[name], sum(sizes.values()))} could be read"
                " again; shorten the run, or take fewer particles or things"
            )


def _tables_of(log: Log) -> Iterator[tuple[str, tables.Columns, tables.Kinds]]:
    """Yield the name, the columns and their kinds of each table of a log."""
    ticks = {"time": log.time, **dict(sorted(log.channels.items()))}
    yield _TICKS, ticks, dict.fromkeys(ticks, "double")
    yield _POSES, tables.pose_columns(log.poses, log.carrier), tables.POSES
    yield _CONTACTS, tables.contact_columns(log.contacts), tables.CONTACTS
    yield _JOINTS, tables.joint_columns(log.joints), tables.JOINTS
    for type, each in sorted(log.happenings.items()):
        yield (
            _HAPPENINGS.format(type),
            tables.happening_columns(each),
            tables.happening_kinds(each.things, each.numbers),
        )
    if _has_particles(log):
        yield _FRAMES, particle_tables.frame_columns(log.particles), particle_tables.FRAMES
        yield _KINDS, particle_tables.kind_columns(log.particles), particle_tables.KINDS
        positions = particle_tables.position_columns(log.particles)
        yield _POSITIONS, positions, particle_tables.position_kinds(positions)
        if log.particles.columns:
            own = particle_tables.own_columns(log.particles)
            yield _OWN, own, dict.fromkeys(own, "float")


def read_log_files(path: Path) -> Log:
    """Return the log of a folder whose seal has been checked.

    Raises:
        LogError: If its files do not hold a log.
    """
    try:
        head = _Head.model_validate_json(read_text(path / HEAD))
        things = head.things
        check_types(head.happenings)
        for type, each in head.happenings.items():
            check_columns(f"{type}s", (*each.things, *each.numbers))
        check_columns("particles", head.particles.columns if head.particles else ())
        reported = [_HAPPENINGS.format(type) for type in head.happenings]
        wet = (_FRAMES, _KINDS, _POSITIONS, *((_OWN,) if head.particles.columns else ())) if head.particles else ()
        names = (_TICKS, _POSES, _CONTACTS, _JOINTS, *reported, *wet)
        untold = sorted({each.name for each in path.glob("*.parquet")} - {*names})
        if untold:
            raise ValueError(f"there is {brief(untold[0])}, of which {HEAD} does not tell")
        tables.check_unpacked_sizes(path / name for name in names)
        ticks = tables.read_table(path / _TICKS)
        time = ticks.pop("time")
        poses, carrier = tables.poses_from(tables.read_table(path / _POSES, tables.POSES), len(time), len(things))
        log = Log(
            dt=head.dt,
            things=things,
            time=time,
            poses=poses,
            carrier=carrier,
            contacts=tables.contacts_from(tables.read_table(path / _CONTACTS, tables.CONTACTS)),
            joints=tables.joints_from(tables.read_table(path / _JOINTS, tables.JOINTS)),
            happenings={type: _happenings(path, type, each) for type, each in head.happenings.items()},
            particles=_particles(head.particles, path, len(things), len(time)),
            channels=ticks,
            actions=tuple(_action(row) for row in head.actions),
            gravity=head.gravity,
        )
        check_log(log)
        return log
    except FileNotFoundError as error:
        raise LogError(f"{path}: holds no log (it has no {Path(str(error.filename)).name})") from None
    except MemoryError:
        raise LogError(f"{path}: memory ran short while its log was read; it needs more than there is") from None
    except ValidationError as error:
        problem = error.errors(include_url=False)[0]
        location = "/".join(str(key) for key in problem["loc"])
        raise LogError(f"{path}: its log is malformed: {HEAD}: {brief(location)}: {brief(problem['msg'])}") from None
    except (KeyError, ValueError, InputError) as error:
        if isinstance(error, LogError):
            raise
        lacking = "no column " if isinstance(error, KeyError) else ""
        raise LogError(f"{path}: its log is malformed: {lacking}{brief(error, 200)}") from None


def _happenings(path: Path, type: str, head: _Happenings) -> Happenings:
    kinds = tables.happening_kinds(head.things, head.numbers)
    return tables.happenings_from(tables.read_table(path / _HAPPENINGS.format(type), kinds), head.things, head.numbers)


def _has_particles(log: Log) -> bool:
    return bool(len(log.particles.stuff) or len(log.particles.tick))


def _particles(head: _Particles | None, path: Path, thing_count: int, tick_count: int) -> Particles:
    if head is None:
        return Particles()
    frames = tables.read_table(path / _FRAMES, particle_tables.FRAMES)
    kinds = tables.read_table(path / _KINDS, particle_tables.KINDS)
    positions = tables.read_table(path / _POSITIONS, particle_tables.WHOLE_POSITIONS, particle_tables.FINE_POSITIONS)
    own = tables.read_table(path / _OWN, dict.fromkeys(head.columns, "float")) if head.columns else {}
    return particle_tables.particles_from(
        frames, kinds, positions, own, spacing=head.spacing, thing_count=thing_count, tick_count=tick_count
    )


def _plain(value: Any) -> Any:
    """Return a thing or what its shape consists of as JSON values, fields at their defaults included.

    What is not told of a thing's centre is left out.
    """
    if type(value) in (float, str, int, bool):
        return value
    if isinstance(value, Thing | Mount | Shape | Geom | Hole | Patch | Surface):
        told = {each.name: getattr(value, each.name) for each in fields(value)}
        return {name: _plain(each) for name, each in told.items() if name != "centre" or each is not None}
    if isinstance(value, frozenset):
        return sorted(cast("frozenset[str]", value))
    if isinstance(value, tuple):
        return [_plain(item) for item in cast("tuple[Any, ...]", value)]
    if isinstance(value, Mapping):
        return {str(key): float(number) for key, number in cast("Mapping[str, float]", value).items()}
    return cast(Any, value).item() if isinstance(value, np.generic) else value


def _plain_particles(particles: Particles) -> dict[str, Any]:
    return {"spacing": particles.spacing, "columns": sorted(particles.columns)}


def _plain_action(action: Action) -> dict[str, Any]:
    return {
        "term": format_value(action.term),
        "arguments": {name: format_value(value) for name, value in action.arguments.items()},
        "start": int(action.start),
        "end": int(action.end),
        "outcome": action.outcome,
        "evidence": dict(action.evidence),
    }


def _action(row: _Action) -> Action:
    term = parse_term(row.term, where=HEAD)
    return Action(
        term=term if isinstance(term, Term) else Term(str(term)),
        arguments={name: parse_term(text, where=HEAD) for name, text in row.arguments.items()},
        start=row.start,
        end=row.end,
        outcome=row.outcome,
        evidence=row.evidence,
    )
