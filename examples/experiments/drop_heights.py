"""From which height does an egg break? A prediction: the shell is calibrated between plates, never by drops.

Prints the table of ``docs/egg.md``: the height at which a lying and a standing egg of weak, mean and strong shell
(the mean and one standard deviation to both sides) breaks on a hard floor, found by bisection.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

from prolepsis.engine.composing import compose_scene
from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.knowledge import KnowledgeBase
from prolepsis.programs import read_program
from prolepsis.scenario.file import DEFAULT_PARTICLES
from prolepsis.terms.terms import Term

SITUATION = """@prefix : <https://w3id.org/prolepsis#> .
:floor a :Floor . :egg1 a :Egg ; :z {z!r} ; :pitch {pitch} .
"""
HALF = {"lying": 0.022, "standing": 0.0285}
"""Height of the centre of an egg that touches the floor [m]."""
DEVIATIONS = (-1, 0, 1)
LOWEST, HIGHEST, BISECTIONS = 0.0005, 0.03, 9


def breaks(posture: str, height: float, force: float, substep: float) -> bool:
    """Return whether an egg whose shell bears ``force`` [N] breaks when dropped from ``height`` [m]."""
    pitch = 90.0 if posture == "standing" else 0.0
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "drop.ttl"
        file.write_text(SITUATION.format(z=HALF[posture] + height, pitch=pitch), encoding="utf-8")
        knowledge = KnowledgeBase.load(file).with_values({"eggshell1.breakingForce": force})
    scene = compose_scene(knowledge, particles=DEFAULT_PARTICLES)
    program = read_program(Term("wait", (0.001,)), scene)
    fall = math.sqrt(2 * height / 9.81)
    log = simulate(compile_world(scene), program, duration=fall + 0.005, max_step=substep)
    return len(log.detachments.tick) > 0


def breaking_height(posture: str, force: float, substep: float = 1e-3) -> float:
    """Return the least height at which an egg breaks [m]."""
    low, high = LOWEST, HIGHEST
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        low, high = (low, middle) if breaks(posture, middle, force, substep) else (middle, high)
    return (low + high) / 2


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "egg.ttl"
        file.write_text(SITUATION.format(z=1.0, pitch=0.0), encoding="utf-8")
        known = KnowledgeBase.load(file).value("eggshell1", "breakingForce")
    assert isinstance(known.value, float) and known.deviation is not None
    forces = [known.value + k * known.deviation for k in DEVIATIONS]
    print(
        "| posture | " + " | ".join(f"{force:g} N" for force in forces) + " | at substeps of 0.25, 0.125, 0.0625 ms |"
    )
    print("|---|" + "---|" * (len(forces) + 1))
    for posture in HALF:
        heights = [f"{1000 * breaking_height(posture, force):.1f} mm" for force in forces]
        steps = [f"{1000 * breaking_height(posture, known.value, step):.1f}" for step in (2.5e-4, 1.25e-4, 6.25e-5)]
        print(f"| {posture} | " + " | ".join(heights) + f" | {', '.join(steps)} mm |")


if __name__ == "__main__":
    main()
