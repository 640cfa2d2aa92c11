"""Masses of wholes and parts add up, whichever of them are stated."""

from __future__ import annotations

from pathlib import Path

import pytest
from situations import load

from prolepsis.knowledge import KnowledgeBase
from prolepsis.terms.errors import KnowledgeError


def total(base: KnowledgeBase, whole: str) -> float:
    """Return the sum of the masses of the direct parts [kg]."""
    return sum(base.quantity(part, "mass") for part in base.parts(whole))


def test_a_stated_whole_is_shared_out_in_the_usual_proportion(tmp_path: Path) -> None:
    usual = load(tmp_path, ":egg1 a :Egg .")
    heavy = load(tmp_path, ":egg1 a :Egg ; :mass 0.0885 .")
    assert total(usual, "egg1") == pytest.approx(usual.quantity("egg1", "mass"))
    ratio = 0.0885 / usual.quantity("egg1", "mass")
    for part in ("eggshell1", "white1", "yolk1"):
        assert heavy.quantity(part, "mass") == pytest.approx(ratio * usual.quantity(part, "mass"))
        assert heavy.value(part, "mass").source == "its share of the mass of egg1"


def test_stated_parts_keep_their_mass_and_the_others_share_the_rest(tmp_path: Path) -> None:
    base = load(tmp_path, ":egg1 a :Egg ; :mass 0.06 ; :hasPart :s . :s a :EggShell ; :mass 0.01 .")
    assert base.quantity("s", "mass") == 0.01
    assert total(base, "egg1") == pytest.approx(0.06)


def test_parts_known_by_density_share_too_and_so_do_parts_of_parts(tmp_path: Path) -> None:
    text = ":b a :Block ; :mass 3 ; :hasPart :c , :d . :c a :Block . :d a :Block ; :hasPart :e , :f . "
    base = load(tmp_path, text + ":e a :Block . :f a :Block ; :mass 0.5 .")
    assert total(base, "b") == pytest.approx(3.0)
    assert total(base, "d") == pytest.approx(base.quantity("d", "mass"))
    assert base.quantity("f", "mass") == 0.5


def test_masses_that_are_rounded_agree(tmp_path: Path) -> None:
    parts = ":hasPart :s , :k . :s a :EggShell ; :mass 0.01 . :k a :EggYolk ; :mass 0.04 ."
    load(tmp_path, f":egg1 a :Egg ; :mass 0.05004 ; {parts}")
    with pytest.raises(KnowledgeError, match=r"the mass of egg1 is 0\.0501 kg"):
        load(tmp_path, f":egg1 a :Egg ; :mass 0.0501 ; {parts}")


def test_an_override_that_contradicts_the_parts_is_refused(tmp_path: Path) -> None:
    base = load(
        tmp_path, ":egg1 a :Egg ; :hasPart :s , :k . :s a :EggShell ; :mass 0.01 . :k a :EggYolk ; :mass 0.04 ."
    )
    with pytest.raises(
        KnowledgeError, match=r"override: the mass of egg1 is 0\.06 kg, but its parts k, s have 0\.05 kg"
    ):
        base.with_values({"egg1.mass": "60 g"})
    assert base.with_values({"s.mass": 0.02}).quantity("egg1", "mass") == pytest.approx(0.06)
