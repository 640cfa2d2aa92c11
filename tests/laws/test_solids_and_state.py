"""What is said of random simulated scenes of solids is what one reads from poses and contacts, tick by tick."""

from __future__ import annotations

import math
import os

import numpy as np
import pytest
from tests.scenes import run

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import BoolArray, FloatArray
from prolepsis.log.log import Log
from prolepsis.log.timeline import Timeline

SEED = int(os.environ.get("PROLEPSIS_FUZZ_SEED", "0"))
G = 9.81
LASTS = 1.2
"""All have come to rest in a second, or roll [s]."""
RADIUS, HEIGHT, WALL, INNER = 0.08, 0.09, 0.005, 0.075
"""Of a wide cup [m]."""
SLACK = 0.06
"""What is said may begin or end so much later or earlier than what is read: gaps that are not noticed [s]."""


def random_solids(random: np.random.Generator) -> str:
    """Return a table with a cup, and balls and blocks that fall into it, beside it, or on one another."""
    lines = [":floor a :Floor . :table1 a :Table . ", f":cup1 a :Cup ; :radius {RADIUS} ; :on :table1 . "]
    for number in range(1, int(random.integers(3, 6))):
        side, far = random.uniform(0, 2 * math.pi), random.choice([0.02, 0.13])
        where = f":x {far * math.cos(side):.4f} ; :y {far * math.sin(side):.4f} ; :z {0.75 + 0.09 * number:.4f}"
        kind = (":Ball ; :radius 0.02", ":Block ; :length 0.03 ; :width 0.03 ; :height 0.03 ; :mass 0.03")
        lines.append(
            f":thing{number} a {kind[int(random.integers(2))]} ; {where} ; :roll {random.uniform(0, 90):.1f} . "
        )
    return "".join(lines)


def near(mask: BoolArray, ticks: int) -> tuple[BoolArray, BoolArray]:
    """Return where a truth holds at some, and where at all, of the ticks at most ``ticks`` away."""
    windows = np.lib.stride_tricks.sliding_window_view(np.pad(mask, ticks, mode="edge"), 2 * ticks + 1)
    some: BoolArray = np.any(windows, axis=1)
    every: BoolArray = np.all(windows, axis=1)
    return some, every


def held(timeline: Timeline, log: Log, type_: str, *args: str) -> BoolArray:
    """Return whether a fact holds at each tick, in either order of its arguments if it is symmetric, shape (T,)."""
    found = np.zeros(log.tick_count, dtype=np.bool_)
    for fact in timeline.facts:
        if fact.type == type_ and (
            fact.args == args or (type_ in ("contacts", "colliding") and fact.args == args[::-1])
        ):
            found[round(fact.start / log.dt) : round(fact.end / log.dt)] = True
    return found


def wrongly(said: BoolArray, read: BoolArray, log: Log, slack: float = SLACK) -> list[int]:
    """Return the ticks at which a fact is said though it is so nowhere near, or not though it is so all around."""
    some, every = near(read, round(slack / log.dt))
    return np.flatnonzero((said & ~some) | (~said & every)).tolist()


def pressing(log: Log, first: int, second: int) -> tuple[BoolArray, FloatArray]:
    """Return whether two things touch at each tick, shape (T,), and the force of the first on the other [N], (T, 3)."""
    touch, force = np.zeros(log.tick_count, dtype=np.bool_), np.zeros((log.tick_count, 3))
    for a, b, sign in ((first, second, 1.0), (second, first, -1.0)):
        rows = (log.contacts.a == a) & (log.contacts.b == b)
        touch[log.contacts.tick[rows]] = True
        np.add.at(force, log.contacts.tick[rows], sign * log.contacts.force[rows])
    return touch, force


def mean(series: FloatArray, ticks: int) -> FloatArray:
    """Return the mean over the ticks at most ``ticks`` away."""
    padded = np.pad(series, ((ticks, ticks), (0, 0)), mode="edge")
    return np.lib.stride_tricks.sliding_window_view(padded, 2 * ticks + 1, axis=0).mean(axis=-1)


