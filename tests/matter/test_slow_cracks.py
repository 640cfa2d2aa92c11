"""Laws of slow cracks: how much more a shell bears for a short time, and how much less for a long one."""

from __future__ import annotations

import pytest

from prolepsis.matter.shells.slow_cracks import SlowCracks


def shell() -> SlowCracks:
    return SlowCracks(exponent=30.0, time=5.0, most=1.5)


def breaking_load(rate: float, step: float) -> float:
    """Return the load at which a shell breaks that rises at a rate [1/s], in steps of a time [s]."""
    slow, load = shell(), 0.0
    while slow.share(load) < 1:
        slow.bear(load, load + rate * step, step)
        load += rate * step
    return load


@pytest.mark.parametrize("step", [0.01, 0.002])
def test_in_the_test_it_breaks_at_its_breaking_force(step: float) -> None:
    assert breaking_load(1 / 5.0, step) == pytest.approx(1.0, rel=2e-3)


@pytest.mark.parametrize("faster", [0.1, 10.0, 100.0])
def test_the_faster_the_load_rises_the_more_it_bears(faster: float) -> None:
    # At a steady rate the load at breaking goes as the (n + 1)th root of the rate.
    assert breaking_load(faster / 5.0, 1e-3 / faster) == pytest.approx(faster ** (1 / 31), rel=2e-3)


def test_it_bears_no_more_than_the_most() -> None:
    assert breaking_load(1e9, 1e-12) == pytest.approx(1.5, rel=2e-3)


def test_under_a_steady_load_it_breaks_in_a_time_that_falls_with_its_power() -> None:
    for load in (0.9, 1.0, 1.1):
        slow, time = shell(), 5.0 / 31 / load**30
        slow.bear(load, load, 0.99 * time)
        assert slow.share(load) < 1
        slow.bear(load, load, 0.02 * time)
        assert slow.share(load) >= 1


def test_the_share_is_that_of_all_loads_so_far() -> None:
    # Loads greater by the inverse of the share would have broken it just now.
    slow, other = shell(), shell()
    slow.bear(0.0, 0.8, 1e-3)
    share = slow.share(0.8)
    other.bear(0.0, 0.8 / share, 1e-3)
    assert share < 0.8
    assert other.share(0.8 / share) == pytest.approx(1.0)
    assert slow.share(0.4) == pytest.approx(share / 2)


def test_without_an_exponent_it_has_no_memory() -> None:
    plain = SlowCracks.of({})
    plain.bear(0.0, 0.99, 1e6)
    assert plain.share(0.99) == 0.99
    assert plain.share(1.0) == 1.0
