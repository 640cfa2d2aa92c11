"""Ticks have one float each, which is the decimal that is printed of it, and every time near it is snapped to that."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.terms.allen import Interval, relation
from prolepsis.terms.ticks import ticks_of

LENGTHS = [0.001, 0.002, 0.01, 1 / 240, 1 / 60, 1 / 3, 0.0005, 0.025, 1.0, 1e-6, math.pi / 1000]


@pytest.mark.parametrize("dt", LENGTHS)
@given(number=st.integers(0, 10**7))
def test_a_tick_is_found_from_what_is_printed_of_it(dt: float, number: int) -> None:
    ticks = ticks_of(dt)
    time = ticks.time(number)
    assert ticks.number(time) == number
    assert ticks.snapped(number * dt) == time
    assert ticks.snapped(time) == time
    assert ticks.snapped(float(f"{time:.{ticks.decimals}f}")) == time


@given(number=st.integers(0, 10**9))
def test_milliseconds_are_their_decimals(number: int) -> None:
    assert ticks_of(0.001).time(number) == float(f"{number // 1000}.{number % 1000:03}")


@pytest.mark.parametrize(("dt", "time"), [(0.001, 1e299), (1e-300, 1.0), (1e14, 1e299)])
def test_a_time_of_too_many_ticks_is_left_as_it_is(dt: float, time: float) -> None:
    assert ticks_of(dt).snapped(time) == time


def test_imported_times_meet_where_they_were_meant_to() -> None:
    rows = [
        {"kind": "event", "type": "first", "start": 0.0, "end": 0.1 + 0.2},
        {"kind": "event", "type": "second", "start": 0.3, "end": 1.0000000001},
    ]
    first, second = Timeline.from_json(rows, dt=0.001, duration=2.0).facts
    assert relation(Interval(start=first.start, end=first.end), Interval(start=second.start, end=second.end)) == "meets"
    assert (first.end, second.end) == (0.3, 1.0)


def test_a_fact_within_a_tick_is_a_tick_long() -> None:
    fact = Fact(kind="event", type="tapping", start=0.0302, end=0.0303)
    (tapping,) = make_timeline([fact], dt=0.01, duration=1.0).facts
    assert (tapping.start, tapping.end) == (0.03, 0.04)
