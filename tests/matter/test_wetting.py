"""What touches a liquid becomes wet and dirty; where a sponge has been and no liquid is left, it is clean again."""

from __future__ import annotations

import pytest
from tests.scenes import run, scene, started

from prolepsis.engine.state import State
from prolepsis.engine.world import compile_world
from prolepsis.fluents import recognize
from prolepsis.log.happenings import DROP
from prolepsis.log.log import FREE
from prolepsis.log.timeline import Fact, Timeline
from prolepsis.matter.films.wetting import LOOK_TICKS, Wetting

PUDDLE = ":floor a :Floor . :table1 a :Table . :liq1 a :Water ; :on :table1 ; :volume 0.0000005 . "
OVER_IT = ":sponge1 a :Sponge ; :length 0.06 ; :width 0.06 ; :height 0.02 ; :z 0.713 . "
AWAY = OVER_IT.replace("0.713", "2.0")


def looks(state: State, wetting: Wetting) -> bool:
    """Let it look again, and return whether the table is wet then."""
    for _ in range(LOOK_TICKS):
        wetting.end_tick(state)
    return bool(state.attribute("table1", "wet"))


def begun(turtle: str) -> tuple[State, Wetting]:
    """Return a run that stands still at its start, with a table that is wet, and what makes it so."""
    state = State.of(compile_world(scene(turtle, particles=60)))
    (wetting,) = started(state, Wetting)
    wetting.end_tick(state)
    assert state.attribute("table1", "wet") and state.attribute("table1", "dirty")
    return state, wetting


def taken_up(state: State) -> None:
    """Let the sponge hold all the liquid."""
    assert state.particles is not None
    state.particles.holder[:] = state.scene.index("sponge1")


def spans(timeline: Timeline, name: str, thing: str) -> list[tuple[float, float]]:
    """Return when a fluent holds of a thing [s]."""
    return [(fact.start, fact.end) for fact in timeline.facts if fact.type == name and fact.args == (thing,)]


def test_a_table_is_wet_until_a_sponge_over_the_place_has_taken_the_puddle_up() -> None:
    state, wetting = begun(PUDDLE + OVER_IT)
    assert looks(state, wetting), "the puddle is there still"
    taken_up(state)
    assert not looks(state, wetting) and not state.attribute("table1", "dirty")
    assert state.attribute("sponge1", "wet")


@pytest.mark.parametrize("particles", [100, 400])
def test_what_is_on_the_other_side_of_a_thin_wall_is_dry(particles: int) -> None:
    glass = ":glass1 a :Cup ; :radius 0.03 ; :thickness 0.002 ; :on :sponge1 ; :contains :milk1 . "
    sponge = ":floor a :Floor . :sponge1 a :Sponge ; :on :floor ; :length 0.1 ; :width 0.1 ; :height 0.03 . "
    timeline = recognize(
        run(sponge + glass + ":milk1 a :Water ; :fill 0.6 .", "wait(0.3)", duration=0.3, particles=particles)
    )
    assert spans(timeline, "wet", "glass1") == [(0.0, 0.3)]
    assert not timeline.select(type="absorbing") and not spans(timeline, "wet", "sponge1")


def test_what_is_gone_but_was_not_wiped_leaves_a_film() -> None:
    state, wetting = begun(PUDDLE + AWAY)
    taken_up(state)
    assert looks(state, wetting)


def test_what_is_wet_again_is_wet_again() -> None:
    state, wetting = begun(PUDDLE + OVER_IT)
    taken_up(state)
    assert not looks(state, wetting)
    assert state.particles is not None
    state.particles.holder[:] = FREE
    assert looks(state, wetting)


def test_what_is_told_to_be_wet_or_dirty_stays_so_for_no_one_knows_where() -> None:
    state, wetting = begun(PUDDLE + OVER_IT + ":table1 :dirty true .")
    taken_up(state)
    assert not looks(state, wetting) and state.attribute("table1", "dirty")


