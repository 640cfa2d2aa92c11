"""The page "How right is it?" gives the case that is farthest off, and tells what falls short."""

from __future__ import annotations

import contextlib
from typing import Any

import pytest
from tests.comparing import PROPERTY, Row, comparing
from tools.how_right import page


def row(measured: float, expected: float, **more: Any) -> Row:
    """Return the row of a comparison of two lengths."""
    found: list[Any] = []
    compare = comparing(lambda _, each: found.append(each))
    with contextlib.suppress(AssertionError):
        compare("how long", measured, expected, by="a ruler", **more)
    return Row(**found[0])


def test_a_row_gives_the_case_that_is_farthest_off() -> None:
    rows = [row(1.01, 1.0, share=0.05, unit="m"), row(2.06, 2.0, share=0.05, unit="m")]
    text = page([("tests/comparing.py::test", each, "") for each in rows])
    assert "| how long | a ruler | 2 | 2.06 m, expected 2 m | 3 % | 5 % |" in text
    assert "falls short\n\nKnown" not in text


def test_what_is_known_to_fail_falls_short_with_its_reason() -> None:
    text = page([("tests/comparing.py::test[long]", row(3.0, 2.0, within=0.5, unit="m"), "it is bent")])
    assert "| how long | long | a ruler | 3 m | 2 m | it is bent |" in text


def test_a_truth_is_counted() -> None:
    rows = [row(True, True), row(False, False), row(True, False)]
    text = page([("tests/comparing.py::test", each, "") for each in rows])
    assert "| how long | a ruler | 3 | 2 of 3 right | | |" in text


def test_what_is_too_far_off_fails_and_is_told() -> None:
    told: list[tuple[str, Any]] = []
    compare = comparing(lambda name, each: told.append((name, each)))
    compare("how long", 1.5, (1.0, 2.0), by="a ruler", unit="m")
    with pytest.raises(AssertionError, match="how long: 2.5 m, expected 1 to 2, 0 beside it at most"):
        compare("how long", 2.5, (1.0, 2.0), by="a ruler", unit="m")
    assert [name for name, _ in told] == [PROPERTY, PROPERTY]
