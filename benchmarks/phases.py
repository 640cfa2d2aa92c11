"""Processor time of a phase of a run, and of bare `mj_step` of the very same substeps from the state at its start.

A program of its own, so that it can measure the package of an earlier state, too (`beside.py`):

    PYTHONPATH=src python benchmarks/phases.py examples/pr2_grasp.toml 3.2 5.2 Force=5

It prints, as JSON, the best of some repeats [s] of each phase. Bare steps are given the controls of the run, tick by
tick, and nothing else is done between them; what touched at the start of the phase must touch at its end.
"""

from __future__ import annotations

import copy
import json
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from prolepsis.engine.composing import compose_scene
from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.projection import read_scenario
from prolepsis.system.mujoco import mujoco

REPEATS = 2
Run = Callable[[Callable[[float], None]], object]
"""A simulation that tells its progress [s]."""


@dataclass
class Phase:
    """From when to when of a simulation [s], the engine's state at the start, and the steps that it was asked for."""

    start: float
    end: float
    model: Any = None
    data: Any = None
    steps: list[tuple[float, Any, int]] = field(default_factory=list[tuple[float, Any, int]])
    """Timestep [s], controls, and how many steps have both."""


def listen(run: Run, phases: Sequence[Phase]) -> None:
    """Note the steps of each phase, by a run in which the engine calls back from each, whoever asked for it."""
    last = -1.0
    now: list[Phase] = []

    def heard(model: Any, data: Any) -> None:
        nonlocal last
        # Forces may be computed once more between two steps.
        if data.time == last:
            return
        last = data.time
        for phase in now:
            if phase.model is None:
                phase.model, phase.data = copy.copy(model), copy.copy(data)
            _note(phase, float(model.opt.timestep), data.ctrl)

    def progress(simulated: float) -> None:
        now[:] = [phase for phase in phases if phase.start <= round(simulated, 1) < phase.end]
        # Compiling a model steps it, too, which cannot be listened to.
        mujoco.set_mjcb_control(heard if now else None)

    try:
        run(progress)
    finally:
        mujoco.set_mjcb_control(None)


def _note(phase: Phase, timestep: float, control: Any) -> None:
    if phase.steps:
        before, controls, counted = phase.steps[-1]
        if before == timestep and np.array_equal(controls, control):
            phase.steps[-1] = (before, controls, counted + 1)
            return
    phase.steps.append((timestep, control.copy(), 1))


def bare(phase: Phase) -> float:
    """Return the processor time of the steps of a phase alone [s].

    Raises:
        RuntimeError: If what touched no longer does: the steps would be others.
    """
    model, data = copy.copy(phase.model), copy.copy(phase.data)
    touching = _touching(model, data)
    option, control, step = model.opt, data.ctrl, mujoco.mj_step
    start = time.process_time()
    for timestep, controls, count in phase.steps:
        option.timestep = timestep
        control[:] = controls
        step(model, data, count)
    used = time.process_time() - start
    if not touching <= _touching(model, data):
        raise RuntimeError("bare steps let go of what the run holds")
    return used


def _touching(model: Any, data: Any) -> set[tuple[int, int]]:
    geoms = data.contact.geom[data.contact.efc_address >= 0]
    return {(int(a), int(b)) for a, b in np.sort(model.geom_bodyid[geoms], axis=1)}


def measured(run: Run, phases: Sequence[Phase]) -> list[dict[str, float]]:
    """Return the simulated time of each phase, and the processor time with all that is done in it, and without [s]."""
    listen(run, phases)
    found = [{"simulated": phase.end - phase.start, "ran": np.inf, "bare": np.inf} for phase in phases]
    for _ in range(REPEATS):
        at: dict[float, float] = {}

        def progress(simulated: float, at: dict[float, float] = at) -> None:
            at[round(simulated, 1)] = time.process_time()

        run(progress)
        for phase, best in zip(phases, found, strict=True):
            best["ran"] = min(best["ran"], at[phase.end] - at[phase.start])
            best["bare"] = min(best["bare"], bare(phase))
    return found


def main(scenario: str, *words: str) -> None:
    """Print what was measured of a scenario with settings (``NAME=VALUE``) and phases (``START END``)."""
    from prolepsis.programs import read_program

    settings = dict(word.split("=", 1) for word in words if "=" in word)
    times = [float(word) for word in words if "=" not in word]
    phases = [Phase(start, end) for start, end in zip(times[::2], times[1::2], strict=True)]
    read = read_scenario(Path(scenario), settings)
    scene = compose_scene(read.knowledge_base())
    world, program = compile_world(scene), read_program(read.bound_plan(), scene)
    print(json.dumps(measured(lambda progress: simulate(world, program, progress=progress), phases)))


if __name__ == "__main__":
    main(*sys.argv[1:])
