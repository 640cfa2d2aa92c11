"""The knowledge base: individuals, their inferred classes, and their values with the origin of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from prolepsis.knowledge.deriving import derive
from prolepsis.knowledge.describing import describe
from prolepsis.knowledge.drawing import draw
from prolepsis.knowledge.inferred import Types
from prolepsis.knowledge.possible import refuse_impossible_values
from prolepsis.knowledge.reading import infer, read
from prolepsis.knowledge.situation import INVERSES, Situation, Statement
from prolepsis.knowledge.sources import Source, sources_of
from prolepsis.knowledge.values import Known
from prolepsis.knowledge.vocabulary import Default, Vocabulary
from prolepsis.log.domain import Domain
from prolepsis.system.text_files import path_of
from prolepsis.terms.errors import KnowledgeError, UnknownNameError, brief


@dataclass(frozen=True, kw_only=True, slots=True)
class KnowledgeBase:
    """What is known before anything moves. It never changes; ``with_values`` and ``with_draws`` return others."""

    vocabulary: Vocabulary
    """Classes and properties."""
    situation: Situation
    """Individuals and what is said of them."""
    types: Types
    """Inferred classes."""
    sources: tuple[Source, ...]
    """The Turtle files."""
    overrides: Mapping[tuple[str, str], Known]
    """(individual, property) to a value that replaces whatever else is known."""

    @classmethod
    def load(cls, *sources: Path | str | Source, check: bool = True, most: int | None = None) -> KnowledgeBase:
        """Return the knowledge base of the built-in ontology and further Turtle files.

        Args:
            sources: Paths of the Turtle files of a situation, or of further classes; or what was read already.
            check: Whether to refuse an inconsistent one; only for looking at what is wrong.
            most: How many individuals a file may have, which is found before any reasoning; any number if None.

        Raises:
            UnknownNameError: If a class, property or individual is not declared.
            KnowledgeError: If a file, a value or the structure of parts is wrong.
            InconsistentError: If the axioms contradict each other.
        """
        texts = sources_of([s if isinstance(s, Source) else path_of(s, "Turtle file", KnowledgeError) for s in sources])
        vocabulary, situation, types = read(texts, check=check, most=most)
        base = cls(vocabulary=vocabulary, situation=situation, types=types, sources=texts, overrides={})
        if check:
            refuse_impossible_values(base)
        return base

    @property
    def unchecked(self) -> str:
        """Why it is not known whether it contradicts itself, and whether its individuals have more classes; empty if
        that is known."""
        return self.types.unchecked

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

    def location(self, name: str) -> str:
        """Return file and line where an individual is introduced, or why it is there."""
        self._require(name)
        return self.situation.locations[name]

    def relations(self) -> tuple[tuple[str, str, str], ...]:
        """Return the asserted relations between individuals but parthood: (relation, subject, object), sorted."""
        rows = {
            (s.property, s.subject, str(s.value))
            for s in self.situation.statements
            if self.vocabulary.properties[s.property].kind == "relation" and s.property not in ("hasPart", "shape")
        }
        return tuple(sorted(rows))

    def value(self, name: str, property_name: str) -> Known:
        """Return the value of a property: overridden or drawn, asserted, derived, its batch's, or its class's.

        Raises:
            UnknownNameError: If there is no such individual or property, or nothing is known of it.
        """
        self._require(name)
        if property_name not in self.vocabulary.properties:
            raise UnknownNameError.of("property", property_name, self.vocabulary.properties)
        known = self.find(name, property_name)
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
        if entry is not None and default is not None and self.find(name, property_name) is None:
            return default
        known = self.value(name, property_name)
        if not isinstance(known.value, float):
            raise KnowledgeError(f"{property_name} of {name} is no quantity but {brief(repr(known.value))}")
        return known.value

    def quantities(self, name: str) -> dict[str, Known]:
        """Return all that is known of ``name``, by property."""
        self._require(name)
        found = {
            p: self.find(name, p) for p, e in self.vocabulary.properties.items() if e.kind != "relation" or p == "shape"
        }
        return {p: known for p, known in found.items() if known is not None}

    def with_values(self, values: Mapping[str, float | str], *, where: str = "") -> KnowledgeBase:
        """Return a knowledge base in which ``"individual.property"`` has another value.

        Args:
            values: Numbers in the property's unit, texts such as ``"58 g"``, ``true``, or names of individuals.
            where: What messages begin with.

        Raises:
            UnknownNameError: If an individual or property does not exist.
            KnowledgeError: If a value is wrong.
        """
        from prolepsis.knowledge.written import read_value

        overrides: dict[tuple[str, str], Known] = {}
        for key, value in values.items():
            name, dot, property_name = key.rpartition(".")
            here = f"{where}{key}"
            if not dot:
                raise KnowledgeError(f"{where}a knowledge value is named individual.property, not {brief(repr(key))}")
            self._require(name, where=here)
            entry = self.vocabulary.properties.get(property_name)
            if entry is None:
                raise UnknownNameError.of("property", property_name, self.vocabulary.properties, where=here)
            counts = {part.counted_by for each in self.vocabulary.classes.values() for part in each.parts}
            if property_name in ("hasPart", "comprises", *INVERSES, *counts):
                raise KnowledgeError(f"{here}: {property_name} cannot be overridden; write it in the situation")
            read = read_value(entry, str(value).lower() if isinstance(value, bool) else value, where=here)
            if entry.kind == "relation":
                self._require(str(read), where=here)
            overrides[name, property_name] = Known(value=read, unit=entry.si_unit, origin="override", source="override")
        return self._with(overrides)

    def with_draws(self, seed: int) -> KnowledgeBase:
        """Return a knowledge base in which every quantity that has a deviation is drawn, as ``drawing`` tells.

        Raises:
            KnowledgeError: If what follows from a draw cannot be.
        """
        drawn = draw(self, seed)
        try:
            return self._with(drawn) if drawn else self
        except KnowledgeError as error:
            raise KnowledgeError(f"what seed {seed} draws cannot be: {error}") from error

    @property
    def drawn(self) -> dict[str, float | str]:
        """What was drawn, ``{"eggshell1.breakingForce": 29.3}``: given to ``with_values``, it is the same to the last
        bit."""
        found: dict[str, float | str] = {}
        for (name, property_name), known in self.overrides.items():
            if known.origin == "drawn" and isinstance(known.value, float):
                plain = self.vocabulary.properties[property_name].unit == known.unit
                found[f"{name}.{property_name}"] = known.value if plain else f"{known.value!r} {known.unit}"
        return found

    def _with(self, more: Mapping[tuple[str, str], Known]) -> KnowledgeBase:
        """Return a knowledge base with more overrides, its types inferred anew."""
        overrides = {**self.overrides, **more}
        statements = [s for s in self.situation.statements if (s.subject, s.property) not in overrides]
        statements += [
            Statement(subject=n, property=p, value=k.value, where=k.origin) for (n, p), k in overrides.items()
        ]
        situation = replace(self.situation, statements=tuple(statements))
        types = infer(self.sources, self.vocabulary, situation)
        changed = replace(self, situation=situation, types=types, overrides=overrides)
        refuse_impossible_values(changed)
        return changed

    def domain(self) -> Domain:
        """Return what is known of the physical objects and force levels as plain rows."""
        names = self.individuals
        return replace(
            self.vocabulary.domain(),
            instances=tuple((n, c) for n in names for c in self.types.classes[n]),
            parts=tuple((w, p) for w in names for p in self.situation.parts.get(w, ())),
            values=tuple((n, p, k.value) for n in names for p, k in self.quantities(n).items()),
            relations=self.relations(),
            unchecked=self.unchecked,
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

    def find(self, name: str, property_name: str) -> Known | None:
        """Return the value of a property, or None if nothing is known of it."""
        entry = self.vocabulary.properties[property_name]
        if (name, property_name) in self.overrides:
            return self.overrides[name, property_name]
        for s in self.situation.said.get((name, property_name), ())[:1]:
            return Known(value=s.value, unit=entry.si_unit, origin="asserted", source=s.where)
        return derive(self, name, property_name) or self.default(name, property_name)

    def subjects(self, relation: str, name: str) -> tuple[str, ...]:
        """Return the individuals of which an asserted relation to ``name`` is told, sorted."""
        return self.situation.said_with.get((relation, name), ())

    def objects_of(self, relation: str, name: str) -> tuple[str, ...]:
        """Return the individuals to which ``name`` has an asserted relation, sorted."""
        return tuple(sorted({str(s.value) for s in self.situation.said.get((name, relation), ())}))

    def stated(self, name: str, property_name: str) -> float | None:
        """Return the number that the situation states [SI], or None."""
        stated = self.situation.said.get((name, property_name), ())
        return next((s.value for s in stated if isinstance(s.value, float)), None)

    def number(self, name: str, property_name: str) -> float | None:
        """Return what is known as a number in SI units, the truth as 1, or None."""
        known = self.find(name, property_name)
        if known is not None and known.value == "true":
            return 1.0
        return known.value if known is not None and isinstance(known.value, float) else None

    def text(self, name: str, property_name: str) -> str | None:
        """Return what is known as a text, or None."""
        known = self.find(name, property_name)
        return known.value if known is not None and isinstance(known.value, str) else None

    def batch(self, name: str) -> str | None:
        """Return the batch to which ``name`` belongs, or what it is a part of."""
        for said in self.situation.said.get((name, "batch"), ())[:1]:
            return str(said.value)
        whole = self.situation.wholes.get(name)
        return None if whole is None else self.batch(whole)

    def default(self, name: str, property_name: str) -> Known | None:
        """Return what its batch has, or the default of the most specific class of ``name``, or None."""
        try:
            found = self.default_of(self.types.classes[name], property_name)
        except KnowledgeError as error:
            raise KnowledgeError(f"{self.situation.locations[name]}: {name}: {error}") from None
        if found is None:
            return None
        class_name, default = found
        batch = self.batch(name)
        of_all = None if batch is None else self.find(batch, property_name)
        if of_all is not None:
            within = default.batch_deviation
            return replace(of_all, origin="batch", source=f"{batch}: {of_all.source}", deviation=within)
        return Known(
            value=default.value,
            unit=self.vocabulary.properties[property_name].si_unit,
            origin="class default",
            source=f"{class_name}: {default.source}",
            certainty=default.certainty,
            deviation=default.deviation,
            batch_deviation=default.batch_deviation,
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
