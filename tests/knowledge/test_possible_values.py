"""What no thing of a class can be - a floor that is a ball, water of 300 degrees - is refused, and the idle too."""

from __future__ import annotations

from pathlib import Path

import pytest
from situations import load
from tests.scenes import scene

from prolepsis.knowledge import KnowledgeBase
from prolepsis.terms.errors import KnowledgeError

OTHER_SHAPES = [
    ("Floor", "box", "must be plane for a Floor"),
    ("Carpet", "sphere", "must be plane for a Carpet"),
    ("Table", "sphere", "must be box or cylinder or mesh for a Table"),
    ("Block", "plane", "must be box for a Block"),
    ("Ball", "box", "must be sphere for a Ball"),
    ("Cup", "sphere", "must be cup or mesh for a Cup"),
    ("PaperBowl", "sphere", "must be bowl"),
    ("PaperBowl", "mesh", "must be bowl for a PaperBowl"),
    ("Egg", "box", "must be ellipsoid for a Egg"),
    ("Gripper", "sphere", "must be parallelGripper for a Gripper"),
    ("PR2", "sphere", "must be articulated for a PR2"),
]


@pytest.mark.parametrize(("kind", "shape", "message"), OTHER_SHAPES)
def test_a_shape_that_a_class_cannot_have_is_refused(tmp_path: Path, kind: str, shape: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=rf"situation\.ttl:\d+: a: shape = {shape}: ({message})"):
        load(tmp_path, f":a a :{kind} ; :shape :{shape} ; :length 0.1 ; :width 0.1 ; :height 0.1 ; :radius 0.1 .")


def test_every_default_is_within_the_limits_of_its_classes() -> None:
    base = KnowledgeBase.load()
    for name in base.vocabulary.classes:
        classes = base.vocabulary.told_classes((name,))
        for limit in (limit for each in classes for limit in base.vocabulary.classes[each].limits):
            found = base.default_of(classes, limit.name)
            assert found is None or limit.admits(found[1].value), (name, limit.name)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            ":w a :Water ; :temperature 300 .",
            "temperature = 300 degC: must be at least 0 and at most 100 degC",
        ),
        (
            ":e a :Egg ; :hasPart :q . :q a :EggYolk ; :temperature 80 .",
            "q: temperature = 80 degC: must be at",
        ),
        (":c a :Cup ; :capacity 3 .", "c: its capacity follows from its extents; leave it out"),
        (":b a :Block ; :mass 3 ; :density 600 .", r"b: its mass is 3 kg, but density \* .* is 0\.6 kg; allowed: one"),
    ],
)
def test_what_cannot_be_or_is_told_twice_is_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        load(tmp_path, text)


def test_a_mass_and_a_density_that_agree_are_taken(tmp_path: Path) -> None:
    assert load(tmp_path, ":b a :Block ; :mass 0.603 ; :density 600 .").quantity("b", "mass") == 0.603


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (":w a :Water ; :on :floor ; :volume '5 ml' ; :shape :sphere .", "w .Water. has no shape of its own"),
        (":w a :Water ; :on :floor ; :volume '5 ml' ; :yaw 30 .", "w .Water. has no yaw of its own"),
        (":w a :Water ; :on :floor ; :volume '5 ml' ; :z 1 .", "w .Water. has no z of its own"),
        (
            ":e a :Egg ; :on :floor ; :hasPart :q . :q a :EggWhite ; :x 3 .",
            "q .EggWhite. has no x of its own",
        ),
        (
            ":h a :Gripper ; :z 1 ; :contains :b . :b a :Block .",
            "in the Gripper h, which has no cavity",
        ),
        (
            ":e a :Coconut ; :on :floor ; :hasPart :q . :q a :ShellContent .",
            "has no mass, since its part q",
        ),
        (":k a :Beads ; :on :floor ; :shape :sphere .", "k .Beads. has no shape of its own"),
        (
            ":b a :Block ; :on :floor ; :comprises :floor .",
            "b comprises floor: how is not said; state",
        ),
        (
            ":s a :Sponge ; :on :floor ; :absorbs :w ; :saturation 0.4 . :w a :Water ; :volume '1 l' .",
            "w .Water.: how much of it there is tells the saturation of s; leave out its volume",
        ),
    ],
)
def test_what_would_come_to_nothing_is_refused(text: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        scene(f":floor a :Floor . {text}")
