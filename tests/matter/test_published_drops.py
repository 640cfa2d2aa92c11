"""Eggs that others have dropped: beside what became of theirs."""

from __future__ import annotations

import math

import pytest
from tests.comparing import Compare
from tests.matter.test_padding import broken, dropped
from tests.scenes import falling_egg, run

PLATE = "Commun. Phys. 2025, 20 eggs of each posture, dropped from 8 mm (its press release)"
LATE = "half of the standing eggs crack from 10 mm, a third at 8: see docs/egg.md"
STIFF = "only the foam under the egg bears: see docs/egg.md"


def cracking_height(standing: bool) -> float:
    """Return from what height a mean egg cracks on a hard floor [m], to 0.1 mm."""
    low, high = 0.001, 0.03
    while high - low > 1e-4:
        middle = (low + high) / 2
        log = run(falling_egg(middle, standing=standing), duration=math.sqrt(2 * middle / 9.81) + 0.004)
        low, high = (low, middle) if broken(log) else (middle, high)
    return high


@pytest.mark.laws
@pytest.mark.parametrize(
    ("standing", "expected"),
    [
        pytest.param(False, (8.0, 100.0), id="lying"),
        pytest.param(True, (0.0, 8.0), id="standing", marks=pytest.mark.xfail(strict=True, reason=LATE)),
    ],
)
def test_half_of_the_eggs_crack_from_a_height(compare: Compare, standing: bool, expected: tuple[float, float]) -> None:
    """Fewer than a tenth of the lying ones cracked, and more than half of the standing."""
    height = 1000 * cracking_height(standing)
    compare("height from which half of the eggs crack", height, expected, by=PLATE, unit="mm")


CARPET = ":floor a :Carpet ; :paddingThickness 0.02 ."
TOWEL = ":floor a :Floor . :soft1 a :Towel ; :on :floor ; :height 0.01 ."
FOAM = ":floor a :Floor . :soft1 a :FoamPad ; :on :floor ; :height 0.05 ."


@pytest.mark.laws
@pytest.mark.parametrize(
    ("soft", "top", "height", "breaks", "by"),
    [
        (CARPET, 0.0, 0.4, False, "a textbook's exercise"),
        (TOWEL, 0.01, 1.2, True, "a pupils' experiment"),
        pytest.param(FOAM, 0.05, 12.0, False, "exercises", marks=pytest.mark.xfail(strict=True, reason=STIFF)),
    ],
    ids=["0.4 m on a carpet of 2 cm", "1.2 m on a towel in five layers", "12 m on foam rubber of 5 cm"],
)
def test_an_egg_that_falls_on_what_is_soft_breaks_or_not(
    compare: Compare, soft: str, top: float, height: float, breaks: bool, by: str
) -> None:
    found = broken(dropped(soft, top, height, after=0.03))
    compare("an egg that falls on what is soft breaks", found, breaks, by=by)
