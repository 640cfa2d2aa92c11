"""What is stated of a whole is so of its parts where the ontology says so, and mass over volume is that of matter."""

from __future__ import annotations

from pathlib import Path

import pytest
from situations import load

from prolepsis.knowledge import KnowledgeBase
from prolepsis.terms.errors import KnowledgeError


@pytest.mark.parametrize(
    ("told", "parts"),
    [
        (":egg1 a :Egg ; :temperature 5 .", {"white1": 278.15, "yolk1": 278.15, "eggshell1": 278.15}),
        (
            ":egg1 a :Egg ; :temperature 5 ; :hasPart :yolk1 . :yolk1 a :EggYolk ; :temperature 40 .",
            {"yolk1": 313.15, "eggshell1": 278.15},
        ),
        (":egg1 a :Egg .", {"white1": 293.15, "eggshell1": 293.15}),
        (
            ":t a :Block ; :temperature 8 ; :hasPart :u . :u a :Block ; :hasPart :v . :v a :Block .",
            {"u": 281.15, "v": 281.15},
        ),
    ],
)
def test_parts_are_as_warm_as_their_whole_is_stated_to_be(tmp_path: Path, told: str, parts: dict[str, float]) -> None:
    base = load(tmp_path, told)
    assert {name: base.quantity(name, "temperature") for name in parts} == pytest.approx(parts)


def test_it_is_so_of_what_is_overridden(tmp_path: Path) -> None:
    base = load(tmp_path, ":egg1 a :Egg .").with_values({"egg1.temperature": 5})
    assert base.value("white1", "temperature").source.startswith("that of egg1, whose part it is")
    with pytest.raises(KnowledgeError, match=r"temperature = 70 degC \(that of egg1.*must be at least -0\.5"):
        base.with_values({"egg1.temperature": 70})


REFUSED = {
    ":egg1 a :Egg ; :length 100 .": r"egg1: its mass, 0\.059 kg, in .* 0\.101 m3 .*at least 80 and at most 1600",
    ":egg1 a :Egg ; :mass 0.001 .": r"egg1: its mass, 0\.001 kg, in its volume, .* 17\.3 kg/m3",
    ":egg1 a :QuailEgg ; :mass 0.06 .": r"egg1: its mass, 0\.06 kg, .*; state both mass and extents",
    ":ball1 a :Ball ; :mass 0.2 ; :radius 0.01 .": r"ball1: its mass, 0\.2 kg, .* 30000 kg/m3 for a Ball$",
    ":block1 a :Block ; :mass 100 .": r"block1: its mass, 100 kg, .*at least 0\.1 and at most 30000 kg/m3 for a Block",
    ":cup1 a :Cup ; :mass 100 .": r"cup1: its mass, 100 kg, in its volume, .*turned outline",
    ":box1 a :EggBox , :Vessel .": r"no EggBox is a Vessel",
}


@pytest.mark.parametrize(("told", "message"), REFUSED.items())
def test_what_no_matter_has_is_refused(tmp_path: Path, told: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        load(tmp_path, told)


@pytest.mark.parametrize("told", [":egg1 a :Egg ; :mass 0.075 ; :length 0.066 .", ":egg1 a :Egg ; :mass 0.006 ."])
def test_what_is_large_or_empty_is_not(tmp_path: Path, told: str) -> None:
    assert load(tmp_path, told).quantity("egg1", "mass") > 0


def test_no_draw_is_refused(tmp_path: Path) -> None:
    base: KnowledgeBase = load(tmp_path, ":egg1 a :Egg . :egg2 a :QuailEgg . :e a :Coconut . :m a :MandM .")
    assert all(base.with_draws(seed).drawn for seed in range(20))
