"""The examples in ``docs/ontology.md`` do what the page says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from prolepsis.engine.composing import compose_scene
from prolepsis.knowledge import KnowledgeBase
from prolepsis.knowledge.masses import TOLERANCE
from prolepsis.knowledge.time_limit import LIMIT_VARIABLE, TIME_LIMIT
from prolepsis.scenario.scenario import FEWEST_PARTICLES, MOST_PARTICLES, Scenario
from prolepsis.terms.terms import format_value

PAGE = Path(__file__).parents[2] / "docs" / "ontology.md"


def test_the_example_of_the_page_loads_and_uses_its_class_defaults(tmp_path: Path) -> None:
    match = re.search(r"```turtle\n(.*?)```", PAGE.read_text(), re.S)
    assert match is not None
    path = tmp_path / "page.ttl"
    path.write_text(match.group(1))
    base = KnowledgeBase.load(path)
    assert base.kind("egg1") == "BantamEgg" and base.is_a("egg1", "LiquidContainer")
    assert base.quantity("egg1", "length") == 0.045
    assert sum(base.quantity(part, "mass") for part in base.parts("egg1")) == pytest.approx(0.030)


def test_the_liquids_of_the_page_are_filled_in_where_it_says(tmp_path: Path) -> None:
    blocks = re.findall(r"```turtle\n(.*?)```", PAGE.read_text(), re.S)
    path = tmp_path / "page.ttl"
    path.write_text(blocks[1])
    base = KnowledgeBase.load(path)
    assert base.quantity("liq1", "volume") == pytest.approx(0.8 * base.quantity("cup1", "capacity"))
    assert base.quantity("liq2", "viscosity") == pytest.approx(60.0)
    made = compose_scene(base, particles=1000)
    assert {pool.stuff: pool.holder for pool in made.pools} == {"liq1": None, "liq2": None, "liq3": "sponge1"}
    assert len(made.thing("cup2").shape.holes) == 3


def test_the_granular_stuffs_of_the_page_are_placed_where_it_says(tmp_path: Path) -> None:
    blocks = re.findall(r"```turtle\n(.*?)```", PAGE.read_text(), re.S)
    path = tmp_path / "page.ttl"
    path.write_text(blocks[2])
    made = compose_scene(KnowledgeBase.load(path), particles=1000)
    assert [len(made.parts(stuff)) for stuff in ("beads1", "beads2")] == [20, 2]
    assert made.thing("beads1/bead20").whole == "beads1"
    assert made.thing("bead1").position[:2] == pytest.approx((0.2, 0.0))
    assert made.thing("ball1").position[:2] == pytest.approx((0.3, 0.0))


def test_the_scenario_of_the_page_is_read_as_it_says(tmp_path: Path) -> None:
    match = re.search(r"```toml\n(.*?)```", PAGE.read_text(), re.S)
    assert match is not None
    (tmp_path / "page.toml").write_text(match.group(1))
    (tmp_path / "egg_on_table.ttl").write_text(
        "@prefix : <https://w3id.org/prolepsis#> . :t a :Table . :egg1 a :Egg ; :on :t . :hand1 a :Hand ; :z 1.0 ."
    )
    scenario = Scenario.load(tmp_path / "page.toml", {"force": "25"})
    assert format_value(scenario.bound_plan()) == "sequence([grasp(hand1,egg1,25.0),lift(hand1,0.1)])"
    assert (scenario.draw, scenario.monitors) == (True, {"egg1": ("load", "speed")})
    assert scenario.particles == 2000 and scenario.with_settings({"particles": "500"}).particles == 500
    assert scenario.knowledge_base().value("eggshell1", "friction").origin == "override"


def test_the_limits_of_the_page_are_those_of_the_code() -> None:
    text = PAGE.read_text()
    assert f"A check may take {TIME_LIMIT:g} s" in text and LIMIT_VARIABLE in text
    assert f"{FEWEST_PARTICLES} to {MOST_PARTICLES}" in text
    assert f"by more than {TOLERANCE:.1%}".replace("%", " %") in text
