"""Logs made by hand, for what no ten-line world does: eggs that fall apart, blobs of yolk, hands and actions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from prolepsis.geometry.shape import FloatArray, Geom, Shape, Triple
from prolepsis.log.log import Action, Contacts, Detachments, Joints, Log
from prolepsis.log.things import FIXED, WITHIN, Thing

DT = 0.001
PLATES = 5
"""Pieces of each half of the shell."""
UP = (0.0, 0.0, 1.0)
Row = tuple[int, str, str, Triple, Triple]


@dataclass
class Draft:
    """A log in the making: everything stands still and touches nothing unless said otherwise."""

    ticks: int
    things: Sequence[Thing]
    poses: FloatArray = field(init=False)
    rows: list[Row] = field(default_factory=list[Row])

    def __post_init__(self) -> None:
        """Put every thing where it says that it starts."""
        self.poses = np.zeros((self.ticks, len(self.things), 7))
        for i, thing in enumerate(self.things):
            self.poses[:, i, :3] = thing.position
            self.poses[:, i, 3:] = thing.orientation
        self.carrier = np.tile(np.arange(len(self.things)), (self.ticks, 1))

    def index(self, name: str) -> int:
        return [thing.name for thing in self.things].index(name)

    def press(
        self,
        a: str,
        b: str,
        start: int,
        end: int,
        force: tuple[float, float, float],
        normal: tuple[float, float, float],
    ) -> None:
        """Let a press on b over ticks with a force [N] along a normal from a to b."""
        self.rows += [(tick, a, b, force, normal) for tick in range(start, end)]

    def rest(self, below: str, above: str, start: int, end: int, weight: float) -> None:
        """Let a thing rest on another."""
        self.press(below, above, start, end, (0.0, 0.0, weight), UP)

    def log(
        self,
        *,
        detachments: Detachments | None = None,
        joints: Joints | None = None,
        channels: Mapping[str, FloatArray] | None = None,
        actions: tuple[Action, ...] = (),
    ) -> Log:
        """Return the log."""
        return Log(
            dt=DT,
            things=tuple(self.things),
            time=np.arange(self.ticks, dtype=np.float64) * DT,
            poses=self.poses,
            carrier=self.carrier,
            contacts=self._contacts(),
            happenings=(detachments or Detachments()).happenings(),
            joints=joints or Joints(),
            channels=channels or {},
            actions=actions,
        )

    def _contacts(self) -> Contacts:
        ordered = sorted(self.rows, key=lambda row: row[0])
        a = np.array([self.index(row[1]) for row in ordered], dtype=np.int64)
        b = np.array([self.index(row[2]) for row in ordered], dtype=np.int64)
        force = np.array([row[3] for row in ordered], dtype=np.float64).reshape(-1, 3)
        normal = np.array([row[4] for row in ordered], dtype=np.float64).reshape(-1, 3)
        sign = np.where(a > b, -1.0, 1.0)[:, None]
        tick = np.array([row[0] for row in ordered], dtype=np.int64)
        low, high = np.minimum(a, b), np.maximum(a, b)
        point = self.poses[tick, high, :3] if len(tick) else np.zeros((0, 3))
        peak = np.abs((force * normal).sum(axis=1))
        return Contacts(tick=tick, a=low, b=high, force=force * sign, normal=normal * sign, point=point, peak=peak)


def floor() -> Thing:
    """Return a floor."""
    return Thing(name="floor", kind="Floor", shape=Shape(geoms=(Geom(type="plane"),)), mount=FIXED)


def solid_box(name: str, *, half: float = 0.05, mass: float = 1.0, z: float = 0.05, x: float = 0.0) -> Thing:
    """Return a loose box."""
    shape = Shape(geoms=(Geom(type="box", size=(half, half, half)),))
    return Thing(name=name, kind="Box", shape=shape, mass=mass, position=(x, 0.0, z))


def egg() -> list[Thing]:
    """Return an egg: a shell of two open boxes of ``PLATES`` pieces, a yolk of three blobs, a white of two."""
    body = Shape(geoms=(Geom(type="ellipsoid", size=(0.022, 0.022, 0.0285)),))
    place = (0.0, 0.0, 0.5)
    things = [
        Thing(name="egg1", kind="Egg", shape=body, mass=0.058, position=place, roles=frozenset({"Breakable"})),
        Thing(name="eggshell1", kind="EggShell", mass=0.006, whole="egg1", position=place),
        Thing(name="yolk1", kind="Yolk", mass=0.018, whole="egg1", position=place, roles=frozenset({"Stuff"})),
        Thing(name="white1", kind="EggWhite", mass=0.034, whole="egg1", position=place, roles=frozenset({"Stuff"})),
    ]
    walls = [((0.001, 0.02, 0.008), (x, 0.0, 0.008)) for x in (0.02, -0.02)]
    walls += [((0.02, 0.001, 0.008), (0.0, y, 0.008)) for y in (0.02, -0.02)]
    plates = [((0.02, 0.02, 0.001), (0.0, 0.0, 0.0)), *walls]
    for k in range(2 * PLATES):
        side = 1 if k < PLATES else -1
        size, shift = plates[k % PLATES]
        shape = Shape(geoms=(Geom(type="box", size=size),))
        where = (shift[0] + 0.1 * side, shift[1], 0.5 + shift[2])
        name = f"eggshell1/piece{k}"
        things.append(
            Thing(name=name, kind="Piece", shape=shape, mass=0.001, whole="eggshell1", position=where,
                  mount=WITHIN, roles=frozenset({"Piece"}))
        )  # fmt: skip
    ball = Shape(geoms=(Geom(type="sphere", size=(0.006, 0.0, 0.0)),))
    for stuff, count, mass in (("yolk1", 3, 0.006), ("white1", 2, 0.017)):
        things += [
            Thing(name=f"{stuff}/blob{k}", kind="Blob", shape=ball, mass=mass, whole=stuff, position=place,
                  mount=WITHIN, roles=frozenset({"Blob"}))
            for k in range(count)
        ]  # fmt: skip
    return things
