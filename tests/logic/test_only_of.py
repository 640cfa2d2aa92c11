"""A "no" says that what is asked never comes about of a thing here, and what was told instead."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.fluents.worlds import FLOOR, STEP, box, roll, world
from tests.synthetic import egg_drop_log

from prolepsis import Log, recognize
from prolepsis.knowledge import KnowledgeBase
from prolepsis.log.domain import Domain
from prolepsis.log.fact_types import NEEDS, ONLY_OF, TOLD_INSTEAD, fact_types
from prolepsis.log.saved import read_timeline_files, write_timeline_files
from prolepsis.log.things import Thing
from prolepsis.log.timeline import Fact, make_timeline
from prolepsis.terms.errors import Note

RUN = make_timeline(
    [
        Fact(kind="event", type="overloading", args=("cup1", 4.9), start=0.4, end=0.401),
        Fact(kind="fluent", type="broken", args=("egg1",), start=0.5, end=2.0),
    ],
    dt=1e-3,
    duration=2.0,
    domain=Domain(
        instances=(
            ("cup1", "Cup"),
            ("egg1", "Breakable"),
            ("eggshell1", "Breakable"),
            ("bowl 2", "Bowl"),
            ("towel1", "Towel"),
        )
        + tuple((name, kind) for name, kind in (("liq1", "Liquid"), ("liq1", "Stuff"), ("yolk1", "Membraned"))),
        subclasses=(("Sponge", "Absorbent"), ("DentingBowl", "Bowl"), ("Hand", "Gripper")),
        parts=(("egg1", "eggshell1"), ("egg1", "yolk1")),
    ),
)


@pytest.mark.parametrize(
    ("goal", "told"),
    [
        (
            "holds(broken(cup1), T)",
            r"overloading\(cup1,4\.9\) occurred, and broken is told of nothing but what is Breakab",
        ),
        ("occurs(breaking(cup1), T)", r"overloading\(cup1,4\.9\) occurred"),
        ("holds(F, T), F = cracked(cup1)", r"overloading\(cup1,4\.9\) occurred"),
        ("holds(F, T), fluentT(F, open), objOf(F, cup1)", r"overloading\(cup1,4\.9\) occurred"),
        ("holds(crushed(X), T)", r"overloading\(cup1,4\.9\) occurred, and crushed is"),
        ("holds(broken('bowl 2'), T)", "'bowl 2' is not Breakable or Membraned, and broken is told of nothing else"),
        ("holds(broken(liq1), T)", "liq1 is not Breakable or Membraned"),
        ("occurs(absorbing(towel1, X), T)", "towel1 is not Absorbent, and absorbing is told of nothing else"),
        ("occurs(E, T), eventT(E, dripping), objOf(E, towel1)", "towel1 is not Absorbent or Liquid or Stuff"),
        ("occurs(pouringTo(cup1, egg1, X), T)", "egg1 is not Liquid or Stuff, and pouringTo is told of nothing else"),
        ("holds(floats(egg1, cup1), T)", "cup1 is not Liquid or Stuff, and floats is told"),
        ("holds(dented(cup1), T)", "cup1 is not DentingBowl, and dented is told of nothing else"),
        ("occurs(closingGripper(cup1), T)", "cup1 is not Gripper, and closingGripper is told of nothing else"),
        ("holds(broken(eggshell1), T)", r"broken\(egg1\) tells of it: eggshell1 is a part"),
    ],
)
def test_no_says_what_never_comes_about(goal: str, told: str) -> None:
    with pytest.warns(Note, match=f"^no, but {told}"):
        assert RUN.ask(goal) == []


@pytest.mark.parametrize(
    "goal",
    [
        "holds(broken(egg1), 0.1)",
        "holds(open(egg1), T)",
        "holds(broken(yolk1), T)",
        "holds(buckled(cup1), T)",
        "holds(floats(egg1, X), T)",
        "holds(wet(cup1), T)",
        "occurs(pouringTo(cup1, liq1, egg1), T)",
    ],
)
def test_no_word_is_lost_about_what_breaks(goal: str) -> None:
    assert RUN.ask(goal) == []
    unknown = make_timeline([], dt=1e-3, duration=2.0, domain=Domain(instances=(("cup1", "Cup"),)))
    assert unknown.ask("holds(broken(cup1), T)") == []


def test_the_types_are_those_that_are_found() -> None:
    import prolepsis.fluents

    assert prolepsis.fluents
    chronicles = {"pouringTo", "overflowing", "leaking"}
    assert {*ONLY_OF, *NEEDS, *TOLD_INSTEAD.values()} - chronicles <= fact_types().keys()
    arities = {name: {len(known.arguments)} for name, known in fact_types().items()}
    assert all({len(roles)} == arities[name] for name, roles in ONLY_OF.items() if name not in chronicles)
    classes = KnowledgeBase.load().vocabulary.classes
    assert {role for roles in ONLY_OF.values() for each in roles for role in each} <= classes.keys()


def test_what_is_found_is_of_such_classes() -> None:
    timeline = recognize(egg_drop_log())
    classes: dict[str, set[str]] = {}
    for name, kind in timeline.domain.instances:
        classes.setdefault(name, set()).add(kind)
    asked = [(fact, i) for fact in timeline.facts for i, roles in enumerate(ONLY_OF.get(fact.type, ())) if roles]
    assert asked
    for fact, i in asked:
        assert classes[str(fact.args[i])] & {*ONLY_OF[fact.type][i]}, fact


FOREIGN = [
    ("holds(broken(a), T)", "Breakable or Membraned, and does not decide broken"),
    ("occurs(breaking(X), T)", "Breakable or Membraned, and does not decide breaking"),
    ("holds(F, T), fluentT(F, crushed)", "Breakable, and does not decide crushed"),
    ("holds(spilled(X), T)", "Liquid or Stuff, and does not decide spilled"),
    ("occurs(pouringTo(a, X, floor), T)", "Liquid or Stuff, and does not decide pouringTo"),
    ("holds(wet(a), T)", "Liquid or Stuff, and does not decide wet"),
    ("holds(absorbs(a, X), T)", "Absorbent, and does not decide absorbs"),
    ("occurs(closingGripper(a), T)", "Gripper, and does not decide closingGripper"),
    ("\\+ holds(broken(a), _)", "Breakable or Membraned, and does not decide broken"),
]


@pytest.mark.parametrize(("goal", "told"), FOREIGN)
def test_a_log_of_others_does_not_decide_what_it_tells_nothing_of(goal: str, told: str) -> None:
    timeline = recognize(Log.from_mujoco(*roll(world(FLOOR + box("a", "0 0 .05")), 0.05), STEP))
    with pytest.warns(Note, match=f"the log tells of nothing that is {told}"):
        timeline.ask(goal)


def test_what_is_said_to_break_does_not_without_parts(tmp_path: Path) -> None:
    fragile = Thing(name="a", kind="Mug", roles=frozenset({"Breakable"}))
    log = Log.from_mujoco(*roll(world(FLOOR + box("a", "0 0 .05")), 0.05), STEP, scene={"a": fragile})
    write_timeline_files(recognize(log), tmp_path)
    for timeline in (recognize(log), read_timeline_files(tmp_path)):
        with pytest.warns(Note, match="Breakable, and does not decide cracked"):
            assert timeline.ask("holds(cracked(a), T)") == []
        assert timeline.ask("holds(contains(a, X), T)") == []


def test_what_a_log_alone_says_of_classes_is_not_all() -> None:
    instances = (("egg1", "Breakable"), ("yolk1", "EggYolk"), ("yolk1", "Stuff"))
    domain = Domain(instances=instances, parts=(("egg1", "yolk1"),))
    told = make_timeline(RUN.facts[1:], dt=1e-3, duration=2.0, domain=domain)
    assert told.select(type="broken") and told.ask("holds(broken(yolk1), T)") == []
