"""Many like bodies of a model that are declared one stuff: grains in a bin, beads in a carton."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fnmatch import fnmatchcase

from prolepsis.log.things import Thing
from prolepsis.terms.errors import InputError, UnknownNameError, brief

LONGEST_NAME = 100
"""Letters of a stuff's name, and of its pattern."""
GRAIN_ROLES = frozenset({"Blob"})
"""Roles of what facts name by its stuff."""


def with_stuffs(things: tuple[Thing, ...], stuffs: Mapping[str, str]) -> tuple[Thing, ...]:
    """Return the things with each stuff behind them, of which all that its pattern matches are then parts.

    Args:
        things: What the model has.
        stuffs: For each stuff the pattern of the names of its parts, as of files: ``{"beads": "bead*"}``.

    Raises:
        UnknownNameError: If a pattern matches nothing that stands for itself.
        InputError: If one matches what does not move freely, or two match the same, or a stuff is called as a thing.
    """
    if not isinstance(stuffs, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(f"stuffs: {brief(repr(stuffs))}; needed: a name and a pattern each, as {{'beads': 'bead*'}}")
    for pair in stuffs.items():
        if not all(isinstance(each, str) and 0 < len(each) <= LONGEST_NAME for each in pair):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(f"stuffs: {brief(repr(pair))}; needed: a name and a pattern, texts of 1 to {LONGEST_NAME}")
    stuff_of: dict[str, str] = {}
    for stuff, pattern in stuffs.items():
        if any(thing.name == stuff for thing in things):
            raise InputError(f"stuffs: {brief(repr(stuff))} is the name of a thing already; take another one")
        for thing in _matched(things, stuff, pattern):
            other = stuff_of.setdefault(thing.name, stuff)
            if other != stuff:
                raise InputError(
                    f"stuffs: {thing.name} matches {stuffs[other]!r} of {other} and {pattern!r} of {stuff}; allowed: "
                    "one of them"
                )
    parts = tuple(
        replace(thing, whole=stuff_of[thing.name], roles=thing.roles | GRAIN_ROLES) if thing.name in stuff_of else thing
        for thing in things
    )
    wholes = (
        Thing(
            name=stuff,
            kind="Granular",
            roles=frozenset({"Stuff"}),
            mass=sum(part.mass for part in parts if part.whole == stuff),
        )
        for stuff in stuffs
    )
    return (*parts, *wholes)


def _matched(things: tuple[Thing, ...], stuff: str, pattern: str) -> list[Thing]:
    wholes = [thing for thing in things if thing.whole is None]
    found = [thing for thing in wholes if fnmatchcase(thing.name, pattern)]
    if not found:
        names = (thing.name for thing in wholes)
        raise UnknownNameError.of("thing", pattern, names, where=f"stuffs: {stuff}")
    for thing in found:
        if thing.mount.by != "nothing" or "Driven" in thing.roles:
            why = (
                "is fixed" if thing.fixed else "is moved by actuators" if "Driven" in thing.roles else "hangs on joints"
            )
            raise InputError(
                f"stuffs: {stuff}: {thing.name} matches {pattern!r}, but {why}; a stuff consists of what moves freely"
            )
    return found
