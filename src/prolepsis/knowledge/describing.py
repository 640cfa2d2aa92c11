"""Descriptions: what there is to say of a class, a property or an individual, a line each."""

from __future__ import annotations

from typing import TYPE_CHECKING

from prolepsis.knowledge.vocabulary import CERTAINTIES, ClassEntry, Curve, Property
from prolepsis.terms.errors import UnknownNameError

if TYPE_CHECKING:
    from prolepsis.knowledge.knowledge_base import KnowledgeBase


def describe(base: KnowledgeBase, name: str) -> tuple[str, ...]:
    """Return lines about the class, property or individual called ``name``.

    Raises:
        UnknownNameError: If there is none.
    """
    vocabulary = base.vocabulary
    if name in vocabulary.classes:
        return tuple(_class_lines(base, vocabulary.classes[name]))
    if name in vocabulary.properties:
        return tuple(_property_lines(vocabulary.properties[name]))
    if name in base.individuals:
        return tuple(_individual_lines(base, name))
    known = [*vocabulary.classes, *vocabulary.properties, *base.individuals]
    raise UnknownNameError.of("class, property or individual", name, known)


def _shown(value: float | str) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _class_lines(base: KnowledgeBase, entry: ClassEntry) -> list[str]:
    lines = [f"{entry.name}: {'defined ' if entry.defined else ''}class. {entry.comment}"]
    above = base.types.superclasses(entry.name)
    lines += [f"  is a: {', '.join(above)}"] if above else []
    below = [c for c in base.vocabulary.classes if entry.name in base.types.superclasses(c)]
    lines += [f"  more special: {', '.join(below)}"] if below else []
    lines += [f"  must be part of: {', '.join(entry.needs_whole)}"] if entry.needs_whole else []
    lines += [
        f"  part by default: {part.kind}{f', {part.counted_by} of them' if part.counted_by else ''} ({part.source})"
        for part in entry.parts
    ]
    lines += [
        f"  limit: {limit.name} {limit.bounds}"
        for class_name in (entry.name, *above)
        for limit in base.vocabulary.classes[class_name].limits
    ]
    seen: set[str] = set()
    for class_name in (entry.name, *above):
        for default in base.vocabulary.classes[class_name].defaults:
            best = base.default_of((entry.name, *above), default.property)
            if default.property in seen or best is None or best[0] != class_name:
                continue
            seen.add(default.property)
            unit = base.vocabulary.properties[default.property].si_unit
            spread = f" +- {default.deviation:g}" if default.deviation else ""
            if default.batch_deviation < default.deviation:
                spread += f" ({default.batch_deviation:g} in a batch)"
            given = "" if class_name == entry.name else f", by {class_name}"
            lines.append(
                f"  {default.property} = {_shown(default.value)}{spread} {unit}".rstrip()
                + f" ({default.certainty}, {CERTAINTIES[default.certainty]}: {default.source}{given})"
            )
        lines += [_curve_line(base, curve) for curve in base.vocabulary.classes[class_name].curves]
    lines += [f"  corresponds to: {iri}" for iri in entry.alignments]
    return lines


def _curve_line(base: KnowledgeBase, curve: Curve) -> str:
    properties = base.vocabulary.properties
    unit, over = properties[curve.property].si_unit, properties[curve.over].si_unit
    points = ", ".join(f"{value:g} at {at:g} {over}" for at, value in curve.points)
    known = f"{curve.certainty}, {CERTAINTIES[curve.certainty]}: {curve.source}"
    return f"  {curve.property} by {curve.over} = {points} [{unit}] ({known})"


def _property_lines(entry: Property) -> list[str]:
    lines = [f"{entry.name}: {entry.kind}. {entry.comment}"]
    lines += (
        [f"  unit: {entry.unit}" + (f" (SI {entry.si_unit})" if entry.si_unit != entry.unit else "")]
        if entry.unit
        else []
    )
    lines += [f"  values: {entry.bounds}"] if entry.bounds else []
    lines += [f"  value is a: {entry.range}"] if entry.range else []
    lines += [f"  is a kind of: {', '.join(entry.parents)}"] if entry.parents else []
    lines += [f"  corresponds to: {iri}" for iri in entry.alignments]
    return lines


def _individual_lines(base: KnowledgeBase, name: str) -> list[str]:
    lines = [f"{name}: {base.kind(name)}", f"  is a: {', '.join(base.classes(name))}"]
    whole, parts = base.whole(name), base.parts(name)
    lines += [f"  part of: {whole}"] if whole is not None else []
    lines += [f"  parts: {', '.join(parts)}"] if parts else []
    for property_name, known in base.quantities(name).items():
        lines.append(
            f"  {property_name} = {_shown(known.value)} {known.unit}".rstrip() + f" ({known.origin}: {known.source})"
        )
    return lines
