"""Programs are generators of commands, so they run here without any physics; bad plans are refused."""

from __future__ import annotations

import pytest
from tests.scenes import EGG_IN_HAND, scene

from prolepsis.geometry.shape import IDENTITY, Triple
from prolepsis.programs import ACTIONS, check_units, read_program
from prolepsis.robots.commands import Begin, CloseGripper, Command, End, HandSense, HandTarget, OpenGripper, Sense
from prolepsis.robots.hand import HAND
from prolepsis.scene.scene import Scene
from prolepsis.terms.errors import InputError, PlanError, UnknownNameError
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import Term


@pytest.fixture(scope="module")
def egg_in_hand() -> Scene:
    return scene(EGG_IN_HAND)


class FakeHand:
    """A hand that does at once what it is told."""

    def __init__(self, position: Triple, opening: float = 0.05) -> None:
        self.start, self.offset, self.rotation = position, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
        self.opening, self.motion, self.force = opening, 0, 0.0

    def obey(self, commands: tuple[Command, ...]) -> None:
        self.motion = 0
        for command in commands:
            if isinstance(command, HandTarget):
                self.offset, self.rotation = command.offset, command.rotation
            elif isinstance(command, OpenGripper):
                self.opening = command.width
            elif isinstance(command, CloseGripper):
                self.force = command.force

    def sense(self, time: float) -> Sense:
        here = tuple(a + b for a, b in zip(self.start, self.offset, strict=True))
        hand = HandSense(
            position=(here[0], here[1], here[2]),
            offset=self.offset,
            rotation=self.rotation,
            opening=self.opening,
            grip=self.force,
            load=lambda: (0.0, 0.0, min(HAND.position_gain * self.offset[2], 0.0)),
            stiffness=HAND.position_gain,
            pad_force=self.force,
            motion=self.motion,
            held=lambda: ("egg1",) if self.force else (),
        )
        return Sense(
            time=time,
            hands={"hand1": hand},
            position=lambda name: (0.0, 0.0, 0.722),
            orientation=lambda _: IDENTITY,
            pressing=lambda one, other: -hand.load()[2],
        )


def carried_out(plan: str, known: Scene, hand: FakeHand | None = None) -> list[tuple[int, Command]]:
    """Return (tick, command) of a plan carried out by a hand that does at once what it is told."""
    hand = hand or FakeHand((0.0, 0.0, 0.722))
    running = read_program(parse_term(plan), known).start(hand.sense(0.0))
    said: list[tuple[int, Command]] = []
    for tick in range(20000):
        commands = running.step(hand.sense(tick * 1e-3))
        said += [(tick, command) for command in commands]
        hand.obey(commands)
        if running.ended:
            return said
    raise AssertionError("the program does not end")


def actions_of(said: list[tuple[int, Command]]) -> list[tuple[str, int, int]]:
    begun = {c.term: t for t, c in said if isinstance(c, Begin)}
    return [(str(c.term), begun[c.term], t) for t, c in said if isinstance(c, End)]


def test_a_sequence_does_one_action_after_the_other(egg_in_hand: Scene) -> None:
    rows = actions_of(carried_out("sequence([wait(0.1), lift(hand1, 0.1), hold(hand1, 0.2)])", egg_in_hand))
    assert [name for name, _, _ in rows] == ["wait(0.1)", "lift(hand1,0.1)", "hold(hand1,0.2)"]
    assert [(start, end) for _, start, end in rows] == [(0, 100), (100, rows[1][2]), (rows[1][2], rows[1][2] + 200)]


def test_an_action_begins_with_its_arguments_by_name(egg_in_hand: Scene) -> None:
    (begin,) = [c for _, c in carried_out("lift(hand1, 0.1)", egg_in_hand) if isinstance(c, Begin)]
    assert str(begin.term) == "lift(hand1,0.1)"
    # What is left out is there as it was used.
    assert begin.arguments == {"hand": "hand1", "height": 0.1, "speed": 0.25, "acceleration": 1.0}


