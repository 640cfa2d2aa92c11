"""How fast liquids are simulated: pouring from cup to cup, by count and viscosity, beside spheres in MuJoCo."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from prolepsis.engine.composing import compose_scene
from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.matter.liquids import flowing
from prolepsis.matter.liquids.kind import Liquids
from prolepsis.matter.liquids.solver import COURANT, Effort
from prolepsis.programs import read_program
from prolepsis.projection import read_scenario
from prolepsis.scene.kind import Controller
from prolepsis.scene.running import Running
from prolepsis.system.mujoco import mujoco

ROOT = Path(__file__).parent.parent
POURING = ROOT / "examples" / "pour_d.toml"
RATE = "150 deg/s"
"""Faster than in the example, so that most of the run is pouring."""
LONGEST = {500: 3.5, 2000: 3.5, 8000: 2.2, 20000: 1.7}
"""Particles, and simulated time [s]: the cup is grasped first, and tilted from about 1.5 s on."""
VISCOSITIES = {"water": (0.001, 998.0), "honey": (19.0, 1420.0)}
"""[Pa s], [kg/m^3]"""
TARGETS = {("water", 2000): ">= 0.8, not below 0.4", ("honey", 2000): ">= 0.5"}
SPHERES = 1000
"""Spheres in MuJoCo, the way of the paper."""

CHECK = """
from numba.core import event
from tests.scenes import run
with event.install_recorder("numba:compile") as compiled:
    run(":floor a :Floor . :cup1 a :Cup . :liq1 a :Water ; :volume 0.0001 . :cup1 :contains :liq1 .", duration=0.02)
print(len(compiled.buffer))
"""


def pour(liquid: str, count: int, duration: float) -> tuple[float, float, Effort]:
    """Return the wall time of a pouring [s], the simulated time [s] and what the liquid's steps took."""
    viscosity, density = VISCOSITIES[liquid]
    settings: dict[str, float | str] = {
        "Rate": RATE,
        "particles": count,
        "liq1.viscosity": viscosity,
        "liq1.density": density,
    }
    read = read_scenario(POURING, settings)
    scene = compose_scene(read.knowledge_base(), particles=read.particles)
    program = read_program(read.bound_plan(), scene)
    made: list[flowing.Flowing] = []
    begun: list[float] = []

    class Timed(Liquids):
        """Liquids, of which the solver is at hand."""

        def start(self, state: Running) -> Sequence[Controller]:
            found = super().start(state)
            made.extend(each for each in found if isinstance(each, flowing.Flowing))
            # The settling before the run is not part of it.
            for each in made:
                each.liquid.effort = Effort()
            begun.append(time.perf_counter())
            return found

    timed = replace(scene, kinds=tuple(Timed() if isinstance(kind, Liquids) else kind for kind in scene.kinds))
    log = simulate(compile_world(timed), program, duration=duration)
    return time.perf_counter() - begun[0], log.duration, made[0].liquid.effort


def spheres(duration: float = 0.3) -> float:
    """Return simulated over wall time of spheres in MuJoCo that fill a cup of boxes, at a step of 1 ms."""
    radius, height, ball = 0.035, 0.09, 0.0028
    spec: Any = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.option.timestep = 1e-3
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[1, 1, 0.1])
    for k in range(16):
        angle = 2 * np.pi * k / 16
        spec.worldbody.add_geom(
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[0.0025, 0.008, height / 2],
            pos=[(radius + 0.0025) * np.cos(angle), (radius + 0.0025) * np.sin(angle), height / 2],
            quat=[np.cos(angle / 2), 0, 0, np.sin(angle / 2)],
        )
    axis = np.arange(-radius, radius, 2 * ball) + ball
    places = [(x, y, ball + 2 * ball * z) for z in range(60) for x in axis for y in axis]
    places = [p for p in places if np.hypot(p[0], p[1]) < radius - ball][:SPHERES]
    for x, y, z in places:
        body = spec.worldbody.add_body(pos=[x, y, z])
        body.add_freejoint()
        body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[ball, 0, 0], density=1000, condim=3)
    model = spec.compile()
    data = mujoco.MjData(model)
    start = time.perf_counter()
    while data.time < duration:
        mujoco.mj_step(model, data)
    return duration / (time.perf_counter() - start)


def rows() -> list[tuple[str, str, str]]:
    """Return name, measured value and target of each benchmark."""
    made: list[tuple[str, str, str]] = []
    compiled = ["", ""]
    for k in range(2):
        done = subprocess.run([sys.executable, "-c", CHECK], cwd=ROOT, check=True, capture_output=True, text=True)
        compiled[k] = done.stdout.split()[-1]
    made.append(("kernels compiled by a warm process", compiled[1], "0"))
    made.append(("Courant number: spacings a step", f"{COURANT:g}", ""))
    pour("water", 500, 0.02)  # loads the kernels
    costs: dict[tuple[str, int], float] = {}
    for liquid in VISCOSITIES:
        for count, duration in LONGEST.items():
            wall, simulated, effort = pour(liquid, count, duration)
            solving = sum(effort.seconds.values())
            costs[liquid, count] = solving / effort.steps / count
            name = f"{liquid}, {count} particles"
            made.append(
                (f"simulated over wall time, {name}", f"{simulated / wall:.2f}", TARGETS.get((liquid, count), ""))
            )
            made.append((f"time per particle and step, {name}", f"{1e6 * costs[liquid, count]:.2f} us", ""))
            made.append((f"mean compression left by a step, {name}", f"{effort.error / effort.steps:.1e}", ""))
            if count == 2000:
                shares = {**effort.seconds, "hand, contacts, coupling and log": wall - solving}
                made += [(f"share of {part}, {name}", f"{s / wall:.0%}", "") for part, s in shares.items()]
        growth = costs[liquid, 20000] / costs[liquid, 2000]
        made.append((f"time per particle and step, 20000 over 2000, {liquid}", f"{growth:.2f}", "<= 2"))
    made.append((f"simulated over wall time, {SPHERES} spheres in MuJoCo", f"{spheres():.2f}", ""))
    return made


def main() -> None:
    """Print the rows."""
    for name, measured, target in rows():
        print(f"{name:70} {measured:>10}  {target}")


if __name__ == "__main__":
    main()
