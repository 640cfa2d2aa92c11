"""Laws: intervals are maximal and never empty, and recognition does not depend on where or in what order things are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.fluents.worlds import FLOOR, STEP, ball, box, cup_geoms, free, roll, world

from prolepsis.fluents import recognize
from prolepsis.fluents.intervals import close_gaps, debounce, drop_short, hysteresis, mask_of, runs, ticks_of, union
from prolepsis.geometry.hull import hull_planes
from prolepsis.geometry.rotations import multiply, rotate
from prolepsis.geometry.shape import BoolArray, FloatArray
from prolepsis.log.log import Contacts, Log
from prolepsis.log.timeline import Timeline
from prolepsis.terms.ticks import Ticks
from prolepsis.terms.ticks import ticks_of as exact_ticks

masks = st.lists(st.booleans(), min_size=1, max_size=60).map(lambda values: np.array(values, dtype=np.bool_))
ticks = st.integers(min_value=1, max_value=8)
quick = settings(deadline=None, max_examples=60)


@quick
@given(masks)
def test_runs_are_the_mask_again(mask: BoolArray) -> None:
    found = runs(mask)
    assert (mask_of(found, len(mask)) == mask).all()
    assert (found[:, 1] > found[:, 0]).all()
    assert (found[1:, 0] > found[:-1, 1]).all()


@quick
@given(masks, ticks, ticks)
def test_debouncing_leaves_no_short_gap_and_no_short_run(mask: BoolArray, gap: int, least: int) -> None:
    found = debounce(mask, 0.001, gap=gap * 0.001, least=least * 0.001)
    assert (found[1:, 0] - found[:-1, 1] > gap).all()
    assert (found[:, 1] - found[:, 0] >= least).all()
    assert set(found.ravel().tolist()) <= set(runs(mask).ravel().tolist())


@quick
@given(masks, ticks)
def test_debouncing_twice_changes_nothing(mask: BoolArray, gap: int) -> None:
    once = close_gaps(runs(mask), gap)
    assert (close_gaps(once, gap) == once).all()
    assert (drop_short(drop_short(once, gap), gap) == drop_short(once, gap)).all()


@quick
@given(masks, masks)
def test_a_union_covers_what_either_covers(first: BoolArray, second: BoolArray) -> None:
    count = max(len(first), len(second))
    both = mask_of(union([runs(first), runs(second)]), count)
    expected = mask_of(runs(first), count) | mask_of(runs(second), count)
    assert (both == expected).all()


@quick
@given(masks, masks)
def test_hysteresis_keeps_whole_runs_that_get_high(low: BoolArray, high: BoolArray) -> None:
    count = min(len(low), len(high))
    kept = {tuple(run) for run in hysteresis(low[:count], high[:count]).tolist()}
    assert kept == {(a, b) for a, b in runs(low[:count]).tolist() if high[a:b].any()}


@quick
@given(st.floats(min_value=0.0005, max_value=0.05), st.floats(min_value=0.001, max_value=1.0))
def test_debouncing_is_in_seconds_whatever_the_tick(dt: float, seconds: float) -> None:
    assert abs(ticks_of(seconds, dt) * dt - seconds) <= max(dt / 2, dt - seconds) + 1e-12


@quick
@given(st.integers(min_value=0, max_value=2**32 - 1), st.integers(min_value=4, max_value=40))
def test_a_hull_holds_its_points_and_touches_them(seed: int, count: int) -> None:
    points = np.random.default_rng(seed).normal(size=(count, 3))
    planes = hull_planes(points)
    distance = points @ planes[:, :3].T - planes[:, 3]
    assert distance.max() < 1e-6
    assert np.allclose(distance.max(axis=0), 0.0, atol=1e-6)


def busy() -> Log:
    """Return a log in which a ball drops into a cup, a box tips over and a box slides into another."""
    things = free("cup", "0 0 .0001", cup_geoms(wall=0.008)) + ball("ball", "0 0 .2", 0.02)
    things += box("tall", ".5 0 .1", ".02 .05 .1", 0.5) + box("slow", "0 .5 .05") + box("fast", "-.3 .5 .05")

    def push(model: object, data: object) -> None:
        if data.time == 0:  # type: ignore[attr-defined]
            data.qvel[16], data.qvel[24] = 9.0, 2.5  # type: ignore[attr-defined]

    model, states = roll(world(FLOOR + things), 0.8, push)
    return Log.from_mujoco(model, states, STEP)


LOG = busy()
PLAIN = recognize(LOG)


def moved(log: Log, yaw: float, shift: FloatArray) -> Log:
    """Return a log of the same world turned about the vertical and shifted."""
    turn = np.array([np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)])
    poses = log.poses.copy()
    poses[..., :3] = rotate(turn, log.poses[..., :3]) + shift
    poses[..., 3:] = multiply(np.broadcast_to(turn, poses[..., 3:].shape), log.poses[..., 3:])
    contacts = replace(
        log.contacts,
        force=rotate(turn, log.contacts.force),
        normal=rotate(turn, log.contacts.normal),
        point=rotate(turn, log.contacts.point) + shift,
    )
    return replace(log, poses=poses, contacts=contacts)


def reordered(log: Log, order: list[int]) -> Log:
    """Return the same log with its things in another order."""
    place = np.argsort(order)
    a, b = place[log.contacts.a], place[log.contacts.b]
    sign = np.where(a > b, -1.0, 1.0)[:, None]
    contacts = Contacts(
        tick=log.contacts.tick,
        a=np.minimum(a, b),
        b=np.maximum(a, b),
        force=log.contacts.force * sign,
        normal=log.contacts.normal * sign,
        point=log.contacts.point,
        peak=log.contacts.peak,
    )
    things = tuple(log.things[i] for i in order)
    return replace(
        log, things=things, poses=log.poses[:, order], carrier=place[log.carrier[:, order]], contacts=contacts
    )


def same(first: Timeline, second: Timeline) -> bool:
    """Return whether two timelines hold the same facts; a tick of difference is rounding at a threshold."""
    one, two = (sorted((str(f.term), f.start, f.end) for f in t.facts) for t in (first, second))
    return [fact[0] for fact in one] == [fact[0] for fact in two] and all(
        abs(p[1] - q[1]) < 1.5 * STEP and abs(p[2] - q[2]) < 1.5 * STEP for p, q in zip(one, two, strict=True)
    )


def test_much_happens_in_the_log_of_the_laws() -> None:
    assert {"falling", "colliding", "contains", "supports", "moving", "contacts"} <= {f.type for f in PLAIN.facts}


@settings(max_examples=8, deadline=None)
@given(st.floats(-3.1, 3.1), st.tuples(*[st.floats(-5.0, 5.0)] * 3))
def test_where_the_world_stands_and_faces_makes_no_difference(yaw: float, shift: tuple[float, float, float]) -> None:
    assert same(PLAIN, recognize(moved(LOG, yaw, np.array(shift))))


@settings(max_examples=8, deadline=None)
@given(st.permutations(range(len(LOG.things))))
def test_the_order_of_the_things_makes_no_difference(order: list[int]) -> None:
    assert same(PLAIN, recognize(reordered(LOG, order)))


EXACT: Ticks = exact_ticks(LOG.dt)


def test_every_fact_ends_on_ticks_and_none_is_empty() -> None:
    instants = {EXACT.time(tick) for tick in range(LOG.tick_count + 1)}
    for fact in PLAIN.facts:
        assert fact.start in instants
        assert fact.end in instants
        assert fact.start < fact.end


def test_the_same_log_gives_the_same_bytes() -> None:
    assert recognize(LOG).to_json() == PLAIN.to_json()
