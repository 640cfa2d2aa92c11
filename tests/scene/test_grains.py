"""A granular stuff consists of bodies that are placed as it says, and is told of as one stuff."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.scenes import PREFIX, run, scene

from prolepsis.engine.world import compile_world
from prolepsis.fluents import recognize
from prolepsis.knowledge import KnowledgeBase
from prolepsis.log.timeline import Timeline
from prolepsis.projection import project
from prolepsis.scenario.scenario import Scenario
from prolepsis.terms.errors import KnowledgeError

CUP = ":floor a :Floor . :cup1 a :Cup ; :on :floor . "
FILLED = CUP + ":cup1 :contains :beads1 . :beads1 a :Beads . "
SOME = ":beads1 a :Granular ; :hasPart :bead1 , :bead2 , :bead3 . :bead1 a :Bead . :bead2 a :Bead . :bead3 a :Bead . "


def base(turtle: str, tmp_path: Path) -> KnowledgeBase:
    """Return the knowledge base of a situation."""
    (tmp_path / "s.ttl").write_text(PREFIX + turtle)
    return KnowledgeBase.load(tmp_path / "s.ttl")


def shown(timeline: Timeline, *types: str) -> dict[str, float]:
    """Return the terms of facts of some types with the greatest fraction."""
    return {str(f.term): float(f.evidence.get("fraction", 0.0)) for f in timeline.facts if f.type in types}


def test_beads_are_as_many_as_their_count_and_weigh_what_these_weigh(tmp_path: Path) -> None:
    known = base(CUP + ":beads1 a :Beads ; :grainCount 12 ; :on :floor ; :x 0.3 .", tmp_path)
    assert len(known.parts("beads1")) == 12
    assert known.kind("beads1/bead12") == "Bead"
    assert known.quantity("beads1", "mass") == pytest.approx(12 * 2500 * 4 / 3 * np.pi * 0.006**3)
    assert known.is_a("beads1", "Stuff") and not known.is_a("beads1", "Solid")
    assert len(base(FILLED, tmp_path).parts("beads1")) == 30


def test_a_class_of_ones_own_may_have_counted_parts(tmp_path: Path) -> None:
    part = ":of :Pea ; :unless :Solid ; :countedBy :grainCount"
    peas = (
        "@prefix owl: <http://www.w3.org/2002/07/owl#> . @prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> . "
        f':Peas a owl:Class ; rdfs:subClassOf :Beads ; :defaultPart [ {part} ; :source "pods" ; :certainty "D" ] ; '
        ':default [ :of :grainCount ; :value 5.0 ; :source "a pod" ; :certainty "D" ] . '
        ":Pea a owl:Class ; rdfs:subClassOf :Ball . :it a :Peas . "
    )
    assert base(peas, tmp_path).parts("it") == tuple(f"it/pea{k}" for k in range(1, 6))
    with pytest.raises(KnowledgeError, match="countedBy radius, which is no property that is a whole number"):
        base(peas.replace(":countedBy :grainCount", ":countedBy :radius"), tmp_path)
    with pytest.raises(KnowledgeError, match="countedBy grainCuont, which is no property"):
        base(peas.replace(":countedBy :grainCount", ":countedBy :grainCuont"), tmp_path)


def test_beads_lie_in_a_cup_apart_from_each_other_and_below_its_brim() -> None:
    made = scene(FILLED)
    places = np.array([thing.position for thing in made.parts("beads1")])
    apart = np.linalg.norm(places[:, None] - places[None], axis=2) + np.eye(30)
    assert len(places) == 30 and apart.min() >= 0.012
    assert places[:, 2].max() < 0.09 and np.hypot(places[:, 0], places[:, 1]).max() < 0.035 - 0.006 + 1e-6
    assert not any(thing.shape.geoms for thing in made.things if thing.name == "beads1")
    compile_world(made)


def test_beads_in_a_cup_are_one_stuff_in_it() -> None:
    timeline = recognize(run(FILLED, "wait(0.3)"))
    assert shown(timeline, "contains", "spilled", "contacts", "colliding", "falling") == {
        "contains(cup1,beads1)": 1.0, "contacts(cup1,floor)": 0.0,
    }  # fmt: skip
    assert {str(arg) for fact in timeline.facts for arg in fact.args if fact.type != "waiting"} == {
        "cup1", "beads1", "floor",
    }  # fmt: skip


def test_some_bodies_of_a_stuff_may_be_elsewhere() -> None:
    more = CUP + SOME + ":cup1 :contains :beads1 . :bead2 :on :floor ; :x 0.2 . :bead3 :x 0.3 ; :z 0.006 ."
    timeline = recognize(run(more, "wait(0.3)"))
    assert shown(timeline, "contains", "spilled") == pytest.approx(
        {"contains(cup1,beads1)": 1 / 3, "spilled(beads1)": 2 / 3}
    )


def test_beads_on_a_table_lie_side_by_side_round_their_place() -> None:
    made = scene(":floor a :Floor . :table1 a :Table . :beads1 a :Beads ; :on :table1 ; :x 0.1 ; :y -0.05 .")
    places = np.array([thing.position for thing in made.parts("beads1")])
    assert places[:, 2] == pytest.approx(0.706, abs=1e-4)
    assert places.mean(axis=0)[:2] == pytest.approx((0.1, -0.05), abs=0.01)


def test_beads_and_a_liquid_share_a_cup() -> None:
    liquid = ":cup1 :contains :liq1 . :liq1 a :Water ; :fill 0.4 . "
    few = FILLED + ":beads1 :grainCount 5 . "
    together, alone = (
        recognize(run(turtle, "wait(0.2)", particles=600, duration=0.3)) for turtle in (few + liquid, CUP + liquid)
    )
    told = "contains", "spilled", "flowingOut", "supports"
    assert shown(alone, *told) == pytest.approx({"contains(cup1,liq1)": 1.0, "supports(floor,cup1)": 0.0}, abs=0.02)
    assert shown(together, *told) == pytest.approx(
        {"contains(cup1,beads1)": 1.0, "contains(cup1,liq1)": 1.0, "supports(floor,cup1)": 0.0}, abs=0.02
    )


@pytest.mark.parametrize(
    ("turtle", "message"),
    [
        (CUP + ":beads1 a :Granular ; :on :floor .", r"beads1 \(Granular\) consists of nothing; state its bodies"),
        (CUP + SOME, r"beads1 \(Granular\) is nowhere; state what :contains it"),
        (CUP + SOME + ":beads1 :grainCount 4 ; :on :floor .", "has a grainCount of 4, but 3 parts"),
        (CUP + SOME + ":beads1 :radius 0.02 ; :on :floor .", "beads1 .* is given radius, which its bodies have"),
        (CUP + SOME + ":beads1 :on :floor . :cup1 :contains :beads1 .", "is in several places: cup1, floor"),
        (CUP + ":b a :Granular ; :hasPart :egg1 ; :on :floor . :egg1 a :Egg .", r"egg1 \(Egg\) is no solid body"),
        (CUP + ":b a :Granular ; :hasPart :t ; :on :floor . :t a :Table .", r"t \(Table\) is no solid body"),
        (CUP + ":beads1 a :Beads ; :grainCount 300 . :cup1 :contains :beads1 .", "300 bodies of 12 mm are to be"),
        (CUP + ":beads1 a :Beads ; :on :cup1 .", "do not lie side by side round x = 0, y = 0, where cup1 is not level"),
        (CUP + ":beads1 a :Beads ; :on :floor . :block1 a :Block ; :on :beads1 .", "cannot be on the Beads beads1"),
        (CUP + ":cup1 :grainCount 3 .", r"cup1 \(Cup\) makes no use of grainCount; what does: Granular"),
        (CUP + SOME + ":bead1 :z 0.5 . :bead2 :z 0.503 . :bead3 :z 0.9 .", "bead1 and bead2 overlap by 9.0 mm"),
    ],
)  # fmt: skip
def test_a_stuff_that_cannot_be_so_is_refused(turtle: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        compile_world(scene(turtle))


def test_a_count_is_written_in_the_situation(tmp_path: Path) -> None:
    with pytest.raises(KnowledgeError, match="grainCount cannot be overridden; write it in the situation"):
        base(FILLED, tmp_path).with_values({"beads1.grainCount": 10.0})


def test_a_query_knows_a_single_bead_of_which_no_fact_tells() -> None:
    made = project(Scenario(situation=FILLED, plan="wait(0.1)", duration=0.2))
    assert made.ask("has_part(beads1, 'beads1/bead7'), instance_of('beads1/bead7', 'Bead')")
    assert not made.ask("holds(contacts(cup1, 'beads1/bead7'), T)")
    assert made.ask("holds(contains(C, S), T), instance_of(S, 'Granular')")[0]["C"] == "cup1"


def test_a_stuff_that_is_told_to_be_wet_is_so() -> None:
    told = run(CUP + SOME + ":beads1 :wet true ; :on :floor ; :x 0.3 .", "wait(0.01)", duration=0.01)
    assert recognize(told).ask("holds(wet(beads1), 0.0), \\+ holds(dirty(beads1), 0.0)")
