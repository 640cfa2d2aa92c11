"""Plans that repeat, nest and do several things at once; none of it needs physics."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.programs.test_programs import FakeHand, actions_of, carried_out
from tests.scenes import EGG_IN_HAND, scene

from prolepsis.programs import read_program
from prolepsis.programs.nesting import as_event, nested
from prolepsis.robots.commands import (
    ActionFailedError,
    Begin,
    Behaviour,
    Command,
    End,
    Measured,
    OpenGripper,
    Sense,
)
from prolepsis.scene.scene import Scene
from prolepsis.terms.errors import InputError, PlanError, UnknownNameError
from prolepsis.terms.reader import parse_term

TWO_HANDS = EGG_IN_HAND + " :hand2 a :Gripper ; :x 0.5 ; :z 0.9 ."


@pytest.fixture(scope="module")
def two_hands() -> Scene:
    return scene(TWO_HANDS)


def ended(said: list[tuple[int, Command]]) -> list[tuple[str, str]]:
    return [(str(c.term), c.outcome) for _, c in said if isinstance(c, End)]


class Resisting(FakeHand):
    """A hand that feels the egg press on the table once it has gone down by 5 mm."""

    def sense(self, time: float) -> Sense:
        force = 4.0 if self.offset[2] < -0.005 else 0.0

        def pressing(first: str, second: str) -> float:
            return force if (first, second) == ("egg1", "table1") else 0.0

        return replace(super().sense(time), pressing=pressing)


def test_an_action_is_repeated_until_the_condition_holds(two_hands: Scene) -> None:
    hand = Resisting((0.0, 0.0, 0.722))
    said = carried_out("repeat_until(pressed(egg1, table1, 3), lift(hand1, -0.002))", two_hands, hand)
    assert [name for name, _ in ended(said)] == ["lift(hand1,-0.002)"] * 3
    assert hand.offset[2] == pytest.approx(-0.006)


class Listening(FakeHand):
    """A hand that hears the egg crack once it has gone down by 3 mm."""

    def sense(self, time: float) -> Sense:
        def attribute(name: str, attribute: str) -> float:
            return float((name, attribute) == ("egg1", "broken") and self.offset[2] < -0.003)

        return replace(super().sense(time), attribute=attribute)


def test_blows_are_repeated_until_a_crack_is_heard(two_hands: Scene) -> None:
    plan = (
        "repeat_until(cracked(egg1), sequence([lift(hand1, -0.002), repeat_until(cracked(egg1), lift(hand1, -0.004))]))"
    )
    said = carried_out(plan, two_hands, Listening((0.0, 0.0, 0.722)))
    assert [name for name, _ in ended(said)] == ["lift(hand1,-0.002)", "lift(hand1,-0.004)"]


def test_what_holds_already_needs_no_repetition(two_hands: Scene) -> None:
    assert not carried_out("repeat_until(not(touching(egg1, table1)), lift(hand1, -0.002))", two_hands)


def test_a_condition_that_never_holds_ends_the_plan(two_hands: Scene) -> None:
    said = carried_out(
        "sequence([repeat_until(above(egg1, 3), wait(0.001)), lift(hand1, 0.1)])",
        two_hands,
        FakeHand((0.0, 0.0, 0.722)),
    )
    assert len(ended(said)) == 1000
    assert not [name for name, _ in ended(said) if name.startswith("lift")]


def test_an_action_within_an_action_is_an_event_of_its_own(two_hands: Scene) -> None:
    hand = FakeHand((0.0, 0.0, 0.722))

    def twice(sense: Sense) -> Behaviour:
        for _ in range(2):
            sense = yield from nested("lift", two_hands, sense, hand=two_hands.thing("hand1"), height=0.01)
        sense = yield (Measured(evidence={"times": 2.0}),)
        return sense

    behaviour = as_event("twice", {"egg": "egg1"}, twice(hand.sense(0.0)), hand.sense(0.0))
    said: list[Command] = list(next(behaviour))
    with pytest.raises(StopIteration):
        while True:
            hand.obey(tuple(said))
            said += behaviour.send(hand.sense(0.0))
    assert [str(c.term) for c in said if isinstance(c, Begin)] == [
        "twice(egg1)",
        "lift(hand1,0.01)",
        "lift(hand1,0.01)",
    ]
    ends = [c for c in said if isinstance(c, End)]
    assert [str(c.term) for c in ends] == ["lift(hand1,0.01)", "lift(hand1,0.01)", "twice(egg1)"]
    assert ends[-1].evidence == {"times": 2.0}


def test_a_grasp_begins_with_reaching_which_takes_no_time_of_its_own(two_hands: Scene) -> None:
    plans = ("grasp(hand1, egg1, 5)", "sequence([reach(hand1, egg1), grasp(hand1, egg1, 5)])")
    once, apart = (actions_of(carried_out(plan, two_hands, FakeHand((0.2, 0.1, 0.95)))) for plan in plans)
    assert [name for name, _, _ in once] == ["reach(hand1,egg1)", "grasp(hand1,egg1,5)"]
    (_, began, reached), (_, first, last) = once
    assert began == first and reached < last
    # A hand that is there already does not reach.
    assert apart == [("reach(hand1,egg1)", 0, reached), ("grasp(hand1,egg1,5)", reached, last)]


def test_what_ends_within_what_goes_on_costs_no_time(two_hands: Scene) -> None:
    said = carried_out("sequence([together([wait(0.1), wait(0.3), wait(0.2)]), wait(0.05)])", two_hands)
    ends = {name: end for name, _, end in actions_of(said)}
    assert ends == {"wait(0.1)": 100, "wait(0.2)": 200, "wait(0.3)": 300, "wait(0.05)": 350}


def test_what_fails_says_so_and_is_raised_for_what_it_is_part_of(two_hands: Scene) -> None:
    hand = FakeHand((0.0, 0.0, 0.722))

    def stuck(sense: Sense) -> Behaviour:
        yield (OpenGripper(hand="hand1", width=0.08, speed=0.1),)
        raise ActionFailedError("unreachable", "too far")

    behaviour = as_event("try", {"hand": "hand1"}, stuck(hand.sense(0.0)), hand.sense(0.0))
    next(behaviour)
    behaviour.send(hand.sense(0.0))
    (end,) = behaviour.send(hand.sense(0.0))
    assert isinstance(end, End)
    assert (end.outcome, end.evidence["reason"]) == ("unreachable", "too far")
    with pytest.raises(ActionFailedError):
        behaviour.send(hand.sense(0.0))


def test_what_slips_out_of_the_hand_is_dropped(two_hands: Scene) -> None:
    class Losing(FakeHand):
        """A hand that loses its grip half-way up."""

        def sense(self, time: float) -> Sense:
            full = super().sense(time)
            lost = self.offset[2] > 0.05
            hands = {
                n: replace(h, pad_force=0.0 if lost else h.grip, held=lambda: () if lost else ("egg1",))
                for n, h in full.hands.items()
            }
            return replace(full, hands=hands)

    plan = "sequence([close(hand1, 5), lift(hand1, 0.1), wait(0.1)])"
    said = carried_out(plan, two_hands, Losing((0.0, 0.0, 0.722)))
    assert [outcome for _, outcome in ended(said)] == ["done", "dropped", "done"]


REFUSED = [
    ("together([lift(hand1, 0.1), hold(hand1, 1)])", PlanError, "command hand1: .*put them in a sequence"),
    ("repeat_until(wait(1))", PlanError, "repeat_until needs a condition and an action"),
    ("repeat_until(touched(egg1, table1), wait(1))", UnknownNameError, "no condition named 'touched'.*touching"),
    ("repeat_until(egg1, wait(1))", PlanError, "egg1 is no condition; one looks like touching"),
    ("repeat_until(touching(egg1), wait(1))", PlanError, r"has 1 argument, needed: touching\(Object, Other\)"),
    ("close(hand1, 500)", PlanError, "force of close.hand1,500. is 500 N, hand1 can do 100 N at most"),
    ("hit(hand1, egg1, egg1)", PlanError, "egg1 cannot be hit against itself"),
    ("split(hand1, hand1, egg1, 5)", PlanError, "hand1 cannot split egg1 alone; name another gripper"),
    ("split(hand1, hand2, egg1, 5)", PlanError, "hand1 and hand2 are not on two arms of one robot"),
    ("split(hand1, hand2, egg1, 5, -0.1)", PlanError, "angle of .* must not be negative, but is -0.1 rad"),
    ("split(hand1, hand2, egg1, 5, 0, 0)", PlanError, "egg1 is not split by no angle and no distance; give one"),
    ("hit(hand1, egg1, table1, 0.2, side)", PlanError, "must be one of edge, top, not side"),
    ("drive(hand1, [0, 0])", UnknownNameError, "no robot named 'hand1'"),
]


@pytest.mark.parametrize(("plan", "kind", "message"), REFUSED)
def test_a_plan_that_cannot_work_is_refused(plan: str, kind: type[InputError], message: str, two_hands: Scene) -> None:
    with pytest.raises(kind, match=message):
        read_program(parse_term(plan), two_hands)


def test_two_hands_work_at_once(two_hands: Scene) -> None:
    read_program(parse_term("together([lift(hand1, 0.1), sequence([lift(hand2, 0.1), hold(hand2, 1)])])"), two_hands)
