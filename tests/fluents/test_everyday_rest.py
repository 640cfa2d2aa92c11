"""Thirty everyday situations, first half: what rests, leans, holds and contains, as a person would say."""

from __future__ import annotations

from tests.fluents.worlds import (
    FLOOR,
    HAND,
    HAND_DRIVES,
    at_end,
    ball,
    box,
    cup_geoms,
    drive,
    ever,
    free,
    of_type,
    ramp,
    times,
    watch,
    world,
)

CUP = free("cup", "0 0 .0001", cup_geoms())


def test_in_a_stack_each_supports_the_next_one_only() -> None:
    timeline = watch(world(FLOOR + box("a", "0 0 .05") + box("b", "0 0 .15") + box("c", "0 0 .25")), 0.6)
    assert of_type(timeline, "supports") == {"supports(floor,a)", "supports(a,b)", "supports(b,c)"}
    assert of_type(timeline, "contacts") == {"contacts(a,floor)", "contacts(a,b)", "contacts(b,c)"}
    assert not of_type(timeline, "attached", "contains", "falling", "colliding")
    assert times(timeline, "supports(b,c)") == [(0.0, 0.6)]


def test_boxes_side_by_side_do_not_support_each_other() -> None:
    timeline = watch(world(FLOOR + box("a", "0 0 .05") + box("b", ".0999 0 .05")), 0.6)
    assert of_type(timeline, "supports", "contacts") == {
        "supports(floor,a)", "supports(floor,b)", "contacts(a,b)", "contacts(a,floor)", "contacts(b,floor)",
    }  # fmt: skip


def test_both_piers_support_a_bridge() -> None:
    piers = box("left", "-.15 0 .05") + box("right", ".15 0 .05")
    timeline = watch(world(FLOOR + piers + box("plank", "0 0 .11", ".2 .05 .01")), 0.6)
    assert of_type(timeline, "supports") == {
        "supports(floor,left)", "supports(floor,right)", "supports(left,plank)", "supports(right,plank)",
    }  # fmt: skip


def test_a_wall_does_not_support_what_leans_on_it() -> None:
    wall = '<geom name="wall" type="box" size=".02 .5 .5" pos=".22 0 .5"/>'
    ladder = box("ladder", ".07 0 .165", ".01 .05 .2", 0.5, 'friction="1.2"', "0 40 0")
    timeline = watch(world(FLOOR + wall + ladder), 1.2)
    assert of_type(timeline, "supports") == {"supports(floor,wall)", "supports(floor,ladder)"}
    assert "contacts(ladder,wall)" in at_end(timeline)
    assert not of_type(timeline, "attached", "contains")


def test_both_sides_of_a_groove_support_a_ball() -> None:
    sides = "".join(
        f'<geom name="{name}" type="box" size=".2 .2 .01" pos="{x} 0 .1" euler="0 {angle} 0"/>'
        for name, x, angle in (("left", -0.1, 45), ("right", 0.1, -45))
    )
    timeline = watch(world(sides + ball("ball", "0 0 .07", 0.04)), 0.8)
    assert of_type(timeline, "supports", "attached", "contains") == {"supports(left,ball)", "supports(right,ball)"}


def test_a_rough_slope_supports_a_box_at_rest() -> None:
    slope = '<geom name="slope" type="box" size=".5 .3 .02" euler="0 20 0"/>'
    timeline = watch(world(slope + box("box", ".0239 0 .0658", turn="0 20 0")), 0.8)
    assert "supports(slope,box)" in at_end(timeline)
    assert "moving(box)" not in at_end(timeline)
    assert not of_type(timeline, "falling")


def test_a_box_across_two_others_of_which_one_bears_nearly_all() -> None:
    # The right pier carries half of the light plank, a fortieth of the whole; a lump over the left pier is the rest.
    piers = box("left", "0 0 .05") + box("right", ".4 0 .05")
    lump = '<geom type="box" size=".04 .04 .03" pos="0 0 .04" mass="2"/>'
    beam = free("beam", "0 0 .11", '<geom type="box" size=".22 .03 .01" pos=".2 0 0" mass=".1"/>' + lump)
    timeline = watch(world(FLOOR + piers + beam), 0.8)
    assert "supports(left,beam)" in at_end(timeline)
    assert "supports(right,beam)" not in ever(timeline)


