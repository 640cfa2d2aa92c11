"""Temporal projection: from a scenario to a timeline that can be asked, and to a folder and back."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, cast

from prolepsis.log.files import read_log_files, write_log_files
from prolepsis.log.log import Log
from prolepsis.log.saved import read_timeline_files, write_timeline_files
from prolepsis.log.sealed import (
    MANIFEST,
    check_replaceable,
    is_plain_name,
    read_json,
    read_sealed,
    read_text,
    write_json,
    write_sealed,
    write_sealed_beside,
    write_text,
)
from prolepsis.log.tables import refuse_long_run
from prolepsis.log.timeline import Timeline
from prolepsis.scenario.file import DEFAULT_PARTICLES, read_robot, write_robot
from prolepsis.scenario.own_robot import OwnRobot
from prolepsis.scenario.scenario import Parameter, Scenario
from prolepsis.scene.scene import Scene
from prolepsis.system.kernels import are_kept
from prolepsis.system.threads import one_thread
from prolepsis.terms.errors import InputError, LogError, ScenarioError, brief
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import Value, format_value

Progress = Callable[[str], None]
"""Called from time to time with a few words on what is being done."""

SCENARIO, WORLD = "scenario.json", "world.xml"


# What is in it are arrays, of which no == tells one truth.
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Projection:
    """One scenario, what happened in it, and what that means in symbols."""

    scenario: Scenario
    """What was asked for, all parameters and overrides resolved."""
    scene: Scene
    """The things at the start, and what is known of them."""
    log: Log
    """What the simulation left behind."""
    timeline: Timeline
    """Which fluents held and which events occurred."""
    world: str
    """The world file (MJCF), which the plain MuJoCo viewer opens."""
    drawn: Mapping[str, float | str] = field(default_factory=dict[str, "float | str"])
    """What was drawn before the run, ``{"eggshell1.breakingForce": 29.3}``; as settings it gives the same run again."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Projection({self.scenario.path.name}: {self.log}, {self.timeline})"

    def ask(self, goal: str, limit: int | None = None) -> list[dict[str, Value]]:
        """Return the answers to a Prolog goal: ``[]`` means no, ``[{}]`` means yes. See ``Timeline.ask``."""
        return self.timeline.ask(goal, limit=limit)

    def save(self, folder: str | Path) -> None:
        """Write everything into a sealed folder; an earlier one of ours is replaced.

        Raises:
            InputError: If ``folder`` holds something that is not ours.
        """
        write_sealed(folder, self.write)

    @classmethod
    def load(cls, folder: str | Path) -> Projection:
        """Return the projection saved in ``folder``. Nothing is simulated or recognized anew.

        Raises:
            LogError: If the folder is not whole, or holds no projection.
        """
        path = read_sealed(folder)
        timeline = read_timeline_files(path)
        log = read_log_files(path)
        try:
            row = read_json(path / SCENARIO)
            scenario, drawn = _scenario(row, path), _drawn(row)
            world = read_text(path / WORLD)
        except FileNotFoundError as error:
            raise LogError(f"{path}: holds no whole projection (it has no {Path(str(error.filename)).name})") from None
        # What is no scenario fails in one of these ways, depending on where.
        except (AttributeError, KeyError, TypeError, ValueError, InputError) as error:
            raise LogError(f"{path}: its scenario is malformed: {brief(error, 200)}") from None
        scene = Scene(things=log.things, domain=timeline.domain, gravity=log.gravity)
        return cls(scenario=scenario, scene=scene, log=log, timeline=timeline, world=world, drawn=drawn)

    def write(self, path: Path) -> None:
        """Write everything into an existing folder, unsealed."""
        write_log_files(self.log, path)
        write_text(path / WORLD, self.world)
        write_timeline_files(self.timeline, path)
        scenario = self.scenario
        own = scenario.robot if isinstance(scenario.robot, OwnRobot) else None
        models = () if own is None else (scenario.path.parent / own.file,)
        taken = {SCENARIO, MANIFEST, *(file.name for file in path.iterdir())}
        sources = (*scenario.sources, *models)
        names = _copy_names([each if isinstance(each, Path) else each.path for each in sources], taken)
        for name, source in zip(names, sources, strict=True):
            if isinstance(source, Path):
                shutil.copyfile(source, path / name)
            else:
                write_text(path / name, source.text)
        if own is not None:
            scenario = replace(scenario, robot=replace(own, file=names[-1], folder=None))
        situation = names[: len(scenario.sources)]
        write_json(path / SCENARIO, {**_scenario_row(scenario, situation), "drawn": dict(self.drawn)})


