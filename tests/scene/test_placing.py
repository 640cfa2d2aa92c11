"""A thing is placed at its x and y from what it is on, wherever that stands and however it is turned."""

from __future__ import annotations

import numpy as np
import pytest
from tests.matter.test_absorbing import SIZE
from tests.scenes import scene

from prolepsis.terms.errors import KnowledgeError

FLOOR = ":floor a :Floor . "
AWAY = FLOOR + ":table1 a :Table ; :x 0.75 ; :y -0.5 . "
CUBE = ":length 0.05 ; :width 0.05 ; :height 0.05 . "
RESTING = {
    "a solid": ":it a :Block ; " + CUBE,
    "what its kind builds": ":it a :Egg . ",
    "a bowl of panels": ":it a :PaperBowl . ",
    "a sponge": ":it a :Sponge ; " + SIZE + " . ",
}


@pytest.mark.parametrize("what", sorted(RESTING))
def test_x_and_y_are_from_what_a_thing_is_on(what: str) -> None:
    made = scene(AWAY + RESTING[what] + ":it :on :table1 ; :x -0.2 ; :y 0.1 .")
    (x, y) = next(t for t in made.things if "it" in (t.name, t.whole)).position[:2]
    assert (x, y) == pytest.approx((0.55, -0.4))


def test_a_puddle_is_at_its_x_and_y_from_what_it_is_on() -> None:
    made = scene(AWAY + ':it a :Water ; :on :table1 ; :x -0.2 ; :y 0.1 ; :volume "5 ml" .')
    (pool,) = made.pools
    assert pool.position.mean(axis=0)[:2] == pytest.approx((0.55, -0.4), abs=pool.spacing / 2)


def test_what_a_vessel_contains_is_at_its_x_and_y_from_the_vessel() -> None:
    ball = ":ball1 a :Ball ; :radius 0.01 ; :x 0.02 . "
    made = scene(AWAY + ":bowl1 a :Bowl ; :on :table1 ; :y 0.2 ; :contains :ball1 . " + ball)
    assert made.thing("ball1").position[:2] == pytest.approx((0.77, -0.3))


def test_each_of_a_pile_is_placed_from_the_one_below() -> None:
    below = ["table1", "b0", "b1", "b2"]
    pile = "".join(f":b{k} a :Block ; :on :{below[k]} ; :x 0.01 ; :y -0.02 ; {CUBE}" for k in range(4))
    made = scene(AWAY + pile)
    found = np.array([made.thing(f"b{k}").position[:2] for k in range(4)])
    assert found == pytest.approx(np.array([(0.76 + 0.01 * k, -0.52 - 0.02 * k) for k in range(4)]))


def test_without_x_and_y_a_thing_is_in_the_middle() -> None:
    made = scene(AWAY + ":b a :Block ; :on :table1 ; " + CUBE)
    assert made.thing("b").position[:2] == made.thing("table1").position[:2]


@pytest.mark.parametrize("turn", [":yaw 90.0", ":roll 90.0", ":yaw 30.0 ; :pitch 180.0"])
def test_a_turned_supporter_does_not_turn_what_is_on_it(turn: str) -> None:
    slab = f":slab a :Block ; :on :table1 ; :x 0.1 ; :length 0.2 ; :width 0.2 ; :height 0.2 ; {turn} . "
    made = scene(AWAY + slab + ":b a :Block ; :on :slab ; :x 0.03 ; :y -0.01 ; " + CUBE)
    assert made.thing("b").position[:2] == pytest.approx((0.88, -0.51))


def test_a_thing_on_two_lies_between_them_on_both() -> None:
    posts = "".join(f":{name} a :Block ; :on :table1 ; :y {y} ; {CUBE}" for name, y in (("one", -0.1), ("two", 0.1)))
    plank = ":plank a :Block ; :on :one, :two ; :length 0.05 ; :width 0.3 ; :height 0.01 ; :x 0.01 . "
    made = scene(AWAY + posts + plank)
    assert made.thing("plank").position[:2] == pytest.approx((0.76, -0.5))
    assert made.thing("plank").position[2] == pytest.approx(0.755, abs=1e-5)


def test_a_place_beside_the_supporter_is_told_in_the_world() -> None:
    with pytest.raises(KnowledgeError, match=r"x = 0, y = -0.5 in the world; its own :x and :y are from what it is on"):
        scene(AWAY + ":b a :Block ; :on :table1 ; :x -0.75 ; " + CUBE)


def test_what_is_not_lowered_cannot_be_on_anything() -> None:
    with pytest.raises(KnowledgeError, match="is on floor, but it is not lowered"):
        scene(AWAY + ":pr2 a :PR2 ; :on :floor .")


@pytest.mark.parametrize(
    ("told", "message"),
    [
        (
            ":b :on :floor, :table1 .",
            "b is on floor and table1, but on table1 it is 700 mm above floor",
        ),
        (":cup1 :contains :b . :b :on :floor .", "b .Block. is in several places: in cup1, on floor; allowed: one"),
        (":cup1 :contains :b . :cup2 :contains :b .", "b .Block. is in several places: in cup1, in cup2; allowed: one"),
        (":slab :contains :b .", "b cannot be in the Block slab, which has no cavity; needed: a Container"),
        (":cup1 :contains :b ; :pitch 180 .", "b cannot be in the Cup cup1: lowered onto it, it stays on top"),
        (":cup1 :contains :b ; :lid true .", "b cannot be in the Cup cup1: lowered onto it, it stays on top"),
    ],
)
def test_a_thing_that_cannot_be_where_it_is_said_to_be_is_refused(told: str, message: str) -> None:
    cups = ":cup1 a :Cup ; :on :table1 ; :x 0.3 . :cup2 a :Cup ; :on :table1 ; :x -0.3 ."
    slab = ":slab a :Block ; :on :table1 ; :x 0.15 . :b a :Block ; :length 0.02 ; :width 0.02 ; :height 0.02 . "
    with pytest.raises(KnowledgeError, match=message):
        scene(f"{AWAY} :floor a :Floor . {cups} {slab} {told}")


def test_what_is_in_a_vessel_in_a_vessel_is_in_the_inner_one() -> None:
    bowl = ":bowl1 a :Bowl ; :on :table1 ; :radius 0.2 ; :height 0.1 ; :contains :cup1 , :b . "
    made = scene(AWAY + bowl + ":cup1 a :Cup ; :contains :b . :b a :Ball ; :radius 0.01 .")
    assert made.thing("b").position[2] - made.thing("cup1").position[2] == pytest.approx(0.015, abs=1e-3)
