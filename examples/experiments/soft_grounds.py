"""From which height does an egg break on what is soft? A prediction: nothing of it is calibrated by drops.

Prints the table of ``docs/egg.md``: the greatest force that the shell bears there, and the height from which a lying
egg breaks, found by bisection, at the usual substep and two shorter ones, and a standing one.
"""

from __future__ import annotations

import math
import sys
import tempfile
from pathlib import Path

from prolepsis.engine.composing import compose_scene
from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.knowledge import KnowledgeBase
from prolepsis.log.log import Log
from prolepsis.programs import read_program
from prolepsis.scenario.file import DEFAULT_PARTICLES
from prolepsis.terms.errors import InvalidSimulationError
from prolepsis.terms.terms import Term

PREFIX = "@prefix : <https://w3id.org/prolepsis#> .\n"
FLOOR = ":floor a :Floor . "
GROUNDS = {
    "tiles": (FLOOR, 0.0),
    "a sheet of kitchen paper": (FLOOR + ":soft1 a :PaperTowel ; :on :floor . ", 0.0005),
    "a towel": (FLOOR + ":soft1 a :Towel ; :on :floor . ", 0.004),
    "a towel in five layers, 10 mm": (FLOOR + ":soft1 a :Towel ; :on :floor ; :height 0.01 . ", 0.01),
    "a towel in five layers, 20 mm": (FLOOR + ":soft1 a :Towel ; :on :floor ; :height 0.02 . ", 0.02),
    "a carpet": (":floor a :Carpet . ", 0.0),
    "a carpet of 2 cm": (":floor a :Carpet ; :paddingThickness 0.02 . ", 0.0),
    "a lawn": (":floor a :Lawn . ", 0.0),
    "an egg box": (FLOOR + ":soft1 a :EggBox ; :on :floor . ", 0.07),
    "a kitchen sponge of 5 cm": (FLOOR + ":soft1 a :Sponge ; :on :floor ; :height 0.05 . ", 0.05),
    "a pad of foam rubber of 5 cm": (FLOOR + ":soft1 a :FoamPad ; :on :floor . ", 0.05),
}
"""What lies below, and its height [m]."""
POSTURES = {"lying": (0.022, 0.0), "standing": (0.0285, 90.0)}
"""Height of the centre of an egg that touches [m], and its pitch [degrees]."""
LOWEST, HIGHEST, BISECTIONS = 0.002, 16.0, 8
SUBSTEPS = (1e-3, 1.25e-4, 6.25e-5)


def fallen(ground: str, posture: str, height: float, substep: float) -> Log:
    """Return the log of an egg that falls from a height [m] onto a ground."""
    below, top = GROUNDS[ground]
    touching, pitch = POSTURES[posture]
    egg = f":egg1 a :Egg ; :z {top + touching + height!r} ; :pitch {pitch} ."
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "drop.ttl"
        file.write_text(PREFIX + below + egg, encoding="utf-8")
        scene = compose_scene(KnowledgeBase.load(file), particles=DEFAULT_PARTICLES)
    program = read_program(Term("wait", (0.001,)), scene)
    duration = math.sqrt(2 * height / 9.81) + 0.03
    return simulate(compile_world(scene), program, duration=duration, max_step=substep)


def breaks(ground: str, posture: str, height: float, substep: float) -> bool:
    """Return whether that egg breaks; one whose shards are thrown through what is soft has."""
    try:
        return len(fallen(ground, posture, height, substep).detachments.tick) > 0
    except InvalidSimulationError:
        return True


def breaking_height(ground: str, posture: str, substep: float) -> float:
    """Return the least height at which an egg breaks [m]."""
    low, high = LOWEST, HIGHEST
    for _ in range(BISECTIONS):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if breaks(ground, posture, middle, substep) else (middle, high)
    return math.sqrt(low * high)


def told(height: float) -> str:
    """Return a height with its unit, to two digits."""
    return f"{1000 * height:.2g} mm" if height < 0.01 else f"{100 * height:.2g} cm" if height < 1 else f"{height:.2g} m"


def main() -> None:
    """Print the table, of all grounds or of those that are named."""
    print("| on | greatest force borne lying | lying | standing |\n|---|---|---|---|")
    for ground in sys.argv[1:] or GROUNDS:
        cells: list[str] = []
        force = 0.0
        for posture in POSTURES:
            substeps = SUBSTEPS if posture == "lying" else SUBSTEPS[:1]
            heights = [breaking_height(ground, posture, substep) for substep in substeps]
            cells.append(" to ".join(dict.fromkeys(told(each) for each in (min(heights), max(heights)))))
            if posture == "lying":
                force = float(fallen(ground, posture, 0.98 * heights[0], SUBSTEPS[0]).channels["egg1.force"].max())
        print(f"| {ground} | {force:.0f} N | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
