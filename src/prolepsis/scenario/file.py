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
_TURTLE = re.compile(r"^\s*@?prefix\s", re.MULTILINE | re.IGNORECASE)
"""What a file of Turtle begins with."""
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
    seed: StrictInt = 0
    draw: StrictBool = False
    particles: StrictInt = DEFAULT_PARTICLES
    robot: StrictStr | dict[str, Any] | None = None
    parameters: dict[str, Number | StrictStr | ParameterTable] = {}
    knowledge: dict[str, bool | Number | StrictStr] = {}
    monitors: dict[str, list[StrictStr]] = {}


WANTED: Mapping[str, str] = {
    "situation": "give the name of a Turtle file, or a list of such names",
    "plan": "give a text, such as 'lift(hand1, 0.1)'",
    "duration": "give a number of seconds, without a unit",
    "seed": "must be a whole number",
    "draw": "must be true or false",
    "particles": "must be a whole number",
    "robot": "give a name, or a table [robot] with file and grippers",
    "parameters": "give a table [parameters], with a value for each variable of the plan",
    "knowledge": 'give a table [knowledge], as "egg1.mass" = 0.06',
    "monitors": 'give a table [monitors], as egg1 = ["load", "speed"]',
}
"""What each key of a scenario file must be."""


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
        told = (
            "; this is a situation, which a scenario names: situation = FILE, plan = ..."
            if _TURTLE.search(text)
            else ""
        )
        raise ScenarioError(f"{location}: TOML syntax: {brief(message, 120)}{told}") from error
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
        known = ScenarioFile.model_fields
        return f"unknown key {brief(repr(keys[0]))}{did_you_mean(keys[0], known)}; known: {', '.join(known)}"
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
    return f"{keys[0]} = {_given(table.get(keys[0]))}: {WANTED[keys[0]]}"


def _given(value: object) -> str:
    """Return a value as TOML has it, nearly."""
    return brief(str(value).lower() if isinstance(value, bool) else repr(value) if isinstance(value, str) else value)


def _said(problem: Any) -> str:
    """Return what is wrong in our words, and as TOML has it: a table is no dataclass there, a list no tuple."""
    limits = problem.get("ctx", {})
    if problem["type"] in ("too_long", "too_short"):
        most, least = limits.get("max_length"), limits.get("min_length")
        return f"has {limits['actual_length']} items; allowed: " + (
            f"at least {least}" if most is None else f"at most {most}"
        )
    if problem["type"] == "missing":
        return "is missing"
    for words, wanted in _WORDS.items():
        if problem["type"].startswith(words):
            return f"{wanted.format(**limits)}, not {_given(problem['input'])}"
    return f"is not what is needed here: {_given(problem['input'])}"


_WORDS: Mapping[str, str] = {
    "greater_than_equal": "must be at least {ge:g}",
    "greater_than": "must be greater than {gt:g}",
    "less_than_equal": "must be at most {le:g}",
    "less_than": "must be less than {lt:g}",
    "finite": "must be finite",
    "string_too_long": "must have at most {max_length} characters",
    "string": "give a text in quotes",
    "int": "give a whole number",
    "float": "give a number",
    "bool": "give true or false",
    **dict.fromkeys(("dict", "mapping", "dataclass", "model"), "give a table"),
    **dict.fromkeys(("tuple", "list"), "give a list"),
}
"""How the types of problems begin, and what to say of them."""
