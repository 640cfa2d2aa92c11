"""What becomes of an egg that meets a floor or a bowl's rim at a speed, and how near is that to something else?

Prints the table of ``docs/egg.md``: whole, cracked or open; the load over the strength, which cracks it at 1; and the
depth of the dent over how far the membrane stretches, at which it opens. Each at the usual substep and two shorter
ones, and moved by a micrometre; where the depths differ, their range. The load on a shell that breaks is that at a
speed which leaves it whole, times the ratio of the speeds; the depth in one that opens is that with a membrane that
stretches farther.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

from prolepsis.engine.composing import compose_scene
from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.knowledge import KnowledgeBase
from prolepsis.log.log import Log
from prolepsis.programs import read_program
from prolepsis.scenario.file import DEFAULT_PARTICLES
from prolepsis.terms.terms import Term

FLOOR = "@prefix : <https://w3id.org/prolepsis#> . :floor a :Floor . "
PLACES = {
    "lying": (FLOOR + ":egg1 a :Egg ; :x {x!r} ; :z {z!r} .", 0.022),
    "standing": (FLOOR + ":egg1 a :Egg ; :x {x!r} ; :z {z!r} ; :pitch 90.0 .", 0.0285),
    "on a rim": (
        FLOOR + ":bowl1 a :Bowl ; :on :floor ; :x -0.0775 . :egg1 a :Egg ; :x {x!r} ; :z {z!r} ; :yaw 90.0 .",
        0.082,
    ),
}
"""Situation, and height of the egg's centre where it touches [m]."""
SPEEDS = (0.25, 0.3, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6)
WHOLE = 0.25
"""It just leaves an egg whole [m/s]."""
VARIATIONS = ((1e-3, 0.0), (5e-5, 0.0), (2.5e-5, 0.0), (1e-3, 1e-6))
"""Longest substep [s] and shift [m]: from contact at 1 m/s on, the usual one is 0.07 ms."""
FARTHER = 10.0
"""A membrane that is not pressed through stretches so much farther [1]."""


def fallen(place: str, speed: float, substep: float = 1e-3, shift: float = 0.0, farther: float = 1.0) -> Log:
    """Return the log of an egg that meets what is at a place at a speed [m/s]."""
    situation, touching = PLACES[place]
    height = speed**2 / (2 * 9.81)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "drop.ttl"
        file.write_text(situation.format(x=shift, z=touching + height + shift), encoding="utf-8")
        knowledge = KnowledgeBase.load(file)
    stretch = knowledge.value("eggshell1", "shellMembraneStretch").value
    assert isinstance(stretch, float)
    scene = compose_scene(
        knowledge.with_values({"eggshell1.shellMembraneStretch": farther * stretch}), particles=DEFAULT_PARTICLES
    )
    program = read_program(Term("wait", (0.001,)), scene)
    return simulate(
        compile_world(scene),
        program,
        duration=math.sqrt(2 * height / 9.81) + 0.02,
        max_step=substep,
        monitors={"egg1": ("load", "pressed_in")},
    )


def came_of(log: Log) -> str:
    """Return what an egg has become."""
    pieces = [i for i, thing in enumerate(log.things) if "Piece" in thing.roles]
    if len({*log.carrier[-1, pieces].tolist()}) > 1:
        return "open"
    return "cracked" if len(log.detachments.tick) else "whole"


def between(values: list[float]) -> str:
    """Return numbers, or one if they are the same, with two decimals."""
    ends = [f"{value:.2f}" for value in (min(values), max(values))]
    return ends[0] if ends[0] == ends[1] else " to ".join(ends)


def cell(place: str, speed: float, load: float) -> str:
    """Return what becomes of an egg at a place and a speed [m/s], with the load over its strength and its dent [1]."""
    logs = [fallen(place, speed, substep, shift) for substep, shift in VARIATIONS]
    outcomes = sorted({came_of(log) for log in logs})
    told = f"{' or '.join(outcomes)}, {load:.2f}"
    if outcomes == ["whole"]:
        return told
    farther = FARTHER if "open" in outcomes else 1.0
    if farther > 1:
        logs = [fallen(place, speed, substep, shift, farther) for substep, shift in VARIATIONS]
    return f"{told}, {between([farther * float(log.channels['egg1.pressed_in'][-1]) for log in logs])}"


def main() -> None:
    """Print the table."""
    print("| speed [m/s] | " + " | ".join(PLACES) + " |\n|---|" + "---|" * len(PLACES))
    loads = {place: float(fallen(place, WHOLE, 2.5e-5).channels["egg1.load"].max()) / WHOLE for place in PLACES}
    for speed in SPEEDS:
        print(f"| {speed:g} | " + " | ".join(cell(place, speed, speed * loads[place]) for place in PLACES) + " |")


if __name__ == "__main__":
    main()
