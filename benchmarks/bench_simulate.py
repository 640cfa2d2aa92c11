"""How fast the simulation loop is beside bare MuJoCo stepping of the same model, and where the rest goes."""

from __future__ import annotations

import cProfile
import pstats
import time
from typing import Any

from tests.scenes import EGG_IN_HAND, scene, started

from prolepsis.engine.simulation import simulate
from prolepsis.engine.state import State
from prolepsis.engine.world import compile_world
from prolepsis.matter.shells.breaking import Breaking
from prolepsis.programs import read_program
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.reader import parse_term

PLANS = {force: f"sequence([close(hand1, {force}), hold(hand1, 2.0)])" for force in (5.0, 15.0)}
REPEATS = 3


def _bare(world: Any, force: float, count: int, step: float) -> float:
    """Return the time of ``count`` bare steps of the same model, the pads pressing the egg with ``force`` [N]."""
    state = State.of(world)
    model, data = state.model, state.data
    model.opt.timestep = step
    motor = model.actuator("hand1/gap").id
    model.actuator_gainprm[motor, 0] = 1.0
    model.actuator_biasprm[motor, :3] = (0.0, 0.0, -100.0)
    data.ctrl[motor] = -force
    for controller in started(state, Breaking):
        controller.begin_tick(state)  # gives the contacts the stiffness of the shell
    for _ in range(2000):
        mujoco.mj_step(model, data)
    start = time.perf_counter()
    for _ in range(count):
        mujoco.mj_step(model, data)
    return time.perf_counter() - start


def rows() -> list[tuple[str, str, str]]:
    """Return name, measured value and target of each benchmark."""
    made: list[tuple[str, str, str]] = []
    known = scene(EGG_IN_HAND)
    world = compile_world(known)
    for force, plan in PLANS.items():
        name = f"a hand holds the egg with {force:g} N"
        program = read_program(parse_term(plan), known)
        ratios: list[float] = []
        speeds: list[float] = []
        for _ in range(REPEATS):
            start = time.perf_counter()
            log = simulate(world, program)
            used = time.perf_counter() - start
            # With the egg near the pads all the time, every tick has four substeps.
            bare = _bare(world, force, 4 * log.tick_count, log.dt / 4)
            ratios.append(bare / used)
            speeds.append(log.duration / used)
        made.append((f"simulate over bare mj_step, {name}", f"{max(ratios):.2f}", ">= 0.3"))
        made.append((f"simulated over wall time, {name}", f"{max(speeds):.2f}", ""))
    made += [(f"share of simulate: {stage}", f"{share:.0%}", "") for stage, share in shares().items()]
    return made


def shares() -> dict[str, float]:
    """Return the share of a run's time that each stage takes, by a profile."""
    known = scene(EGG_IN_HAND)
    world = compile_world(known)
    program = read_program(parse_term(PLANS[15.0]), known)
    profile = cProfile.Profile()
    profile.enable()
    simulate(world, program)
    profile.disable()
    table: Any = pstats.Stats(profile)
    stats: dict[tuple[str, int, str], tuple[int, int, float, float, object]] = table.stats
    total = max(row[3] for row in stats.values())

    def spent(file: str, *names: str) -> float:
        return sum(row[3] for (path, _, name), row in stats.items() if path.endswith(file) and name in names)

    found = {
        "physics (mj_step)": sum(row[3] for (_, _, name), row in stats.items() if "mj_step" in name),
        "bond check and contact stiffness": spent("breaking.py", "act", "substep"),
        "recording and channels": spent("recorder.py", "tick", "substep", "contact_columns", "pose_columns")
        + spent("channels.py", "tick"),
        "hand, program and senses": spent("hand_control.py", "act", "measure") + spent("program.py", "step"),
    }
    found = {name: seconds / total for name, seconds in found.items()}
    return {**found, "the loop itself and the rest": 1 - sum(found.values())}


def main() -> None:
    """Print the rows."""
    for name, measured, target in rows():
        print(f"{name:60} {measured:>8}  {target}")


if __name__ == "__main__":
    main()
