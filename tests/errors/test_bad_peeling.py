"""What cannot be peeled, and by whom, is refused with one clear line before anything moves."""

from __future__ import annotations

import pytest
from tests.scenes import EGG_IN_HAND, scene

from prolepsis.programs import read_program
from prolepsis.terms.errors import PlanError
from prolepsis.terms.reader import parse_term

RAW = EGG_IN_HAND + " :hand2 a :Gripper ; :x 0.5 ; :z 0.9 ."
BOILED = RAW.replace(":Egg", ":HardBoiledEgg")

REFUSED = [
    (BOILED, "peel(hand1, hand1, egg1, 3)", "^plan: hand1 cannot peel egg1 alone; name another gripper$"),
    (BOILED, "peel(hand1, hand2, egg1, 3)", "^plan: hand1 and hand2 are not on two arms of one robot$"),
    (RAW, "peel(hand1, hand2, egg1, 3)", "^plan: egg1 cannot be peeled: it has no shell round a firm kernel$"),
    (RAW, "peel(hand1, hand2, table1, 3)", "^plan: table1 cannot be peeled: it has no shell round a firm kernel$"),
    (
        BOILED,
        "peel(hand1, hand2, egg1)",
        r"^plan: peel\(hand1,hand2,egg1\) has 3 arguments, needed: peel\(Hand, Other,",
    ),
]


@pytest.mark.parametrize(("situation", "plan", "message"), REFUSED)
def test_what_cannot_be_peeled_is_refused(situation: str, plan: str, message: str) -> None:
    with pytest.raises(PlanError, match=message):
        read_program(parse_term(plan), scene(situation))
