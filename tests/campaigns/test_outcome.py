"""The outcome of a grasp follows from the timeline: a slip from a height is no crush, whatever breaks afterwards."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.synthetic import DT, LAND, TICKS, egg_drop_log

from prolepsis.campaigns.campaign import Outcomes, Row
from prolepsis.campaigns.outcome import Grasp, GraspOutcome, judge_grasp
from prolepsis.log.log import Log
from prolepsis.log.things import Thing
from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.terms.errors import InputError


def fact(kind: str, type: str, *args: str | float, start: float, end: float) -> Fact:
    return Fact(kind="event" if kind == "event" else "fluent", type=type, args=args, start=start, end=end)


GRASP = (
    fact("event", "grasping", "hand1", "egg1", "force7", start=0.0, end=0.1),
    fact("event", "lifting", "hand1", 0.1, start=0.1, end=0.2),
    fact("event", "holding", "hand1", 0.5, start=0.2, end=0.7),
)


def timeline(*more: Fact) -> Timeline:
    return make_timeline((*GRASP, *more), dt=DT, duration=TICKS * DT)


def log_with_hand() -> Log:
    """The synthetic drop with a hand that stands still from the start."""
    log = egg_drop_log()
    hand = (
        Thing(name="hand1", kind="Gripper", roles=frozenset({"Gripper"})),
        Thing(name="hand1/palm", kind="Palm", whole="hand1"),
    )
    still = np.zeros((TICKS, 2, 7))
    still[:, :, 3] = 1.0
    n = len(log.things)
    return replace(
        log,
        things=log.things + hand,
        poses=np.concatenate([log.poses, still], axis=1),
        carrier=np.concatenate([log.carrier, np.tile([-1, n + 1], (TICKS, 1))], axis=1),
        channels={**log.channels, "hand1.pad_force": np.linspace(0.0, 15.0, TICKS)},
    )


ATTACHED = fact("fluent", "attached", "hand1", "egg1", start=0.1, end=0.8)
TOUCHED = fact("fluent", "contacts", "hand1", "egg1", start=0.05, end=0.3)
SLIPPED = (
    fact("fluent", "attached", "hand1", "egg1", start=0.1, end=0.3),
    TOUCHED,
    fact("event", "falling", "egg1", start=0.3, end=0.5),
    fact("event", "breaking", "egg1", start=0.5, end=0.501),
    fact("fluent", "broken", "egg1", start=0.5, end=0.8),
)
CRUSHED = (
    TOUCHED,
    fact("event", "breaking", "egg1", start=0.09, end=0.1),
    fact("fluent", "broken", "egg1", start=0.09, end=0.8),
    fact("event", "falling", "egg1", start=0.4, end=0.5),
)
RELEASED_LATER = (
    fact("fluent", "attached", "hand1", "egg1", start=0.1, end=0.75),
    fact("event", "falling", "egg1", start=0.75, end=0.78),
    fact("event", "breaking", "egg1", start=0.78, end=0.79),
    fact("fluent", "broken", "egg1", start=0.78, end=0.8),
)


@pytest.mark.parametrize(
    ("facts", "outcome"),
    [
        ((ATTACHED, TOUCHED), "hold"),
        (SLIPPED, "slip"),
        (CRUSHED, "crush"),
        (RELEASED_LATER, "hold"),
        ((TOUCHED,), "slip"),
        ((replace(ATTACHED, end=0.69),), "slip"),
    ],
    ids=["held", "slipped and broke below", "crushed", "dropped after the hold", "never attached", "lost too early"],
)
def test_the_outcome_of_a_grasp(facts: tuple[Fact, ...], outcome: GraspOutcome) -> None:
    assert judge_grasp(timeline(*facts), log_with_hand()).outcome == outcome


def test_the_evidence_is_measured() -> None:
    grasp = judge_grasp(timeline(*SLIPPED), log_with_hand())
    assert (grasp.hand, grasp.object, grasp.level) == ("hand1", "egg1", "force7")
    assert grasp.peak_force == 15.0
    assert grasp.bonds_broken == 1
    # The egg falls 0.3 s, which ends before the holding does.
    assert grasp.slip == pytest.approx(0.5 * 9.81 * ((LAND - 201) * DT) ** 2, rel=1e-6)


def test_a_run_without_a_grasp_has_no_outcome() -> None:
    with pytest.raises(InputError, match="grasps nothing"):
        judge_grasp(make_timeline((), dt=DT, duration=1.0), egg_drop_log())


def test_transitions_lie_between_neighbouring_levels_in_order_of_force() -> None:
    def row(level: float, outcome: GraspOutcome) -> Row:
        grasp = Grasp(hand="h", object="o", level=level, outcome=outcome, slip=0.0, peak_force=level, bonds_broken=0)
        return Row(values={"Force": level}, level=level, grasp=grasp)

    outcomes = Outcomes(
        rows=(row(40.0, "crush"), row(1.0, "hold"), row(0.5, "slip"), row(20.0, "hold"), Row(values={}, error="no"))
    )
    found = [(each.below.outcome, each.above.outcome, each.low, each.high) for each in outcomes.transitions()]
    assert found == [("slip", "hold", 0.5, 1.0), ("hold", "crush", 20.0, 40.0)]
    assert outcomes.transitions()[0].force == 0.75