def test_together_begins_at_once_and_ends_with_the_last(egg_in_hand: Scene) -> None:
    rows = actions_of(carried_out("together([wait(0.3), lift(hand1, 0.01), wait(0.1)])", egg_in_hand))
    assert {start for _, start, _ in rows} == {0}
    assert max(end for _, _, end in rows) == 300


def test_a_move_keeps_to_its_acceleration_and_speed(egg_in_hand: Scene) -> None:
    said = carried_out("carry(hand1, [0.6, 0, 0.8], 4.0, 0.5)", egg_in_hand)
    speeds = [sum(v * v for v in c.velocity) ** 0.5 for _, c in said if isinstance(c, HandTarget)]
    assert max(speeds) == pytest.approx(0.5, rel=0.01)
    steps = [abs(b - a) / 1e-3 for a, b in zip(speeds, speeds[1:], strict=False)]
    assert max(steps) <= 4.0
    last = [c for _, c in said if isinstance(c, HandTarget)][-1]
    assert last.offset == pytest.approx((0.6, 0.0, 0.8))


def test_a_tilt_keeps_to_its_rate_and_a_tilted_hand_stays_tilted_when_it_is_carried(egg_in_hand: Scene) -> None:
    said = carried_out("sequence([tilt(hand1, 1.2, 2.0), carry(hand1, [0.1, 0, 0], 4.0)])", egg_in_hand)
    targets = [c for _, c in said if isinstance(c, HandTarget)]
    rolls = [c.rotation[2] for c in targets]
    steps = [(b - a) / 1e-3 for a, b in zip(rolls, rolls[1:], strict=False)]
    assert max(steps) == pytest.approx(2.0, rel=0.01)
    assert min(steps) >= 0.0
    assert [c.angular_velocity[2] for c in targets][1 : len(steps) + 1] == pytest.approx(steps, abs=0.01)
    assert targets[-1].rotation == pytest.approx((0.0, 0.0, 1.2))
    assert targets[-1].offset == pytest.approx((0.1, 0.0, 0.0))


def test_squeezing_ends_with_the_grip_that_was_before(egg_in_hand: Scene) -> None:
    said = carried_out("sequence([grasp(hand1, egg1, 5), squeeze(hand1, egg1, 9, 0.1)])", egg_in_hand)
    assert [c.force for _, c in said if isinstance(c, CloseGripper)] == [5.0, 9.0, 5.0]


def test_wiping_presses_strokes_there_and_back_and_lets_go_of_the_surface(egg_in_hand: Scene) -> None:
    said = carried_out(
        "sequence([grasp(hand1, egg1, 5), wipe(hand1, egg1, table1, [0.1, 0.05, 0], 3, 2.0)])", egg_in_hand
    )
    offsets = [c.offset for _, c in said if isinstance(c, HandTarget)]
    # The surface of this hand is a spring at height 0.
    lowest = -2.0 / HAND.position_gain
    assert min(z for _, _, z in offsets) == pytest.approx(lowest, rel=0.02)
    assert all(z == pytest.approx(lowest, rel=0.02) for x, _, z in offsets if 0.001 < x < 0.099)
    assert max(x for x, _, _ in offsets) == pytest.approx(0.1)
    # Three strokes: there, back and there.
    assert offsets[-1] == pytest.approx((0.1, 0.05, 0.0), abs=1e-9)


def test_grasp_reaches_for_what_is_elsewhere_and_closes_with_the_named_level(egg_in_hand: Scene) -> None:
    hand = FakeHand((0.2, 0.1, 0.95), opening=0.0)
    said = carried_out("grasp(hand1, egg1, force7)", egg_in_hand, hand)
    assert hand.sense(0.0).hands["hand1"].position == pytest.approx((0.0, 0.0, 0.722), abs=1e-6)
    assert hand.opening >= 0.044
    closings = [c for _, c in said if isinstance(c, CloseGripper)]
    assert [c.force for c in closings] == [15.0]


def test_grasp_tells_the_greatest_pad_force_as_evidence(egg_in_hand: Scene) -> None:
    ends = [c for _, c in carried_out("grasp(hand1, egg1, 5)", egg_in_hand) if isinstance(c, End)]
    assert ends[0].evidence == {"peak_pad_force": 5.0, "between": "egg1", "pad_force": 5.0, "commanded_force": 5.0}


