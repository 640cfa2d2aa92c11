"""Recognition: a log of 10 s at 1 kHz with 40 bodies, and how its cost grows with the steps."""

from __future__ import annotations

import time

import numpy as np

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import FloatArray, Geom, IntArray, Shape
from prolepsis.log.log import Contacts, Log
from prolepsis.log.things import FIXED, Thing

DT = 0.001
BODIES = 40
STACK = 5
CORNERS = np.array([(-0.04, -0.04, 0.0), (0.04, -0.04, 0.0), (-0.04, 0.04, 0.0), (0.04, 0.04, 0.0)])


def busy_log(seconds: float, *, seed: int = 1) -> Log:
    """Return a log of stacked boxes, rolling and bouncing balls and filled cups, all in flickering contact.

    Args:
        seconds: Length of the log [s].
        seed: Seed of the flicker.
    """
    random = np.random.default_rng(seed)
    ticks = round(seconds / DT)
    things = [Thing(name="floor", kind="Floor", shape=Shape(geoms=(Geom(type="plane"),)), mount=FIXED)]
    poses = np.zeros((ticks, BODIES + 1, 7))
    poses[:, :, 3] = 1.0
    pairs: list[tuple[int, int, float]] = []
    box = Shape(geoms=(Geom(type="box", size=(0.05, 0.05, 0.05)),))
    ball = Shape(geoms=(Geom(type="sphere", size=(0.03, 0.0, 0.0)),))
    time_of: FloatArray = np.arange(ticks, dtype=np.float64) * DT
    for body in range(1, BODIES + 1):
        column, level = divmod(body - 1, STACK)
        place = np.array([0.4 * column, 0.0, 0.05 + 0.1 * level])
        poses[:, body, :3] = place + random.normal(0.0, 2e-6, (ticks, 3))
        shape, below = box, 0 if level == 0 else body - 1
        if column == 0:
            shape, below = ball, 0
            poses[:, body, 0] = 0.1 * np.sin(2 * np.pi * time_of / 2)
            poses[:, body, 1:3] = [1.0 + 0.1 * level, 0.03]
        elif column == 1:
            shape = cup() if level == 0 else ball
            poses[:, body, :3] = [0.4, 0.025 * (level - 2) if level else 0.0, 0.04 if level else 0.0]
            below = 0 if level == 0 else 6
        things.append(Thing(name=f"body{body}", kind="Thing", shape=shape, mass=1.0))
        pairs.append((below, body, 9.81 * (1 if column < 2 and level else STACK - level)))
    contacts = stacked_contacts(random, poses, pairs)
    carrier: IntArray = np.broadcast_to(np.arange(BODIES + 1), (ticks, BODIES + 1)).copy()
    return Log(dt=DT, things=tuple(things), time=time_of, poses=poses, carrier=carrier, contacts=contacts)


def cup() -> Shape:
    """Return a box without a lid."""
    walls = [((0.08, 0.08, 0.003), (0.0, 0.0, 0.003))]
    walls += [((0.003, 0.08, 0.04), (side * 0.08, 0.0, 0.04)) for side in (-1, 1)]
    walls += [((0.08, 0.003, 0.04), (0.0, side * 0.08, 0.04)) for side in (-1, 1)]
    return Shape(geoms=tuple(Geom(type="box", size=size, position=place) for size, place in walls))


def stacked_contacts(random: np.random.Generator, poses: FloatArray, pairs: list[tuple[int, int, float]]) -> Contacts:
    """Return two rows a pair and tick, of which every tenth is missing as in flickering contact."""
    ticks, count = len(poses), len(pairs)
    below = np.array([pair[0] for pair in pairs])
    above = np.array([pair[1] for pair in pairs])
    force = np.array([pair[2] for pair in pairs])
    tick = np.repeat(np.arange(ticks), 2 * count)
    a, b = np.tile(np.repeat(below, 2), ticks), np.tile(np.repeat(above, 2), ticks)
    push = np.tile(np.repeat(force / 2 / 0.9, 2), ticks)
    kept = random.random(len(tick)) < 0.9
    tick, a, b, push = tick[kept], a[kept], b[kept], push[kept]
    zeros = np.zeros_like(push)
    point = poses[tick, b, :3] - np.array([0.0, 0.0, 0.05])
    normal = np.stack((zeros, zeros, np.ones_like(push)), axis=1)
    return Contacts(
        tick=tick, a=a, b=b, force=np.stack((zeros, zeros, push), axis=1), normal=normal, point=point, peak=push
    )


def seconds_to_recognize(log: Log, repeats: int = 3) -> float:
    """Return the least time that recognition takes [s]."""
    best = np.inf
    for _ in range(repeats):
        begin = time.perf_counter()
        recognize(log)
        best = min(best, time.perf_counter() - begin)
    return float(best)


def rows() -> list[tuple[str, str, str]]:
    """Return what was measured, its value and what it should be."""
    recognize(busy_log(0.1))
    long, half = busy_log(10.0), busy_log(5.0)
    whole, part = seconds_to_recognize(long), seconds_to_recognize(half)
    return [
        (
            f"recognize 10 s at 1 kHz, {BODIES} bodies, {len(long.contacts.tick)} contact rows",
            f"{whole:.2f} s",
            "< 1 s",
        ),
        ("simulated over wall time", f"{10.0 / whole:.0f}", "> 10"),
        ("cost of twice the steps", f"{whole / part:.2f} times", "1.6 to 2.4"),
        ("facts found", str(len(recognize(long).facts)), "> 0"),
    ]


def main() -> None:
    """Print the table."""
    for name, measured, target in rows():
        print(f"{name:75} {measured:>10}   {target}")


if __name__ == "__main__":
    main()
