"""What every log must be, whoever wrote it: columns that fit each other, of finite numbers and things that exist.

A folder may come from a stranger who has sealed it well, so nothing beyond this may be taken for granted by its files.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from prolepsis.geometry.shape import GEOM_TYPES, Shape
from prolepsis.log.happenings import DETACHMENT, FILM, FILM_AREA, Happenings
from prolepsis.log.log import Log
from prolepsis.log.things import Thing
from prolepsis.terms.errors import brief, brief_list

MOST_GEOMS, MOST_POINTS = 2_000, 10_000
"""Solids of a thing, and points of its profile."""
MOST_ACTIONS = 20_000
"""More than one in each 0.1 s of the longest run; to read and recognize them takes four seconds."""
MOST_TYPES, LONGEST_NAME = 100, 60
"""Types of happenings, and letters of the name of one."""
FARTHEST = 1e10
"""MuJoCo calls a coordinate beyond this unstable (``mjMAXVAL``) [m]."""
UNIT = 1e-3
"""By how much the length of a quaternion may differ from 1: nobody rounds more."""

Column = npt.NDArray[Any]


def check_log(log: Log) -> None:
    """Check a log that was read from files.

    Raises:
        ValueError: If it is none; the message says which of its columns is wrong, and how.
    """
    ticks, count = log.tick_count, len(log.things)
    if not 0.0 < log.dt < FARTHEST:
        raise ValueError(f"the tick dt = {log.dt} s is not positive")
    _check_things(log.things)
    if len(log.actions) > MOST_ACTIONS:
        raise ValueError(f"there are {len(log.actions):,} actions; allowed: {MOST_ACTIONS:,}")
    if not np.allclose(log.time, np.arange(ticks) * log.dt, rtol=1e-9, atol=log.dt / 1000):
        raise ValueError("the times of the ticks are not 0, dt, 2 dt ...")
    _check_numbers("poses", log.poses)
    lengths = np.linalg.norm(log.poses[:, :, 3:], axis=-1)
    if lengths.size and np.abs(lengths - 1.0).max() > UNIT:
        raise ValueError("poses: a quaternion is not of unit length")
    _check_range("carrier", log.carrier, -1, count)
    contacts, joints, particles = log.contacts, log.joints, log.particles
    _check_ascending("contacts", contacts.tick, ticks)
    for name in ("force", "normal", "point", "peak"):
        _check_numbers(f"contacts: {name}", getattr(contacts, name))
    for what, table, names in (
        ("contacts", contacts, ("a", "b")),
        ("joints", joints, ("a", "b")),
    ):
        for name in names:
            _check_range(f"{what}: {name}", getattr(table, name), 0, count)
    _check_range("joints: start", joints.start, 0, ticks + 1)
    _check_range("joints: end", joints.end, 0, ticks + 1)
    for name in ("position", "mass", "volume"):
        _check_numbers(f"particles: {name}", getattr(particles, name))
    check_columns("particles", tuple(particles.columns))
    for name, column in particles.columns.items():
        _check_numbers(f"particles: {name}", column)
        if column.shape != particles.holder.shape:
            raise ValueError(f"particles: {name} has another shape than their holders")
    if len(particles.stuff) and not 0.0 < particles.spacing < FARTHEST:
        raise ValueError(f"particles: a spacing of {particles.spacing} m is not positive")
    check_types(log.happenings)
    for type, each in log.happenings.items():
        _check_happenings(type, each, ticks, count)
    for name, series in log.channels.items():
        _check_numbers(f"channel {name}", series)
    for action in log.actions:
        if not 0 <= action.start <= action.end <= ticks:
            raise ValueError(f"an action from tick {action.start} to {action.end} is not within the {ticks} ticks")


def check_types(happenings: Collection[str]) -> None:
    """Check names of types of happenings, each of which becomes a part of the name of a file.

    Raises:
        ValueError: If one is no plain name.
    """
    if len(happenings) > MOST_TYPES:
        raise ValueError(f"there are {len(happenings)} types of happenings; allowed: {MOST_TYPES}")
    for type in happenings:
        check_name("type of happenings", type)


def check_columns(what: str, names: Sequence[str]) -> None:
    """Check names of columns of a table that has a column ``tick``, too.

    Raises:
        ValueError: If one is no plain name, or there twice.
    """
    for name in names:
        check_name(f"column of {what}", name)
    if len({*names, "tick"}) <= len(names):
        raise ValueError(f"{what}: a column is there twice")


def check_name(what: str, name: str) -> None:
    """Check a name that is a column's or a part of a file's.

    Raises:
        ValueError: If it is no plain name.
    """
    if not (name.isascii() and name.isidentifier() and len(name) <= LONGEST_NAME):
        allowed = f"at most {LONGEST_NAME} letters, digits and _"
        raise ValueError(f"{brief(repr(name))} is no {what}; allowed: {allowed}")


def check_rows(what: str, key: str, column: Column, count: int, times: int) -> None:
    """Check that a long table has a row for each of ``times`` times of the first, then of the second ...

    Raises:
        ValueError: If not; ``key`` is the name of the column that numbers what the rows are of.
    """
    if len(column) != count * times:
        raise ValueError(f"{what}: {len(column)} rows; needed: {count * times}, of {count} {key}s at {times} times")
    if (column != np.arange(count).repeat(times)).any():
        raise ValueError(f"{what}: the column {key} does not tell {times} rows of the first, then of the second ...")


def _check_happenings(type: str, happenings: Happenings, ticks: int, count: int) -> None:
    check_columns(f"{type}s", (*happenings.things, *happenings.numbers))
    _check_ascending(f"{type}s", happenings.tick, ticks)
    for name, column in happenings.things.items():
        _check_range(f"{type}s: {name}", column, 0, count)
    for name, column in happenings.numbers.items():
        _check_numbers(f"{type}s: {name}", column)
    known = {each.name: each for each in (DETACHMENT, FILM, FILM_AREA)}.get(type)
    things, numbers = (known.things, known.numbers) if known is not None else ((), ())
    if known is not None and ({*happenings.things} != {*things} or {*happenings.numbers} != {*numbers}):
        needed = ", ".join((*things, *numbers))
        raise ValueError(f"{type}s have {brief_list((*happenings.things, *happenings.numbers))}; needed: {needed}")


def _check_things(things: tuple[Thing, ...]) -> None:
    wholes = {thing.name: thing.whole for thing in things}
    if len(wholes) < len(things) or "" in wholes:
        raise ValueError("two things have the same name, or one has none")
    _refuse_circles(wholes, "is a part of")
    for thing in things:
        if thing.mount.to is not None and thing.mount.by != "joints":
            raise ValueError(f"{thing.name}: hangs on {brief(thing.mount.to)}, but not by joints")
    _refuse_circles({thing.name: thing.mount.to for thing in things}, "hangs on")
    for thing in things:
        _check_numbers(f"{thing.name}: pose", np.array((*thing.position, *thing.orientation), dtype=np.float64))
        if thing.centre is not None:
            _check_numbers(f"{thing.name}: centre", np.array(thing.centre, dtype=np.float64))
        _check_shape(thing.name, thing.shape)


def _refuse_circles(above: Mapping[str, str | None], how: str) -> None:
    """Refuse things above which, by name, something is that is no thing, or is above itself."""
    for name in above:
        holder, seen = above[name], {name}
        while holder is not None:
            if holder not in above or holder in seen:
                raise ValueError(f"{name}: {how} {brief(holder)}, which is no thing or {how} itself")
            seen.add(holder)
            holder = above[holder]


def _check_shape(name: str, shape: Shape) -> None:
    if len(shape.geoms) > MOST_GEOMS or len(shape.profile or ()) > MOST_POINTS:
        raise ValueError(f"{name}: has more than {MOST_GEOMS} geoms or {MOST_POINTS} points of a profile")
    for geom in shape.geoms:
        if geom.type not in GEOM_TYPES:
            raise ValueError(f"{name}: no geom of type {geom.type!r}; known: {', '.join(GEOM_TYPES)}")
        numbers = (*geom.size, *geom.position, *geom.orientation, *itertools.chain.from_iterable(geom.vertices))
        _check_numbers(f"{name}: a geom", np.array(numbers, dtype=np.float64))
        if min(geom.size) < 0.0:
            raise ValueError(f"{name}: the size of a geom is negative")
    if shape.patch is not None:
        patch = shape.patch
        if len(patch.neighbours) > MOST_POINTS or min(*patch.semi_axes, patch.thickness) <= 0.0:
            raise ValueError(f"{name}: a patch has more than {MOST_POINTS} neighbours, or no size")
        numbers = (*patch.semi_axes, patch.thickness, *patch.middle, *itertools.chain.from_iterable(patch.neighbours))
        _check_numbers(f"{name}: patch", np.array(numbers, dtype=np.float64))
    if shape.surface is not None:
        _check_numbers(f"{name}: surface", np.array(shape.surface.vertices, dtype=np.float64))
        corners = np.array(shape.surface.triangles, dtype=np.int64)
        _check_range(f"{name}: triangles", corners, 0, len(shape.surface.vertices))


def _check_numbers(what: str, numbers: Column) -> None:
    # A comparison with what is no number is false.
    if numbers.dtype.kind != "f" or (numbers.size and not (numbers.min() >= -FARTHEST and numbers.max() <= FARTHEST)):
        raise ValueError(f"{what}: a number is not finite, or too large")


def _check_range(what: str, numbers: Column, low: int, end: int) -> None:
    if numbers.dtype.kind != "i" or (numbers.size and not (numbers.min() >= low and numbers.max() < end)):
        raise ValueError(f"{what}: a number is not from {low} to {end - 1}")


def _check_ascending(what: str, tick: Column, ticks: int) -> None:
    _check_range(f"{what}: tick", tick, 0, ticks)
    if (np.diff(tick) < 0).any():
        raise ValueError(f"{what}: the ticks do not ascend")
