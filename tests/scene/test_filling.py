"""Liquids at the start: exact counts and volumes, inside their container, clear of walls, as high as they fill it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy import spatial  # pyright: ignore[reportMissingTypeStubs]
from tests.scenes import PREFIX, scene

from prolepsis.engine.composing import compose_scene
from prolepsis.geometry.rotations import matrix
from prolepsis.geometry.shape import FloatArray
from prolepsis.geometry.signed_distance import field_of
from prolepsis.knowledge import KnowledgeBase
from prolepsis.log.things import Thing
from prolepsis.matter.liquids.filling import FULL, basin_of
from prolepsis.scene.scene import Pool, Scene
from prolepsis.scene.shapes import SHAPES
from prolepsis.terms.errors import KnowledgeError

TABLE = ":table1 a :Table . "
CUP = {"radius": 0.04, "height": 0.09, "thickness": 0.005}
INNER, BOTTOM = 0.035, 0.005


def distance(thing: Thing, points: FloatArray) -> FloatArray:
    """Return the distance of world points to a thing's matter [m]."""
    local = (points - np.array(thing.position)) @ matrix(np.array(thing.orientation))
    return field_of(thing.shape).distance(local)


def nearest(points: FloatArray) -> FloatArray:
    """Return the distance of each point to its nearest neighbour [m]."""
    library: Any = spatial
    found: FloatArray = library.cKDTree(points).query(points, k=2)[0][:, 1]
    return found


def pool_of(made: Scene, name: str = "liq1") -> Pool:
    """Return the pool of a liquid."""
    (pool,) = (pool for pool in made.pools if pool.stuff == name)
    return pool


@pytest.mark.parametrize("vessel", ["Cup", "Bowl"])
@pytest.mark.parametrize("fill", [0.2, 0.9])
def test_a_vessel_holds_exactly_what_it_is_told(vessel: str, fill: float) -> None:
    made = scene(f"{TABLE} :v1 a :{vessel} ; :on :table1 ; :x 0.1 ; :contains :liq1 . :liq1 a :Water ; :fill {fill} .")
    liquid, pool, container = made.thing("liq1"), pool_of(made), made.thing("v1")
    capacity = container.quantities["capacity"]
    assert len(pool.position) == 2000 and pool.holder is None
    assert 2000 * pool.spacing**3 == pytest.approx(fill * capacity)
    assert liquid.quantities["volume"] == pytest.approx(fill * capacity)
    assert liquid.mass == pytest.approx(998.0 * fill * capacity)
    assert liquid.roles == {"Stuff", "Liquid"} and not liquid.shape.geoms
    assert liquid.position == pytest.approx(pool.position.mean(axis=0))
    # The last push may leave a particle a little too near.
    assert distance(container, pool.position).min() > 0.45 * pool.spacing
    assert nearest(pool.position).min() > 0.85 * pool.spacing
    assert np.median(nearest(pool.position)) > 0.95 * pool.spacing


@pytest.mark.parametrize("particles", [200, 2000, 8000])
def test_the_surface_is_as_high_as_the_volume_says(particles: int, tmp_path: Any) -> None:
    (tmp_path / "s.ttl").write_text(
        f"{PREFIX}{TABLE} :cup1 a :Cup ; :on :table1 ; :contains :liq1 . :liq1 a :Water ; :volume 0.0002 ."
    )
    made = compose_scene(KnowledgeBase.load(tmp_path / "s.ttl"), particles=particles)
    pool, base = pool_of(made), made.thing("cup1").position[2]
    level = BOTTOM + 0.0002 / (math.pi * INNER**2)
    assert len(pool.position) == particles
    top = pool.position[:, 2].max() + pool.spacing / 2 - base
    # At most one layer of particles lower than the surface, and never above it.
    assert level - pool.spacing < top <= level + 1e-6
    assert np.hypot(pool.position[:, 0], pool.position[:, 1]).max() < INNER - 0.45 * pool.spacing


def test_a_tilted_cup_holds_what_its_lowest_lip_allows() -> None:
    tilt = math.radians(30.0)
    cup = Thing(
        name="cup1",
        kind="Cup",
        shape=SHAPES["cup"](CUP),
        orientation=(math.cos(tilt / 2), math.sin(tilt / 2), 0.0, 0.0),
    )
    _, basin = basin_of("cup1", (cup,))
    # The level surface through the inner lip cuts the cylinder off at half the slope.
    exact = math.pi * INNER**2 * (0.085 - INNER * math.tan(tilt))
    assert basin.capacity == pytest.approx(exact, rel=0.01)


