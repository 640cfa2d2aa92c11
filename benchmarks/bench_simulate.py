"""How fast the simulation loop is beside bare MuJoCo stepping of the same substeps, and where the rest goes."""

from __future__ import annotations

import inspect
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.scenes import EGG_IN_HAND, PREFIX

from beside import ROOT, Row, phase_rows
from prolepsis.engine import simulation
from prolepsis.engine.channels import Channels
from prolepsis.engine.composing import compose_scene
from prolepsis.engine.recording import Frames, Recorder
from prolepsis.engine.world import compile_world
from prolepsis.matter.shells.breaking import Breaking
from prolepsis.programs import read_program
from prolepsis.programs.program import RunningProgram
from prolepsis.projection import read_scenario
from prolepsis.robots.control import Controls
from prolepsis.system.mujoco import mujoco

FORCES = (5.0, 15.0)
PLAN = "sequence([close(hand1, {force}), hold(hand1, 2.0)])"
HELD = (1.0, 2.9)
"""The pads are closed before 1 s, and hold until 2.96 s."""
PR2 = ROOT / "examples" / "pr2_grasp.toml"
STAGES: dict[str, tuple[tuple[Any, tuple[str, ...]], ...]] = {
    "mj_step": ((mujoco, ("mj_step",)),),
    "bonds: are any overloaded?": ((Breaking, ()),),
    "hand, program and senses": ((Controls, ()), (RunningProgram, ("step",))),
    "recording and channels": ((Recorder, ()), (Frames, ()), (Channels, ())),
    "checks after the run": ((simulation, ("_refuse_passed", "_refuse_gained")),),
}
"""Whose functions are of which stage: those that are named, or all that are public."""
REST = "other kinds, and the loop's own lines"


def compared(sources: Sequence[Path]) -> Iterator[Row]:
    """Yield the rows that an earlier state has, too."""
    with tempfile.TemporaryDirectory() as folder:
        for force in FORCES:
            name = f"a hand holds an egg with {force:g} N"
            yield from phase_rows(sources, _scenario(Path(folder), force), [(name, *HELD, ">= 0.75", "")])


def rows() -> Iterator[Row]:
    """Yield the shares of the stages."""
    with tempfile.TemporaryDirectory() as folder:
        for name, file in {"a hand, 15 N": _scenario(Path(folder), 15.0), "PR2": PR2}.items():
            for stage, share in shares(file).items():
                yield f"share of simulate, {name}: {stage}", f"{share:.0%}", ""


def _scenario(folder: Path, force: float) -> Path:
    """Write an egg between the pads of a hand that press it, and return the file."""
    (folder / "egg.ttl").write_text(PREFIX + EGG_IN_HAND, encoding="utf-8")
    file = folder / "egg.toml"
    file.write_text(f'situation = "egg.ttl"\nplan = "{PLAN.format(force=force)}"\n', encoding="utf-8")
    return file


class Stopwatch:
    """Where the time goes: to the innermost stage."""

    def __init__(self) -> None:
        self.spent: defaultdict[str, float] = defaultdict(float)
        self._stage, self._since = REST, time.perf_counter()

    def enter(self, stage: str) -> str:
        """Let another stage begin, and return which one ends."""
        now = time.perf_counter()
        self.spent[self._stage] += now - self._since
        before, self._stage, self._since = self._stage, stage, now
        return before

    def timed(self, stage: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function whose time is a stage's."""

        def inner(*args: Any, **options: Any) -> Any:
            before = self.enter(stage)
            try:
                return function(*args, **options)
            finally:
                self.enter(before)

        return inner


@contextmanager
def _timed_stages() -> Generator[Stopwatch]:
    """Time the functions of all stages within."""
    watch = Stopwatch()
    kept: list[tuple[Any, str, Any]] = []
    for stage, owners in STAGES.items():
        for owner, named in owners:
            members: dict[str, object] = owner.__dict__
            public = [name for name, each in members.items() if inspect.isfunction(each) and name[0] != "_"]
            for name in named or public:
                function = getattr(owner, name)
                kept.append((owner, name, function))
                setattr(owner, name, watch.timed(stage, function))
    try:
        yield watch
    finally:
        for owner, name, function in kept:
            setattr(owner, name, function)


def shares(file: Path) -> dict[str, float]:
    """Return the share of a run's time that each stage takes; the timers add a few microseconds a tick."""
    scenario = read_scenario(file, {})
    scene = compose_scene(scenario.knowledge_base())
    world, program = compile_world(scene), read_program(scenario.bound_plan(), scene)
    simulation.simulate(world, program)
    with _timed_stages() as watch:
        simulation.simulate(world, program)
        watch.enter(REST)
    total = sum(watch.spent.values())
    return {stage: watch.spent[stage] / total for stage in (*STAGES, REST)}