def test_a_seesaw_in_balance_supports_both_children_and_is_supported() -> None:
    pivot = '<geom name="pivot" type="cylinder" size=".03 .1" pos="0 0 .03" euler="90 0 0"/>'
    riders = box("anna", "-.25 0 .111", ".03 .03 .03", 0.2) + box("ben", ".25 0 .111", ".03 .03 .03", 0.2)
    timeline = watch(world(FLOOR + pivot + box("plank", "0 0 .07", ".3 .05 .01", 0.5) + riders), 0.8)
    assert of_type(timeline, "supports") == {
        "supports(floor,pivot)", "supports(pivot,plank)", "supports(plank,anna)", "supports(plank,ben)",
    }  # fmt: skip


def test_a_table_stands_on_the_floor_and_a_shelf_on_the_wall_does_not() -> None:
    table = (
        '<body name="table"><geom type="box" size=".3 .3 .01" pos="0 0 .4"/>'
        '<geom type="cylinder" size=".02 .195" pos=".25 .25 .195"/>'
        '<geom type="cylinder" size=".02 .195" pos="-.25 -.25 .195"/></body>'
    )
    shelf = '<body name="shelf" pos="0 1 1"><geom type="box" size=".1 .1 .01"/></body>'
    timeline = watch(world(FLOOR + table + shelf + box("box", "0 0 .46")), 0.4)
    assert of_type(timeline, "supports") == {"supports(floor,table)", "supports(table,box)"}


def test_what_is_nested_is_contained_by_all_around_it() -> None:
    bowl = free("bowl", "0 0 .0001", cup_geoms(0.1, 0.1))
    cup = free("cup", "0 0 .0043", cup_geoms(0.04, 0.06))
    timeline = watch(world(FLOOR + bowl + cup + ball("ball", "0 0 .024", 0.015)), 0.6)
    assert of_type(timeline, "contains") == {"contains(bowl,cup)", "contains(bowl,ball)", "contains(cup,ball)"}


def test_an_upturned_cup_over_a_box_contains_nothing() -> None:
    cup = free("cup", "0 0 .0801", cup_geoms(), "180 0 0")
    timeline = watch(world(FLOOR + cup + box("box", "0 0 .015", ".015 .015 .015", 0.1)), 0.6)
    assert not of_type(timeline, "contains", "attached")
    assert "supports(floor,box)" in at_end(timeline)


def test_the_free_corner_of_an_l_contains_nothing() -> None:
    part = free(
        "corner", "0 0 .005",
        '<geom type="box" size=".1 .1 .005" mass=".5"/>'
        '<geom type="box" size=".005 .1 .05" pos="-.095 0 .055" mass=".3"/>'
        '<geom type="box" size=".1 .005 .05" pos="0 -.095 .055" mass=".3"/>',
    )  # fmt: skip
    timeline = watch(world(FLOOR + part + box("box", "-.06 -.06 .0301", ".02 .02 .02", 0.1)), 0.6)
    assert not of_type(timeline, "contains")
    assert "supports(corner,box)" in at_end(timeline)


def test_a_tray_on_its_side_contains_nothing() -> None:
    walls = '<geom type="box" size=".003 .06 .04" pos="{} 0 .04"/><geom type="box" size=".06 .003 .04" pos="0 {} .04"/>'
    tray = free(
        "tray", "0 0 .061",
        '<geom type="box" size=".06 .06 .003"/>' + walls.format(0.057, 0.057) + walls.format(-0.057, -0.057), "90 0 0",
    )  # fmt: skip
    timeline = watch(world(FLOOR + tray + box("box", "0 -.04 .0201", ".015 .015 .015", 0.1)), 0.6)
    assert "supports(tray,box)" in at_end(timeline)
    assert not of_type(timeline, "contains")


def test_a_hoop_without_a_bottom_contains_nothing() -> None:
    hoop = free("hoop", "0 0 .0001", cup_geoms(0.08, 0.04, bottom=False))
    timeline = watch(world(FLOOR + hoop + ball("ball", "0 0 .02", 0.02)), 0.5)
    assert not of_type(timeline, "contains")


