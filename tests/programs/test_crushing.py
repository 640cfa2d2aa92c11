"""An action whose own force breaks what it holds has crushed it, whatever else came of that; a blow has not."""

from __future__ import annotations

import pytest
from tests.programs.test_programs import FakeHand, carried_out
from tests.scenes import EGG_IN_HAND, run, scene

from prolepsis.fluents import recognize
from prolepsis.robots.commands import End, Sense
from prolepsis.terms.errors import Note


class Breaking(FakeHand):
    """A hand whose egg breaks at 0.2 s under some force in all, and then is no longer between its pads, or is."""

    def __init__(self, total: float, *, pressed: float = 0.0, lost: bool = False) -> None:
        super().__init__((0.0, 0.0, 0.722))
        self.total, self.pressed, self.lost = total, pressed, lost

    def sense(self, time: float) -> Sense:
        full = super().sense(time)
        broken = {("egg1", "broken"): 1.0, ("egg1", "force"): self.total} if time > 0.2 else {}
        full.attribute = lambda name, attribute: broken.get((name, attribute), 0.0)
        full.pressing = lambda one, other: self.pressed
        if self.lost and time > 0.2:
            full.hands["hand1"].held = lambda: ()
        return full


def ends(plan: str, hand: FakeHand) -> list[End]:
    return [each for _, each in carried_out(plan, scene(EGG_IN_HAND), hand) if isinstance(each, End)]


@pytest.mark.parametrize(("total", "outcome"), [(80.0, "crushed"), (200.0, "done")])
def test_what_breaks_by_the_grip_is_crushed_and_by_something_else_is_not(total: float, outcome: str) -> None:
    (_, hold) = ends("sequence([grasp(hand1, egg1, 40), hold(hand1, 0.5)])", Breaking(total))
    assert hold.outcome == outcome
    if outcome == "crushed":
        assert (hold.evidence["force"], hold.evidence["reason"]) == (40.0, "egg1 broke at 40 of 40 N")


def test_what_is_crushed_is_not_said_to_be_dropped_and_the_plan_goes_on() -> None:
    found = ends("sequence([grasp(hand1, egg1, 40), hold(hand1, 0.5), wait(0.1)])", Breaking(80.0, lost=True))
    assert [each.outcome for each in found] == ["done", "crushed", "done"]


def test_what_is_pressed_until_it_breaks_is_crushed() -> None:
    *_, press = ends("sequence([grasp(hand1, egg1, 5), press(hand1, egg1, table1, 30)])", Breaking(70.0, pressed=28.0))
    assert (press.outcome, press.evidence["reason"]) == ("crushed", "egg1 broke at 28 of 30 N")


@pytest.mark.filterwarnings("ignore:no, but attached is told of parts of egg1")
def test_a_grasp_that_crushes_says_at_which_force_and_a_no_tells_of_it() -> None:
    log = run(EGG_IN_HAND, "sequence([grasp(hand1, egg1, 60), hold(hand1, 0.1)])")
    grasp, hold = log.actions
    assert (grasp.outcome, hold.term.functor) == ("crushed", "hold")
    (broken,) = [fact for fact in recognize(log).select(type="broken") if fact.args == ("egg1",)]
    assert grasp.evidence["force"] == pytest.approx(broken.evidence["force"], rel=0.02)
    with pytest.warns(Note, match=r"grasping\(hand1,egg1,60\) was crushed \(egg1 broke at .* of 60 N\)"):
        assert recognize(log).ask("holds(attached(hand1, egg1), T)") == []


def test_what_breaks_by_what_is_held_is_not_crushed_by_the_grip_on_that() -> None:
    block = ":block1 a :Block ; :on :table1 ; :y 0.2 ; :length 0.04 ; :width 0.04 ; :height 0.04 . "

    class Holding(Breaking):
        """A hand that holds another thing than the egg, with more than what breaks that."""

        def sense(self, time: float) -> Sense:
            full = super().sense(time)
            full.hands["hand1"].held = lambda: ("block1",)
            return full

    known, hand = scene(EGG_IN_HAND + block), Holding(40.0, pressed=8.0)
    said = carried_out("sequence([close(hand1, 40), press(hand1, block1, egg1, 10)])", known, hand)
    assert all(each.outcome != "crushed" for _, each in said if isinstance(each, End))