REFUSED = [
    ("gasp(hand1, egg1, 5)", UnknownNameError, "plan: no action named 'gasp'; did you mean 'grasp'"),
    (
        "grasp(hand1)",
        PlanError,
        r"plan: grasp\(hand1\) has 1 argument, needed: grasp\(Hand, Object, Force, Height = 0 m, Short = 0 m\)",
    ),
    ("lift(hand1, 0.1, 0.2, 0.3, 0.4)", PlanError, r"has 5 arguments, needed: lift\(Hand, Height, Speed = 0.25"),
    ("grasp(hand2, egg1, 5)", UnknownNameError, "plan: hand of .*: no gripper named 'hand2'.*known: hand1"),
    ("grasp(hand1, egg7, 5)", UnknownNameError, "plan: object of .*: no object named 'egg7'.*known: egg1"),
    ("grasp(hand1, egg1, force99)", UnknownNameError, "no force level named 'force99'"),
    ("grasp(hand1, egg1, -3)", PlanError, "must be positive, not -3"),
    ("grasp(hand1, egg1, Force)", PlanError, "has no value; give parameter Force one"),
    ("lift(hand1, high)", PlanError, r"must be a number \[m\], not high"),
    ("lift(hand1, [1, 2])", PlanError, r"must be a number \[m\], not \[1,2\]"),
    ("grasp([hand1], egg1, 5)", PlanError, r"hand of grasp.*must be the name of a gripper, not \[hand1\]"),
    ("grasp(hand1, egg1, [5])", PlanError, r"must be a force of each pad \[N\], a number or a force level, not \[5\]"),
    ("carry(hand1, 0.3, 2.0)", PlanError, r"must be a list of three lengths .*, such as \[0.2, 0, 0.1\]"),
    ("grasp(hand1, table1, 5)", PlanError, "table1 is not graspable: .* mm wide between the pads, hand1 opens 90 mm"),
    ("tilt(hand1, 90)", PlanError, r"must be at most 3.1416 rad in size, not 90; degrees need a parameter such as"),
    ("tilt(hand1, 1, 30)", PlanError, r"rate of .* must be at most 6 rad/s in size, not 30; degrees need a param"),
    ("lift(hand1, 0.1, 1, 50)", PlanError, r"acceleration of .* must be at most 30 m/s2 in size, not 50"),
    ("wipe(hand1, egg1, table1, [0.1, 0, 0], 2, 200)", PlanError, "is 200 N, hand1 can do 150 N at most"),
    ("pour(hand1, egg1, table1, 1.5, 1.0, 20)", PlanError, "height 20 m of pour, allowed 0 to 0.5 m"),
    ("pour(hand1, egg1, table1, 1.5, 1.0, 0.02, 20)", PlanError, "offset 20 m of pour, allowed up to 0.5 m"),
    ("pour(hand1, egg1, egg1)", PlanError, "egg1 cannot be poured into itself"),
    ("pour(hand1, egg1, floor)", PlanError, "floor has no body to pour to"),
    ("pour(hand1, egg1, table1)", PlanError, "hand1 is not level, so it cannot pour; allowed: pitch 0 and roll 0"),
    ("carry(hand1, [0, 0, 0])", PlanError, r"displacement of .* must not be zero, but is 0 m$"),
    ("carry(hand1, [0, 0, -0.0])", PlanError, "must not be zero"),
    ("lift(hand1, 0)", PlanError, "height of .* must not be zero, but is 0"),
    ("wipe(hand1, egg1, egg1, [0.1, 0, 0])", PlanError, "egg1 cannot be wiped over itself"),
    ("wipe(hand1, egg1, table1, [0, 0, 0.1])", PlanError, "a stroke of wipe goes along the surface, not only up or"),
    ("grasp(hand1, egg1, 5, 0, -0.01)", PlanError, "short of .* must not be negative, but is -0.01"),
    (
        "reach(hand1, egg1, 0.2, 0, 0.03)",
        PlanError,
        "30 mm short of the middle of egg1 is beyond its end, which is 28 mm",
    ),
    ("pour(hand1, egg1, table1, -1)", PlanError, "angle of .* must be positive, not -1 rad"),
    ("pour(hand1, egg1, table1, 0)", PlanError, "angle of .* must be positive, not 0 rad"),
    ("tilt(hand1, 1, 1e-12)", PlanError, "rate of .* must be at least 0.001 rad/s, not 1e-12"),
    ("lift(hand1, 0.1, 1e-12)", PlanError, "speed of .* must be at least 0.0001 m/s, not 1e-12"),
    ("lift(hand1, 0.1, 0.1, 1e-12)", PlanError, "acceleration of .* must be at least 0.001 m/s2, not 1e-12"),
    ("hit(hand1, egg1, table1, 1e-9)", PlanError, "speed of .* must be at least 0.0001 m/s, not 1e-09"),
    ("repeat_until(touching(egg1, egg1), wait(1))", PlanError, "would never hold: nothing touches itself"),
    ("repeat_until(not(pressed(egg1, egg1, 2)), wait(1))", PlanError, "would never hold: nothing touches itself"),
    ("wait(0.1), wait(0.2)", PlanError, r"actions are joined by sequence\(\[A, B\]\) or together"),
    (
        "grasp(hand1, egg1, '5 N')",
        PlanError,
        r"must be a number \[N\] or a force level, not 5 N; what has",
    ),
    ("sequence(lift(hand1, 0.1))", PlanError, "sequence needs a list of at least one action"),
    ("sequence([Something])", PlanError, "Something stands where an action is needed"),
    ("wait", PlanError, r"wait\(\) has 0 arguments, needed: wait\(Duration\)"),
]


