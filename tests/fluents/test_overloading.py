"""Vessels do not break here; a blow that exceeds what their wall bears is told, with its share."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import pytest
from tests.scenes import run

from prolepsis.fluents import recognize
from prolepsis.fluents.solids.struck_walls import blow, wall_of
from prolepsis.log.log import Log
from prolepsis.log.timeline import Fact, Timeline

GLASS = {"youngsModulus": 70.0e9, "bendingStrength": 50.0e6, "radius": 0.08}
TILE = {"youngsModulus": 50.0e9}


@pytest.mark.parametrize(("thickness", "bore", "broke"), [(0.006, 0.4, 0.5), (0.004, 0.3, 0.4)])
def test_panes_bear_about_the_ball_that_they_bore(thickness: float, bore: float, broke: float) -> None:
    """A ball of 100 g on a pane of 158 by 120 mm: at which fall is its force what the law says that the pane bears?

    Source:
        British Manufacturing Industries: Pottery, Glass and Silicates (1876), tests of ordinary and toughened glass;
        Timoshenko and Woinowsky-Krieger for a supported plate with a load in its middle.
    """
    wall = wall_of(GLASS | {"thickness": thickness})
    assert wall is not None
    rigidity = 70.0e9 * thickness**3 / (12 * (1 - 0.22**2))
    stiffness = rigidity / (0.0146 * 0.12**2)
    fall = wall.bears**2 / (2 * stiffness) / (0.1 * 9.81)
    assert 0.8 * bore < fall < 1.2 * broke


def test_a_blow_has_the_energy_that_wall_and_contact_take_up() -> None:
    wall = wall_of(GLASS | {"thickness": 0.005})
    assert wall is not None
    force = blow(wall, GLASS, TILE, 0.3, 1.0)
    # The contact gives, too.
    assert 0.8 < force / math.sqrt(0.3 * wall.stiffness) < 1.0
    assert blow(wall, GLASS, TILE, 0.3, 2.0) == pytest.approx(2 * force, rel=0.1)
    assert blow(wall, GLASS, TILE | {"surfaceStiffness": 5.0e3}, 0.3, 1.0) == pytest.approx(math.sqrt(1500), rel=0.01)
    assert blow(wall, GLASS, {"youngsModulus": 1.0e6}, 0.3, 1.0) < force / 10


def dropped(what: str, height: float, ground: Mapping[str, float] | None = None) -> Log:
    turtle = f":floor a :Floor . :vessel1 a :{what} ; :z {height!r} ."
    values = {f"floor.{name}": value for name, value in (ground or {}).items()}
    return run(turtle, values=values, duration=math.sqrt(2 * height / 9.81) + 0.1)


def overloads(timeline: Timeline) -> Sequence[Fact]:
    return timeline.select(type="overloading")


@pytest.mark.parametrize("what", ["Cup", "Bowl"])
def test_a_vessel_that_falls_a_metre_on_tiles_would_break_and_two_centimetres_not(what: str) -> None:
    assert not overloads(recognize(dropped(what, 0.02)))
    timeline = recognize(dropped(what, 1.0))
    (fact, *_) = overloads(timeline)
    assert fact.args[0] == "vessel1"
    assert 3 < float(fact.args[1]) < 6
    assert fact.evidence["margin"] == pytest.approx(float(fact.evidence["force"]) / float(fact.evidence["bears"]))
    (collision, *_) = timeline.select(type="colliding")
    assert (fact.start, fact.evidence["by"]) == (collision.start, "floor")
    assert timeline.ask("occurs(overloading(vessel1, Share), T), Share > 3, occurs(colliding(vessel1, floor), T)")


def test_what_is_soft_spares_it() -> None:
    """A carpet, as soft as felt."""
    assert not overloads(recognize(dropped("Cup", 1.0, {"youngsModulus": 0.5e6})))


@pytest.mark.parametrize("what", ["ClayBowl", "PaperBowl"])
def test_what_yields_is_not_overloaded(what: str) -> None:
    assert not overloads(recognize(dropped(what, 0.5)))


def test_a_vessel_that_is_nearly_overloaded_is_a_near_miss() -> None:
    timeline = recognize(dropped("Bowl", 0.05))
    assert not overloads(timeline)
    assert {fact.type for fact in timeline.near_misses} == {"overloading"}


@pytest.mark.parametrize(("ball", "strikes"), [('"33 g"', True), ('"2 g"', False)])
def test_what_falls_on_a_vessel_strikes_it(ball: str, strikes: bool) -> None:
    turtle = (
        ":floor a :Floor . :cup1 a :Cup ; :on :floor . "
        f":ball1 a :Ball ; :radius 0.01 ; :mass {ball} ; :youngsModulus 2.0e11 ; :x 0.037 ; :z 0.5 ."
    )
    found = overloads(recognize(run(turtle, duration=0.5)))
    assert bool([fact for fact in found if fact.args[0] == "cup1" and fact.evidence["by"] == "ball1"]) == strikes


def test_an_egg_that_breaks_on_a_bowl_does_not_overload_it() -> None:
    turtle = ":floor a :Floor . :bowl1 a :Bowl ; :on :floor . :egg1 a :Egg ; :x 0.0775 ; :z 0.3 ; :yaw 90.0 ."
    assert not overloads(recognize(run(turtle, duration=0.4)))
