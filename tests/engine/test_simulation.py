"""The loop: what is logged, what monitors may do, and how a run ends when the physics diverges."""

from __future__ import annotations

import hashlib

import numpy as np
import pytest
from tests.scenes import EGG_IN_HAND, falling_egg, run, scene

from prolepsis.engine.channels import known_channels
from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.log.log import Log
from prolepsis.matter.kinds import known_kinds
from prolepsis.programs import read_program
from prolepsis.terms.errors import InvalidSimulationError, KnowledgeError, ScenarioError, UnknownNameError
from prolepsis.terms.reader import parse_term

TWO_BLOCKS = ":floor a :Floor . :block1 a :Block ; :on :floor . :block2 a :Block ; :on :block1 ."


def digest(log: Log) -> str:
    """Return a hash of everything physical in a log."""
    total = hashlib.sha256()
    contacts = log.contacts
    for column in (log.poses, log.carrier, contacts.tick, contacts.a, contacts.b, contacts.force, contacts.peak):
        total.update(np.ascontiguousarray(column).tobytes())
    return total.hexdigest()


def test_the_same_run_gives_the_same_bytes() -> None:
    first, second = (run(falling_egg(0.2), duration=0.5) for _ in range(2))
    assert digest(first) == digest(second)


def test_monitors_change_nothing() -> None:
    plan = "sequence([close(hand1, 50), lift(hand1, 0.05)])"
    few = run(EGG_IN_HAND, plan)
    anything = [name for name, channel in known_channels(known_kinds()).items() if channel.role in (None, "Breakable")]
    many = run(EGG_IN_HAND, plan, monitors={"egg1": anything, "hand1": ["speed", "wet", "height"]})
    assert len(many.channels) > len(few.channels)
    assert digest(few) == digest(many)


def test_what_is_logged_can_be_chosen_per_object() -> None:
    log = run(falling_egg(0.05), duration=0.02, monitors={"egg1": ["height", "speed"]})
    assert {name for name in log.channels if name.startswith("egg1.")} == {"egg1.height", "egg1.speed"}
    assert log.channels["egg1.speed"][-1] == pytest.approx(9.81 * 0.019, rel=0.1)
    assert log.channels["egg1.height"][0] == pytest.approx(0.072)


def test_an_unknown_or_unfitting_monitor_is_refused() -> None:
    with pytest.raises(UnknownNameError, match=r"\[monitors\] egg1: no monitor named 'sped'; did you mean 'speed'"):
        run(falling_egg(0.05), duration=0.01, monitors={"egg1": ["sped"]})
    with pytest.raises(UnknownNameError, match=r"\[monitors\]: no object named 'egg2'"):
        run(falling_egg(0.05), duration=0.01, monitors={"egg2": ["speed"]})
    with pytest.raises(ScenarioError, match="opening is of a Gripper, which it is not"):
        run(falling_egg(0.05), duration=0.01, monitors={"egg1": ["opening"]})


def test_breaking_makes_broken_and_free_liquid_wets_and_dirties_what_it_touches() -> None:
    log = run(
        EGG_IN_HAND,
        "sequence([close(hand1, 50), hold(hand1, 0.2)])",
        monitors={"egg1": ["broken"], "hand1": ["wet", "dirty"], "table1": ["wet", "temperature"]},
    )
    for channel in ("egg1.broken", "hand1.wet", "hand1.dirty", "table1.wet"):
        series = log.channels[channel]
        assert (series[0], series[-1]) == (0.0, 1.0), channel
        assert (np.diff(series) >= 0).all(), channel
    assert (log.channels["table1.temperature"] > 290).all()  # kelvin


def test_time_advances_by_ticks_and_the_log_ends_with_the_duration() -> None:
    log = run(TWO_BLOCKS, duration=0.25)
    assert log.tick_count == 250
    assert np.array_equal(log.time, np.arange(250) * log.dt)


def test_stacked_blocks_rest_and_bear_their_weight() -> None:
    log = run(TWO_BLOCKS, duration=1.0)
    late = log.contacts.tick > 500
    weight = log.things[log.index("block1")].mass * 9.81
    on_floor = late & (log.contacts.b == max(log.index("floor"), log.index("block1")))
    on_floor &= log.contacts.a == min(log.index("floor"), log.index("block1"))
    total = np.abs(log.contacts.force[on_floor][:, 2]).sum() / 499
    assert total == pytest.approx(2 * weight, rel=0.02)
    assert np.abs(log.poses[-1, :, :3] - log.poses[0, :, :3]).max() < 1e-3


def test_the_peak_of_a_blow_is_that_of_a_moment_however_many_there_are_in_a_tick() -> None:
    log = run(falling_egg(0.005), duration=0.1)
    mean = np.abs(np.einsum("ci,ci->c", log.contacts.force, log.contacts.normal))
    # Of the four moments of a tick each has its force: the greatest is more than their mean, and less than their sum.
    assert len(mean) and (log.contacts.peak > 1.1 * mean).all()
    assert np.median(log.contacts.peak / mean) < 3.0


