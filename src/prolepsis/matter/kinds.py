"""The kinds that there are: robots, hands, and those of matter, found where they lie.

Each folder here has a file ``kind.py`` in which ``KIND`` is a kind of matter; any other file here is one by itself.
"""

from __future__ import annotations

import importlib
import pkgutil

import prolepsis.matter
from prolepsis.robots.kinds import FreeHands, Robots
from prolepsis.scene.kind import Kind
from prolepsis.scene.robot import Robot
from prolepsis.terms.errors import InputError


def known_kinds(robot: Robot | None = None) -> tuple[Kind, ...]:
    """Return all kinds; ``robot`` is what an individual of class Robot is whose class says no more."""
    found = pkgutil.iter_modules(prolepsis.matter.__path__, "prolepsis.matter.")
    names = [f"{module.name}.kind" if module.ispkg else module.name for module in found]
    return (Robots(robot), FreeHands(), *(_kind(name) for name in names if name != __name__))


def _kind(name: str) -> Kind:
    try:
        found = getattr(importlib.import_module(name), "KIND", None)
    except ModuleNotFoundError as error:
        if error.name != name:
            raise
        found = None
    if not isinstance(found, Kind):
        raise InputError(f"{name.replace('.', '/')}.py: needs KIND, which says what kind of matter it is")
    return found
