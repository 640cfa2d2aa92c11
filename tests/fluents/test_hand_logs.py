"""Stories on logs made by hand: grippers, commanded levels, actions and grips."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.fluents.logs import Draft, floor, solid_box
from tests.fluents.worlds import FLOOR, HAND, HAND_DRIVES, drive, ever, of_type, ramp, times, watch, world

from prolepsis.fluents import recognize
from prolepsis.geometry.shape import Geom, Shape
from prolepsis.log.fact_types import EVENTS, FLUENTS, event_of
from prolepsis.log.log import Action, Joints
from prolepsis.log.things import Thing
from prolepsis.terms.terms import Term


def hand(name: str = "rightGripper") -> list[Thing]:
    """Return a gripper of a palm and two fingers."""
    pad = Shape(geoms=(Geom(type="box", size=(0.02, 0.005, 0.02)),))
    return [
        Thing(name=name, kind="Hand", roles=frozenset({"Gripper"}), position=(0.0, 0.0, 0.2)),
        Thing(name=f"{name}/palm", kind="Palm", shape=pad, whole=name, position=(0.0, 0.0, 0.2)),
        Thing(name=f"{name}/left_finger", kind="Finger", shape=pad, whole=name, position=(0.0, 0.055, 0.05)),
        Thing(name=f"{name}/right_finger", kind="Finger", shape=pad, whole=name, position=(0.0, -0.055, 0.05)),
    ]


def grasp_draft() -> Draft:
    draft = Draft(1000, [floor(), *hand(), solid_box("egg1", mass=0.1)])
    draft.carrier[:, draft.index("rightGripper")] = -1
    return draft


def action(name: str, *, start: int, end: int, **arguments: str | float) -> Action:
    return Action(term=Term(name, tuple(arguments.values())), arguments=arguments, start=start, end=end)


def squeeze(draft: Draft, start: int, end: int, force: float = 10.0) -> None:
    draft.press("rightGripper/left_finger", "egg1", start, end, (0.0, -force, 0.5), (0.0, -1.0, 0.0))
    draft.press("rightGripper/right_finger", "egg1", start, end, (0.0, force, 0.5), (0.0, 1.0, 0.0))


def test_closing_carries_the_commanded_level_of_the_grasp() -> None:
    draft = grasp_draft()
    state = np.zeros(1000)
    state[100:300], state[800:900] = -1.0, 1.0
    force = np.linspace(0.0, 20.0, 1000)
    grasp = action("grasp", hand="rightGripper", object="egg1", force="force7", start=50, end=320)
    release = action("release", hand="rightGripper", start=800, end=900)
    channels = {"rightGripper.gripper": state, "rightGripper.pad_force": force}
    timeline = recognize(draft.log(channels=channels, actions=(grasp, release)))
    assert times(timeline, "closingGripper(rightGripper)") == [(0.1, 0.3)]
    assert times(timeline, "openingGripper(rightGripper)") == [(0.8, 0.9)]
    (closing,) = timeline.select(type="closingGripper")
    assert closing.evidence["level"] == "force7"
    assert closing.evidence["force"] == pytest.approx(force[299], rel=1e-11)
    assert "level" not in timeline.select(type="openingGripper")[0].evidence
    assert times(timeline, "grasping(rightGripper,egg1,force7)") == [(0.05, 0.32)]
    assert times(timeline, "releasing(rightGripper)") == [(0.8, 0.9)]


@pytest.mark.parametrize(("argument", "level"), [(20, 20.0), (7.5, 7.5), ("force12", "force12")])
def test_a_level_may_be_a_number(argument: float | str, level: float | str) -> None:
    draft = grasp_draft()
    close = action("close", hand="rightGripper", force=argument, start=0, end=300)
    other = action("grasp", hand="leftGripper", object="cup1", force=3, start=0, end=400)
    state = np.where(np.arange(1000) < 250, -1.0, 0.0)
    timeline = recognize(draft.log(channels={"rightGripper.gripper": state}, actions=(other, close)))
    assert timeline.select(type="closingGripper")[0].evidence["level"] == level


def test_of_two_grasps_the_level_is_that_of_the_one_that_goes_on_longer_while_the_gripper_closes() -> None:
    draft = grasp_draft()
    state = np.where((np.arange(1000) >= 100) & (np.arange(1000) < 300), -1.0, 0.0)
    first = action("grasp", hand="rightGripper", object="egg1", force="force3", start=0, end=120)
    second = action("grasp", hand="rightGripper", object="egg1", force="force7", start=120, end=400)
    timeline = recognize(draft.log(channels={"rightGripper.gripper": state}, actions=(first, second)))
    assert timeline.select(type="closingGripper")[0].evidence["level"] == "force7"


def test_without_a_logged_state_the_gap_between_the_fingers_tells() -> None:
    draft = grasp_draft()
    way = np.concatenate((np.zeros(200), np.linspace(0, 0.02, 300), np.full(200, 0.02), np.linspace(0.02, 0, 300)))
    draft.poses[:, draft.index("rightGripper/left_finger"), 1] -= way
    draft.poses[:, draft.index("rightGripper/right_finger"), 1] += way
    timeline = recognize(draft.log())
    ((start, end),) = times(timeline, "closingGripper(rightGripper)")
    assert abs(start - 0.2) < 0.02
    assert abs(end - 0.5) < 0.02
    assert len(times(timeline, "openingGripper(rightGripper)")) == 1
    assert "moving(rightGripper)" not in ever(timeline)


def closing(*things: Thing) -> bool:
    """Return whether a gripper is seen to close whose two last parts come together."""
    draft = Draft(500, [floor(), *things])
    draft.carrier[:, draft.index(things[0].name)] = -1
    for part, way in zip(things[-2:], (-1.0, 1.0), strict=True):
        draft.poses[:, draft.index(part.name), 1] += way * np.linspace(0, 0.05, 500)
    return f"closingGripper({things[0].name})" in ever(recognize(draft.log()))


def test_a_finger_is_what_is_told_to_be_one_or_where_the_joints_end_whatever_it_is_called() -> None:
    whole, palm, left, right = hand()
    assert closing(whole, palm, replace(left, name="rightGripper/a"), replace(right, name="rightGripper/b"))
    unknown = [replace(part, kind="Thing") for part in (left, right)]
    # A palm, and two parts beside it of which nothing is told but their names: any two may be the fingers.
    assert not closing(whole, palm, *unknown)
    assert closing(whole, palm, *(replace(part, roles=frozenset({"Finger"})) for part in unknown))
    assert closing(whole, palm, *(replace(part, whole=palm.name) for part in unknown))


def test_a_hand_of_a_model_closes_whatever_its_fingers_are_called() -> None:
    for name in ("finger", "jaw"):
        xml = world(FLOOR + HAND.replace("_finger", f"_{name}"), HAND_DRIVES)
        gripper = {"hand": Thing(name="hand", kind="Hand", roles=frozenset({"Gripper"}))}
        control = drive(lambda _: 0.0, lambda _: 0.0, lambda t: ramp(t, 0.1, 0.2, 2.0))
        assert "closingGripper(hand)" in ever(watch(xml, 0.6, control, gripper))


def test_a_grip_attaches_when_nothing_else_carries() -> None:
    draft = grasp_draft()
    squeeze(draft, 200, 1000)
    draft.rest("floor", "egg1", 0, 500, 0.981)
    timeline = recognize(draft.log())
    assert times(timeline, "attached(rightGripper,egg1)") == [(0.5, 1.0)]
    (fact,) = timeline.select(type="attached")
    assert fact.evidence["by"] == "grip"
    assert fact.evidence["pad_force"] == pytest.approx(10.0)  # type: ignore[reportUnknownMemberType]
    assert "supports(rightGripper,egg1)" not in ever(timeline)


def test_what_slips_out_of_the_fingers_is_not_attached() -> None:
    draft = grasp_draft()
    squeeze(draft, 0, 1000)
    draft.poses[:, draft.index("egg1"), 2] -= 0.05 * np.arange(1000) / 1000
    assert not of_type(recognize(draft.log()), "attached", "falling")


def test_one_finger_does_not_hold() -> None:
    draft = grasp_draft()
    draft.press("rightGripper/left_finger", "egg1", 0, 1000, (0.0, -10.0, 0.9), (0.0, -1.0, 0.0))
    assert not of_type(recognize(draft.log()), "attached", "supports")


def test_what_lies_on_a_palm_is_supported_and_not_attached() -> None:
    draft = grasp_draft()
    draft.rest("rightGripper/palm", "egg1", 0, 1000, 0.981)
    timeline = recognize(draft.log())
    assert of_type(timeline, "supports", "attached") == {"supports(rightGripper,egg1)"}


def test_a_joint_attaches_for_as_long_as_it_is_there() -> None:
    draft = grasp_draft()
    one = np.array([draft.index("rightGripper/palm")])
    joints = Joints(a=one, b=np.array([draft.index("egg1")]), start=np.array([100]), end=np.array([500]))
    timeline = recognize(draft.log(joints=joints))
    assert times(timeline, "attached(rightGripper,egg1)") == [(0.1, 0.5)]


def test_actions_become_events_in_ing() -> None:
    verbs = ["grasp", "release", "move", "hit", "pourTo", "put", "wait", "open", "wipe", "lie", "stir", "carry", "tap"]
    assert [event_of(verb) for verb in verbs] == [
        "grasping", "releasing", "moving", "hitting", "pouringTo", "putting", "waiting", "opening", "wiping", "lying",
        "stirring", "carrying", "tapping",
    ]  # fmt: skip


def test_any_action_of_a_log_is_an_event_with_its_arguments() -> None:
    draft = grasp_draft()
    stir = Action(term=Term("stir", ("rightGripper", (0.1, 2))), start=10, end=10, outcome="unfinished")
    (fact,) = recognize(draft.log(actions=(stir,))).select(type="stirring")
    assert (fact.start, fact.end, fact.args, fact.evidence["outcome"]) == (
        0.01,
        0.011,
        ("rightGripper", "[0.1,2]"),
        "unfinished",
    )


def test_all_of_both_tables_are_listed_with_a_line() -> None:
    assert set(FLUENTS) == {
        *("contacts", "attached", "supports", "contains", "broken", "spilled", "absorbs", "dented", "buckled"),
        *("wet", "dirty", "cracked", "open", "crushed", "floats", "immersed"),
    }
    table2 = {"colliding", "falling", "moving", "openingGripper", "closingGripper", "breaking", "spilling"}
    assert table2 <= set(EVENTS)
    assert all(known.doc for known in (*FLUENTS.values(), *EVENTS.values()))


def edge_draft(ticks: int = 1000) -> Draft:
    """Return a board in the air, and two hands that each have a pad above and a pad below it."""
    board = replace(solid_box("tray1", mass=0.4), position=(0.0, 0.0, 0.15))
    draft = Draft(ticks, [floor(), *hand("handL"), *hand("handR"), board])
    for name in ("handL", "handR"):
        draft.carrier[:, draft.index(name)] = -1
    return draft


def clamp(draft: Draft, name: str, start: int, end: int, palm: float = 0.0) -> None:
    """Let a hand press on the board from above and below, and with its palm along y [N]."""
    draft.press(f"{name}/left_finger", "tray1", start, end, (0.0, 0.0, -20.0), (0.0, 0.0, -1.0))
    draft.press(f"{name}/right_finger", "tray1", start, end, (0.0, 0.0, 22.0), (0.0, 0.0, 1.0))
    if palm:
        draft.press(f"{name}/palm", "tray1", start, end, (0.0, palm, 0.0), (0.0, float(np.sign(palm)), 0.0))


@pytest.mark.parametrize("palm", [0.0, 100.0])
def test_each_of_two_hands_holds_what_both_grip(palm: float) -> None:
    draft = edge_draft()
    clamp(draft, "handL", 0, 1000, palm)
    clamp(draft, "handR", 0, 1000, -palm)
    timeline = recognize(draft.log())
    for name in ("handL", "handR"):
        assert times(timeline, f"attached({name},tray1)") == [(0.0, 1.0)]
    assert all(fact.evidence["pad_force"] == pytest.approx(21.0) for fact in timeline.select(type="attached"))


def test_in_a_handover_the_holds_overlap() -> None:
    draft = edge_draft()
    clamp(draft, "handL", 0, 600)
    clamp(draft, "handR", 400, 1000)
    timeline = recognize(draft.log())
    assert times(timeline, "attached(handL,tray1)") == [(0.0, 0.6)]
    assert times(timeline, "attached(handR,tray1)") == [(0.4, 1.0)]
    goal = "holds(attached(handL, tray1), A), holds(attached(handR, tray1), B), overlaps(A, B)"
    assert timeline.ask(goal)


def test_what_swings_in_a_pinch_is_held_and_what_runs_through_the_pads_is_not() -> None:
    draft = grasp_draft()
    squeeze(draft, 0, 1000)
    angle = np.linspace(0.0, 2.0, 1000)
    egg1 = draft.index("egg1")
    draft.poses[:, egg1, 3], draft.poses[:, egg1, 5] = np.cos(angle / 2), np.sin(angle / 2)
    assert times(recognize(draft.log()), "attached(rightGripper,egg1)") == [(0.0, 1.0)]
    draft.poses[:, egg1, 2] = 0.05 - 0.1 * np.maximum(np.arange(1000) - 500, 0) * 0.001
    ((_, end),) = times(recognize(draft.log()), "attached(rightGripper,egg1)")
    assert end == pytest.approx(0.5, abs=0.03)


def test_what_is_gripped_and_dragged_over_a_table_is_attached() -> None:
    draft = grasp_draft()
    squeeze(draft, 100, 900)
    draft.rest("floor", "egg1", 0, 1000, 0.98)
    way = 0.05 * np.clip(np.arange(1000) - 300, 0, 400) * 0.001
    for i, thing in enumerate(draft.things):
        if thing.name != "floor":
            draft.poses[:, i, 0] += way
    ((start, end),) = times(recognize(draft.log()), "attached(rightGripper,egg1)")
    assert start == pytest.approx(0.3, abs=0.03)
    # It stays in the grip where it is left standing.
    assert end == pytest.approx(0.9, abs=0.03)


@pytest.mark.parametrize("gap", [10, 50])
def test_how_fast_it_slips_is_told_where_it_is_known(gap: int) -> None:
    draft = grasp_draft()
    squeeze(draft, 200, 400)
    squeeze(draft, 400 + gap, 600)
    (held,) = recognize(draft.log()).select(type="attached")
    assert held.evidence["slip_speed"] == 0.0
