"""What is drawn before a run: every quantity with a stated deviation, each by itself, within its bounds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from prolepsis.knowledge import KnowledgeBase
from prolepsis.knowledge.drawing import draw
from prolepsis.terms.errors import KnowledgeError

PREFIX = """@prefix : <https://w3id.org/prolepsis#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
"""
EGG = ":table1 a :Table . :egg1 a :Egg ; :on :table1 .\n"
CORK = """
:Cork a owl:Class ; rdfs:subClassOf :Block ; rdfs:comment "A piece of cork." ; :default
  [ :of :density ; :value 200.0 ; :deviation 60.0 ; :source "oak" ; :certainty "M" ] ,
  [ :of :friction ; :value 0.5 ; :deviation 5.0 ; :source "rough or waxed" ; :certainty "D" ] ,
  [ :of :temperature ; :value 18.0 ; :deviation 4.0 ; :source "a room" ; :certainty "D" ] .
"""


def load(folder: Path, *texts: str) -> KnowledgeBase:
    """Return the knowledge base of some files, in their order."""
    files: list[Path] = []
    for text in texts:
        files.append(folder / f"{len(list(folder.iterdir()))}.ttl")
        files[-1].write_text(PREFIX + text)
    return KnowledgeBase.load(*files)


def test_all_that_has_a_deviation_is_drawn_and_the_rest_is_as_it_was(tmp_path: Path) -> None:
    usual = load(tmp_path, EGG + ":hand1 a :Gripper .")
    drawn = usual.with_draws(1)
    for name in usual.objects:
        for property_name, known in usual.quantities(name).items():
            if known.origin == "derived":
                continue
            origin = "drawn" if known.deviation else known.origin
            assert drawn.value(name, property_name).origin == origin
            assert (drawn.value(name, property_name).value != known.value) == bool(known.deviation)
    assert {"egg1.length", "eggshell1.breakingForce", "yolk1.viscosity", "hand1.friction"} < {*drawn.drawn}
    assert "table1" not in str(drawn.drawn) and usual.drawn == {}


def test_what_follows_from_a_quantity_follows_its_draw(tmp_path: Path) -> None:
    drawn = load(tmp_path, EGG).with_draws(1)
    assert drawn.quantity("egg1", "mass") == pytest.approx(
        sum(drawn.quantity(part, "mass") for part in ("eggshell1", "white1", "yolk1"))
    )
    assert drawn.quantity("egg1", "breakingForce") == drawn.quantity("eggshell1", "breakingForce")
    assert "egg1.breakingForce" not in drawn.drawn and "egg1.mass" not in drawn.drawn
    assert ("eggshell1", "breakingForce", drawn.drawn["eggshell1.breakingForce"]) in drawn.domain().values
    cork = load(tmp_path, CORK + ":cork1 a :Cork ; :length 0.1 ; :width 0.1 ; :height 0.1 .").with_draws(1)
    assert cork.quantity("cork1", "mass") == pytest.approx(1e-3 * cork.quantity("cork1", "density"))


def test_what_is_told_is_not_drawn(tmp_path: Path) -> None:
    told = load(tmp_path, EGG + ':egg1 :mass "60 g" ; :length "58 mm" .').with_values({"eggshell1.friction": 0.4})
    drawn = told.with_draws(1)
    assert drawn.quantity("egg1", "mass") == 0.06 and drawn.value("egg1", "length").origin == "asserted"
    assert drawn.value("eggshell1", "friction").origin == "override"
    # The parts share the mass of the whole, and a share is no draw.
    assert drawn.value("yolk1", "mass").origin == "derived"


def test_a_draw_hangs_on_the_seed_and_its_name_alone(tmp_path: Path) -> None:
    egg, more = EGG, ":egg0 a :Egg ; :on :table1 ; :x 0.1 . :hand1 a :Gripper ."
    alone = load(tmp_path, egg).with_draws(1).drawn
    assert alone == load(tmp_path, egg).with_draws(1).drawn
    both = load(tmp_path, egg, more).with_draws(1).drawn
    assert list(both.items()) == list(load(tmp_path, more, egg).with_draws(1).drawn.items())
    assert {name: both[name] for name in alone} == alone
    assert both["eggshell0.breakingForce"] != both["eggshell1.breakingForce"]
    other = load(tmp_path, egg).with_draws(2).drawn
    assert all(other[name] != alone[name] for name in alone)


def test_draws_have_the_mean_and_deviation_that_are_stated(tmp_path: Path) -> None:
    base, count = load(tmp_path, EGG), 300
    forces = [float(draw(base, seed)["eggshell1", "breakingForce"].value) for seed in range(count)]
    # Five standard errors; the deviation of a sample has one of 1 / sqrt(2 n) of itself.
    assert np.mean(forces) == pytest.approx(45.0, abs=5 * 7.0 / np.sqrt(count))
    assert np.std(forces) == pytest.approx(7.0, rel=5 / np.sqrt(2 * count))


def test_what_is_positive_is_at_least_a_fifth_of_its_mean(tmp_path: Path) -> None:
    base = load(tmp_path, CORK + ":cork1 a :Cork .")
    frictions = [float(base.with_draws(seed).drawn["cork1.friction"]) for seed in range(40)]
    assert min(frictions) >= 0.1 and max(frictions) > 3.0 and len({*frictions}) == 40


def test_limits_of_a_class_cut_the_distribution_off(tmp_path: Path) -> None:
    limit = CORK + ":Cork :limit [ :of :density ; :above 190.0 ; :atMost 210.0 ] . :cork1 a :Cork ."
    base = load(tmp_path, limit)
    densities = [float(base.with_draws(seed).drawn["cork1.density"]) for seed in range(20)]
    assert all(190.0 < density <= 210.0 for density in densities) and len({*densities}) == 20


def test_counts_are_drawn_as_whole_numbers(tmp_path: Path) -> None:
    coarse = """:CoarseShell a owl:Class ; rdfs:subClassOf :EggShell ; rdfs:comment "A shell of other pieces." ;
      :default [ :of :pieceCount ; :value 30.0 ; :deviation 30.0 ; :source "any" ; :certainty "D" ] .
    :egg1 a :Egg ; :hasPart :s . :s a :CoarseShell ."""
    base = load(tmp_path, coarse)
    counts = [float(base.with_draws(seed).drawn["s.pieceCount"]) for seed in range(20)]
    assert all(count.is_integer() and 8 <= count <= 60 for count in counts) and len({*counts}) > 5


def test_what_was_drawn_gives_the_same_knowledge_again_in_any_unit(tmp_path: Path) -> None:
    base = load(tmp_path, CORK + EGG + ":cork1 a :Cork .")
    drawn = base.with_draws(3)
    assert str(drawn.drawn["cork1.temperature"]).endswith(" K")
    again = base.with_values(drawn.drawn)
    assert again.domain() == drawn.domain() and again.value("cork1", "temperature").origin == "override"


def test_a_draw_tells_its_distribution(tmp_path: Path) -> None:
    lines = "\n".join(load(tmp_path, EGG).with_draws(1).describe("eggshell1"))
    assert "N (drawn: 45 +- 7 N, EggShell: slow compression" in lines


def test_a_draw_from_which_nothing_possible_follows_is_refused_with_its_seed(tmp_path: Path) -> None:
    light = CORK + ":Cork :limit [ :of :mass ; :above 0.1999 ; :atMost 0.2001 ] .\n"
    base = load(tmp_path, light + ":cork1 a :Cork ; :length 0.1 ; :width 0.1 ; :height 0.1 .")
    with pytest.raises(KnowledgeError, match=r"what seed 2 draws cannot be: .*cork1: mass = .* at most 0.2001 kg"):
        base.with_draws(2)


CARTON = ":carton1 a :Batch . " + "".join(f":egg{i} a :Egg ; :batch :carton1 . " for i in range(4))


def strengths(base: KnowledgeBase, seed: int) -> list[float]:
    return [float(draw(base, seed)[f"eggshell{i}", "breakingForce"].value) for i in range(4)]


def test_eggs_of_one_batch_differ_less_than_eggs_of_all_kinds(tmp_path: Path) -> None:
    base, count = load(tmp_path, CARTON), 25
    drawn = np.array([strengths(base, seed) for seed in range(count)])
    # Within a batch, between the means of batches, and over all; five standard errors each.
    assert np.sqrt(drawn.var(axis=1, ddof=1).mean()) == pytest.approx(6.0, rel=5 / np.sqrt(2 * 3 * count))
    means = np.sqrt(7.0**2 - 6.0**2 + 6.0**2 / 4)
    assert drawn.mean(axis=1).std() == pytest.approx(means, rel=5 / np.sqrt(2 * count))
    assert drawn.mean() == pytest.approx(45.0, abs=5 * means / np.sqrt(count))


def test_what_is_stated_of_a_batch_is_the_mean_of_its_individuals(tmp_path: Path) -> None:
    base = load(tmp_path, CARTON.replace(":Batch", ":Batch ; :breakingForce 38.0"))
    known = base.value("eggshell3", "breakingForce")
    assert (known.value, known.origin, known.deviation) == (38.0, "batch", 6.0)
    assert known.source.startswith("carton1: ")
    drawn = np.array([strengths(base, seed) for seed in range(10)])
    assert drawn.mean() == pytest.approx(38.0, abs=5 * 6.0 / np.sqrt(drawn.size))
    weaker = base.with_values({"carton1.breakingForce": 30.0})
    assert weaker.quantity("eggshell3", "breakingForce") == 30.0
    assert base.value("eggshell3", "shellThickness").origin == "class default"


def test_a_batch_that_differs_more_than_all_is_refused(tmp_path: Path) -> None:
    odd = """:OddShell a owl:Class ; rdfs:subClassOf :EggShell ; rdfs:comment "An odd shell." ; :default
      [ :of :breakingForce ; :value 30.0 ; :deviation 2.0 ; :batchDeviation 3.0 ; :source "any" ; :certainty "D" ] ."""
    with pytest.raises(KnowledgeError, match="batchDeviation must not be greater than the deviation"):
        load(tmp_path, odd)