def project(
    scenario: Scenario | str | Path,
    *,
    out: str | Path | None = None,
    settings: Mapping[str, float | str] | None = None,
    progress: Progress | None = None,
    **parameters: float | str,
) -> Projection:
    """Simulate a scenario, recognize what happens, and return all of it.

    Args:
        scenario: A scenario, or its TOML file.
        out: Folder to save the projection in. If something that is not ours comes into it meanwhile, the projection is
            saved beside it (``out-2``), and a ``Note`` says so.
        settings: Values by name, of parameters (``Force``), of the knowledge base (``eggshell3.friction``), and of
            ``seed``, ``draw`` and ``particles``.
        progress: Called from time to time with what is being done.
        parameters: More settings of parameters, ``Force=25`` or ``force="force7"``.

    Raises:
        InputError: If anything given is wrong; the subclass tells what.
        InvalidSimulationError: If the physics went unstable.
    """
    if not isinstance(settings, Mapping | None):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(f"settings are numbers or texts by name, as {{'Force': 5.0}}, not {brief(settings)}")
    read = read_scenario(scenario, {**(settings or {}), **parameters})
    return project_into(read, out, progress)[0]


@one_thread()
def project_into(
    read: Scenario, out: str | Path | None, progress: Progress | None = None
) -> tuple[Projection, Path | None]:
    """Return what ``project`` does of a scenario that was read, and the folder in which it is saved."""
    if out is not None:
        check_replaceable(out)

    tell = progress or _silent
    tell("reading the knowledge")
    knowledge = read.knowledge_base()
    # What physics imports takes a moment, and a wrong scenario is refused before it.
    from prolepsis.engine.composing import compose_scene
    from prolepsis.engine.simulation import simulate
    from prolepsis.engine.world import compile_world
    from prolepsis.engine.world_file import world_file
    from prolepsis.fluents import recognize
    from prolepsis.programs import check_units, read_program
    from prolepsis.robots.loading import load_robot
    from prolepsis.scene.particles import PERIOD
    from prolepsis.scene.running import TICK

    if any(knowledge.is_a(name, "Liquid") for name in knowledge.objects) and not are_kept():
        tell("compiling the kernels of liquids, once, in about a minute")
    own = read.robot if isinstance(read.robot, OwnRobot) else None
    robot = None if own is None else load_robot(own, read.path.parent, f"{read.path}: robot")
    scene = compose_scene(knowledge, robot=robot, particles=read.particles)
    check_units(read.plan, {name: each.unit for name, each in read.parameters.items()})
    program = read_program(read.bound_plan(), replace(scene, folder=read.path.parent))
    tell("building the world")
    world = compile_world(scene)
    if out is not None and read.duration is not None:
        # A run without a duration may end soon; of a long one it is told when it is saved.
        ticks = round(read.duration / TICK)
        particles = sum(len(pool.position) for pool in scene.pools)
        refuse_long_run(len(scene.things), ticks, particles, ticks // PERIOD)
    log = simulate(
        world,
        program,
        duration=read.duration,
        seed=read.seed,
        monitors=read.monitors,
        progress=lambda time: tell(f"simulating: {time:.1f} s"),
        checking=lambda: tell("checking"),
    )
    tell("recognizing")
    timeline = recognize(log, domain=scene.domain)
    result = Projection(
        scenario=read, scene=scene, log=log, timeline=timeline, world=world_file(world), drawn=knowledge.drawn
    )
    if out is None:
        return result, None
    tell("saving")
    return result, write_sealed_beside(out, result.write)


def _silent(doing: str) -> None:
    """Tell nobody."""


def read_scenario(scenario: Scenario | str | Path, settings: Mapping[str, float | str]) -> Scenario:
    """Return a scenario, read from its file if need be, with ``settings`` applied."""
    read = scenario if isinstance(scenario, Scenario) else Scenario.load(scenario)
    return read.with_settings(settings)


def _copy_names(sources: Sequence[Path], taken: Collection[str]) -> list[str]:
    """Return for each file the name of its copy, distinct from each other and from those that are ``taken``."""
    names: list[str] = []
    for i, source in enumerate(sources):
        name = _as_text(source.name)
        names.append(name if name not in (*names, *taken) else f"{i}_{name}")
    return names


def _as_text(name: str) -> str:
    """Return the name of a file as Unicode, which it need not be."""
    return name.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")


def _scenario_row(scenario: Scenario, situation: list[str]) -> dict[str, Any]:
    return {
        "name": _as_text(Path(scenario.path).name),
        "situation": situation,
        "plan": format_value(scenario.plan),
        "bound_plan": format_value(scenario.bound_plan()),
        "parameters": {name: {"value": each.value, "unit": each.unit} for name, each in scenario.parameters.items()},
        "knowledge": dict(scenario.knowledge),
        "robot": write_robot(scenario.robot) if isinstance(scenario.robot, OwnRobot) else scenario.robot,
        "duration": scenario.duration,
        "seed": scenario.seed,
        "draw": scenario.draw,
        "particles": scenario.particles,
        "monitors": {name: list(chosen) for name, chosen in scenario.monitors.items()},
    }


def _scenario(row: dict[str, Any], path: Path) -> Scenario:
    parameters: Mapping[str, Any] = row["parameters"]
    plan = parse_term(row["plan"], where=SCENARIO)
    robot: Any = row["robot"]
    if not isinstance(row["seed"], int):
        raise ScenarioError(f"{SCENARIO}: seed is not a whole number")
    return Scenario(
        path=path / _name(row["name"]),
        situation=tuple(path / _name(name) for name in row["situation"]),
        plan=plan,
        parameters={name: Parameter(value=each["value"], unit=each["unit"]) for name, each in parameters.items()},
        knowledge=dict(row["knowledge"]),
        robot=_own_robot(cast("dict[str, Any]", robot)) if isinstance(robot, dict) else robot,
        duration=row["duration"],
        seed=row["seed"],
        draw=row.get("draw", False),
        particles=row.get("particles", DEFAULT_PARTICLES),
        monitors={name: tuple(chosen) for name, chosen in row.get("monitors", {}).items()},
    )


def _drawn(row: dict[str, Any]) -> dict[str, float | str]:
    drawn: Mapping[str, Any] = row.get("drawn", {})
    if not all(isinstance(value, str | int | float) for value in drawn.values()):
        raise ScenarioError(f"{SCENARIO}: what was drawn is not numbers or texts by name")
    return dict(drawn)


def _own_robot(table: dict[str, Any]) -> OwnRobot:
    robot = read_robot(table, SCENARIO)
    _name(robot.file)
    return replace(robot, folder=None)


def _name(name: Any) -> str:
    """Return a name if it is one of a file in the same folder: a folder of a stranger's leads nowhere else.

    Raises:
        ScenarioError: If it is not.
    """
    if not isinstance(name, str) or not is_plain_name(name):
        raise ScenarioError(f"{SCENARIO}: {brief(repr(name))} is no name of a file in the folder")
    return name
