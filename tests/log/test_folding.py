"""Facts that differ only in which of many like things they are about are told as one; what is alike, things say."""

from __future__ import annotations

import pytest

from prolepsis.log.domain import Domain, with_things
from prolepsis.log.folding import MANY, about, fold
from prolepsis.log.things import Thing
from prolepsis.log.timeline import Fact, make_timeline

SHARDS = ("a", "cap", "Rim_2", "left", "x7", "of all", "last")
"""Seven names that have nothing in common."""


def known(*things: Thing) -> Domain:
    return with_things(Domain(), things)


def shards(*names: str, kind: str = "Shard") -> tuple[Thing, ...]:
    return (Thing(name="jar", kind="Jar"), *(Thing(name=name, kind=kind, whole="jar") for name in names))


def lying(name: str, start: float = 1.0, end: float = 2.0, force: float = 1.0) -> Fact:
    return Fact(kind="fluent", type="supports", args=("floor", name), start=start, end=end, evidence={"force": force})


def told(facts: list[Fact], domain: Domain) -> list[str]:
    return [row.what for row in fold(facts, domain)]


def test_facts_about_parts_of_one_whole_are_told_as_one() -> None:
    facts = [lying(name, 1.0 + 0.1 * i, 2.0 + 0.1 * i, i + 1.0) for i, name in enumerate(SHARDS)]
    (row,) = fold(facts, known(*shards(*SHARDS)))
    assert row.what == "supports(floor,[7 parts of jar])"
    assert (row.start, row.end) == (1.0, 2.0 + 0.1 * 6)
    assert row.evidence == "facts=7, force=1..7"


def test_a_short_fact_within_a_long_one_ends_no_burst() -> None:
    facts = [lying("a", 1.0, 4.0), lying("cap", 1.1, 1.2), lying("left", 3.0, 4.0)]
    (row,) = fold(facts, known(*shards(*SHARDS)))
    assert (row.what, row.start, row.end) == ("supports(floor,[3 parts of jar])", 1.0, 4.0)


def test_how_many_are_meant_is_told() -> None:
    assert told([lying(name) for name in SHARDS[:3]], known(*shards(*SHARDS))) == ["supports(floor,[3 parts of jar])"]


def test_one_of_many_keeps_its_name() -> None:
    facts = [lying("cap", 1.0, 2.0), lying("cap", 2.1, 3.0)]
    assert told(facts, known(*shards(*SHARDS))) == ["supports(floor,cap)"] * 2


def test_few_parts_keep_their_names() -> None:
    names = SHARDS[: MANY - 1]
    assert len(told([lying(name) for name in names], known(*shards(*names)))) == len(names)


def test_parts_of_other_classes_keep_their_names() -> None:
    things = [*shards(*SHARDS[:MANY]), Thing(name="lid", kind="Lid", whole="jar")]
    facts = [lying(name) for name in (*SHARDS[:MANY], "lid")]
    assert sorted(told(facts, known(*things))) == ["supports(floor,[6 parts of jar])", "supports(floor,lid)"]


def test_the_links_of_a_chain_are_parts_of_what_they_all_hang_on() -> None:
    links = [Thing(name=f"l{i}", kind="Link", whole=f"l{i - 1}" if i else "robot") for i in range(MANY)]
    domain = known(Thing(name="robot", kind="Robot"), *links)
    assert told([lying(link.name) for link in links], domain) == ["supports(floor,[6 parts of robot])"]


def test_things_are_alike_that_are_of_the_same_classes_and_mass() -> None:
    beads = [Thing(name=name, kind="Bead", mass=0.001) for name in SHARDS]
    heavy = Thing(name="marble", kind="Bead", mass=0.02)
    assert sorted(told([lying(each.name) for each in (*beads, heavy)], known(*beads, heavy))) == [
        "supports(floor,[7 like 'Rim_2'])",
        "supports(floor,marble)",
    ]


def test_names_alone_make_nothing_alike() -> None:
    beads = [Thing(name=f"bead{i}", kind="Bead", mass=0.001 * (i + 1)) for i in range(9)]
    assert len(told([lying(each.name) for each in beads], known(*beads))) == 9


def test_what_comes_later_is_told_apart() -> None:
    facts = [lying(name, start, start + 0.1) for start in (0.0, 5.0) for name in SHARDS[:2]]
    assert told(facts, known(*shards(*SHARDS))) == ["supports(floor,[2 parts of jar])"] * 2


def test_facts_among_many_name_them_twice() -> None:
    facts = [
        Fact(kind="event", type="colliding", args=pair, start=0.0, end=0.1)
        for pair in (("a", "cap"), ("cap", "left"), ("left", "x7"))
    ]
    assert told(facts, known(*shards(*SHARDS))) == ["colliding([4 parts of jar],[4 parts of jar])"]


@pytest.mark.parametrize("whole", ["jar", "shelf"])
def test_what_is_about_a_thing_is_about_its_parts(whole: str) -> None:
    domain = known(Thing(name="shelf", kind="Shelf"), *shards("a", "cap"))
    domain = with_things(Domain(parts=(("shelf", "jar"),)), [*shards("a", "cap")]) if whole == "shelf" else domain
    timeline = make_timeline([lying("a")], dt=0.001, duration=3.0, domain=domain)
    assert {"jar", "a", "cap"} <= about(timeline, whole)
