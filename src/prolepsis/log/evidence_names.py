"""What evidence is called, with its SI unit: what groundings measure, and what actions note of themselves."""

from __future__ import annotations

from collections.abc import Mapping

EVIDENCE_UNITS: Mapping[str, str] = {
    "share": "1",
    "fraction": "1",
    "spilled_before": "1",
    "spilled_after": "1",
    "over_rim": "1",
    "through_holes": "1",
    "fill": "1",
    "largest": "1",
    "second": "1",
    "depth": "m",
    "volume": "m3",
    "mass": "kg",
    "force": "N",
    "peak_force": "N",
    "mean_force": "N",
    "pad_force": "N",
    "peak_pad_force": "N",
    "command": "N",
    "level": "N",
    "impulse": "N s",
    "speed": "m/s",
    "slip_speed": "m/s",
    "distance": "m",
    "slip": "m",
    "height": "m",
    "behind": "rad",
    "opening_before": "m",
    "opening_after": "m",
    "tilt": "rad",
    "tilt_before": "rad",
    "bonds": "1",
    "parts": "1",
    "pieces": "1",
    "pieces_off": "1",
    "tries": "1",
    "by": "",
    "ends": "",
    "outcome": "",
    "reason": "",
    "source": "",
}
"""By name; the unit of a name or a text is empty. A level may be a name, too."""
