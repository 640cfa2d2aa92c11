"""The scenario: a situation, a plan with its parameters, and what else one run is told.

A scenario file is TOML; it is checked here, at the edge, and is a frozen value from then on.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import cast

from prolepsis.knowledge import KnowledgeBase
from prolepsis.knowledge.situation import MOST_INDIVIDUALS
from prolepsis.knowledge.sources import NAMESPACE, Source
from prolepsis.scenario.file import DEFAULT_PARTICLES, ParameterTable, read_file, read_robot
from prolepsis.scenario.own_robot import OwnRobot
from prolepsis.scenario.plan import bind, read_plan, variables
from prolepsis.system.text_files import is_file, path_of
from prolepsis.terms.errors import InputError, ScenarioError, UnknownNameError, brief, brief_list
from prolepsis.terms.terms import Value
from prolepsis.terms.units import read_quantity, si_symbol, to_float, to_si, unit_of

FEWEST_PARTICLES, MOST_PARTICLES = 20, 200_000
"""Fewer are no liquid; more would take gigabytes of log, and days."""
LONGEST = 86_400.0
"""Longest duration [s]: a day."""
LARGEST_SEED = 2**63 - 1
"""Larger ones are no whole numbers to most programs that read the saved scenario."""
ROBOTS: Mapping[str, Path | None] = {
    "hand": None,
    **{file.stem: file for file in sorted((Path(__file__).parent.parent / "knowledge" / "robots").glob("*.ttl"))},
}
"""Robots that a scenario may name, with what each adds to the situation: a hand is declared there by who wants one."""


_PREFIX = f"@prefix : <{NAMESPACE}> ."
_DECLARES = re.compile(r"(?i)(@prefix|\bprefix)\s+:\s*<")
"""Whether a text of Turtle says what ``:`` stands for."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """What a variable of the plan stands for."""

    value: float | str
    """A number in SI units, or the name of an individual of the knowledge base, ``force7``."""
    unit: str | None = None
    """SI unit of a number; None for a pure number or a name."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Scenario:
    """Everything that one run is told. The same scenario gives the same bytes."""

    path: Path = Path("scenario")
    """The scenario file; for one made in Python, where its relative paths start."""
    situation: Path | str | Source | Sequence[Path | str | Source]
    """Turtle files, or Turtle itself: a path is a file, a text is Turtle, in which ``:`` need not be declared. One or
    several; kept as a tuple of paths and of texts with their names."""
    plan: Value
    """What the robot does, with variables. A text is read as a plan in a scenario file is, and kept as a term."""
    parameters: Mapping[str, Parameter] = field(default_factory=dict[str, Parameter])
    """Value of each variable of the plan."""
    knowledge: Mapping[str, float | str] = field(default_factory=dict[str, "float | str"])
    """Values of the knowledge base that are replaced, ``{"eggshell3.friction": 0.4}``."""
    robot: str | OwnRobot | None = None
    """Robot that is added to the situation: one of ``ROBOTS`` or the user's own; None if the situation has all that it
    needs."""
    duration: float | None = None
    """Simulated time [s]; None for the plan's length plus settling."""
    seed: int = 0
    """Seed of every random draw."""
    draw: bool = False
    """Whether quantities with a stated deviation are drawn before the run; if not, each is its mean."""
    particles: int = DEFAULT_PARTICLES
    """Number of particles of the largest liquid; those of the others are as large."""
    monitors: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, "tuple[str, ...]"])
    """What is logged of a thing instead of the usual, ``{"egg1": ("load", "speed")}``."""

    def __post_init__(self) -> None:
        """Read what is given as text, and refuse a scenario that cannot be run."""
        for name, (fits, wanted) in WANTED.items():
            if not fits(value := getattr(self, name)):
                raise ScenarioError(f"scenario: {name} = {brief(repr(value))}: give {wanted}")
        object.__setattr__(self, "situation", _situation(self.situation, self.path))
        if isinstance(self.plan, str):
            object.__setattr__(self, "plan", read_plan(self.plan, self.path))
        if self.duration is not None and not 0.0 < to_float(self.duration) <= LONGEST:
            raise ScenarioError(
                f"{self.path}: duration must be a finite number of seconds greater than 0 and at most {LONGEST:,.0f}, "
                f"not {to_float(self.duration):g}"
            )
        for name in ("seed", "particles"):
            if type(getattr(self, name)) is not int:
                raise ScenarioError(f"{self.path}: {name} = {brief(getattr(self, name))}: must be a whole number")
        if type(self.draw) is not bool:
            raise ScenarioError(f"{self.path}: draw = {brief(self.draw)}: must be true or false")
        if not 0 <= self.seed <= LARGEST_SEED:
            raise ScenarioError(f"{self.path}: seed = {brief(self.seed)}: allowed: 0 to {LARGEST_SEED}")
        if not FEWEST_PARTICLES <= self.particles <= MOST_PARTICLES:
            raise ScenarioError(
                f"{self.path}: particles = {brief(self.particles)}: allowed: {FEWEST_PARTICLES} to {MOST_PARTICLES}"
            )
        if isinstance(self.robot, str) and self.robot not in ROBOTS:
            raise UnknownNameError.of("robot", self.robot, ROBOTS, f"{self.path}: robot")
        for name, parameter in self.parameters.items():
            if isinstance(parameter.value, float) and not math.isfinite(parameter.value):
                raise ScenarioError(f"{self.path}: parameter {brief(name)} must be finite, not {parameter.value}")
        used = sorted(set(variables(self.plan)))
        missing = [name for name in used if name not in self.parameters]
        if missing:
            raise ScenarioError(
                f"{self.path}: the plan's variable {brief(missing[0])} has no value; give it under [parameters], or "
                f"begin what is no variable with a small letter; given: {brief_list(sorted(self.parameters))}"
            )
        unused = [name for name in sorted(self.parameters) if name not in used]
        if unused:
            raise ScenarioError(
                f"{self.path}: the plan has no variable {brief(unused[0])}, which [parameters] gives; "
                f"variables of the plan: {brief_list(used)}"
            )

    @property
    def sources(self) -> tuple[Path | Source, ...]:
        """What the situation consists of: files, and texts with their names."""
        return cast("tuple[Path | Source, ...]", self.situation)

    @classmethod
    def load(cls, path: Path | str, settings: Mapping[str, str | float] | None = None) -> Scenario:
        """Return the scenario in the TOML file at ``path``.

        Args:
            path: The file. Situations are found relative to it.
            settings: ``NAME -> VALUE`` as ``--set`` gives them: parameters in their own unit, without regard
                to case, and knowledge values named ``individual.property``.

        Raises:
            ScenarioError: If the file is missing or wrong.
            PlanError: If the plan cannot be read.
            UnknownNameError: If a setting names no parameter.
        """
        path = path_of(path, "scenario", ScenarioError)
        content = read_file(path)
        files = [content.situation] if isinstance(content.situation, str) else content.situation
        situation = tuple(path.parent / name for name in files)
        for file in situation:
            if not is_file(file):
                raise ScenarioError(f"{path}: situation: there is no file {brief(file)}")
        scenario = cls(
            path=path,
            situation=situation,
            plan=content.plan,
            parameters={n: _parameter(v, f"{path}: parameter {n}") for n, v in content.parameters.items()},
            knowledge={n: _plain(v) for n, v in content.knowledge.items()},
            robot=read_robot(content.robot, str(path)) if isinstance(content.robot, dict) else content.robot,
            duration=None if content.duration is None else to_float(content.duration),
            seed=content.seed,
            draw=content.draw,
            particles=content.particles,
            monitors={n: tuple(names) for n, names in content.monitors.items()},
        )
        return scenario.with_settings(settings or {})

    def with_settings(self, settings: Mapping[str, str | float]) -> Scenario:
        """Return the scenario with other values of parameters, of the knowledge base, of particles, seed or draw.

        Raises:
            UnknownNameError: If a setting names no parameter.
            ScenarioError: If a value has the wrong unit, or is none.
        """
        if not all(map(_is_setting, settings.items())):
            raise ScenarioError(
                f"{self.path}: settings are numbers or texts by name, as {{'Force': 5.0}}, not {brief(settings)}"
            )
        parameters, knowledge = dict(self.parameters), dict(self.knowledge)
        chosen: dict[str, int] = {}
        self.refuse_twice(settings)
        for given, value in settings.items():
            name = self.meant(given)
            where = f"{self.path}: {name} = {brief(value)}"
            if "." in name:
                knowledge[name] = _plain(value)
            elif name in parameters:
                parameters[name] = _setting(value, parameters[name], where)
            else:
                chosen[name] = KEYS[name](value, where)
        return replace(self, parameters=parameters, knowledge=knowledge, **chosen)

    def meant(self, name: str) -> str:
        """Return what the name of a setting means: a knowledge value, a parameter in any case, or one of ``KEYS``.

        Raises:
            UnknownNameError: If it means nothing.
        """
        if "." in name or name in self.parameters:
            return name
        match = [known for known in self.parameters if known.lower() == name.lower()]
        if not match and name in KEYS:
            return name
        if len(match) != 1:
            raise UnknownNameError.of("parameter", name, self.parameters, where=str(self.path))
        return match[0]

    def refuse_twice(self, names: Iterable[str]) -> None:
        """Refuse settings of which two mean the same.

        Raises:
            ScenarioError: With both.
        """
        seen: dict[str, str] = {}
        for name in names:
            meant = self.meant(name)
            if meant in seen:
                other = "" if seen[meant] == name else f", also as {brief(seen[meant])}"
                raise ScenarioError(f"{self.path}: {brief(name)} is given twice{other}; allowed: once")
            seen[meant] = name

    def knowledge_base(self) -> KnowledgeBase:
        """Return the knowledge base of the situation, with this scenario's values, and what its seed draws.

        Raises:
            UnknownNameError: If a parameter or a knowledge value names nothing that is there.
            KnowledgeError: If a value, or what is drawn, is wrong.
        """
        base = KnowledgeBase.load(*self._robot_sources(), *self.sources, most=MOST_INDIVIDUALS)
        for name, parameter in self.parameters.items():
            if isinstance(parameter.value, str) and parameter.value not in base.individuals:
                raise UnknownNameError.of(
                    "individual", parameter.value, base.individuals, f"{self.path}: parameter {name}"
                )
        base = base.with_values(self.knowledge, where=f"{self.path}: knowledge: ") if self.knowledge else base
        return base.with_draws(self.seed) if self.draw else base

    def _robot_sources(self) -> list[Path | Source]:
        """Return what says that the robot is there."""
        if isinstance(self.robot, OwnRobot):
            # These lines are in no file.
            return [Source(path=self.path, text=self.robot.statements(self.path), numbered=False)]
        file = ROBOTS.get(self.robot or "")
        return [] if file is None else [file]

    def bound_plan(self) -> Value:
        """Return the plan with each variable replaced by its number (SI) or the name of its individual."""
        return bind(self.plan, {name: parameter.value for name, parameter in self.parameters.items()})


