"""Fitting a damped wave, or a line, to what was measured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy import optimize  # pyright: ignore[reportMissingTypeStubs]

from prolepsis.geometry.shape import FloatArray


def damped_wave(times: Sequence[float], values: Sequence[float], frequency: float) -> tuple[float, float]:
    """Return the circular frequency [rad/s] and the damping [1/s] of a wave that dies out.

    Args:
        times: [s].
        values: Of any unit, about any middle.
        frequency: First guess [rad/s].
    """

    def wave(time: FloatArray, size: float, damping: float, turn: float, phase: float, middle: float) -> FloatArray:
        return size * np.exp(-damping * time) * np.cos(turn * time + phase) + middle

    guess = [values[0], 0.2 * frequency, frequency, 0.0, 0.0]
    fit: Any = optimize.curve_fit  # pyright: ignore[reportUnknownMemberType, reportUnknownVariableType]
    found = fit(wave, np.array(times), np.array(values), p0=guess, maxfev=5000)[0]
    return abs(float(found[2])), float(found[1])


def slope_of(x: FloatArray, y: FloatArray) -> float:
    """Return the slope of the line that fits best."""
    x = x - x.mean()
    return float((x * y).sum() / (x * x).sum())
