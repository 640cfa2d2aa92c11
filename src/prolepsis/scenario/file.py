"""The keys of a scenario file: TOML, checked by name and type where it is read."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Mapping
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Annotated, Any, TypeVar, cast

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    StrictBool,
    StrictFloat,
    StrictInt,
    StrictStr,
    TypeAdapter,
    ValidationError,
)

from prolepsis.scenario.own_robot import OwnGripper, OwnRobot
from prolepsis.system.text_files import read_text
from prolepsis.terms.errors import ScenarioError, brief, did_you_mean

Number = StrictInt | StrictFloat
T = TypeVar("T")

LONGEST_FILE = 1_000_000
"""Longest scenario file [bytes]."""
MOST_DOTS = 50
"""Parts of a key; the reader of TOML takes the square of them."""
_LONG_KEY = re.compile(rf"(?:[\w-]+[ \t]*\.[ \t]*){{{MOST_DOTS}}}")
DEFAULT_PARTICLES = 2000
"""Particles of the largest liquid, if nothing is said: some 5 mm apart in a cup."""


class ParameterTable(BaseModel):
    """``{ value = 20, unit = "N" }``."""

    model_config = ConfigDict(extra="forbid")
    value: Number
    unit: StrictStr = "1"


class ScenarioFile(BaseModel):
    """The keys of a scenario file."""

    model_config = ConfigDict(extra="forbid")
    situation: StrictStr | Annotated[list[StrictStr], Field(min_length=1)]
    plan: StrictStr
    duration: Number | None = None
    seed: Annotated[StrictInt, Field(ge=0)] = 0
    draw: StrictBool = False
    particles: StrictInt = DEFAULT_PARTICLES
    robot: StrictStr | dict[str, Any] | None = None
    parameters: dict[str, Number | StrictStr | ParameterTable] = {}
    knowledge: dict[str, bool | Number | StrictStr] = {}
    monitors: dict[str, list[StrictStr]] = {}


def read_file(path: Path) -> ScenarioFile:
    """Return what a scenario file says.

    Raises:
        ScenarioError: If it is missing or wrong.
    """
    text = read_text(path, "scenario", most=LONGEST_FILE, error=ScenarioError)
    if _LONG_KEY.search(text):
        raise ScenarioError(f"{path}: TOML syntax: a key of more than {MOST_DOTS} parts")
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        message = str(error)
        line = re.search(r"at line (\d+)", message)
        location = f"{path}:{line.group(1)}" if line else str(path)
        raise ScenarioError(f"{location}: TOML syntax: {brief(message, 200)}") from error
    except ValueError as error:
        raise ScenarioError(f"{path}: TOML syntax: a number, date or time that cannot be: {brief(error)}") from error
    except RecursionError as error:
        raise ScenarioError(f"{path}: TOML syntax: tables or lists are nested too deeply") from error
    try:
        return ScenarioFile.model_validate(table)
    except ValidationError as error:
        raise ScenarioError(f"{path}: {_first_problem(error, table)}") from error


def read_robot(table: Mapping[str, Any], where: str) -> OwnRobot:
    """Return what a ``[robot]`` table says.

    Raises:
        ScenarioError: If it is wrong.
    """
    grippers = table.get("grippers")
    if isinstance(grippers, Mapping):
        named = cast("Mapping[str, Any]", grippers)
        table = {**table, "grippers": {name: _effector_apart(each) for name, each in named.items()}}
    return read_table(OwnRobot, table, f"{where}: robot")


def write_robot(robot: OwnRobot) -> dict[str, Any]:
    """Return the table from which ``read_robot`` makes the same robot."""
    table = TypeAdapter(OwnRobot).dump_python(robot, mode="json")
    for gripper in table["grippers"].values():
        gripper |= gripper.pop("effector")
    return table


def read_table(type: type[T], table: Mapping[str, Any], location: str) -> T:
    """Return what a table says that a dataclass describes.

    Raises:
        ScenarioError: If it is wrong.
    """
    try:
        return TypeAdapter(type).validate_python(table)
    except ValidationError as error:
        problem = error.errors(include_url=False)[0]
        # Where a value may be of several types, pydantic adds which of them it has tried.
        keys = [str(key) for key in problem["loc"] if "constrained-" not in str(key)]
        where = location + "".join(f".{key}" for key in keys[:-1])
        described: Any = OwnGripper if keys[0] == "grippers" and len(keys) > 2 else type
        known = {each.name: each for each in fields(described)}
        if problem["type"] == "unexpected_keyword_argument":
            raise unknown_key(where, keys[-1], known) from None
        if problem["type"] == "missing" and not keys[-1].isdigit():
            needed = ", ".join(n for n, each in known.items() if MISSING is each.default is each.default_factory)
            raise ScenarioError(f"{where}: the key {keys[-1]!r} is missing; needed: {needed}") from None
        raise ScenarioError(f"{where}.{keys[-1]}: {_said(problem)}") from None


def unknown_key(location: str, key: str, known: Collection[str]) -> ScenarioError:
    """Return the error for a key that a table may not have, with the nearest one that it may."""
    return ScenarioError(
        f"{location}: unknown key {brief(repr(key))}{did_you_mean(key, known)}; known: {', '.join(known)}"
    )


def _effector_apart(gripper: Any) -> Any:
    """Return a gripper's table with the keys of its kind of effector in one of their own; None says nothing."""
    if not isinstance(gripper, Mapping):
        return gripper
    keys = cast("Mapping[str, Any]", gripper)
    common = {key: keys[key] for key in keys if key in OwnGripper.__dataclass_fields__ and key != "effector"}
    return {**common, "effector": {k: v for k, v in keys.items() if k not in common and v is not None}}