def _situation(given: object, path: Path) -> tuple[Path | Source, ...]:
    """Return the files and texts of a situation, each text with a name that no other has.

    Raises:
        ScenarioError: If something is neither.
    """
    found: list[Path | Source] = []
    for each in cast("Sequence[object]", given) if isinstance(given, list | tuple) else (given,):
        if isinstance(each, str):
            if not any(character.isspace() for character in each.strip()):
                name = brief(repr(each.strip()))
                raise ScenarioError(f"{path}: situation: {name} is no Turtle; a file is given as Path({name})")
            name = "situation.ttl" if not found else f"situation_{len(found) + 1}.ttl"
            each = Source(path=Path(name), text=each if _DECLARES.search(each) else f"{_PREFIX} {each}")
        if not isinstance(each, Path | Source):
            raise ScenarioError(
                f"{path}: situation: {brief(repr(each))} is none; allowed: a Path of a Turtle file, a text of Turtle, "
                "or several of them"
            )
        found.append(each)
    return tuple(found)


def _parameter(value: float | str | ParameterTable, where: str) -> Parameter:
    if isinstance(value, ParameterTable):
        return _quantity(to_float(value.value), value.unit, where)
    if isinstance(value, str):
        read = read_quantity(value)
        return Parameter(value) if read is None else _quantity(*read, where)
    return Parameter(to_float(value))