def test_an_upright_vessel_s_basin_has_its_capacity() -> None:
    for name, extents in (("cup", CUP), ("bowl", {"radius": 0.08, "height": 0.06, "thickness": 0.005})):
        vessel = Thing(name="v1", kind="Vessel", shape=SHAPES[name](extents), position=(0.1, 0.2, 0.7))
        _, basin = basin_of("v1", (vessel,))
        known = scene(f"{TABLE} :v1 a :{name.capitalize()} ; :on :table1 .").thing("v1").quantities["capacity"]
        # A grid of 2 mm.
        assert basin.capacity == pytest.approx(known, rel=0.002)
        assert basin.level(known / 2) < basin.brim


@pytest.mark.parametrize(("roll", "lid"), [(180.0, False), (120.0, False), (180.0, True), (90.0, True)])
def test_an_upturned_vessel_holds_something_only_under_a_lid(roll: float, lid: bool) -> None:
    text = f"{TABLE} :cup1 a :Cup ; :on :table1 ; :roll {roll} ; :lid {str(lid).lower()} ; :contains :liq1 ."
    text += " :liq1 a :Water ; :volume 0.0002 ."
    if not lid:
        with pytest.raises(KnowledgeError, match="cup1 contains a liquid at the start, but as it stands it has no"):
            scene(text)
        return
    made = scene(text)
    pool, cup = pool_of(made), made.thing("cup1")
    local = (pool.position - np.array(cup.position)) @ matrix(np.array(cup.orientation))
    assert (np.hypot(local[:, 0], local[:, 1]) < INNER).all()
    assert ((local[:, 2] > BOTTOM) & (local[:, 2] < 0.09)).all()
    assert distance(cup, pool.position).min() > 0.45 * pool.spacing


def test_holes_are_stopped_until_the_run_begins() -> None:
    holes = ":bottomHoleRadius 0.005 ; :holeRadius 0.004 ; :holeHeight 0.03 ; :holeCount 4"
    made = scene(f"{TABLE} :cup1 a :Cup ; :on :table1 ; {holes} ; :contains :liq1 . :liq1 a :Water ; :fill 0.8 .")
    pool, cup = pool_of(made), made.thing("cup1")
    local = pool.position - np.array(cup.position)
    assert (np.hypot(local[:, 0], local[:, 1]) < INNER).all() and (local[:, 2] > BOTTOM).all()
    assert len(cup.shape.holes) == 5


def test_two_liquids_in_one_vessel_lie_in_layers_of_equal_particles() -> None:
    liquids = ":oil1 a :OliveOil ; :volume 0.0001 . :liq1 a :Water ; :volume 0.0002 ."
    made = scene(f"{TABLE} :bowl1 a :Bowl ; :on :table1 ; :contains :liq1 , :oil1 . {liquids}")
    water, oil = pool_of(made), pool_of(made, "oil1")
    assert (len(water.position), len(oil.position)) == (2000, 1000) and water.spacing == oil.spacing
    assert water.position[:, 2].max() <= oil.position[:, 2].min()


def test_liquid_keeps_clear_of_what_lies_in_the_vessel() -> None:
    ball = ":ball1 a :Ball ; :radius 0.02 ; :density 2500 ; :on :bowl1 ."
    made = scene(f"{TABLE} :bowl1 a :Bowl ; :on :table1 ; :contains :liq1 . {ball} :liq1 a :Water ; :volume 0.0001 .")
    pool = pool_of(made)
    assert distance(made.thing("ball1"), pool.position).min() > 0.4 * pool.spacing


def test_a_puddle_is_a_disc_as_thick_as_its_surface_tension_makes_it() -> None:
    made = scene(f'{TABLE} :liq1 a :Water ; :on :table1 ; :x 0.1 ; :y -0.05 ; :volume "20 ml" .')
    pool, liquid = pool_of(made), made.thing("liq1")
    q = liquid.quantities
    thickness = 2 * math.sqrt(q["surfaceTension"] / (q["density"] * 9.81)) * math.sin(q["contactAngle"] / 2)
    layers = len(np.unique(np.round(pool.position[:, 2], 6)))
    assert layers * pool.spacing == pytest.approx(thickness, abs=0.6 * pool.spacing)
    assert np.abs(distance(made.thing("table1"), pool.position)).min() == pytest.approx(pool.spacing / 2, abs=1e-5)
    radius = math.sqrt(20e-6 / (layers * pool.spacing) / math.pi)
    away = np.hypot(pool.position[:, 0] - 0.1, pool.position[:, 1] + 0.05)
    assert away.max() == pytest.approx(radius, abs=1.5 * pool.spacing)


