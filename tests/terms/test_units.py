"""Units: numbers with a unit become SI numbers, and a wrong dimension is refused in one line."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from prolepsis.terms.errors import InputError
from prolepsis.terms.units import qudt_symbol, read_quantity, si_symbol, to_si, unit_of

SYMBOLS = ("g", "mm", "min", "deg", "degC", "kN", "N/mm", "g/cm3", "mPa s", "mN/m", "km/s", "m/s^2", "l", "%", "MPa")


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [
        (58.0, "g", 0.058),
        (1.0, "", 1.0),
        (12.0, "%", 0.12),
        (150.0, "N/mm", 150e3),
        (1.035, "g/cm3", 1035.0),
        (1.5, "mPa s", 1.5e-3),
        (47.5, "mN/m", 0.0475),
        (9.81, "m/s^2", 9.81),
        (9.81, "m s^-2", 9.81),
        (1.0, "kg·m/s²", 1.0),
        (180.0, "deg", math.pi),
        (20.0, "degC", 293.15),
        (-40.0, "°C", 233.15),
        (2.0, "l", 2e-3),
        (2.0, "L", 2e-3),
        (100.0, "mL", 1e-4),
        (0.5, "min", 30.0),
        (3.0, "kN/m2", 3000.0),
    ],
)
def test_a_value_becomes_si(value: float, unit: str, expected: float) -> None:
    assert to_si(value, unit) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(("unit", "si"), [("g", "kg"), ("N/mm", "N/m"), ("kN/m2", "Pa"), ("degC", "K"), ("%", "1")])
def test_the_si_unit_of_a_dimension_has_its_usual_name(unit: str, si: str) -> None:
    assert si_symbol(unit_of(unit)) == si


@given(st.floats(-1e6, 1e6), st.sampled_from(SYMBOLS))
def test_conversion_is_linear_and_lands_in_the_named_si_unit(value: float, symbol: str) -> None:
    unit = unit_of(symbol)
    assert to_si(value, symbol) == unit.factor * value + unit.offset
    assert to_si(to_si(value, symbol), si_symbol(unit), symbol) == to_si(value, symbol)


@pytest.mark.parametrize("text", ["stone", "5", "N//m", "kkg", "N^x", "m^", "/s", "µm", "N-m"])
def test_an_unknown_unit_is_refused_in_one_line_with_the_known_ones(text: str) -> None:
    with pytest.raises(InputError) as caught:
        unit_of(text)
    message = str(caught.value)
    assert message.startswith(f"no unit {text!r}; known: ") and "kg/m3" in message and "\n" not in message


@pytest.mark.parametrize(("unit", "expected"), [("N", "kg"), ("deg", "m"), ("1", "m"), ("N m", "N"), ("Pa", "Pa s")])
def test_a_wrong_dimension_is_refused_in_one_line(unit: str, expected: str) -> None:
    with pytest.raises(InputError) as caught:
        to_si(1.0, unit, expected)
    assert str(caught.value) == f"unit {unit!r} does not fit: a unit such as {expected!r} is needed"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("58 g", (58.0, "g")),
        ("58g", (58.0, "g")),
        (" -1.5e-3 m ", (-1.5e-3, "m")),
        (".5", (0.5, "")),
        ("force7", None),
        ("true", None),
        ("", None),
        ("information", None),
        ("nano", None),
    ],
)
def test_a_quantity_is_a_number_and_perhaps_a_unit(text: str, expected: tuple[float, str] | None) -> None:
    assert read_quantity(text) == expected


def test_nan_and_infinity_are_read_as_numbers_so_that_they_are_refused_as_such() -> None:
    read = read_quantity("nan")
    assert read is not None and math.isnan(read[0])
    assert read_quantity("-inf kg") == (-math.inf, "kg")


def test_only_units_that_are_used_have_a_qudt_name() -> None:
    assert qudt_symbol("KiloGM-PER-M3") == "kg/m3"
    assert qudt_symbol("FURLONG") is None
