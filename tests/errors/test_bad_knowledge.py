"""Bad situations are refused with what is wrong, where, and what is allowed."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest

from prolepsis.knowledge import KnowledgeBase
from prolepsis.terms.errors import LONGEST_LINE, InconsistentError, InputError, KnowledgeError

PREFIX = "@prefix : <https://w3id.org/prolepsis#> .\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (":egg1 a :Eg .", r"s\.ttl:2: no class named 'Eg'; did you mean 'Egg'"),
        (":egg1 a :egg .", r"no class named 'egg'; did you mean 'Egg'"),
        (
            "@prefix ex: <http://example.org/k#> . :egg1 a :Egg ; ex:mass 0.05 .",
            r"s\.ttl:2: no property http://example\.org/k#mass; did you mean https://w3id\.org/prolepsis#mass\?$",
        ),
        (
            "@prefix ex: <http://example.org/k#> . :egg1 a ex:Egg .",
            r"no class http://example\.org/k#Egg; did you mean https://w3id\.org/prolepsis#Egg\?$",
        ),
        (":egg1 a :EGG .", r"no class named 'EGG'; did you mean 'Egg'"),
        (":egg1 a :Egg ; :MASS 0.05 .", r"no property named 'MASS'; did you mean 'mass'"),
        (":t a :paper_TOWEL .", r"no class named 'paper_TOWEL'; did you mean 'PaperTowel'"),
        (
            ":a a :Solid ; :shape :elipsoid .",
            r"named 'elipsoid'; did you mean 'ellipsoid'\?; known: articulated, bowl",
        ),
        (":a a :Egg ; :batch :carton .", r"no individual named 'carton'; known: none"),
        (":a a :Egg ; :on :FLOOR . :floor a :Floor .", r"named 'FLOOR'; did you mean 'floor'\?; known: a, floor$"),
        (":egg1 a :Egg ; :mas 0.05 .", r"s\.ttl:2: no property named 'mas'; did you mean 'mass'"),
        (":egg1 a :Egg ; :on :tabel1 . :table1 a :Table .", r"no individual named 'tabel1'; did you mean 'table1'"),
        (":egg1 a :Egg ; :mass -0.05 .", r"egg1: mass = -0\.05: must be finite and at least 1e-09"),
        (":egg1 a :Egg ; :mass 0 .", r"mass = 0: must be finite and at least 1e-09"),
        (':egg1 a :Egg ; :mass "nan" .', r"mass = nan: must be finite"),
        (':egg1 a :Egg ; :mass "inf" .', r"mass = inf: must be finite"),
        (":egg1 a :Egg ; :friction -1 .", r"friction = -1: must be finite and at least 1e-05"),
        (':egg1 a :Egg ; :mass "0,05 kg" .', r"mass = '0,05 kg': decimals are behind a point, as in 1\.5"),
        (':egg1 a :Egg ; :mass "5 N" .', r"mass = '5 N': unit 'N' does not fit: a unit such as 'kg'"),
        (':egg1 a :Egg ; :mass "5 stone" .', r"no unit 'stone'"),
        (":yolk1 a :EggYolk .", r"yolk1 is part of nothing: EggYolk must be a part of a Egg"),
        (":y a :Egg .", r"y is the name of a property"),
        (":table1 a :Table ; :hasPart :yolk . :yolk a :EggYolk .", r"yolk is a part of table1, which is no Egg"),
        (":a a :Egg ; :hasPart :s . :b a :Egg ; :hasPart :s . :s a :EggShell .", r"s has two wholes: a and b"),
        (":a a :Block ; :hasPart :b . :b a :Block ; :hasPart :a .", r"is a part of itself: a is part of b"),
        (":egg1 a :Egg ; :mass 0.05 , 0.06 .", r"egg1 has two values of mass"),
        (
            ":egg1 a :Egg ; :mass 0.04 ; :hasPart :s , :k . :s a :EggShell ; :mass 0.01 . :k a :EggYolk ; :mass 0.04 .",
            r"s\.ttl:2: the mass of egg1 is 0\.04 kg, but its parts k, s have 0\.05 kg$",
        ),
        (
            ":egg1 a :Egg ; :mass 0.06 ; :hasPart :s , :k . :s a :EggShell ; :mass 0.01 . :k a :EggYolk ; :mass 0.04 .",
            r"s\.ttl:2: the mass of egg1 is 0\.06 kg, but its parts k, s have 0\.05 kg$",
        ),
        (
            ":egg1 a :Egg ; :mass 0.01 ; :hasPart :s . :s a :EggShell ; :mass 0.01 .",
            r"the mass of egg1 is 0\.01 kg, but its part s has 0\.01 kg, which leaves nothing for white1, yolk1$",
        ),
        (
            ":b a :Block ; :mass 1 ; :hasPart :c . :c a :Block ; :hasPart :d . :d a :Block ; :mass 2 .",
            r"the mass of b is 1 kg, but its part c has 2 kg$",
        ),
        (":cup a :Cup .", r"s\.ttl:2: cup is a ShapeKind of the ontology; name the individual otherwise, such as cup1"),
        (
            ":box a :Table . :egg1 a :Egg ; :on :box .",
            r"s\.ttl:2: box is a ShapeKind of the ontology; name the individual",
        ),
        (":egg1 a :Egg\n:floor a :Floor .", r"s\.ttl:\d: Turtle syntax"),
    ],
)
def test_a_bad_situation_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "s.ttl"
    path.write_text(PREFIX + text)
    with pytest.raises(InputError, match=message):
        KnowledgeBase.load(path)


def test_a_contradiction_names_the_axioms_that_clash(tmp_path: Path) -> None:
    path = tmp_path / "s.ttl"
    path.write_text(PREFIX + ":egg1 a :Egg , :ForceLevel .")
    with pytest.raises(InconsistentError) as caught:
        KnowledgeBase.load(path)
    message = str(caught.value)
    assert "egg1 is an Egg" in message and "egg1 is a ForceLevel" in message and "s.ttl:2" in message
    assert message.count(";") == 3


def test_a_contradiction_of_many_axioms_is_one_line_and_tells_the_user_s_own_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    path = Path("s.ttl")
    path.write_text(f"{PREFIX}:egg1 a :Water , :Cup .")
    with pytest.raises(InconsistentError) as caught:
        KnowledgeBase.load(path)
    message, conflict = str(caught.value), caught.value.conflict
    assert len(message) <= LONGEST_LINE and "; every Water is a Liquid" in message
    assert message.startswith(
        f"the knowledge base contradicts itself: egg1 is a Cup ({path}:2); egg1 is a Water ({path}:2)"
    )
    assert sum(map(len, conflict)) > LONGEST_LINE and any("liquids.ttl:" in each for each in conflict)
    assert pickle.loads(pickle.dumps(caught.value)).conflict == conflict


def test_a_contradiction_that_has_no_room_says_how_much_more_there_is(tmp_path: Path) -> None:
    path = tmp_path / "s.ttl"
    names = [f"{'Long' * 12}Class{k}" for k in range(9)]
    lines = [f":{a} a owl:Class ; rdfs:subClassOf :{b} ." for a, b in zip(names, [*names[1:], "Water"], strict=True)]
    owl = "@prefix owl: <http://www.w3.org/2002/07/owl#> .\n@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .\n"
    path.write_text("\n".join([PREFIX + owl, *lines, f":egg1 a :Cup , :{names[0]} ."]))
    with pytest.raises(InconsistentError, match=r"; and \d+ more$") as caught:
        KnowledgeBase.load(path)
    assert len(str(caught.value)) <= LONGEST_LINE and len(caught.value.conflict) > 10


BOTH = {
    "Egg , :Water": "no Shelled is a Stuff",
    "Block , :Table": "no Block is a Table",
    "Floor , :Egg": "no Floor is a Shelled",
    "Egg , :Block": "no Block is a Shelled",
    "Cup , :Bowl": "no Bowl is a Cup",
    "Milk , :Honey": "no Honey is a Milk",
    "Sponge , :Block": "no Block is a Sponge",
    "PR2 , :Block": "no Block is a Robot",
    "Gripper , :Beads": "no Gripper is a Stuff",
    "Batch , :ForceLevel": "no Batch is a ForceLevel",
}


@pytest.mark.parametrize(("classes", "excluded"), BOTH.items(), ids=list(BOTH))
def test_what_excludes_each_other_contradicts(tmp_path: Path, classes: str, excluded: str) -> None:
    path = tmp_path / "s.ttl"
    path.write_text(f"{PREFIX}:b1 a :{classes} .")
    with pytest.raises(InconsistentError) as caught:
        KnowledgeBase.load(path)
    assert excluded in str(caught.value) and "s.ttl:2" in str(caught.value)


def test_parts_that_two_classes_give_are_told_with_the_classes(tmp_path: Path) -> None:
    path = tmp_path / "s.ttl"
    path.write_text(f"{PREFIX}:b1 a :Egg , :Coconut .")
    with pytest.raises(KnowledgeError, match=r"s\.ttl:2: b1 is of Coconut and Egg, .*; allowed: one of them"):
        KnowledgeBase.load(path)


BROKEN = (
    "root:x:0:0:secret",
    "secret",
    ":egg1 a secret:Egg .",
    ":egg1 a :Egg ; :mass secret .",
    ':egg1 a :Egg ; :colour "secret',
    "<secret",
    ':egg1 a :Egg ; :mass "\\secret" .',
    "@prefix secret",
)


@pytest.mark.parametrize("text", BROKEN)
@pytest.mark.parametrize("name", ["shadow", "key.pem", "s.toml"])
def test_what_another_file_than_one_of_turtle_says_is_not_shown(tmp_path: Path, name: str, text: str) -> None:
    path = tmp_path / name
    path.write_text(PREFIX + text)
    with pytest.raises(KnowledgeError, match=f"{name}.*: Turtle syntax: ") as caught:
        KnowledgeBase.load(path)
    assert "secret" not in str(caught.value)


def test_of_a_turtle_file_the_word_is_shown_at_which_it_goes_wrong(tmp_path: Path) -> None:
    path = tmp_path / "s.ttl"
    path.write_text(f"{PREFIX}:egg1 a :Egg\n:floor a :Floor .")
    with pytest.raises(KnowledgeError, match=r"s\.ttl:\d: Turtle syntax: .* at ':floor'$"):
        KnowledgeBase.load(path)
    path.write_text(":egg1 a :Egg .")
    with pytest.raises(KnowledgeError, match=r"not bound .write '@prefix : <https://w3id.org/prolepsis#> .' before"):
        KnowledgeBase.load(path)


def test_a_byte_order_mark_is_no_text(tmp_path: Path) -> None:
    path = tmp_path / "s.ttl"
    path.write_text(f"{PREFIX}:egg1 a :Egg .", encoding="utf-8-sig")
    assert "egg1" in KnowledgeBase.load(path).objects


@pytest.mark.parametrize("classes", [":Wall, :Obstacle", ":Block, :Obstacle"])
def test_what_is_in_no_list_together_may_be_one_thing(tmp_path: Path, classes: str) -> None:
    file = tmp_path / "s.ttl"
    file.write_text(f"@prefix : <https://w3id.org/prolepsis#> . :b a {classes} .", encoding="utf-8")
    assert KnowledgeBase.load(file).objects == ("b",)