def test_a_soaked_sponge_holds_its_liquid_evenly() -> None:
    made = scene(f"{TABLE} :sponge1 a :Sponge ; :on :table1 ; :saturation 0.5 ; :absorbs :liq1 . :liq1 a :Water .")
    sponge, liquid, pool = made.thing("sponge1"), made.thing("liq1"), pool_of(made)
    assert pool.holder == "sponge1" and len(pool.position) == 2000
    assert liquid.mass == pytest.approx(0.5 * 15.0 * sponge.mass)
    assert (distance(sponge, pool.position) < 0).all()
    assert pool.position.mean(axis=0) == pytest.approx(np.array(sponge.position), abs=2e-3)
    # Half a step free on either side, of a lattice that is a little finer than the spacing would be.
    step = (0.11 * 0.07 * 0.03 / 2000) ** (1 / 3)
    assert (np.ptp(pool.position, axis=0) > np.array((0.11, 0.07, 0.03)) - 2 * step).all()


def test_filling_is_the_same_every_time() -> None:
    text = f"{TABLE} :cup1 a :Cup ; :on :table1 ; :contains :liq1 . :liq1 a :Honey ; :fill 0.5 ."
    assert (pool_of(scene(text)).position == pool_of(scene(text)).position).all()


@pytest.mark.parametrize("vessel", ["PaperBowl", "ClayBowl", "Bowl", "Cup"])
@pytest.mark.parametrize("more", ["", "; :radius 0.11", "; :height 0.03"])
def test_a_vessel_may_be_full_to_the_brim(vessel: str, more: str) -> None:
    text = f":floor a :Floor . :v1 a :{vessel} ; :on :floor {more} ; :contains :liq1 . :liq1 a :Water ; :fill 1.0 ."
    made = scene(text, particles=300)
    liquid, container = made.thing("liq1"), made.thing("v1")
    basin = basin_of("v1", tuple(thing for thing in made.things if thing.name == "v1"))[1]
    assert liquid.quantities["volume"] <= FULL * basin.capacity
    assert liquid.quantities["volume"] == pytest.approx(container.quantities["capacity"], rel=0.02)
    assert made.number("liq1", "volume") == liquid.quantities["volume"]
    assert made.number("liq1", "mass") == liquid.mass


@pytest.mark.parametrize("vessel", ["PaperBowl", "Bowl"])
def test_more_fill_is_more_liquid(vessel: str) -> None:
    def volume(fill: float) -> float:
        text = f":floor a :Floor . :v1 a :{vessel} ; :on :floor ; :contains :liq1 . :liq1 a :Water ; :fill {fill} ."
        return scene(text, particles=300).thing("liq1").quantities["volume"]

    volumes = [volume(fill) for fill in (0.5, 0.9, 0.99, 0.998, 0.999, 1.0)]
    assert volumes == sorted(volumes)
    assert volumes[-1] == pytest.approx(2.0 * volumes[0])


def test_several_liquids_may_fill_a_vessel_together() -> None:
    text = ":floor a :Floor . :v1 a :PaperBowl ; :on :floor ; :contains :a , :b . :a a :Water ; :fill 0.5 . :b a :Honey"
    made = scene(f"{text} ; :fill 0.5 .", particles=300)
    assert made.thing("a").quantities["volume"] == made.thing("b").quantities["volume"]
    with pytest.raises(KnowledgeError, match="are to be in v1, which holds"):
        scene(f"{text} ; :fill 0.52 .", particles=300)


def test_a_tilted_vessel_is_filled_by_its_share_of_the_upright_one() -> None:
    bowl = ":floor a :Floor . :v1 a :PaperBowl ; :z 0.1 ; :pitch 20.0 ; :contains :liq1 . :liq1 a :Water ; :fill"
    assert scene(f"{bowl} 0.3 .", particles=300).thing("liq1").quantities["volume"] > 2e-4
    with pytest.raises(KnowledgeError, match="are to be in v1, which holds"):
        scene(f"{bowl} 0.95 .", particles=300)
