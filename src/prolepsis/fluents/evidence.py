"""What physics allows of the numbers behind a fact: a number outside its range is no evidence, and no answer either."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from prolepsis.log.timeline import Evidence
from prolepsis.terms.errors import InvalidSimulationError

ROUNDING = 1.0e-9
"""Sums of shares are off by no more than this [1]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Range:
    """The least and the greatest value that a quantity can have, whatever happens."""

    least: float
    greatest: float
    why: str
    """What it is, with its unit, and what bounds it."""


def _share(of: str) -> Range:
    return Range(least=0.0, greatest=1.0, why=f"{of} [1]: a part of a whole")


def _positive(what: str) -> Range:
    return Range(least=0.0, greatest=math.inf, why=f"{what}: a magnitude")


def _count(of: str) -> Range:
    return Range(least=1.0, greatest=math.inf, why=f"{of}: there is at least one, or there is no fact")


RANGES: Mapping[str, Range] = {
    "share": _share("what bears a thing, of all that bears it"),
    "fraction": _share("mass of a stuff or volume of a thing"),
    "fraction_mean": _share("mass of a stuff"),
    "fraction_least": _share("mass of a stuff"),
    "fraction_at_end": _share("mass of a stuff"),
    "spilled_before": _share("mass of a stuff"),
    "spilled_after": _share("mass of a stuff"),
    "over_rim": _share("mass of an outflow"),
    "through_holes": _share("mass of an outflow"),
    "fill": _share("of the capacity of a vessel, which is at least what it holds"),
    "largest": _share("mass of a shell"),
    "second": Range(least=0.0, greatest=0.5, why="mass of a shell [1]: there is one at least as large"),
    "depth": _positive("distance below a rim, or of a rim from where it was [m]"),
    "volume": _positive("volume [m^3]"),
    "mass": _positive("mass [kg]"),
    "area": _positive("area of a film [m^2]"),
    "area_at_end": _positive("area of a film [m^2]"),
    "force": _positive("magnitude of a force [N]"),
    "bears": _positive("greatest force that is borne [N]"),
    "peak_force": _positive("normal force, and contacts only push [N]"),
    "mean_force": _positive("normal force, and contacts only push [N]"),
    "pad_force": _positive("normal force, and contacts only push [N]"),
    "command": _positive("force that is asked for [N]"),
    "level": _positive("force that is asked for [N]"),
    "impulse": _positive("impulse of a force that only pushes [N s]"),
    "speed": _positive("magnitude of a velocity [m/s]"),
    "slip_speed": _positive("magnitude of a velocity [m/s]"),
    "distance": _positive("length of a path [m]"),
    "slip": _positive("displacement [m]"),
    "height": _positive("height of a fall [m]"),
    "opening_before": _positive("gap between two pads that do not pass through each other [m]"),
    "opening_after": _positive("gap between two pads that do not pass through each other [m]"),
    "tilt": Range(least=0.0, greatest=math.pi, why="angle between two directions [rad]"),
    "tilt_before": Range(least=0.0, greatest=math.pi, why="angle between two directions [rad]"),
    "angle": Range(least=0.0, greatest=math.pi, why="angle between two directions [rad]"),
    "bonds": _count("detached bonds"),
    "parts": _count("parts of a shell"),
    "equal_parts": _count("parts of a shell"),
}
"""The numbers that are measured in a log, by name. Of others, which actions note, it is known that they are finite."""


def possible(fact: str, evidence: Evidence) -> dict[str, float | str]:
    """Return the evidence of a fact, once it is sure that it is possible.

    Raises:
        InvalidSimulationError: If a number is not finite, or outside its range.
    """
    found: dict[str, float | str] = {}
    for name, value in evidence.items():
        found[name] = value if isinstance(value, str) else _within(fact, name, float(value))
    return found


def _within(fact: str, name: str, value: float) -> float:
    known = RANGES.get(name)
    least, greatest = (known.least, known.greatest) if known is not None else (-math.inf, math.inf)
    if not math.isfinite(value) or not least - ROUNDING <= value <= greatest + ROUNDING:
        why = f" ({known.why})" if known is not None else ""
        raise InvalidSimulationError(f"{fact}: {name} would be {value:g}; possible is {least:g} to {greatest:g}{why}")
    return min(max(value, least), greatest)
