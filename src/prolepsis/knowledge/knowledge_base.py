"""The knowledge base: individuals, their inferred classes, and their values with the origin of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from prolepsis.domain import Domain
from prolepsis.errors import KnowledgeError, UnknownNameError
from prolepsis.knowledge.declarations import read_vocabulary
from prolepsis.knowledge.derived import volume
from prolepsis.knowledge.describing import describe
from prolepsis.knowledge.masses import Masses
from prolepsis.knowledge.reasoning import Types, infer_types
from prolepsis.knowledge.situation import INVERSES, Situation, Statement, read_situation
from prolepsis.knowledge.spelling import refuse_unknown_names
from prolepsis.knowledge.turtle import Document, documents_of
from prolepsis.knowledge.values import Known
from prolepsis.knowledge.vocabulary import Default, Vocabulary
from prolepsis.knowledge.written import read_value

OF_THE_WALL = ("friction", "breakingForce", "plateStiffness", "shellThickness")
"""A whole with one part that encloses the others has these of that part: one touches and breaks an egg by its shell."""


@dataclass(frozen=True, kw_only=True, slots=True)
class KnowledgeBase:
    """What is known before anything moves. It never changes; ``with_values`` returns another one."""

    vocabulary: Vocabulary
    """Classes and properties."""
    situation: Situation
    """Individuals and what is said of them."""
    types: Types
    """Inferred classes."""
    documents: tuple[Document, ...]
    """The Turtle files."""
    overrides: Mapping[tuple[str, str], float | str]
    """(individual, property) to a value that replaces whatever else is known."""

    @classmethod
    def load(cls, *paths: Path | str, check: bool = True) -> KnowledgeBase:
        """Return the knowledge base of the built-in ontology and the Turtle files at ``paths``.

        Args:
            paths: Turtle files of a situation, or of further classes.
            check: Whether to refuse an inconsistent one; only for looking at what is wrong.

        Raises:
            UnknownNameError: If a class, property or individual is not declared.
            KnowledgeError: If a file, a value or the structure of parts is wrong.
            InconsistentError: If the axioms contradict each other.
        """
        documents = documents_of([Path(path) for path in paths])
        vocabulary = read_vocabulary(documents)
        refuse_unknown_names(documents, vocabulary)
        situation = read_situation(documents, vocabulary)
        types = infer_types(documents, vocabulary, situation, check=check)
        base = cls(vocabulary=vocabulary, situation=situation, types=types, documents=documents, overrides={})
        if check:
            base._refuse_impossible_masses()
        return base

    @property
    def individuals(self) -> tuple[str, ...]:
        """Names of all individuals but the kinds of shape, sorted."""
        return tuple(name for name in self.situation.classes if "ShapeKind" not in self.types.classes[name])

    @property
    def objects(self) -> tuple[str, ...]:
        """Names of the physical objects, parts included, sorted."""
        return tuple(name for name in self.individuals if "PhysicalObject" in self.types.classes[name])

    def classes(self, name: str) -> tuple[str, ...]:
        """Return the inferred classes of the individual ``name``, sorted."""
        self._require(name)
        return self.types.classes[name]

    def kind(self, name: str) -> str:
        """Return the most specific class of ``name`` that is not defined: what it is, not the state it is in."""
        return self.types.kind(self.classes(name), self.vocabulary)

    def is_a(self, name: str, class_name: str) -> bool:
        """Return whether the individual ``name`` belongs to the class."""
        if class_name not in self.vocabulary.classes:
            raise UnknownNameError.of("class", class_name, self.vocabulary.classes)
        return class_name in self.classes(name)

    def parts(self, name: str) -> tuple[str, ...]:
        """Return the direct parts of ``name``, sorted."""
        self._require(name)
        return self.situation.parts.get(name, ())

    def whole(self, name: str) -> str | None:
        """Return what ``name`` is a direct part of."""
        self._require(name)
        return self.situation.wholes.get(name)

    def relations(self) -> tuple[tuple[str, str, str], ...]:
        """Return the asserted relations between individuals but parthood: (relation, subject, object), sorted."""
        rows = {
            (s.property, s.subject, str(s.value))
            for s in self.situation.statements
            if self.vocabulary.properties[s.property].kind == "relation" and s.property not in ("hasPart", "shape")
        }
        return tuple(sorted(rows))

    def value(self, name: str, property_name: str) -> Known:
        """Return the value of a property: overridden, asserted, derived, or the most specific class default.

        Raises:
            UnknownNameError: If there is no such individual or property, or nothing is known of it.
        """
        self._require(name)
        if property_name not in self.vocabulary.properties:
            raise UnknownNameError.of("property", property_name, self.vocabulary.properties)
        known = self._find(name, property_name)
        if known is None:
            raise UnknownNameError.of(f"value {property_name} of {name}", property_name, self.quantities(name))
        return known

    def quantity(self, name: str, property_name: str, default: float | None = None) -> float:
        """Return the value of a quantity in SI units, or ``default`` if nothing is known and it is given.

        Raises:
            UnknownNameError: If nothing is known of it and there is no ``default``.
            KnowledgeError: If the property is no quantity.
        """
        self._require(name)
        entry = self.vocabulary.properties.get(property_name)
        if entry is not None and default is not None and self._find(name, property_name) is None:
            return default
        known = self.value(name, property_name)
        if not isinstance(known.value, float):
            raise KnowledgeError(f"{property_name} of {name} is no quantity but {known.value!r}")
        return known.value

    def quantities(self, name: str) -> dict[str, Known]:
        """Return all that is known of ``name``, by property."""
        self._require(name)
        found = {
            p: self._find(name, p)
            for p, e in self.vocabulary.properties.items()
            if e.kind != "relation" or p == "shape"
        }
        return {p: known for p, known in found.items() if known is not None}

    def with_values(self, values: Mapping[str, float | str]) -> KnowledgeBase:
        """Return a knowledge base in which ``"individual.property"`` has another value.

        Args:
            values: Numbers in the property's unit, texts such as ``"58 g"``, ``true``, or names of individuals.

        Raises:
            UnknownNameError: If an individual or property does not exist.
            KnowledgeError: If a value is wrong.
        """
        overrides = dict(self.overrides)
        for key, value in values.items():
            name, dot, property_name = key.rpartition(".")
            if not dot:
                raise KnowledgeError(f"a knowledge value is named individual.property, not {key!r}")
            self._require(name, where=key)
            entry = self.vocabulary.properties.get(property_name)
            if entry is None:
                raise UnknownNameError.of("property", property_name, self.vocabulary.properties, where=key)
            if property_name in ("hasPart", "comprises", *INVERSES):
                raise KnowledgeError(f"{key}: {property_name} cannot be overridden; write it in the situation")
            read = read_value(entry, str(value).lower() if isinstance(value, bool) else value, where=key)
            if entry.kind == "relation":
                self._require(str(read), where=key)
            overrides[name, property_name] = read
        statements = [s for s in self.situation.statements if (s.subject, s.property) not in overrides]
        statements += [Statement(subject=n, property=p, value=v, where="override") for (n, p), v in overrides.items()]
        situation = replace(self.situation, statements=tuple(statements))
        types = infer_types(self.documents, self.vocabulary, situation, check=True)
        changed = replace(self, situation=situation, types=types, overrides=overrides)
        changed._refuse_impossible_masses()
        return changed

    def domain(self) -> Domain:
        """Return what is known of the physical objects and force levels as plain rows."""
        names = self.individuals
        return Domain(
            instances=tuple((n, c) for n in names for c in self.types.classes[n]),
            parts=tuple((w, p) for w in names for p in self.situation.parts.get(w, ())),
            values=tuple((n, p, k.value) for n in names for p, k in self.quantities(n).items()),
            relations=self.relations(),
        )

    def class_names(self) -> tuple[str, ...]:
        """Return the names of all classes, sorted."""
        return tuple(self.vocabulary.classes)

    def describe(self, name: str) -> tuple[str, ...]:
        """Return lines that tell what is known of a class, a property or an individual.

        Raises:
            UnknownNameError: If there is none of that name.
        """
        return describe(self, name)

    def _require(self, name: str, where: str = "") -> None:
        if name not in self.situation.classes:
            raise UnknownNameError.of("individual", name, self.individuals, where)

    def _find(self, name: str, property_name: str) -> Known | None:
        entry = self.vocabulary.properties[property_name]
        for s in self.situation.statements:
            if s.subject == name and s.property == property_name:
                origin = "override" if (name, property_name) in self.overrides else "asserted"
                return Known(value=s.value, unit=entry.si_unit, origin=origin, source=s.where)
        return self._derive(name, property_name) or self._default(name, property_name)

    def _derive(self, name: str, property_name: str) -> Known | None:
        if property_name in OF_THE_WALL:
            walls = [part for part in self.situation.parts.get(name, ()) if "Enclosure" in self.types.classes[part]]
            known = self._find(walls[0], property_name) if len(walls) == 1 else None
            if known is None:
                return None
            return replace(known, origin="derived", source=f"that of its wall {walls[0]} ({known.source})")
        if property_name != "mass":
            return None
        masses = self._masses()
        share = masses.share(name)
        if share is not None:
            return _derived(share, f"its share of the mass of {self.situation.wholes[name]}")
        parts = self.situation.parts.get(name, ())
        known = [self._find(part, "mass") for part in parts]
        if parts and all(known):
            return _derived(sum(float(k.value) for k in known if k is not None), f"sum of {', '.join(parts)}")
        return self._mass_of_volume(name)

    def _mass_of_volume(self, name: str) -> Known | None:
        shape, default = self._find(name, "shape"), self._default(name, "mass")
        found = volume(str(shape.value), lambda p: self._number(name, p)) if shape and not default else None
        density = self._number(name, "density")
        return _derived(density * found[0], f"density * {found[1]}") if found and density else None

    def _masses(self) -> Masses:
        def usual(name: str) -> float | None:
            known = self._default(name, "mass") or self._mass_of_volume(name)
            return None if known is None else float(known.value)

        return Masses(
            parts=self.situation.parts,
            wholes=self.situation.wholes,
            stated=lambda name: self._stated(name, "mass"),
            usual=usual,
        )

    def _refuse_impossible_masses(self) -> None:
        def where(name: str) -> str:
            places = [s.where for s in self.situation.statements if (s.subject, s.property) == (name, "mass")]
            return places[0] if places else self.situation.places[name]

        self._masses().refuse(where)

    def _stated(self, name: str, property_name: str) -> float | None:
        for s in self.situation.statements:
            if s.subject == name and s.property == property_name and isinstance(s.value, float):
                return s.value
        return None

    def _number(self, name: str, property_name: str) -> float | None:
        known = self._find(name, property_name)
        return known.value if known is not None and isinstance(known.value, float) else None

    def _default(self, name: str, property_name: str) -> Known | None:
        found = self.default_of(self.types.classes[name], property_name)
        if found is None:
            return None
        class_name, default = found
        return Known(
            value=default.value,
            unit=self.vocabulary.properties[property_name].si_unit,
            origin="class default",
            source=f"{class_name}: {default.source}",
            certainty=default.certainty,
            deviation=default.deviation,
        )

    def default_of(self, classes: tuple[str, ...], property_name: str) -> tuple[str, Default] | None:
        """Return the default of the most specific of ``classes`` that has one, with its class.

        Raises:
            KnowledgeError: If two classes, neither a subclass of the other, give different values.
        """
        candidates = {c: d for c in classes for d in self.vocabulary.classes[c].defaults if d.property == property_name}
        best = [c for c in candidates if not any(c in self.types.superclasses(o) for o in candidates if o != c)]
        if not best:
            return None
        if len({candidates[c].value for c in best}) > 1:
            raise KnowledgeError(
                f"{' and '.join(best)} give different defaults of {property_name}, and neither is the more specific: "
                f"state it for the individual, or for a common subclass"
            )
        return best[0], candidates[best[0]]


def _derived(mass: float, source: str) -> Known:
    return Known(value=mass, unit="kg", origin="derived", source=source)
