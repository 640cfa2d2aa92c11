"""What lands on a slope collides with it, by the same speed and impulse however short the substeps are."""

from __future__ import annotations

import math

import pytest
from tests.laws.rest_scenes import FLOOR, block
from tests.scenes import run

from prolepsis.fluents import recognize


@pytest.mark.parametrize(("degrees", "gap"), [(30.0, 0.002), (30.0, 0.001), (20.0, 0.0005)])
def test_a_landing_on_a_slope_is_the_same_at_every_substep(degrees: float, gap: float) -> None:
    angle, away = math.radians(degrees), 0.01 + 0.025 + gap
    ramp = (
        f":ramp a :Obstacle ; :z 0.3 ; :length 1.0 ; :width 0.3 ; :height 0.02 ; :pitch {degrees!r} ; :friction 0.4 . "
    )
    where = f":x {away * math.sin(angle)!r} ; :z {0.3 + away * math.cos(angle)!r} ; :pitch {degrees!r} ; :friction 0.4"
    met: list[tuple[float, float]] = []
    for substep in (1e-3, 5e-4, 2.5e-4, 1e-4):
        log = run(FLOOR + ramp + block("b", (0.1, 0.1, 0.05), where), duration=0.06, max_step=substep)
        first, *_ = recognize(log).select(type="colliding")
        met.append((float(first.evidence["speed"]), float(first.evidence["impulse"])))
    least = math.sqrt(2 * 9.81 * gap) * math.sqrt(math.cos(angle))
    for speed, impulse in met:
        assert speed == pytest.approx(least, rel=0.15)
        assert (speed, impulse) == pytest.approx(met[-1], rel=0.15)


@pytest.mark.parametrize("height", [0.05, 0.1, 0.2, 0.4])
def test_what_still_bounces_is_not_supported_yet(height: float) -> None:
    timeline = recognize(run(FLOOR + f":ball1 a :Ball ; :z {0.03 + height!r} .", duration=1.5))
    (support,) = (fact for fact in timeline.select(type="supports") if fact.args == ("floor", "ball1"))
    touching = [(fact.start, fact.end) for fact in timeline.select(type="contacts")]
    assert support.end == timeline.duration
    assert any(start <= support.start and end - start > 0.03 for start, end in touching if end > support.start)
    assert all(end <= support.start for start, end in touching if end - start < 0.03)
