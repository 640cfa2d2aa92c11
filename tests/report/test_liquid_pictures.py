"""Pictures show liquids: free particles in their colour, held and parked ones not, a wet sponge darker."""

from __future__ import annotations

import numpy as np
import pytest

from prolepsis.geometry.shape import FloatArray, Geom, Hole, Shape
from prolepsis.log.log import FREE, PARKED, Contacts, Log, Particles
from prolepsis.log.things import FIXED, Thing
from prolepsis.report.droplets import Droplets
from prolepsis.report.lathe import turned_surface
from prolepsis.report.liquid import LOOKS, Eye, Picture, painted
from prolepsis.report.render import pictures

SPACING = 0.004
FLOOR, SPONGE, LIQUID = 0, 1, 2


def log_of(positions: FloatArray, holder: int, kind: str = "Water", *, last: FloatArray | None = None) -> Log:
    """Return the log, two ticks long, of particles above a floor, and a sponge far from them."""
    things = (
        Thing(name="floor", kind="Floor", shape=Shape(geoms=(Geom(type="plane"),), colour=(1, 1, 1, 1)), mount=FIXED),
        Thing(
            name="sponge1", kind="Sponge", shape=Shape(geoms=(Geom(type="box", size=(0.02, 0.02, 0.01)),)), mass=0.01
        ),
        Thing(name="liq1", kind=kind, roles=frozenset({"Stuff", "Liquid"})),
    )
    poses = np.zeros((21, 3, 7))
    poses[..., 3] = 1.0
    poses[:, SPONGE, :3] = (0.15, 0.0, 0.01)
    none = np.zeros(0, dtype=np.int64)
    empty = np.zeros((0, 3))
    count = len(positions)
    return Log(
        dt=0.001,
        things=things,
        time=np.linspace(0.0, 0.02, 21),
        poses=poses,
        carrier=np.tile([FLOOR, SPONGE, -1], (21, 1)),
        contacts=Contacts(tick=none, a=none, b=none, force=empty, normal=empty, point=empty, peak=np.zeros(0)),
        particles=Particles(
            tick=np.array([0, 20]),
            position=np.stack([positions, positions if last is None else last]).astype(np.float32),
            holder=np.full((2, count), holder, dtype=np.int16),
            stuff=np.full(count, LIQUID),
            mass=np.full(count, 0.03 / count),
            volume=np.full(count, SPACING**3),
            spacing=SPACING,
        ),
    )


def cube(middle: tuple[float, float, float]) -> FloatArray:
    side: FloatArray = np.arange(-5.0, 6.0) * SPACING
    return np.stack(np.meshgrid(side, side, side), axis=-1).reshape(-1, 3).astype(np.float64) + middle


def picture_of(log: Log) -> Picture:
    return next(pictures(log, [0], size=(160, 120)))


def changed(first: Picture, second: Picture) -> int:
    return int((np.abs(first.astype(int) - second).max(axis=2) > 25).sum())


@pytest.mark.parametrize(
    ("kind", "strongest", "weakest"), [("Water", 2, 0), ("Honey", 0, 2), ("OliveOil", 0, 2), ("EggYolk", 0, 2)]
)
def test_a_liquid_is_painted_in_its_colour(kind: str, strongest: int, weakest: int) -> None:
    free, hidden = (picture_of(log_of(cube((0.0, 0.0, 0.05)), holder, kind)) for holder in (FREE, PARKED))
    wet = np.abs(free.astype(int) - hidden).max(axis=2) > 25
    assert wet.sum() > 300
    assert free[wet][:, strongest].mean() > free[wet][:, weakest].mean() + 15


def test_what_is_held_within_a_sponge_is_not_seen_but_darkens_it() -> None:
    positions = cube((0.0, 0.0, 0.05))
    log = log_of(positions, SPONGE)
    assert Droplets(log).at(0) is None
    assert Droplets(log).held_share(0)[SPONGE] == pytest.approx(0.75)
    held, parked = picture_of(log), picture_of(log_of(positions, PARKED))
    darker = parked.astype(int).sum(axis=2) - held.astype(int).sum(axis=2)
    assert (darker > 60).sum() > 50
    assert darker.min() > -30


def test_between_two_frames_particles_are_on_the_straight_line() -> None:
    first, last = cube((0.0, 0.0, 0.05)), cube((0.0, 0.0, 0.09))
    wet = Droplets(log_of(first, FREE, last=last)).at(5)
    assert wet is not None
    assert wet.positions == pytest.approx(0.75 * first + 0.25 * last, abs=1e-6)


def test_one_splash_far_away_does_not_draw_the_camera() -> None:
    near = cube((0.0, 0.0, 0.05))
    splashed = near.copy()
    splashed[0] = (0.5, 0.5, 0.5)
    assert changed(picture_of(log_of(near, FREE)), picture_of(log_of(splashed, FREE))) < 100


def test_twenty_thousand_particles_are_painted_too() -> None:
    side: FloatArray = np.arange(28.0) * 0.002
    many: FloatArray = np.stack(np.meshgrid(side, side, side), axis=-1).reshape(-1, 3)[:20000].astype(np.float64)
    assert changed(picture_of(log_of(many, FREE)), picture_of(log_of(many, PARKED))) > 300


def test_a_turned_surface_encloses_the_volume_of_its_solid_and_is_open_at_holes() -> None:
    outline = ((0.0, 0.0), (0.04, 0.0), (0.04, 0.09), (0.035, 0.09), (0.035, 0.005), (0.0, 0.005))
    corners, triangles = turned_surface(Shape(profile=outline))
    a, b, c = (corners[triangles[:, k]] for k in range(3))
    volume = float(np.einsum("ni,ni->n", a, np.cross(b, c)).sum()) / 6
    solid = np.pi * (0.04**2 * 0.09 - 0.035**2 * 0.085)
    assert volume == pytest.approx(solid, rel=0.003)  # a polygon of 72 sides has .9987 of its circle's area
    hole = Hole(position=(0.0, 0.0, 0.03), direction=(1.0, 0.0, 0.0), radius=0.004)
    corners, triangles = turned_surface(Shape(profile=outline, holes=(hole,)))
    middles = corners[triangles].mean(axis=1)
    assert not ((middles[:, 0] > 0) & (np.hypot(middles[:, 1], middles[:, 2] - 0.03) < 0.004)).any()
    assert ((middles[:, 0] < 0) & (np.hypot(middles[:, 1], middles[:, 2] - 0.03) < 0.004)).any()


def test_what_is_painted_does_not_depend_on_liquid_elsewhere_in_the_picture() -> None:
    picture = np.full((120, 400, 3), 200, dtype=np.uint8)
    eye = Eye(position=np.zeros(3), forward=np.array([1.0, 0, 0]), up=np.array([0, 0, 1.0]), focal=200.0)
    behind = np.full(picture.shape[:2], 2.0)
    near, far = cube((0.5, 0.3, 0.02)), cube((0.5, -0.3, -0.02))

    def paint(positions: FloatArray) -> tuple[Picture, FloatArray]:
        kinds = np.zeros(len(positions), dtype=np.int64)
        return painted(picture, behind, eye, positions, kinds, [LOOKS["Water"]], SPACING)

    (alone, taken), (both, taken_by_both) = paint(near), paint(np.concatenate([near, far]))
    assert (alone[:, :200] != picture[:, :200]).any() and (both[:, 200:] != picture[:, 200:]).any()
    assert (alone[:, :200] == both[:, :200]).all() and (taken[:, :200] == taken_by_both[:, :200]).all()
    assert (alone[:, 200:] == picture[:, 200:]).all()
