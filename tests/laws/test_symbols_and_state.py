"""What is said of a scene is what one reads from its frames: random scenes, and each fact counted out by hand."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass

import numpy as np
import pytest
from tests.fluents.liquids import (
    DT,
    EVERY,
    HEIGHT,
    INNER,
    RADIUS,
    WALL,
    D,
    placed,
    poured,
    puddle,
    table,
    tilted,
    vessel,
    wet,
)

from prolepsis.fluents import recognize
from prolepsis.fluents.liquids.liquid import LINGERING, OUTSIDE_GAP, RESIDUE_FRACTION
from prolepsis.fluents.solids.containment import CONTAINED_GAP, NOTICEABLE_FRACTION
from prolepsis.geometry.shape import BoolArray, FloatArray, Hole
from prolepsis.log.things import Thing
from prolepsis.log.timeline import Timeline

SEED = int(os.environ.get("PROLEPSIS_FUZZ_SEED", "0"))
FRAMES = 60
MARGIN = 0.015
"""Greatest share that the surface of a liquid may add or take [1]: a layer of particles lies half above its level."""
SIDE = Hole(position=(RADIUS + 0.01, 0.0, 0.04), direction=(-1.0, 0.0, 0.0), radius=0.005)
BOTTOM = Hole(position=(0.0, 0.0, -0.01), direction=(0.0, 0.0, 1.0), radius=0.006)
HOLES = ((), (SIDE,), (BOTTOM,), (SIDE, BOTTOM))


@dataclass(frozen=True, kw_only=True)
class Wet:
    """A cup that leans, some liquid in it, and some that lies on the table from the start or from some time on."""

    cup: Thing
    way: FloatArray
    """Where the particles are, shape (F, P, 3)."""

    def in_cup(self) -> FloatArray:
        """Return the share of the liquid in the cup and below its lip in each frame, shape (F,)."""
        local = _into(self.cup, self.way)
        inside = (np.hypot(local[..., 0], local[..., 1]) < INNER) & (local[..., 2] > WALL) & (local[..., 2] < HEIGHT)
        return (inside & (self.way[..., 2] < self.lip())).mean(axis=1)

    def on_table(self) -> FloatArray:
        """Return the share of the liquid that touches the table in each frame, shape (F,)."""
        return (self.way[..., 2] < D).mean(axis=1)

    def lip(self) -> float:
        """Return the height of the lowest point of the cup's inner edge [m]."""
        angle = np.linspace(0.0, 2 * math.pi, 721)
        edge = np.stack((INNER * np.cos(angle), INNER * np.sin(angle), np.full(721, HEIGHT)), axis=1)
        return float(placed(edge, self.cup)[:, 2].min())


def random_wet(random: np.random.Generator) -> Wet:
    """Return a random one of them."""
    cup = vessel(
        at=(0.0, 0.0, 0.15), turn=tilted(float(random.uniform(0.0, 70.0))), holes=HOLES[int(random.integers(4))]
    )
    every = placed(poured(), cup)
    level = float(random.uniform(float(every[:, 2].min()), float(every[:, 2].max())))
    lip = Wet(cup=cup, way=every[None]).lip()
    kept = every[every[:, 2] < min(level, lip - 1.5 * D)]
    lying = puddle(0.3, half=0.05)
    lying = lying[: int(random.integers(0, len(lying)))]
    start = np.concatenate((kept, lying))
    way = np.repeat(start[None], FRAMES, axis=0)
    # Some of what is in the cup is on the table from some frame on; how it came there is another question.
    gone = int(random.integers(0, len(kept) + 1)) if random.random() < 0.5 else 0
    there = puddle(-0.3, half=0.08)[:gone]
    way[int(random.integers(20, 40)) :, len(kept) - len(there) : len(kept)] = there
    return Wet(cup=cup, way=way)


def _into(thing: Thing, points: FloatArray) -> FloatArray:
    """Return points of the world in a thing's frame."""
    w, *v = thing.orientation
    axis = -np.array(v)
    points = points - np.array(thing.position)
    twice = 2 * np.cross(axis, points)
    return points + w * twice + np.cross(axis, twice)


def held(timeline: Timeline, term: str, frames: int) -> BoolArray:
    """Return whether a fact holds at each frame, shape (F,)."""
    time = np.arange(frames) * EVERY * DT
    found = np.zeros(frames, dtype=np.bool_)
    for fact in timeline.facts:
        if str(fact.term) == term:
            found |= (time >= fact.start - 1e-9) & (time < fact.end - 1e-9)
    return found


def disagreements(said: BoolArray, share: FloatArray, slack: float) -> list[int]:
    """Return the frames in which a fact about a share is said wrongly, but for some time round changes [s]."""
    wide = math.ceil(slack / (EVERY * DT)) + 1
    found: list[int] = []
    for frame in range(len(share)):
        near = share[max(0, frame - wide) : frame + wide + 1]
        if said[frame] and near.max() < NOTICEABLE_FRACTION - MARGIN:
            found.append(frame)
        if not said[frame] and near.min() > NOTICEABLE_FRACTION + MARGIN:
            found.append(frame)
    return found


@pytest.mark.parametrize("number", range(40))
def test_where_a_liquid_is_said_to_be_is_where_its_particles_are(number: int) -> None:
    scene = random_wet(np.random.default_rng((SEED, number)))
    if not scene.way.shape[1]:
        pytest.skip("nothing is there")
    timeline = recognize(wet([table(), scene.cup], {"liq1": scene.way}, ticks=FRAMES * EVERY))
    contained, lying = scene.in_cup(), scene.on_table()
    # What still clings to a cup that was emptied is its residue.
    assert not [
        frame
        for frame in disagreements(held(timeline, "contains(cup1,liq1)", FRAMES), contained, CONTAINED_GAP)
        if contained[frame] > RESIDUE_FRACTION or contained.max() < NOTICEABLE_FRACTION
    ]
    slack = max(OUTSIDE_GAP, LINGERING)
    assert not disagreements(held(timeline, "spilled(liq1)", FRAMES), lying, slack)
    assert not disagreements(held(timeline, "supports(table1,liq1)", FRAMES), lying, slack)
    assert not [fact for fact in timeline.facts if fact.type == "supports" and fact.args == ("cup1", "liq1")]