def test_a_diverging_simulation_is_invalid_and_says_when_and_where() -> None:
    composed = scene(falling_egg(0.2))
    world = compile_world(composed)
    world.spec.option.gravity = [0.0, 0.0, -1e12]
    program = read_program(parse_term("wait(0.01)"), composed)
    with pytest.raises(InvalidSimulationError, match=r"the simulation became unstable at 0\.\d{3} s at egg1"):
        simulate(world, program, duration=0.5)


def test_a_run_in_which_the_engine_has_no_room_for_all_contacts_is_invalid() -> None:
    composed = scene(TWO_BLOCKS)
    world = compile_world(composed)
    world.spec.memory = 3000
    program = read_program(parse_term("wait(0.01)"), composed)
    with pytest.raises(
        InvalidSimulationError, match=r"unstable at 0\.\d{3} s at block\d \(mjWARN_CONTACTFULL, mjWARN_CNSTRFULL\)"
    ):
        simulate(world, program, duration=0.05)


def test_things_that_overlap_at_the_start_are_refused() -> None:
    with pytest.raises(KnowledgeError, match=r"egg1 and block1 overlap by \d+\.\d mm at the start"):
        compile_world(scene(":floor a :Floor . :block1 a :Block ; :z 0.3 . :egg1 a :Egg ; :z 0.33 ."))


def test_a_thing_with_nothing_under_its_place_is_refused() -> None:
    with pytest.raises(KnowledgeError, match="block1 cannot rest on table1: there is nothing of it under its place"):
        scene(":floor a :Floor . :table1 a :Table . :block1 a :Block ; :x 5.0 ; :on :table1 .")


def test_things_that_rest_on_each_other_in_a_circle_are_refused() -> None:
    with pytest.raises(KnowledgeError, match="block1, block2 rest on or are in each other, in a circle"):
        scene(":block1 a :Block ; :on :block2 . :block2 a :Block ; :on :block1 .")


def test_an_egg_lowered_into_a_bowl_rests_in_it() -> None:
    log = run(":floor a :Floor . :bowl1 a :Bowl ; :on :floor . :egg1 a :Egg ; :on :bowl1 .", duration=0.5)
    assert log.poses[-1, log.index("egg1"), 2] < 0.04
    assert len(log.detachments.tick) == 0


def test_two_eggs_that_break_at_once_both_touch_the_floor() -> None:
    log = run(":floor a :Floor . :egg1 a :Egg ; :z 0.5 . :egg2 a :Egg ; :z 0.5004 ; :x 0.5 .", duration=0.5)
    floor = log.index("floor")
    for egg in (log.index("egg1"), log.index("egg2")):
        touching = (np.minimum(log.contacts.a, log.contacts.b) == min(egg, floor)) & (
            np.maximum(log.contacts.a, log.contacts.b) == max(egg, floor)
        )
        assert touching.any()
        assert egg in log.detachments.thing


def test_a_cup_is_gripped_at_its_middle() -> None:
    log = run(
        ":floor a :Floor . :table1 a :Table . :cup1 a :Cup ; :on :table1 ; :radius 0.03 . "
        ":hand1 a :Gripper ; :z 1.0 ; :pitch 90.0 .",
        "sequence([grasp(hand1, cup1, 10), lift(hand1, 0.1), hold(hand1, 0.2)])",
    )
    assert log.channels["hand1.pad_force"][-1] == pytest.approx(10.0, rel=0.02)
    assert log.poses[-1, log.index("cup1"), 2] - log.poses[0, log.index("cup1"), 2] == pytest.approx(0.1, abs=0.003)


def test_what_a_vessel_is_said_to_contain_is_put_into_it() -> None:
    known = scene(":floor a :Floor . :cup1 a :Cup ; :on :floor ; :contains :ball1 . :ball1 a :Ball ; :radius 0.01 .")
    assert known.thing("ball1").position[2] == pytest.approx(0.015, abs=1e-3)


REFUSED = [
    (":floor a :Floor . :ball1 a :Ball ; :on :floor ; :radius 0.0001 .", "ball1 is too small or light: "),
    (":floor a :Floor . :egg1 a :Egg ; :length 0.5 ; :breadth 0.01 ; :mass 0.026 .", "allowed: a breadth of 0.5 to 2"),
    (":floor a :Floor . :egg1 a :Egg ; :on :floor ; :broken true .", "egg1 is broken at the start"),
    (":floor a :Floor . :hand1 a :Gripper ; :on :floor .", "a Gripper does not rest on anything; state its z"),
]


@pytest.mark.parametrize(("situation", "message"), REFUSED)
def test_what_cannot_be_simulated_is_refused(situation: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        run(situation, duration=0.01)


def test_a_duration_out_of_range_is_refused() -> None:
    for duration in (1e-9, 1e9):
        with pytest.raises(ScenarioError, match=r"duration: .* s is not between 0\.001 and 600 s"):
            run(TWO_BLOCKS, duration=duration)


def test_a_world_in_which_nothing_moves_runs() -> None:
    assert run(":floor a :Floor .", duration=0.02).tick_count == 20
