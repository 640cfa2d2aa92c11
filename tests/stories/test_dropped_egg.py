"""Section 3.6 of the paper: an egg rests on a hand that opens; what happens to it after it is no longer supported?"""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.projection import Projection, project

EXAMPLES = Path(__file__).parents[2] / "examples"

THE_QUERY = """holds(F1,T1), fluentT(F1,supports), objOf(F1,egg1),
   after(T2,T1), occurs(E1,T2), objOf(E1,egg1)"""


@pytest.fixture(scope="module")
def drop() -> Projection:
    return project(EXAMPLES / "dropped_egg.toml")


def test_it_falls_collides_and_breaks_after_it_is_no_longer_supported(drop: Projection) -> None:
    events = {str(answer["E1"]) for answer in drop.ask(THE_QUERY)}
    assert {"falling(egg1)", "colliding(egg1,floor)", "breaking(egg1)"} <= events
    assert events <= {"falling(egg1)", "colliding(egg1,floor)", "breaking(egg1)", "moving(egg1)"}


def test_the_hand_supports_it_until_it_opens(drop: Projection) -> None:
    assert drop.ask(
        "holds(supports(hand1,egg1), S), S = 0.0-_, occurs(openingGripper(hand1), T), allen(overlaps, S, T)"
    )


def test_it_falls_from_where_the_support_is_lost_until_it_hits_the_floor(drop: Projection) -> None:
    assert drop.ask("occurs(falling(egg1), T2), allen(met_by, T2, T1), holds(supports(hand1,egg1), T1)")
    assert drop.ask("occurs(falling(egg1), T1), occurs(colliding(egg1,floor), T2), allen(meets, T1, T2)")


def test_in_the_end_the_egg_is_broken_and_its_content_spilled_on_the_floor(drop: Projection) -> None:
    end = drop.timeline.duration - 0.001
    for fluent in (
        "broken(egg1)",
        "spilled(yolk1)",
        "spilled(white1)",
        "supports(floor,yolk1)",
        "supports(floor,white1)",
    ):
        assert drop.ask(f"holds_at({fluent}, {end})"), fluent
    for fluent in ("contains(egg1,yolk1)", "supports(_,egg1)", "attached(_,egg1)"):
        assert not drop.ask(f"holds_at({fluent}, {end})"), fluent


def test_the_content_is_in_the_egg_until_it_breaks(drop: Projection) -> None:
    goal = "holds(contains(egg1,yolk1), 0.0-E), occurs(breaking(egg1), S-_), S =< E"
    assert drop.ask(goal)


def test_nothing_picks_it_up_or_puts_it_down(drop: Projection) -> None:
    assert not drop.ask("occurs(picking_up(_,_), _)")
    assert not drop.ask("occurs(putting_down(_,_), _)")


def test_what_is_known_can_be_asked_beside_what_happens(drop: Projection) -> None:
    answers = drop.ask("occurs(breaking(X), _), instance_of(X, 'Fragile'), has_part(X, P), instance_of(P, 'EggYolk')")
    assert [(answer["X"], answer["P"]) for answer in answers] == [("egg1", "yolk1")]
    assert drop.ask("holds(on(egg1,hand1), 0.0)")


def test_what_a_shard_is_and_of_what_can_be_asked(drop: Projection) -> None:
    lying = drop.ask("holds(supports(floor, X), T), has_part(eggshell1, X), instance_of(X, 'EggShellPiece')")
    assert len(lying) > 1
    assert drop.ask("has_part(hand1, X), instance_of(X, 'Part')")