@pytest.mark.parametrize(("plan", "kind", "message"), REFUSED)
def test_a_plan_that_cannot_work_is_refused(
    plan: str, kind: type[InputError], message: str, egg_in_hand: Scene
) -> None:
    with pytest.raises(kind, match=message):
        read_program(parse_term(plan), egg_in_hand)


@pytest.mark.parametrize(
    "plan",
    [
        "lift(hand1, -0.1)",
        "carry(hand1, [0, 0, -0.1])",
        "tilt(hand1, 0)",
        "grasp(hand1, egg1, 5, -0.005, 0.02)",
        "bring(hand1, table1, -0.01)",
        "wipe(hand1, egg1, table1, [0.1, 0, 0.01])",
    ],
)
def test_a_plan_whose_zero_or_negative_number_means_something_is_read(plan: str, egg_in_hand: Scene) -> None:
    read_program(parse_term(plan), egg_in_hand)


def test_an_object_out_of_reach_is_refused() -> None:
    far = scene(":floor a :Floor . :egg1 a :Egg ; :x 9.0 ; :on :floor . :hand1 a :Gripper ; :pitch 90.0 ; :z 0.5 .")
    with pytest.raises(PlanError, match=r"egg1 is out of reach of hand1: 9\.00 m away, allowed 1\.5 m"):
        read_program(parse_term("grasp(hand1, egg1, 5)"), far)


def test_every_action_says_what_it_does_and_how_it_is_written() -> None:
    for spec in ACTIONS.values():
        assert spec.doc.endswith("."), spec.name
        assert spec.usage().startswith(f"{spec.name}(")
    assert isinstance(parse_term("wait(1)"), Term)


def test_two_actions_at_once_with_the_same_hand_are_refused(egg_in_hand: Scene) -> None:
    with pytest.raises(PlanError, match="two actions done together command hand1"):
        read_program(parse_term("together([lift(hand1, 0.1), sequence([close(hand1, 5)])])"), egg_in_hand)


def test_a_parameter_in_another_unit_than_its_place_needs_is_refused() -> None:
    plan = parse_term("sequence([wait(Time), grasp(hand1, egg1, Force)])")
    check_units(plan, {"Time": "s", "Force": "N"})
    check_units(plan, {"Time": None, "Force": None})
    with pytest.raises(PlanError, match="parameter Force is in kg, but force of grasp needs N"):
        check_units(plan, {"Time": "s", "Force": "kg"})
