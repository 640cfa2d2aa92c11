"""How actions end: all outcomes stand in one place; what is done has reached what it aims at, and every action ends."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
from tests.programs.test_programs import FakeHand, carried_out
from tests.scenes import EGG_IN_HAND, run, scene

from prolepsis.engine import simulation
from prolepsis.fluents import recognize
from prolepsis.log.log import Log
from prolepsis.log.outcomes import GOES_ON, OUTCOMES, Outcome
from prolepsis.programs.actions.striking import push_down
from prolepsis.programs.nesting import as_event
from prolepsis.robots.commands import Command, End, Sense, is_instant
from prolepsis.robots.hand import HAND
from prolepsis.terms.errors import Note, PlanError

DOCS = Path(__file__).parents[2] / "docs"


def test_all_outcomes_stand_in_one_place_and_in_the_docs() -> None:
    assert list(OUTCOMES) == list(get_args(Outcome))
    page = (DOCS / "actions.md").read_text(encoding="utf-8")
    for name, says in OUTCOMES.items():
        plan = "goes on" if name in GOES_ON else "its sequence ends" if name != "unfinished" else ""
        assert f"| `{name}` | {says} | {plan} |" in page


def test_what_the_end_of_a_run_cuts_off_is_unfinished() -> None:
    log = run(":floor a :Floor .", "sequence([wait(0.01), wait(1.0)])", duration=0.05)
    assert [action.outcome for action in log.actions] == ["done", "unfinished"]


BLOCK = ":floor a :Floor . :table1 a :Table . :block1 a :Block ; :on :table1 ; :length 0.04 ; :width 0.04 ; "
ABOVE = " :hand1 a :Gripper ; :pitch 90.0 ; :z 0.9 ; :opening 0.03 ."
"""A hand in the air, which points down."""


def ended(log: Log) -> list[tuple[str, str, str]]:
    """Return verb, outcome and reason of each action, in the order of their ends, parts before their wholes."""
    done = sorted(reversed(log.actions), key=lambda action: (action.end, -action.start, action.term.functor == "grasp"))
    return [(each.term.functor, each.outcome, str(each.evidence.get("reason", ""))) for each in done]


def test_pads_that_press_each_other_hold_nothing() -> None:
    plan = "sequence([close(hand1, 20), press(hand1, block1, table1, 5), wait(1)])"
    log = run(BLOCK + ":height 0.04 ." + ABOVE, plan)
    assert ended(log) == [
        ("close", "missed", "between the pads of hand1 is nothing"),
        ("press", "not_held", "hand1 does not hold block1: between its pads is nothing"),
    ]
    assert log.actions[0].evidence["between"] == "nothing"
    # They do press, with the force that was asked for.
    assert log.actions[0].evidence["peak_pad_force"] == pytest.approx(20.0, rel=0.05)


def test_a_closing_tells_what_both_fingers_press_on_from_one_side() -> None:
    wide = BLOCK.replace(":width 0.04", ":width 0.2") + ":height 0.04 ."
    log = run(
        wide + " :hand1 a :Gripper ; :pitch 90.0 ; :z 0.785 ; :opening 0.05 .",
        "sequence([lift(hand1, -0.03), close(hand1, 20)])",
    )
    assert ended(log)[-1] == (
        "close",
        "missed",
        "between the pads of hand1 is nothing; its fingers are pressed against block1",
    )


def test_a_grasp_that_closes_on_another_thing_has_missed() -> None:
    # The second block lies on the first one, and the pads reach higher than that.
    both = BLOCK + ":height 0.004 . :block2 a :Block ; :on :block1 ; :length 0.04 ; :width 0.05 ; :height 0.04 ."
    log = run(both + " :hand1 a :Gripper ; :pitch 90.0 ; :z 0.8 ; :opening 0.085 .", "grasp(hand1, block1, 10, 0.03)")
    assert ended(log)[-1] == ("grasp", "missed", "between the pads of hand1 is block2, not block1")


CUPS = ":floor a :Floor . :table1 a :Table . :cup1 a :Cup ; :on :table1 . :cup2 a :Cup ; :on :table1 ; :y 0.2 . " + (
    ":hand1 a :Gripper ; :x -0.2 ; :z 0.9 ."
)


@pytest.mark.parametrize(
    ("things", "plan"),
    [
        (BLOCK + ":height 0.04 ." + ABOVE, "wipe(hand1, block1, table1, [0.1, 0, 0])"),
        (BLOCK + ":height 0.04 ." + ABOVE, "squeeze(hand1, block1, 10)"),
        (CUPS, "pour(hand1, cup1, cup2)"),
    ],
)
def test_nothing_is_done_with_what_was_never_held(things: str, plan: str) -> None:
    log = run(things, f"sequence([{plan}, wait(1)])")
    ((_, outcome, reason),) = ended(log)
    assert (outcome, reason.split(":")[0]) == (
        "not_held",
        f"hand1 does not hold {'cup1' if 'cup' in plan else 'block1'}",
    )


MOVES = (
    "lift(hand1, 0.05)",
    "carry(hand1, [0.1, 0, 0])",
    "tilt(hand1, 0.3)",
    "bring(hand1, table1)",
    "hold(hand1, 0.1)",
)


def test_a_hand_that_grips_nothing_carries_nothing_but_goes_its_way() -> None:
    log = run(BLOCK + ":height 0.04 ." + ABOVE, f"sequence([close(hand1, 20), {', '.join(MOVES)}])")
    missed, *moved = ended(log)
    assert missed[1] == "missed"
    nothing = "between the pads of hand1 is nothing"
    assert moved == [(move.partition("(")[0], "not_held", nothing) for move in MOVES]
    # One that does not grip is only moved.
    assert {each[1] for each in ended(run(BLOCK + ":height 0.04 ." + ABOVE, f"sequence([{', '.join(MOVES)}])"))} == {
        "done"
    }


class Losing(FakeHand):
    """A hand that loses what it holds after a while."""

    def sense(self, time: float) -> Sense:
        full = super().sense(time)
        if time > 0.3:
            full.hands = {n: replace(h, pad_force=0.0, held=lambda: ()) for n, h in full.hands.items()}
        return full


@pytest.mark.parametrize("move", [*MOVES, "wipe(hand1, egg1, table1, [0.1, 0, 0])", "squeeze(hand1, egg1, 5)"])
def test_what_is_lost_meanwhile_is_dropped_and_not_held_after_that(move: str) -> None:
    plan = f"sequence([grasp(hand1, egg1, 5), hold(hand1, 0.2), {move.replace('0.1)', '0.5)')}, lift(hand1, 0.1)])"
    said = carried_out(plan, scene(EGG_IN_HAND), Losing((0.0, 0.0, 0.722)))
    ends = [each.outcome for _, each in said if isinstance(each, End)]
    assert ends == ["done", "done", "dropped", "not_held"]


POST = (
    ":floor a :Floor . :table1 a :Table . :block1 a :Block ; :on :table1 ; :length 0.04 ; :width 0.04 ; :height 0.3 ; "
    ':friction 0.7 ; :mass "200 g" . :hand1 a :Gripper ; :z 0.85 ; :opening 0.05 .'
)
"""A post that stands on a table, taller than it is lifted: the pads press on it wherever it slides to."""


@pytest.mark.parametrize(("share", "lifting", "pressing"), [(0.8, "dropped", "not_held"), (4.0, "done", "done")])
def test_what_slides_through_the_pads_is_dropped_and_not_held(share: float, lifting: str, pressing: str) -> None:
    force = share * 0.2 * (9.81 + 1.0) / (2 * 0.7)
    log = run(POST, f"sequence([grasp(hand1, block1, {force!r}), lift(hand1, 0.08), press(hand1, block1, table1, 3)])")
    (_, grasped, _), (_, lifted, _), (_, pressed, reason) = ended(log)
    assert (grasped, lifted, pressed) == ("done", lifting, pressing)
    assert ("slipped" in reason) == (pressing == "not_held")


BLOCK_IN_HAND = BLOCK + ":height 0.04 ." + " :hand1 a :Gripper ; :pitch 90.0 ; :z 0.742 ; :opening 0.05 ."


def lifted_and_wiped(height: float) -> Log:
    """Return the log of a block that is lifted by ``height`` [m] and then wiped over the table."""
    wiping = f"lift(hand1, {height}), wipe(hand1, block1, table1, [0.1, 0, 0])"
    return run(BLOCK_IN_HAND, f"sequence([grasp(hand1, block1, 20), {wiping}])")


def test_a_wiping_over_nothing_makes_no_strokes() -> None:
    log = lifted_and_wiped(0.1)
    assert ended(log)[-1] == ("wipe", "not_reached", "block1 is not pressed on table1 30 mm farther down")
    assert float(np.ptp(log.poses[:, log.index("block1"), 0])) < 0.01
    # What it did not touch is told all the same.
    (wiping,) = recognize(log).select(type="wiping")
    assert wiping.evidence["outcome"] == "not_reached"


def test_the_strokes_of_a_wiping_begin_when_what_is_held_presses_on_the_surface() -> None:
    log = lifted_and_wiped(0.01)
    assert ended(log)[-1] == ("wipe", "done", "")
    begun = log.actions[-1].start
    aside = np.abs(log.poses[begun:, log.index("block1"), 0] - log.poses[begun, log.index("block1"), 0])
    first = int(np.flatnonzero(aside > 0.001)[0]) + begun
    down = [f.start for f in recognize(log).select(type="contacts") if set(f.args) == {"block1", "table1"}][-1]
    assert log.time[begun] < down < log.time[first]


PR2_BY_A_TABLE = (
    ":floor a :Floor . :table1 a :Table . :block1 a :Block ; :on :table1 ; :x 0.2 . :pr2 a :PR2 ; :x -0.8 ; "
    + (":hasPart :rightGripper , :leftGripper . :rightGripper a :Gripper . :leftGripper a :Gripper . ")
)


@pytest.mark.parametrize(
    ("plan", "reason"),
    [
        ("drive(pr2, [-0.2, 0])", "base_x of pr2 is 0."),
        ("raise_torso(pr2, 0.3)", "torso_lift_joint of pr2 is 0."),
    ],
)
def test_a_trunk_that_is_held_up_has_not_reached_its_place(plan: str, reason: str) -> None:
    lid = ":lid1 a :Obstacle ; :x -0.8 ; :z 1.65 ; :length 0.6 ; :width 0.6 ; :height 0.1 ."
    log = run(PR2_BY_A_TABLE + lid, plan)
    ((_, outcome, said),) = ended(log)
    assert (outcome, said[: len(reason)]) == ("not_reached", reason)


def test_what_has_gone_meanwhile_is_not_looked_at() -> None:
    carried = "together([look_at(pr2, block1), carry(rightGripper, [0, -0.3, 0.1], 4)])"
    near = PR2_BY_A_TABLE.replace(":x 0.2", ":x -0.2 ; :y -0.1 ; :length 0.04 ; :width 0.04 ; :height 0.07")
    log = run(near, f"sequence([grasp(rightGripper, block1, 20), {carried}])")
    assert {verb: outcome for verb, outcome, _ in ended(log)}["look_at"] == "not_reached"


def test_a_free_hand_takes_a_bar_by_one_end_and_gives_it_to_another() -> None:
    bar = (
        ":floor a :Floor . :table1 a :Table . :block1 a :Block ; :on :table1 ; :length 0.04 ; :width 0.04 ; "
        ":height 0.06 . :bar1 a :Block ; :on :block1 ; :length 0.04 ; :width 0.2 ; :height 0.04 . "
    )
    hands = ":handA a :Gripper ; :y -0.35 ; :z 0.9 ; :yaw 90 . :handB a :Gripper ; :y 0.35 ; :z 0.9 ; :yaw -90 ."
    taken = "grasp(handA, bar1, 15, 0, 0.06), lift(handA, 0.1), grasp(handB, bar1, 15, 0, 0.06), release(handA)"
    log = run(
        bar + hands, f"sequence([{taken}, carry(handA, [0, -0.1, 0]), carry(handB, [0, 0.1, 0]), hold(handB, 0.2)])"
    )
    assert {outcome for _, outcome, _ in ended(log)} == {"done"}


def test_fingers_that_cannot_open_end_their_action() -> None:
    wall = " :wall{0} a :Obstacle ; :on :table1 ; :y {1} ; :length 0.1 ; :width 0.04 ; :height 0.15 ."
    walls = wall.format(1, 0.05) + wall.format(2, -0.05)
    hand = " :hand1 a :Gripper ; :pitch 90.0 ; :z 0.8 ; :opening 0.02 ."
    log = run(":floor a :Floor . :table1 a :Table ." + walls + hand, "release(hand1)")
    ((_, outcome, reason),) = ended(log)
    assert outcome == "in_collision"
    assert reason.endswith("its fingers are pressed against wall1 and wall2")


@pytest.mark.parametrize(
    ("hand", "reason"),
    [
        (":z 0.8", "hand1: it is pressed against table1"),
        (":pitch 90.0 ; :z 0.9", "hand1: its fingers are pressed against wall1"),
    ],
)
def test_what_is_in_the_way_of_a_free_hand_ends_its_reaching(hand: str, reason: str) -> None:
    wall = " :wall1 a :Obstacle ; :on :table1 ; :y 0.045 ; :length 0.1 ; :width 0.04 ; :height 0.03 ."
    x = "-0.25" if "pitch" not in hand else "0"
    gripper = f" :hand1 a :Gripper ; :x {x} ; {hand} ; :opening 0.085 ."
    log = run(BLOCK + ":height 0.012 ." + wall + gripper, "grasp(hand1, block1, 10)")
    assert ended(log) == [("reach", "in_collision", reason), ("grasp", "in_collision", reason)]


@pytest.mark.parametrize(("bump", "outcome"), [("egg1", "done"), ("table1", "in_collision")])
def test_what_a_free_hand_reaches_for_is_not_in_its_way(bump: str, outcome: str) -> None:
    class Bumping(FakeHand):
        """A hand whose palm feels something all the time."""

        def sense(self, time: float) -> Sense:
            full = super().sense(time)
            return replace(full, hands={name: replace(hand, bump=bump) for name, hand in full.hands.items()})

    said = carried_out("grasp(hand1, egg1, 5)", scene(EGG_IN_HAND), Bumping((0.2, 0.1, 0.95)))
    assert {each.outcome for _, each in said if isinstance(each, End)} == {outcome}


def test_a_hand_that_is_held_up_has_not_reached_its_place() -> None:
    log = run(":floor a :Floor . :table1 a :Table ." + ABOVE, "sequence([lift(hand1, -0.25), lift(hand1, 0.05)])")
    (_, first, reason), (_, second, _) = ended(log)
    assert first == "not_reached"
    assert "mm and 0.0" in reason
    # It is still held up; the plan goes on all the same.
    assert second in ("done", "not_reached")


def test_a_plan_that_goes_on_and_on_says_so_and_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(simulation, "LONG", 0.02)
    monkeypatch.setattr(simulation, "LONGEST", 0.05)
    told = re.escape("plan: wait(2.0) has not ended after 0.02 s; without a duration it is given up at 0.05 s")
    with pytest.warns(Note, match=told), pytest.raises(PlanError, match="has not ended after 0.05 s"):
        run(":floor a :Floor .", "sequence([wait(0.01), wait(2.0)])")


class Yielding(FakeHand):
    """A hand under which a surface, 3 mm below, yields at 19 N."""

    def sense(self, time: float) -> Sense:
        force = max(HAND.position_gain * min(self.offset[2] + 0.003, 0.0), -19.0)
        full = super().sense(time)
        hands = {n: replace(h, load=lambda: (0.0, 0.0, force)) for n, h in full.hands.items()}
        return replace(full, hands=hands)


class Creeping(FakeHand):
    """A hand in which what it holds creeps while it is pressed on a surface, 3 mm below where it is at first."""

    force_felt, began, pressing = 0.0, -1.0, 0

    def obey(self, commands: tuple[Command, ...]) -> None:
        before = self.offset[2]
        super().obey(commands)
        below = min(before, -0.003) - min(self.offset[2], -0.003)
        # As an egg in the hand of a PR2: 5000 N/m, and 0.45 mm/s for each newton.
        self.force_felt = max(self.force_felt + 5.0e3 * (below - 4.5e-4 * self.force_felt * 1e-3), 0.0)
        self.pressing += self.force_felt > 0.0

    def sense(self, time: float) -> Sense:
        self.began = time if self.began < 0.0 and self.offset[2] < 0.0 else self.began
        # It feels its own inertia, too, when it sets out.
        force = self.force_felt + 2.0 * (self.began >= 0.0 and time < self.began + 0.1)
        full = super().sense(time)
        hands = {n: replace(h, load=lambda: (0.0, 0.0, -force), stiffness=5.0e3) for n, h in full.hands.items()}
        return replace(full, hands=hands)


def pushed(hand: FakeHand, force: float) -> End:
    """Return the end of a push of half a second by a hand."""
    thing = scene(BLOCK + ":height 0.04 ." + ABOVE).thing("hand1")
    behaviour = as_event("push", {"hand": thing}, push_down(thing, hand.sense(0.0), force, 0.5), hand.sense(0.0))
    made, time = next(behaviour), 0.0
    said: list[Command] = []
    with pytest.raises(StopIteration):
        while True:
            said += made
            hand.obey(made)
            time += 0.0 if is_instant(made) else 0.001
            made = behaviour.send(hand.sense(time))
    return [each for each in said if isinstance(each, End)][-1]


@pytest.mark.parametrize("force", [10.0, 20.0, 40.0])
def test_a_push_keeps_up_its_force_though_what_is_held_creeps(force: float) -> None:
    hand = Creeping((0.0, 0.0, 0.722))
    assert pushed(hand, force).outcome == "done"
    assert hand.force_felt == pytest.approx(force, rel=0.05)
    # The force has grown in a second on the surface, not on the way there, and was held for half a second.
    assert hand.pressing > 1450


@pytest.mark.parametrize(("force", "outcome", "reason"), [(15.0, "done", ""), (45.0, "not_reached", "19 of 45 N")])
def test_a_push_is_done_if_its_force_was_there(force: float, outcome: str, reason: str) -> None:
    last = pushed(Yielding((0.0, 0.0, 0.722)), force)
    assert (last.outcome, last.evidence.get("reason", "")) == (outcome, reason)
    # What was commanded stands beside what was reached, be it done or not.
    assert last.evidence["commanded_force"] == force >= float(last.evidence["force"]) - 0.05 * force


class Pinching(FakeHand):
    """A hand whose pads press with other forces than they are told, and may not come to rest."""

    share, restless = 1.0, False

    def sense(self, time: float) -> Sense:
        full, motion = super().sense(time), -1 if self.restless else 0
        hands = {n: replace(h, pad_force=self.share * h.pad_force, motion=motion) for n, h in full.hands.items()}
        return replace(full, hands=hands)


@pytest.mark.parametrize(("share", "outcome"), [(0.85, "not_reached"), (1.05, "done"), (1.15, "not_reached")])
def test_a_grasp_that_presses_too_much_has_not_reached_its_force_either(share: float, outcome: str) -> None:
    hand = Pinching((0.0, 0.0, 0.722))
    hand.share = share
    said = carried_out("close(hand1, 5)", scene(EGG_IN_HAND), hand)
    assert [each.outcome for _, each in said if isinstance(each, End)] == [outcome]


def test_a_closing_that_does_not_come_to_rest_is_given_up() -> None:
    hand = Pinching((0.0, 0.0, 0.722))
    hand.restless = True
    said = carried_out("close(hand1, 5)", scene(EGG_IN_HAND), hand)
    ((tick, end),) = [(tick, each) for tick, each in said if isinstance(each, End)]
    assert (tick, end.outcome) == (8000, "timed_out")
    assert end.evidence["reason"] == "hand1 does not come to rest on egg1"


def test_what_a_hand_holds_cannot_be_brought_over() -> None:
    log = run(BLOCK_IN_HAND, "sequence([grasp(hand1, block1, 20), bring(hand1, block1)])")
    assert ended(log)[-1] == ("bring", "unreachable", "hand1 holds block1, which goes where the hand goes")
