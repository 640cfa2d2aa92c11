"""What is known of liquids, vessels and sponges: densities, viscosities by temperature, volumes and capacities."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from situations import load

from prolepsis.knowledge import KnowledgeBase
from prolepsis.terms.errors import KnowledgeError

LIQUIDS = {
    "Water": (998.0, 0.001),
    "Coffee": (1000.0, 0.0011),
    "Milk": (1030.0, 0.0019),
    "OliveOil": (911.0, 0.08),
    "PancakeBatter": (1100.0, 2.0),
    "Honey": (1420.0, 19.0),
}


def test_every_liquid_has_all_that_a_simulation_needs(tmp_path: Path) -> None:
    base = load(tmp_path, " ".join(f":{name.lower()}1 a :{name} ; :volume 0.0001 ." for name in LIQUIDS))
    for name, (density, viscosity) in LIQUIDS.items():
        individual = f"{name.lower()}1"
        assert base.is_a(individual, "Liquid") and base.kind(individual) == name
        assert base.quantity(individual, "density") == density
        assert base.quantity(individual, "viscosity") == pytest.approx(viscosity)
        assert 0.02 < base.quantity(individual, "surfaceTension") < 0.08
        assert 0.0 < base.quantity(individual, "contactAngle") < math.pi / 2
        assert base.quantity(individual, "mass") == pytest.approx(density * 1e-4)


@pytest.mark.parametrize(
    ("temperature", "viscosity"),
    [(14.0, 60.0), (20.0, 19.0), (30.0, 6.5), (40.0, 2.0), (70.0, 0.3), (25.0, math.sqrt(19.0 * 6.5))],
)
def test_honey_is_thinner_when_it_is_warm(tmp_path: Path, temperature: float, viscosity: float) -> None:
    base = load(tmp_path, f":honey1 a :Honey ; :temperature {temperature} .")
    known = base.value("honey1", "viscosity")
    assert known.value == pytest.approx(viscosity) and known.origin == "derived"
    assert (known.unit, known.certainty) == ("Pa s", "T")
    assert known.source.startswith("Honey: honey with 16 % water")


@pytest.mark.parametrize("temperature", [13.0, 71.0])
def test_honey_of_a_temperature_that_is_not_known_is_refused(tmp_path: Path, temperature: float) -> None:
    with pytest.raises(KnowledgeError, match=r"the viscosity of Honey is known from 287\.15 to 343\.15 K only"):
        load(tmp_path, f":honey1 a :Honey ; :temperature {temperature} .")
    stated = load(tmp_path, f":honey1 a :Honey ; :temperature {temperature} ; :viscosity 5.0 .")
    assert stated.value("honey1", "viscosity").origin == "asserted"


def test_a_class_of_one_s_own_may_give_another_viscosity(tmp_path: Path) -> None:
    thin = ':default [ :of :viscosity ; :value 2.0 ; :source "mine" ; :certainty "R" ]'
    base = load(tmp_path, f":Heather a owl:Class ; rdfs:subClassOf :Honey ; {thin} . :honey1 a :Heather .")
    assert base.quantity("honey1", "viscosity") == 2.0


def test_a_curve_needs_two_points_and_the_property_that_it_depends_on(tmp_path: Path) -> None:
    def syrup(curve: str) -> KnowledgeBase:
        start = ":Syrup a owl:Class ; rdfs:subClassOf :Liquid ; :curve [ :of :viscosity ; "
        return load(tmp_path, f'{start}{curve} ; :source "mine" ; :certainty "R" ] . :s1 a :Syrup .')

    two = ":point [ :at 10 ; :value 4 ] , [ :at 30 ; :value 1 ]"
    assert syrup(f":over :temperature ; {two}").quantity("s1", "viscosity") == pytest.approx(2.0)
    with pytest.raises(KnowledgeError, match="the curve viscosity of Syrup needs two points or more"):
        syrup(":over :temperature ; :point [ :at 10 ; :value 4 ]")
    with pytest.raises(KnowledgeError, match="the curve viscosity of Syrup has no :over"):
        syrup(two)
    with pytest.raises(KnowledgeError, match="a point needs :at and a positive :value"):
        syrup(":over :temperature ; :point [ :at 10 ; :value 4 ] , [ :at 30 ]")


def test_a_vessel_has_the_capacity_of_its_cavity(tmp_path: Path) -> None:
    base = load(
        tmp_path,
        ":cup1 a :Cup . :box1 a :Vessel ; :shape :openBox ; :length 0.2 ; :width 0.1 ; :height 0.1 ;"
        " :thickness 0.01 ; :density 600 . :block1 a :Block .",
    )
    assert base.quantity("cup1", "capacity") == pytest.approx(math.pi * 0.035**2 * 0.085)
    assert base.value("cup1", "capacity").origin == "derived"
    assert base.quantity("box1", "capacity") == pytest.approx(0.18 * 0.08 * 0.09)
    assert base.quantity("box1", "mass") == pytest.approx(600 * (0.2 * 0.1 * 0.1 - 0.18 * 0.08 * 0.09))
    assert base.number("block1", "capacity") is None


def test_holes_and_lids_change_the_mass_of_a_vessel(tmp_path: Path) -> None:
    base = load(tmp_path, ":a a :Cup . :b a :Cup ; :bottomHoleRadius 0.01 . :c a :Cup ; :lid true .")
    plain, holed, lidded = (base.quantity(name, "mass") for name in "abc")
    assert plain - holed == pytest.approx(2300.0 * math.pi * 0.01**2 * 0.005)
    assert lidded - plain == pytest.approx(2300.0 * math.pi * 0.04**2 * 0.005)


def test_the_volume_of_a_liquid_follows_from_its_mass_or_from_what_it_fills(tmp_path: Path) -> None:
    base = load(
        tmp_path,
        ':w a :Water ; :mass "99.8 g" . :h a :Honey ; :fill 0.5 . :cup1 a :Cup ; :contains :h .'
        " :s a :Sponge ; :saturation 0.5 ; :absorbs :m . :m a :Milk . :egg1 a :Egg .",
    )
    assert base.quantity("w", "volume") == pytest.approx(1e-4)
    assert base.quantity("h", "volume") == pytest.approx(0.5 * base.quantity("cup1", "capacity"))
    assert base.quantity("h", "mass") == pytest.approx(1420.0 * base.quantity("h", "volume"))
    assert base.quantity("m", "mass") == pytest.approx(0.5 * 15.0 * base.quantity("s", "mass"))
    assert base.quantity("white1", "volume") == pytest.approx(base.quantity("white1", "mass") / 1035.0)


def test_a_liquid_described_tells_where_its_volume_comes_from(tmp_path: Path) -> None:
    base = load(tmp_path, ":cup1 a :Cup ; :contains :h . :h a :Honey ; :fill 0.5 .")
    assert any(line.endswith("(derived: fill * capacity of cup1)") for line in base.describe("h"))
    assert any("60 at 287.15 K" in line for line in base.describe("Honey"))