def _quantity(number: float, unit: str, where: str) -> Parameter:
    try:
        symbol = si_symbol(unit_of(unit))
        return Parameter(to_si(number, unit), None if symbol == "1" else symbol)
    except InputError as error:
        raise ScenarioError(f"{where}: {error}") from error


def _setting(value: str | float, old: Parameter, where: str) -> Parameter:
    read = read_quantity(value) if isinstance(value, str) else (to_float(value), "")
    if read is None:
        return Parameter(str(value))
    number, unit = read
    if not unit:
        return Parameter(number, old.unit)
    new = _quantity(number, unit, where)
    if old.unit is not None and new.unit != old.unit:
        raise ScenarioError(f"{where}: unit {brief(repr(unit))} does not fit: a unit such as {old.unit!r} is needed")
    return new


def _whole(value: str | float, where: str) -> int:
    if isinstance(value, bool):
        raise ScenarioError(f"{where}: must be a whole number")
    if isinstance(value, int) or (isinstance(value, str) and value.strip().isdigit()):
        try:
            return int(value)
        except ValueError:  # Python reads none that is longer than 4300 digits.
            raise ScenarioError(f"{where}: must be a whole number") from None
    try:
        return _whole_float(value)
    except ValueError:
        raise ScenarioError(f"{where}: must be a whole number") from None


