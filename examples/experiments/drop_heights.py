"""From which height does an egg break? A prediction: the shell is calibrated between plates, never by drops.

Prints the tables of ``docs/egg.md``: the height at which a lying and a standing egg of weak, mean and strong shell
(the mean and one standard deviation to both sides) breaks on a hard floor, found by bisection; the same with other
numbers that are not well known; and how many of 24 drawn eggs of one batch, and of 24 of all kinds, have cracked at
each height, beside what was published.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from prolepsis.engine.composing import compose_scene
from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.knowledge import KnowledgeBase
from prolepsis.programs import read_program
from prolepsis.scenario.file import DEFAULT_PARTICLES
from prolepsis.terms.terms import Term

SITUATION = """@prefix : <https://w3id.org/prolepsis#> .
:floor a :Floor . :egg1 a :Egg ; :z {z!r} ; :pitch {pitch} ; :batch :carton1 . :carton1 a :Batch {mean}.
"""
POSTURES = {"lying": (0.0, "breadth"), "standing": (90.0, "length")}
"""Pitch [degree], and the size that is upright."""
SHELL = "eggshell1."
DEVIATIONS = (-1, 0, 1)
DOUBTS = {
    "as it is": {},
    "breaks at 40 N": {SHELL + "breakingForce": 40.0},
    "breaks at 50 N": {SHELL + "breakingForce": 50.0},
    "no slow cracks": {SHELL + "crackGrowthExponent": 200.0},
    "exponent 20": {SHELL + "crackGrowthExponent": 20.0},
    "exponent 45": {SHELL + "crackGrowthExponent": 45.0},
    "tested in 1 s": {SHELL + "breakingTime": 1.0},
    "tested in 20 s": {SHELL + "breakingTime": 20.0},
    "120 N/mm between plates": {SHELL + "plateStiffness": 120e3},
    "200 N/mm": {SHELL + "plateStiffness": 200e3},
    "a twentieth of the mass left out": {"egg1.mass": 0.95 * 0.059},
}
"""What is not well known, each at both ends."""
EGGS = 24
HEIGHTS = (0.002, 0.004, 0.006, 0.007, 0.008, 0.009, 0.010, 0.012, 0.014, 0.016)
PUBLISHED = {
    ("lying", 0.008): "< 10 %",
    ("lying", 0.009): "fewer than standing",
    ("lying", 0.010): "fewer than standing",
    ("standing", 0.008): "> 50 %",
}
"""Share of 20 eggs that cracked (Commun. Phys. 2025), as its press release tells."""
LOWEST, HIGHEST, BISECTIONS = 0.0005, 0.04, 8


def egg(posture: str, mean: float | None = None) -> KnowledgeBase:
    """Return an egg in a posture, of a batch that breaks at a ``mean`` force [N], or any."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "drop.ttl"
        stated = "" if mean is None else f"; :breakingForce {mean!r} "
        file.write_text(SITUATION.format(z=1.0, pitch=POSTURES[posture][0], mean=stated), encoding="utf-8")
        return KnowledgeBase.load(file)


def breaks(knowledge: KnowledgeBase, posture: str, height: float, substep: float = 1e-3) -> bool:
    """Return whether an egg breaks when dropped from a height [m]."""
    touching = knowledge.quantity("egg1", POSTURES[posture][1]) / 2
    scene = compose_scene(knowledge.with_values({"egg1.z": touching + height}), particles=DEFAULT_PARTICLES)
    program = read_program(Term("wait", (0.001,)), scene)
    fall = math.sqrt(2 * height / 9.81)
    log = simulate(compile_world(scene), program, duration=fall + 0.005, max_step=substep)
    return len(log.detachments.tick) > 0


def breaking_height(knowledge: KnowledgeBase, posture: str, substep: float = 1e-3) -> float:
    """Return the least height at which an egg breaks [m]."""
    low, high = LOWEST, HIGHEST
    for _ in range(BISECTIONS):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if breaks(knowledge, posture, middle, substep) else (middle, high)
    return math.sqrt(low * high)


def of_one_egg(values: Mapping[str, float], *, substep: float = 1e-3) -> list[float]:
    """Return the height at which the mean egg breaks lying and standing, with some other values [mm]."""
    return [1000 * breaking_height(egg(posture).with_values(values), posture, substep) for posture in POSTURES]


def interval(count: int, of: int) -> str:
    """Return between what shares a chance lies of which ``count`` have come true (Wilson, 95 %)."""
    z, share = 1.96, count / of
    middle, half = share + z**2 / (2 * of), z * math.sqrt(share * (1 - share) / of + z**2 / (4 * of**2))
    low, high = ((middle + sign * half) / (1 + z**2 / of) for sign in (-1, 1))
    return f"{100 * low:.0f} to {100 * high:.0f} %"


def main() -> None:
    """Print the tables."""
    known = egg("lying").value("eggshell1", "breakingForce")
    assert isinstance(known.value, float)
    forces = [known.value + k * known.deviation for k in DEVIATIONS]
    columns = [of_one_egg({SHELL + "breakingForce": force}) for force in forces]
    steps = [of_one_egg({}, substep=step) for step in (2.5e-4, 1.25e-4, 6.25e-5)]
    print(
        "| posture | " + " | ".join(f"{force:g} N" for force in forces) + " | at substeps of 0.25, 0.125, 0.0625 ms |"
    )
    print("|---|" + "---|" * (len(forces) + 1))
    for i, posture in enumerate(POSTURES):
        heights = " | ".join(f"{column[i]:.1f} mm" for column in columns)
        print(f"| {posture} | {heights} | {', '.join(f'{step[i]:.1f}' for step in steps)} mm |")
    print("\n| the mean egg | lying | standing |\n|---|---|---|")
    for doubt, values in DOUBTS.items():
        print(f"| {doubt} | " + " | ".join(f"{height:.1f} mm" for height in of_one_egg(values)) + " |")
    print("\n| height | " + " | ".join(f"{p}, one batch | all kinds | published" for p in POSTURES) + " |")
    print("|---|" + "---|---|---|" * len(POSTURES))
    found = {
        (posture, mean): np.array(
            [breaking_height(egg(posture, mean).with_draws(seed), posture) for seed in range(1, EGGS + 1)]
        )
        for posture in POSTURES
        for mean in (known.value, None)
    }
    for height in HEIGHTS:
        cells: list[str] = []
        for posture in POSTURES:
            one, all_kinds = (int((found[posture, mean] <= height).sum()) for mean in (known.value, None))
            published = PUBLISHED.get((posture, height), "")
            cells += [f"{one} of {EGGS} ({interval(one, EGGS)})", f"{all_kinds} of {EGGS}", published]
        print(f"| {1000 * height:g} mm | " + " | ".join(cells) + " |")
    for (posture, mean), heights in found.items():
        kinds = "all kinds" if mean is None else "one batch"
        print(f"{posture}, {kinds}: half at {1000 * float(np.median(heights)):.1f} mm")


if __name__ == "__main__":
    main()
