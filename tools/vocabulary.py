"""Write what the shipped program knows by name as Prolog facts, so that a question is checked without importing it.

python tools/vocabulary.py          # writes src/prolepsis/logic/prolog/vocabulary.pl; a test says when it is needed
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from prolepsis import programs
from prolepsis.fluents import fact_types
from prolepsis.knowledge import KnowledgeBase
from prolepsis.knowledge.vocabulary import Vocabulary
from prolepsis.log.evidence_names import EVIDENCE_UNITS
from prolepsis.log.fact_types import FactType
from prolepsis.log.outcomes import OUTCOMES
from prolepsis.logic.unknown_names import OTHERWISE
from prolepsis.terms.terms import format_atom

FILE = Path(__file__).parents[1] / "src/prolepsis/logic/prolog/vocabulary.pl"
HEAD = """\
/*  What is known by name without any run: fluents, events, evidence, and the built-in ontology.

    Made by tools/vocabulary.py from what is declared in Python and in the ontology; not to be edited.
*/

:- module(vocabulary,
          [ fact_type/3,                % ?Name, ?Arity, ?Kind
            evidence_unit/2,            % ?Name, ?Unit
            class/1,                    % ?Class
            parent/2,                   % ?Class, ?Parent
            defined_by/3,               % ?Class, ?Property, ?Filler
            property_parent/2,          % ?Property, ?Parent
            property_inverse/2,         % ?Property, ?Inverse
            property/2,                 % ?Property, ?Unit
            allowed_value/2             % ?Name, ?Value
          ]).
"""


def vocabulary_text() -> str:
    """Return the text of the Prolog file."""
    knowledge = KnowledgeBase.load()
    vocabulary = knowledge.vocabulary
    # What actions are as events is known once they have been imported.
    assert programs.ACTIONS
    sections = (
        ("fact_type(Name, Arity, Kind): fluents, asserted relations among them, and events.", _facts(vocabulary)),
        (
            "evidence_unit(Name, Unit): what evidence is called; the unit of a text is ''.",
            _rows("evidence_unit", EVIDENCE_UNITS.items()),
        ),
        ("class(Class), parent(Class, Parent): the classes, and those above them as told.", _classes(vocabulary)),
        (
            "defined_by(Class, Property, Filler): what a defined class asks for, all of it, where that is a row each.",
            _rows("defined_by", {(each.name, *row) for each in vocabulary.classes.values() for row in each.conditions}),
        ),
        (
            "property_parent(Property, Parent): the properties, and those above them as told.",
            _rows("property_parent", ((p.name, above) for p in vocabulary.properties.values() for above in p.parents)),
        ),
        (
            "property_inverse(Property, Inverse): what says the same from the other end, as told.",
            _rows("property_inverse", ((p.name, its) for p in vocabulary.properties.values() for its in p.inverses)),
        ),
        (
            "property(Property, Unit): what individuals have; the unit of what is no quantity is ''.",
            _rows("property", ((entry.name, entry.si_unit) for entry in vocabulary.properties.values())),
        ),
        (
            "allowed_value(Name, Value): the values of a property or of evidence, where there are few.",
            _rows("allowed_value", _values(knowledge)),
        ),
    )
    return HEAD + "".join(f"\n%   {told}\n\n{''.join(rows)}" for told, rows in sections)


def _rows(name: str, rows: Iterable[tuple[str, ...]]) -> Iterator[str]:
    for row in sorted(rows):
        yield f"{name}({', '.join(map(format_atom, row))}).\n"


def _facts(vocabulary: Vocabulary) -> Iterator[str]:
    types = dict(fact_types())
    for entry in vocabulary.properties.values():
        if entry.kind == "relation" and entry.name not in OTHERWISE:
            types.setdefault(entry.name, FactType(name=entry.name, kind="fluent", arguments=("", ""), doc=""))
    for name, known in sorted(types.items()):
        for arity in known.arities:
            yield f"fact_type({format_atom(name)}, {arity}, {known.kind}).\n"


def _values(knowledge: KnowledgeBase) -> Iterator[tuple[str, str]]:
    yield from (("outcome", outcome) for outcome in OUTCOMES)
    for entry in knowledge.vocabulary.properties.values():
        if entry.kind == "truth":
            yield from ((entry.name, value) for value in ("true", "false"))
    shapes = (name for name, classes in knowledge.situation.classes.items() if "ShapeKind" in classes)
    yield from (("shape", name) for name in shapes)


def _classes(vocabulary: Vocabulary) -> Iterator[str]:
    yield from _rows("class", ((name,) for name in vocabulary.classes))
    yield "\n"
    yield from _rows(
        "parent", {(entry.name, parent) for entry in vocabulary.classes.values() for parent in entry.parents}
    )


if __name__ == "__main__":
    FILE.write_text(vocabulary_text(), encoding="utf-8")