def _first_problem(error: ValidationError, table: Mapping[str, Any]) -> str:
    problem = error.errors(include_url=False)[0]
    keys = [str(key) for key in problem["loc"]]
    if problem["type"] == "extra_forbidden" and len(keys) == 1:
        return f"unknown key {brief(repr(keys[0]))}; known: {', '.join(ScenarioFile.model_fields)}"
    if problem["type"] == "missing" and len(keys) == 1:
        return f"the key {keys[0]!r} is missing; needed: situation, plan"
    if keys[0] == "parameters" and len(keys) > 1:
        return f'parameter {brief(keys[1])}: give a number, the name of an individual, or {{ value = 20, unit = "N" }}'
    if keys[0] == "knowledge" and len(keys) > 1:
        return (
            f'knowledge: {brief(keys[1])}: give a number, a text or true/false; write the name in quotes, "egg1.mass"'
        )
    if keys[0] == "monitors" and len(keys) > 1:
        return f'monitors: {brief(keys[1])}: give a list of names, such as ["load", "speed"]'
    given = brief(repr(table.get(keys[0])))
    if keys[0] == "robot":
        return f"robot = {given}: give a name, or a table [robot] with file and grippers"
    if keys[0] == "draw":
        return f"draw = {given}: must be true or false"
    return f"{keys[0]} = {given}: {_said(problem)}"


def _said(problem: Any) -> str:
    """Return what is wrong as TOML has it: a table is no dictionary or dataclass there, a list no tuple."""
    if problem["type"] in ("dict_type", "mapping_type", "dataclass_type", "dataclass_exact_type", "model_type"):
        return "give a table"
    if problem["type"] in ("tuple_type", "list_type"):
        return "give a list"
    if problem["type"] in ("too_long", "too_short"):
        most, least = problem["ctx"].get("max_length"), problem["ctx"].get("min_length")
        return f"has {problem['ctx']['actual_length']} items; allowed: " + (
            f"at least {least}" if most is None else f"at most {most}"
        )
    return str(problem["msg"]).lower().removesuffix(", unable to parse string as a number")