def test_a_lid_on_the_rim_is_not_in_the_pot_and_the_ball_under_it_is() -> None:
    lid = box("lid", "0 0 .0842", ".07 .07 .004", 0.1)
    timeline = watch(world(FLOOR + CUP + lid + ball("ball", "0 0 .024", 0.02)), 0.6)
    assert of_type(timeline, "contains") == {"contains(cup,ball)"}
    assert {"supports(cup,lid)", "supports(cup,ball)"} <= at_end(timeline)


def test_what_is_beside_or_above_a_cup_is_not_in_it() -> None:
    shelf = '<body name="shelf" pos="0 0 .15"><geom type="box" size=".05 .05 .005"/></body>'
    things = ball("beside", ".09 0 .02", 0.02) + ball("above", "0 0 .17", 0.015)
    timeline = watch(world(FLOOR + CUP + shelf + things), 0.5)
    assert not of_type(timeline, "contains")


def test_a_ball_too_big_for_the_cup_rests_on_its_rim() -> None:
    timeline = watch(world(FLOOR + CUP + ball("ball", "0 0 .126", 0.065)), 0.8)
    assert "supports(cup,ball)" in at_end(timeline)
    assert not of_type(timeline, "contains", "attached")


def test_a_basket_of_bars_contains_what_is_wider_than_its_gaps() -> None:
    places = [(-0.08 + 0.04 * k, side) for k in range(5) for side in (-0.08, 0.08)]
    bars = "".join(
        f'<geom type="box" size=".003 .003 .05" pos="{x} {y} .05" mass=".02"/>'
        for a, b in places
        for x, y in ((a, b), (b, a))
    )
    basket = free("basket", "0 0 .0031", '<geom type="box" size=".083 .083 .003" mass=".2"/>' + bars)
    timeline = watch(world(FLOOR + basket + ball("ball", "0 0 .037", 0.03)), 0.6)
    assert of_type(timeline, "contains") == {"contains(basket,ball)"}
    timeline = watch(world(FLOOR + basket + ball("pea", "0 0 .0162", 0.01)), 0.4)
    assert not of_type(timeline, "contains")


def test_a_weld_attaches_and_supports_nothing() -> None:
    hook = '<body name="hook" pos="0 0 .5"><geom type="box" size=".02 .02 .02"/></body>'
    weld = '<equality><weld body1="hook" body2="box"/></equality>'
    timeline = watch(world(FLOOR + hook + box("box", "0 0 .4"), weld), 0.5)
    assert times(timeline, "attached(hook,box)") == [(0.0, 0.5)]
    assert not of_type(timeline, "supports", "falling", "moving")


def test_a_stack_that_flickers_at_rest_neither_moves_nor_collides() -> None:
    # MuJoCo's default contacts under a heavy box on a light one never quite settle.
    stack = box("a", "0 0 .05", mass=5) + box("b", ".005 .003 .15", mass=0.1) + box("c", "0 0 .25", mass=3)
    timeline = watch(f"<mujoco><worldbody>{FLOOR}{stack}</worldbody></mujoco>", 1.5)
    assert not of_type(timeline, "colliding", "falling")
    assert not {term for term in at_end(timeline) if term.startswith("moving")}
    assert len(times(timeline, "supports(b,c)")) == 1


def test_an_open_hand_around_a_box_does_not_hold_it() -> None:
    brick = box("brick", "0 0 .03", ".02 .03 .03", 0.2)
    timeline = watch(world(FLOOR + HAND + brick, HAND_DRIVES), 0.5, drive(lambda t: 0, lambda t: 0, lambda t: -3))
    assert not of_type(timeline, "attached", "contains")
    assert "supports(hand,brick)" not in ever(timeline)


def test_a_grip_on_a_standing_box_attaches_it_only_when_it_is_lifted() -> None:
    brick = box("brick", "0 0 .03", ".02 .03 .03", 0.2)
    control = drive(lambda t: 0, lambda t: ramp(t, 0.8, 1.4, 0.1), lambda t: 10 if t > 0.3 else -3)
    timeline = watch(world(FLOOR + HAND + brick, HAND_DRIVES), 2.0, control)
    ((held, end),) = times(timeline, "attached(hand,brick)")
    ((_, lifted),) = times(timeline, "supports(floor,brick)")
    assert 0.3 < lifted <= held < 1.0
    assert end == timeline.duration
    assert "supports(hand,brick)" not in ever(timeline)