def in_cup(log: Log, thing: int) -> BoolArray:
    """Return whether a thing's middle is in the cup and below its rim at each tick; the cup stands upright."""
    away = log.poses[:, thing, :3] - log.poses[:, log.index("cup1"), :3]
    low, high = -HEIGHT / 2, HEIGHT / 2
    if log.poses[0, log.index("cup1"), 2] < 0.7 + HEIGHT / 4:
        low, high = 0.0, HEIGHT
    inside: BoolArray = (np.hypot(away[:, 0], away[:, 1]) < INNER) & (away[:, 2] > low) & (away[:, 2] < high)
    return inside


@pytest.mark.parametrize("number", range(12))
def test_what_solids_are_said_to_do_is_what_they_do(number: int) -> None:
    turtle = random_solids(np.random.default_rng((SEED, number)))
    log = run(turtle, f"wait({LASTS})", duration=LASTS)
    timeline = recognize(log)
    names = [thing.name for thing in log.things if thing.name.startswith(("thing", "cup", "table", "floor"))]
    loose = [name for name in names if name.startswith("thing")]
    for k, first in enumerate(names):
        for second in names[k + 1 :]:
            touch, force = pressing(log, log.index(first), log.index(second))
            assert not wrongly(held(timeline, log, "contacts", first, second), touch, log), (first, second)
            for below, above, lift in ((first, second, force[:, 2]), (second, first, -force[:, 2])):
                if above not in loose:
                    continue
                weight = log.things[log.index(above)].mass * G
                speed = np.gradient(log.poses[:, log.index(above), 2], log.dt)
                rests = near(np.abs(speed) < 0.02, round(0.05 / log.dt))[1]
                share = mean(lift[:, None], round(0.05 / log.dt))[:, 0] / weight
                said = held(timeline, log, "supports", below, above)
                assert not (near(rests & (share > 0.2), 50)[1] & ~said).any(), (below, above)
                assert not (said & ~near(touch, round(SLACK / log.dt))[0]).any(), (below, above)
    assert {fact.args[0] for fact in timeline.facts if fact.type == "contains"} <= {"cup1"}
    for name in loose:
        thing = log.index(name)
        inside, contained = in_cup(log, thing), held(timeline, log, "contains", "cup1", name)
        touches_any = np.zeros(log.tick_count, dtype=np.bool_)
        rows = (log.contacts.a == thing) | (log.contacts.b == thing)
        touches_any[log.contacts.tick[rows]] = True
        # What falls into the cup is contained once something in it bears it, at the latest when it has lain there.
        assert not (contained & ~near(inside, 150)[0]).any(), name
        height = log.poses[:, thing, 2]
        speed = np.gradient(height, log.dt)
        # What still bounces in it has not been borne yet.
        lies = inside & near(touches_any, 100)[0] & near(np.abs(speed) < 0.05, 50)[1]
        assert not (near(lies, 250)[1] & ~contained).any(), name
        free = ~touches_any & (speed < -0.05)
        falling = held(timeline, log, "falling", name)
        assert not (falling & ~near(free, 35)[0]).any(), name
        drops = near(free, 40)[1]
        assert not (drops & ~falling).any(), name
        moved = np.linalg.norm(log.poses[50:, thing, :3] - log.poses[:-50, thing, :3], axis=1) / (50 * log.dt)
        goes = np.concatenate((moved > 0.015, np.zeros(50, dtype=np.bool_)))
        assert not (near(goes, 30)[1] & ~held(timeline, log, "moving", name)).any(), name


@pytest.mark.parametrize("height", [0.25, 0.6])
def test_what_has_no_hollow_contains_nothing_though_shards_lie_on_it(height: float) -> None:
    log = run(f":floor a :Floor . :table1 a :Table . :egg1 a :Egg ; :z {0.722 + height} ; :pitch 20.0 .", duration=1.0)
    timeline = recognize(log)
    pieces = {fact.args[1] for fact in timeline.select(type="supports") if "piece" in str(fact.args[1])}
    assert len(pieces) > 1, "shards lie about"
    assert not [fact for fact in timeline.select(type="contains") if fact.args[0] in ("table1", "floor")]
    shares = [value for fact in timeline.facts for name, value in fact.evidence.items() if name in ("share", "fill")]
    assert shares and all(isinstance(share, float) and 0.0 <= share <= 1.0 for share in shares)