def test_a_dry_surface_has_its_friction_again() -> None:
    state, wetting = begun(PUDDLE + OVER_IT + ":table1 :friction 0.6 ; :frictionWhenWet 0.2 .")
    assert state.model.geom("table1/0").friction[0] == pytest.approx(0.2)
    taken_up(state)
    assert not looks(state, wetting)
    assert state.model.geom("table1/0").friction[0] == pytest.approx(0.6)


def test_facts_tell_what_is_wet_from_when_to_when_and_with_what() -> None:
    full = ":sponge2 a :Sponge ; :x 0.2 ; :on :table1 ; :length 0.03 ; :width 0.03 ; :height 0.01 ; :saturation 0.5 ; "
    soaked = full + ":absorbs :liq2 . :liq2 a :Water . "
    timeline = recognize(run(PUDDLE + AWAY + soaked, "wait(0.2)", duration=0.2, particles=150))
    assert spans(timeline, "wet", "table1") == spans(timeline, "dirty", "table1") == [(0.0, 0.2)]
    assert timeline.ask("evidence(wet(table1), _, by, liq1), evidence(wet(sponge2), 0.0-_, by, liq2)")
    assert not timeline.ask("holds(wet(sponge1), _) ; holds(wet(floor), _)")


def test_a_hand_that_is_told_to_be_wet_is_so_without_any_liquid() -> None:
    told = run(":floor a :Floor . :hand1 a :Gripper ; :wet true ; :z 0.5 .", "wait(0.01)", duration=0.01)
    timeline = recognize(told)
    assert spans(timeline, "wet", "hand1") == [(0.0, 0.01)] and not spans(timeline, "dirty", "hand1")
    assert timeline.ask("evidence(wet(hand1), _, source, told)")


def test_what_a_single_fine_particle_touches_is_not_wet_yet() -> None:
    state = State.of(compile_world(scene(PUDDLE, particles=200)))
    (wetting,) = started(state, Wetting)
    assert state.particles is not None and state.particles.volume[0] < DROP / 10
    state.particles.position[1:, 2] += 1.0
    wetting.end_tick(state)
    assert not state.attribute("table1", "wet")
    state.particles.position[1:, 2] -= 1.0
    assert looks(state, wetting)


def test_a_part_of_a_shell_is_wet_where_any_of_its_pieces_is() -> None:
    log = run(":floor a :Floor . :egg1 a :Egg ; :z 0.3 .", duration=0.8)
    films, first = log.happenings["film"], log.index("eggshell1/piece0")
    carried = [k for k in films.things["thing"].tolist() if log.carrier[-1, k] == first]
    assert carried, "some piece of the largest part is wet"
    assert recognize(log).ask("holds(wet('eggshell1/piece0'), T), ongoing(wet('eggshell1/piece0'))")


def test_facts_tell_how_large_the_film_is() -> None:
    timeline = recognize(run(PUDDLE, "wait(0.5)", duration=0.5, particles=60))
    (fact,) = timeline.select(type="wet")
    # Half a millilitre in a layer of particles of 8 mm^3, which spreads a little.
    assert 1.5e-4 < float(fact.evidence["area_at_end"]) <= float(fact.evidence["area"]) < 6e-4


def test_what_is_under_water_is_wet_by_its_surface_however_many_particles_there_are() -> None:
    bowl = ":floor a :Floor . :bowl1 a :Bowl ; :on :floor ; :contains :liq1 . :liq1 a :Water ; :volume 0.0003 . "
    block = ":block1 a :Block ; :length 0.02 ; :width 0.02 ; :height 0.02 ; :density 1500 ; :z 0.06 . "
    areas: list[float] = []
    margins: list[float] = []
    for particles in (500, 1000, 2000):
        timeline = recognize(run(bowl + block, "wait(0.6)", duration=0.6, particles=particles))
        (fact,) = (fact for fact in timeline.select(type="wet") if fact.args == ("block1",))
        areas.append(number(fact, "area"))
        margins.append(number(fact, "margin"))
    assert min(areas) > 0.0022 and max(areas) < 0.00245
    assert max(margins) < 1.1 * min(margins)


def number(fact: Fact, name: str) -> float:
    """Return what was measured of a fact."""
    value = fact.evidence[name]
    assert isinstance(value, float)
    return value
