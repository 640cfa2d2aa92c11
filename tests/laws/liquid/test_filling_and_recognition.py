"""Filling and recognition agree on what a vessel holds, whichever shape it has and however it is turned."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.fluents.liquids import liquid, placed, tilted, wet
from tests.laws.rest_scenes import TABLE
from tests.scenes import run

from prolepsis.engine.placing import resting_height
from prolepsis.fluents import recognize
from prolepsis.fluents.liquids.particle_locations import particle_locations
from prolepsis.fluents.observation import observe
from prolepsis.geometry.shape import BoolArray, FloatArray, Geom, Shape
from prolepsis.geometry.signed_distance import field_of
from prolepsis.log.log import Log
from prolepsis.log.things import Thing
from prolepsis.log.timeline import Fact
from prolepsis.matter.liquids.filling import basin_of, fill
from prolepsis.matter.liquids.liquids import Placement
from prolepsis.scene.scene import Pool
from prolepsis.scene.shapes import SHAPES
from prolepsis.terms.errors import KnowledgeError

AGREEMENT = 0.015
"""Greatest difference of capacities that filling and recognition find, over that when upright [1]: a grid lies
differently in the frame of the world and in that of the vessel."""
BOTTLE = Shape(
    geoms=(Geom(type="cylinder", size=(0.032, 0.1, 0.0), position=(0.0, 0.0, 0.1)),),
    profile=(
        (0.0, 0.0), (0.032, 0.0), (0.032, 0.13), (0.014, 0.16), (0.014, 0.2),
        (0.012, 0.2), (0.012, 0.16), (0.03, 0.13), (0.03, 0.002), (0.0, 0.002),
    ),
)  # fmt: skip
SHAPE = {
    "cup": SHAPES["cup"]({"radius": 0.04, "height": 0.09, "thickness": 0.003}),
    "bowl": SHAPES["bowl"]({"radius": 0.08, "height": 0.06, "thickness": 0.004}),
    "bottle": BOTTLE,
}
CASES = [
    *(("cup", degrees) for degrees in (0.0, 10.0, 31.0, 50.0, 65.0)),
    *(("bowl", degrees) for degrees in (0.0, 12.0, 25.0)),
    *(("bottle", degrees) for degrees in (0.0, 30.0, 60.0, 85.0)),
]


def vessel(name: str, degrees: float) -> Thing:
    """Return a vessel that is tilted about an axis of the world."""
    return Thing(
        name="cup1", kind="Cup", shape=SHAPE[name], mass=0.1, position=(0.1, 0.2, 0.3), orientation=tilted(degrees)
    )


def filled(container: Thing, volume: float) -> Pool:
    """Return the particles of a volume [m^3] in it."""
    water = replace(liquid(), quantities={"density": 1000.0, "viscosity": 0.001, "volume": volume})
    placements = {"liq1": Placement(relation="contains", host="cup1")}
    (pool,) = fill([water], placements, {"cup1": (container,)}, resting_height, 1500)[1]
    return pool


def at_rest(container: Thing, position: FloatArray, spacing: float) -> Log:
    """Return a log in which particles of a spacing [m] stay where they are."""
    log = wet([container], {"liq1": position})
    volume = np.full(len(position), spacing**3)
    return replace(log, particles=replace(log.particles, spacing=spacing, volume=volume, mass=1000.0 * volume))


def said(log: Log, type: str) -> list[Fact]:
    """Return the facts of a type."""
    return [fact for fact in recognize(log).facts if fact.type == type]


@pytest.mark.parametrize(("name", "degrees"), CASES)
def test_what_filling_accepts_is_contained_and_what_it_refuses_would_overflow(name: str, degrees: float) -> None:
    container = vessel(name, degrees)
    capacity, upright = basin_of("cup1", (container,))[1].capacity, basin_of("cup1", (vessel(name, 0.0),))[1].capacity
    pool = filled(container, 0.99 * capacity)
    log = at_rest(container, pool.position, pool.spacing)
    (fact,) = said(log, "contains")
    assert str(fact.term) == "contains(cup1,liq1)" and fact.evidence["fraction"] == pytest.approx(1.0)
    assert fact.evidence["volume"] == pytest.approx(0.99 * capacity, rel=1e-3)
    assert not said(log, "spilled")
    seen = observe(log).of(particle_locations)
    assert seen is not None
    assert seen.inside[0].capacity(0) == pytest.approx(capacity, abs=AGREEMENT * upright)
    with pytest.raises(KnowledgeError, match="which holds"):
        filled(container, 1.01 * capacity)


@pytest.mark.parametrize("name", SHAPE)
def test_what_is_tilted_too_far_is_refused_and_contains_nothing(name: str) -> None:
    upright = vessel(name, 0.0)
    whole = basin_of("cup1", (upright,))[1].capacity
    pool = filled(upright, 0.3 * whole)
    own = pool.position - np.array(upright.position)
    shares: list[float] = []
    for degrees in (15.0, 40.0, 60.0, 95.0, 120.0, 180.0):
        container = vessel(name, degrees)
        facts = said(at_rest(container, placed(own, container), pool.spacing), "contains")
        try:
            capacity = basin_of("cup1", (container,))[1].capacity
        except KnowledgeError:
            assert not facts
            continue
        shares.append(float(facts[0].evidence["fraction"]) if facts else 0.0)
        # The surface is a layer of particles: half of it may be above the brim.
        assert shares[-1] * 0.3 * whole < capacity + 0.1 * whole
    assert shares and shares == sorted(shares, reverse=True)


HOLES = (
    "; :bottomHoleRadius 0.008",
    "; :bottomHoleRadius 0.01",
    "; :holeRadius 0.008 ; :holeHeight 0.026 ; :holeCount 4.0",
    "; :bottomHoleRadius 0.009 ; :holeRadius 0.01 ; :holeHeight 0.03",
)


@pytest.mark.parametrize("particles", [300, 1000])
@pytest.mark.parametrize("holes", HOLES)
def test_a_vessel_with_holes_begins_to_leak_when_the_run_begins(holes: str, particles: int) -> None:
    """All that it is told to contain is within it at time 0, and neither in a hole nor beside it; then it flows."""
    vessel = f":c a :Cup ; :on :table1 {holes} ; :contains :l . :l a :Water ; :fill 0.8 ."
    log = run(TABLE + vessel, duration=0.3, particles=particles)
    shape = log.things[log.index("c")].shape
    height = max(z for _, z in shape.profile)
    begun, ended = (log.particles.position[frame] - log.poses[0, log.index("c"), :3] for frame in (0, -1))
    whole = field_of(replace(shape, holes=()))

    def within(points: FloatArray) -> BoolArray:
        beside = np.hypot(points[:, 0], points[:, 1]) > max(r for r, _ in shape.profile)
        clear = whole.distance(points) > 0.45 * log.particles.spacing
        return clear & ~beside & (points[:, 2] > 0.0) & (points[:, 2] < height)

    assert within(begun).all()
    assert not within(ended).all()