def _truth(value: str | float, where: str) -> bool:
    text = str(value).strip().lower()
    if text not in ("true", "false"):
        raise ScenarioError(f"{where}: must be true or false")
    return text == "true"


KEYS: Mapping[str, Callable[[str | float, str], int]] = {"particles": _whole, "seed": _whole, "draw": _truth}
"""Keys of a scenario that are settings, with how each is read."""


def _whole_float(value: str | float) -> int:
    number = float(value)
    # Beyond this a float stands for other whole numbers, too.
    if not (number.is_integer() and abs(number) < 2**53):
        raise ValueError(number)
    return int(number)


def _plain(value: bool | float | str) -> float | str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    return to_float(value)


def _is_setting(item: tuple[object, object]) -> bool:
    name, value = item
    return isinstance(name, str) and isinstance(value, str | int | float)


def _is_table(fits: Callable[[object], bool]) -> Callable[[object], bool]:
    """Return whether something is a mapping from names to what fits."""

    def is_table(value: object) -> bool:
        rows = cast("Mapping[object, object]", value).items() if isinstance(value, Mapping) else None
        return rows is not None and all(isinstance(name, str) and fits(each) for name, each in rows)

    return is_table


def _are_names(value: object) -> bool:
    return isinstance(value, list | tuple) and all(isinstance(name, str) for name in cast("Sequence[object]", value))


WANTED: Mapping[str, tuple[Callable[[object], bool], str]] = {
    "path": (lambda value: isinstance(value, Path), "a Path"),
    "parameters": (
        _is_table(lambda value: isinstance(value, Parameter)),
        "each variable's Parameter by its name, {'Force': Parameter(20.0, 'N')}",
    ),
    "knowledge": (
        _is_table(lambda value: isinstance(value, str | int | float)),
        "numbers, texts or truths by individual.property, {'egg1.mass': 0.06}",
    ),
    "robot": (
        lambda value: value is None or isinstance(value, str | OwnRobot),
        "the name of a robot, an OwnRobot, or None",
    ),
    "duration": (
        lambda value: value is None or (isinstance(value, int | float) and not isinstance(value, bool)),
        "a number of seconds, or None",
    ),
    "monitors": (_is_table(_are_names), "lists of names by thing, {'egg1': ['load', 'speed']}"),
}
"""Fields of a scenario that Python may give as anything: whether a value fits, and what does."""
