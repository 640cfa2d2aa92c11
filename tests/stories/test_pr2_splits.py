"""The paper's third experiment: two hands part a cracked egg."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis import Projection, project

# Blows are as weak as just cracks the shell, and an egg that turned in the fingers is lost: both is said.
pytestmark = pytest.mark.filterwarnings(
    "ignore:near its threshold", "ignore:no, but the plan ended at .* splitting", "ignore:no, but hitting.* not_reached"
)

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def parted() -> Projection:
    return project(EXAMPLES / "pr2_split.toml")


def test_both_hands_hold_the_cracked_egg_before_it_opens(parted: Projection) -> None:
    assert parted.ask(
        "occurs(splitting(rightGripper, leftGripper, egg1, _, _), S), occurs(breaking(egg1), B), before(B, S), "
        "holds(attached(leftGripper, egg1), L), allen(during, L, S), holds(attached(rightGripper, egg1), _)"
    )


def test_what_was_inside_ends_in_the_bowl(parted: Projection) -> None:
    assert parted.ask("evidence(contains(bowl1, yolk1), T, fraction, F), F > 0.9")
    assert not parted.ask("holds(broken(yolk1), T)")


def test_blows_end_when_a_crack_is_heard_and_the_egg_is_opened_over_the_bowl() -> None:
    run = project(EXAMPLES / "pr2_split_heard.toml")
    blow, crack = "occurs(hitting(rightGripper, egg1, bowl1, _), H)", "occurs(breaking(egg1), B)"
    assert run.ask(f"{blow}, {crack}, before(H, B)")
    assert run.ask(f"{blow}, {crack}, allen(during, B, H)")
    assert not run.ask(f"{blow}, {crack}, after(H, B)")
    assert run.ask("evidence(contains(bowl1, yolk1), _, fraction, F), F > 0.9, \\+ holds(broken(yolk1), _)")
    # Where one hand loses its end, the egg has opened before, between them.
    (split,) = run.ask("evidence(splitting(rightGripper, leftGripper, egg1, _, _), S, outcome, Outcome)")
    opened = "occurs(splitting(rightGripper, leftGripper, egg1, _, _), S), holds(open(egg1), O), allen(overlaps, S, O)"
    assert split["Outcome"] == "done" or run.ask(opened)
