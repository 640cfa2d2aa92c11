"""Values of one individual that bound each other: a receding angle is no greater than the contact angle, and so on."""

from __future__ import annotations

from pathlib import Path

import pytest
from situations import load

from prolepsis.knowledge import KnowledgeBase
from prolepsis.terms.errors import InputError, KnowledgeError

WATER = ':floor a :Floor . :w a :Water ; :on :floor ; :volume "3 ml" ; '
SHELL = ":w a :Egg ; :hasPart :s . :s a :EggShell ; "


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (WATER + ":recedingAngle 60 .", r"w .Water.: recedingAngle = 60 deg: must be at most its contactAngle, 50 deg"),
        (":w a :Sponge ; :squeezedCapacity 20 .", r"squeezedCapacity = 20: must be at most its absorbentCapacity, 15"),
        (":w a :Sponge ; :poreSize 0.05 .", r"poreSize = 0\.05 m: must be at most its height, 0\.03 m"),
        (":w a :FoamPad ; :paddingThickness 3 .", r"paddingThickness = 3 m: must be at most its height, 0\.05 m"),
        (":w a :FoamPad ; :yieldStress 1e9 .", r"yieldStress = 1e\+09 Pa: must be at most its youngsModulus, 50000 Pa"),
        (
            SHELL + ":cushionedBreakingForce 4 .",
            r"cushionedBreakingForce = 4 N: must be at least its breakingForce",
        ),
        (
            ":w a :FoamPad ; :densificationStrain 1e-9 .",
            r"densificationStrain = 1e-09: must be finite and",
        ),
        (":w a :FoamPad ; :densificationStrain 1.0 .", r"densificationStrain = 1\.0: must be .* at most 0\.98"),
    ],
)
def test_a_value_on_the_wrong_side_of_another_is_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=r"situation\.ttl:\d+: .*" + message):
        load(tmp_path, text)


@pytest.mark.parametrize(
    "text", [WATER + ":contactAngle 10 .", ":w a :Sponge ; :absorbentCapacity 1 .", SHELL + ":breakingForce 1000 ."]
)
def test_a_default_gives_way_to_what_is_said_of_the_other(tmp_path: Path, text: str) -> None:
    load(tmp_path, text)


def test_what_a_setting_or_a_class_says_is_compared_too(tmp_path: Path) -> None:
    with pytest.raises(KnowledgeError, match="override: w .Water.: recedingAngle = 55 deg: must be at most"):
        load(tmp_path, WATER + ":x 0.1 .").with_values({"w.recedingAngle": 55.0})
    steep = ":Soap a owl:Class ; rdfs:subClassOf :Water ; :default [ :of :recedingAngle ; :value 70 ; :source 's' ; "
    with pytest.raises(KnowledgeError, match=r"w .Soap.: recedingAngle = 70 deg: must be at most its contactAngle, 50"):
        load(tmp_path, steep + ":certainty 'D' ] . :w a :Soap .")


@pytest.mark.parametrize(("other", "message"), [("mass", "p is bounded by mass; allowed"), ("hight", "by hight")])
def test_a_bound_by_what_cannot_be_compared_is_refused(tmp_path: Path, other: str, message: str) -> None:
    length = "rdfs:range <http://www.w3.org/2001/XMLSchema#double> ; <http://qudt.org/schema/qudt/hasUnit>"
    with pytest.raises(InputError, match=message):
        load(
            tmp_path,
            f":p a owl:DatatypeProperty ; {length} <http://qudt.org/vocab/unit/M> ; :atMost :{other} .",
        )


def test_the_defaults_of_all_classes_are_on_the_right_side() -> None:
    base = KnowledgeBase.load()
    vocabulary = base.vocabulary
    compared = [each for each in vocabulary.properties.values() if each.at_least_of or each.at_most_of]
    assert len(compared) >= 8
    for name in vocabulary.classes:
        for each in compared:
            found = (
                base.default_of(vocabulary.told_classes((name,)), p)
                for p in (each.at_least_of, each.name, each.at_most_of)
            )
            values = [default.value for _, default in filter(None, found)]
            assert values == sorted(values, key=float), (name, each.name)
