"""A class is asked at a time: what makes an individual one of a class comes and goes."""

from __future__ import annotations

import pytest

from prolepsis.knowledge import KnowledgeBase
from prolepsis.log.saved import read_timeline_files, write_timeline_files
from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.terms.errors import GoalError

SITUATION = """@prefix : <https://w3id.org/prolepsis#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
:WetEgg a owl:Class ; rdfs:comment "An egg that is wet." ;
  owl:equivalentClass [ a owl:Class ; owl:intersectionOf ( :Egg :WetThing ) ] .
:Slippery a owl:Class ; rdfs:comment "What slips." .
:WetThing rdfs:subClassOf :Slippery .
:Ruined a owl:Class ; rdfs:comment "What is broken." ;
  owl:equivalentClass [ a owl:Restriction ; owl:onProperty :broken ; owl:hasValue true ] .
:keeps a owl:ObjectProperty ; rdfs:subPropertyOf :carries ; rdfs:comment "Has in it." .
:carries a owl:ObjectProperty ; rdfs:subPropertyOf :keeps ; rdfs:comment "Has in it." .
:contains rdfs:subPropertyOf :keeps .
:Keeper a owl:Class ; rdfs:comment "A cup that has something in it." ;
  owl:equivalentClass [ a owl:Class ; owl:intersectionOf ( :Cup
    [ a owl:Restriction ; owl:onProperty :carries ; owl:someValuesFrom owl:Thing ] ) ] .
:table1 a :Table . :egg1 a :Egg ; :on :table1 . :cup1 a :Cup ; :on :table1 ; :x 0.2 .
:liq1 a :Water . :hand1 a :Gripper ; :wet true ; :z 1.0 . :hand2 a :Gripper ; :wet true ; :z 1.5 .
"""


def fluent(type_: str, *args: str, start: float, end: float) -> Fact:
    """Return a fluent without evidence."""
    return Fact(kind="fluent", type=type_, args=args, start=start, end=end)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Timeline:
    """Return a timeline, saved and read again, in which an egg breaks and things become wet and dry."""
    folder = tmp_path_factory.mktemp("run")
    (folder / "situation.ttl").write_text(SITUATION)
    facts = [
        fluent("broken", "egg1", start=0.5, end=2.0),
        fluent("wet", "egg1", start=0.6, end=1.0),
        fluent("wet", "egg1", start=1.5, end=2.0),
        fluent("wet", "hand1", start=0.0, end=0.8),
        fluent("contains", "cup1", "liq1", start=0.2, end=0.9),
        fluent("contains", "cup1", "egg1", start=1.2, end=1.4),
    ]
    domain = KnowledgeBase.load(folder / "situation.ttl").domain()
    write_timeline_files(make_timeline(facts, dt=0.001, duration=2.0, domain=domain), folder)
    return read_timeline_files(folder)


def when(run: Timeline, individual: str, kind: str) -> list[str]:
    """Return the intervals over which an individual is of a class."""
    return [str(answer["T"]) for answer in run.ask(f"instance_of({individual}, '{kind}', T)")]


def test_an_egg_is_a_broken_thing_from_when_it_breaks(run: Timeline) -> None:
    assert when(run, "egg1", "BrokenThing") == ["0.5-2.0"]
    assert run.ask("instance_of(egg1, 'BrokenThing', 1)") and not run.ask("instance_of(egg1, 'BrokenThing', 0.499)")
    assert run.ask("instance_of(egg1, 'BrokenThing')"), "whatever it is at any time is no 'no'"
    assert not run.ask("instance_of(cup1, 'BrokenThing')")


def test_what_it_is_for_good_it_is_from_start_to_end(run: Timeline) -> None:
    assert when(run, "egg1", "Egg") == when(run, "egg1", "PhysicalObject") == ["0.0-2.0"]


def test_a_class_that_asks_for_two_holds_while_both_are_so(run: Timeline) -> None:
    assert when(run, "egg1", "WetEgg") == ["0.6-1.0", "1.5-2.0"]
    assert when(run, "hand1", "WetEgg") == []


def test_a_container_of_liquid_is_one_while_a_liquid_is_in_it(run: Timeline) -> None:
    assert when(run, "cup1", "LiquidContainer") == ["0.2-0.9"]
    assert when(run, "cup1", "Container") == ["0.0-2.0"]


def test_what_was_told_ends_where_a_fluent_ends_and_stays_where_none_tells_of_it(run: Timeline) -> None:
    assert when(run, "hand1", "WetGripper") == when(run, "hand1", "WetThing") == ["0.0-0.8"]
    assert when(run, "hand2", "WetGripper") == ["0.0-2.0"]


def test_a_class_of_one_s_own_that_nothing_else_names_is_known(run: Timeline) -> None:
    assert when(run, "egg1", "Ruined") == ["0.5-2.0"] and not run.ask("instance_of(cup1, 'Ruined')")


def test_a_relation_to_anything_is_met_by_what_is_told_below_it(run: Timeline) -> None:
    assert when(run, "cup1", "Keeper") == ["0.2-0.9", "1.2-1.4"]


def test_classes_above_come_and_go_with_it(run: Timeline) -> None:
    assert when(run, "egg1", "Slippery") == ["0.6-1.0", "1.5-2.0"]
    assert when(run, "hand1", "Slippery") == ["0.0-0.8"]


def test_each_pair_comes_once_and_intervals_can_be_related(run: Timeline) -> None:
    answers = [(str(a["C"]), str(a["T"])) for a in run.ask("instance_of(egg1, C, T)")]
    assert len(answers) == len({*answers}) and ("BrokenThing", "0.5-2.0") in answers
    assert run.ask("instance_of(egg1, 'WetThing', T), during(T, B), instance_of(egg1, 'BrokenThing', B)")
    assert run.ask("after(T, B), instance_of(egg1, 'WetThing', T), instance_of(hand1, 'WetThing', B)")


def test_a_typo_in_it_is_no_no(run: Timeline) -> None:
    with pytest.raises(GoalError, match="did you mean 'BrokenThing'"):
        run.ask("instance_of(egg1, 'BrokenTing', T)")
    with pytest.raises(GoalError, match="did you mean egg1"):
        run.ask("instance_of(eggg1, 'BrokenThing', 1.0)")


def test_a_log_from_elsewhere_has_the_built_in_classes() -> None:
    bare = make_timeline([fluent("broken", "jar", start=0.5, end=1.0)], dt=0.001, duration=1.0)
    assert bare.ask("instance_of(jar, 'BrokenThing', T)") == []
    assert not bare.ask("instance_of(jar, 'Container')"), "nothing says that it is a physical object"
