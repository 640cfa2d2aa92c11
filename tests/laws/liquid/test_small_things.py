"""What is denser than water sinks in it, however small."""

from __future__ import annotations

import pytest
from tests.laws.rest_scenes import cup
from tests.scenes import run


@pytest.mark.laws
@pytest.mark.parametrize(
    "what",
    [
        pytest.param(
            ":b a :MandM ; :z 0.9 . ",
            marks=pytest.mark.xfail(strict=True, reason="liquid: what weighs as much as four particles does not sink"),
            id="a hard candy",
        ),
        pytest.param(":b a :Ball ; :radius 0.01 ; :density 7800.0 ; :z 0.9 . ", id="a steel ball"),
    ],
)
def test_what_is_denser_than_water_sinks(what: str) -> None:
    log = run(cup(0.5, what), duration=2.0, particles=800)
    assert log.poses[-1, log.index("b"), 2] < 0.725
