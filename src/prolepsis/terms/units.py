"""Units: numbers with a unit become SI numbers, and a wrong dimension is refused.

A unit is written as a product and quotient of symbols with whole powers: ``N``, ``g``, ``kg/m3``,
``m/s^2``, ``N/mm``, ``Pa s``, ``mN/m``, ``deg``, ``degC``.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import lru_cache

from prolepsis.terms.errors import InputError, brief

Dimension = tuple[int, int, int, int, int]
"""Powers of kilogram, metre, second, kelvin and radian."""

_KG: Dimension = (1, 0, 0, 0, 0)
_M: Dimension = (0, 1, 0, 0, 0)
_S: Dimension = (0, 0, 1, 0, 0)
_K: Dimension = (0, 0, 0, 1, 0)
_RAD: Dimension = (0, 0, 0, 0, 1)
_NONE: Dimension = (0, 0, 0, 0, 0)
_N: Dimension = (1, 1, -2, 0, 0)
_PA: Dimension = (1, -1, -2, 0, 0)
_J: Dimension = (1, 2, -2, 0, 0)

ZERO_CELSIUS = 273.15
"""0 degC [K]; by definition."""


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit: ``SI value = factor * value + offset``."""

    symbol: str
    """How it is written, ``N/mm``."""
    factor: float
    """Size in SI units."""
    dimension: Dimension
    """Powers of the base units."""
    offset: float = 0.0
    """Zero point in SI units; only temperatures on a scale have one."""


_BASES: dict[str, tuple[float, Dimension]] = {
    "1": (1.0, _NONE),
    "%": (0.01, _NONE),
    "g": (1e-3, _KG),
    "m": (1.0, _M),
    "s": (1.0, _S),
    "min": (60.0, _S),
    "K": (1.0, _K),
    "rad": (1.0, _RAD),
    "deg": (math.pi / 180.0, _RAD),
    "N": (1.0, _N),
    "Pa": (1.0, _PA),
    "J": (1.0, _J),
    "l": (1e-3, (0, 3, 0, 0, 0)),
    "L": (1e-3, (0, 3, 0, 0, 0)),
    "Hz": (1.0, (0, 0, -1, 0, 0)),
}
_PREFIXES = {"G": 1e9, "M": 1e6, "k": 1e3, "c": 1e-2, "m": 1e-3, "u": 1e-6}
_PREFIXED = ("g", "m", "s", "N", "Pa", "J", "l", "L")
_SYMBOL = re.compile(r"([A-Za-z%]+|1)(?:\^?(-?[0-9]))?")
"""A symbol and its power of one digit; more would be no quantity of this world."""

_QUDT = {
    "UNITLESS": "1",
    "KiloGM": "kg",
    "KiloGM-PER-M3": "kg/m3",
    "M": "m",
    "M3": "m3",
    "SEC": "s",
    "K": "K",
    "DEG_C": "degC",
    "DEG": "deg",
    "RAD": "rad",
    "N": "N",
    "PA": "Pa",
    "PA-SEC": "Pa s",
    "N-PER-M": "N/m",
    "J-PER-M2": "J/m2",
    "M-PER-SEC": "m/s",
    "M-PER-SEC2": "m/s2",
}
"""QUDT unit names that the ontology uses, with the symbol of each."""


def _factor(symbol: str) -> tuple[float, Dimension] | None:
    if symbol in _BASES:
        return _BASES[symbol]
    for base in _PREFIXED:
        prefix = symbol.removesuffix(base)
        if prefix != symbol and prefix in _PREFIXES:
            factor, dimension = _BASES[base]
            return _PREFIXES[prefix] * factor, dimension
    return None


@lru_cache(maxsize=256)
def unit_of(symbol: str) -> Unit:
    """Return the unit that is written ``symbol``; the empty string is the number one.

    Raises:
        InputError: If there is no such unit.
    """
    text = symbol.strip() or "1"
    if text in ("degC", "°C"):
        return Unit(symbol=text, factor=1.0, dimension=_K, offset=ZERO_CELSIUS)
    factor, powers = 1.0, [0, 0, 0, 0, 0]
    numerator, *denominators = text.replace("²", "2").replace("³", "3").split("/")
    groups = [(1, numerator)] + [(-1, part) for part in denominators]
    for sign, group in groups:
        for piece in re.split(r"[\s*·]+", group.strip()):
            match = _SYMBOL.fullmatch(piece)
            found = _factor(match.group(1)) if match else None
            if match is None or found is None:
                raise InputError(
                    f"no unit {brief(repr(symbol))}; known: products and quotients of {', '.join(_BASES)}, degC, "
                    f"with the prefixes {', '.join(_PREFIXES)}, such as kg/m3, N/mm, Pa s"
                )
            power = sign * int(match.group(2) or 1)
            factor *= found[0] ** power
            powers = [old + power * new for old, new in zip(powers, found[1], strict=True)]
    return Unit(symbol=text, factor=factor, dimension=(powers[0], powers[1], powers[2], powers[3], powers[4]))


def qudt_symbol(name: str) -> str | None:
    """Return the symbol of the QUDT unit called ``name`` (``KiloGM``), or None if it is not used here."""
    return _QUDT.get(name)


@lru_cache(maxsize=256)
def si_symbol(unit: Unit) -> str:
    """Return how the SI unit of ``unit``'s dimension is written (``kg`` for ``g``)."""
    for symbol in _SI_NAMES:
        if unit_of(symbol).dimension == unit.dimension:
            return symbol
    names = zip(("kg", "m", "s", "K", "rad"), unit.dimension, strict=True)
    return " ".join(name if power == 1 else f"{name}^{power}" for name, power in names if power)


_SI_NAMES = (
    "1",
    "kg",
    "m",
    "s",
    "K",
    "rad",
    "rad/s",
    "N",
    "N/m",
    "Pa",
    "Pa s",
    "J",
    "kg/m3",
    "m/s",
    "m/s2",
    "m3",
    "Hz",
)


def to_float(number: float) -> float:
    """Return a number as a float, an integer that is too large for one as infinite."""
    try:
        return float(number)
    except OverflowError:
        return math.inf if number > 0 else -math.inf


def to_si(value: float, unit: str, expected: str | None = None) -> float:
    """Return ``value`` in SI units.

    Args:
        value: Number in ``unit``.
        unit: How the unit is written.
        expected: A unit of the dimension that the number must have; any if None.

    Raises:
        InputError: If the unit is unknown or of another dimension than expected.
    """
    given = unit_of(unit)
    if expected is not None and given.dimension != unit_of(expected).dimension:
        raise InputError(f"unit {brief(repr(unit))} does not fit: a unit such as {expected!r} is needed")
    return value * given.factor + given.offset


LONGEST_QUANTITY = 1000
"""Longest text that is read as a quantity [characters]."""
_QUANTITY = re.compile(
    r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?(?:nan|inf(?:inity)?)\b)\s*(.*)", re.I | re.DOTALL
)


def read_quantity(text: str) -> tuple[float, str] | None:
    """Return number and unit symbol of ``"58 g"`` (the unit may be empty), or None if it is no quantity."""
    match = _QUANTITY.fullmatch(text.strip()) if len(text) <= LONGEST_QUANTITY else None
    return None if match is None else (float(match.group(1)), match.group(2))
