"""What follows for an individual from what else is known of it: its mass, its volume, what it holds, its viscosity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from prolepsis.knowledge import derived
from prolepsis.knowledge.masses import Masses
from prolepsis.knowledge.values import Known
from prolepsis.terms.errors import KnowledgeError

if TYPE_CHECKING:
    from prolepsis.knowledge.knowledge_base import KnowledgeBase

OF_THE_WALL = ("friction", "breakingForce", "plateStiffness", "shellThickness")
"""A whole with one part that encloses the others has these of that part: one touches and breaks an egg by its shell."""


def derive(base: KnowledgeBase, name: str, property_name: str) -> Known | None:
    """Return the value of a property that follows from other values, or None if it does not.

    Raises:
        KnowledgeError: If it cannot be.
    """
    if property_name in OF_THE_WALL:
        return _of_its_wall(base, name, property_name)
    if base.vocabulary.properties[property_name].of_parts:
        return _of_its_whole(base, name, property_name)
    rule = _RULES.get(property_name)
    known = (rule(base, name) if rule else None) or _on_a_curve(base, name, property_name)
    if known is not None:
        _refuse_out_of_bounds(base, name, property_name, known)
    return known


def _refuse_out_of_bounds(base: KnowledgeBase, name: str, property_name: str, known: Known) -> None:
    """Refuse what follows from values that are each within their bounds, but is itself not."""
    entry, where = base.vocabulary.properties[property_name], base.situation.locations[name]
    if not entry.admits(float(known.value)):
        value = f"{entry.shown(float(known.value))} ({known.source})"
        raise KnowledgeError(f"{where}: {name}: {property_name} = {value}: must be {entry.bounds}")


def masses_of(base: KnowledgeBase) -> Masses:
    """Return the masses of all individuals, whichever of them are stated."""

    def usual(name: str) -> float | None:
        known = base.default(name, "mass") or mass_of_volume(base, name)
        return None if known is None else float(known.value)

    return Masses(
        parts=base.situation.parts,
        wholes=base.situation.wholes,
        stated=lambda name: base.stated(name, "mass"),
        usual=usual,
    )


def _of_its_wall(base: KnowledgeBase, name: str, property_name: str) -> Known | None:
    walls = [part for part in base.situation.parts.get(name, ()) if "Enclosure" in base.types.classes[part]]
    known = base.find(walls[0], property_name) if len(walls) == 1 else None
    if known is None:
        return None
    return replace(known, origin="derived", source=f"that of its wall {walls[0]} ({known.origin}: {known.source})")


def _of_its_whole(base: KnowledgeBase, name: str, property_name: str) -> Known | None:
    """Return what is stated of the nearest whole of which it is."""
    whole = base.situation.wholes.get(name)
    while whole is not None:
        known = base.find(whole, property_name) if (whole, property_name) in base.situation.said else None
        if known is not None:
            return replace(known, origin="derived", source=f"that of {whole}, whose part it is ({known.source})")
        whole = base.situation.wholes.get(whole)
    return None


def _mass(base: KnowledgeBase, name: str) -> Known | None:
    share = masses_of(base).share(name)
    if share is not None:
        return _derived(share, "kg", f"its share of the mass of {base.situation.wholes[name]}")
    parts = base.situation.parts.get(name, ())
    known = [base.find(part, "mass") for part in parts]
    if parts and all(known):
        return _derived(sum(float(k.value) for k in known if k is not None), "kg", f"sum of {', '.join(parts)}")
    return mass_of_volume(base, name)


def mass_of_volume(base: KnowledgeBase, name: str) -> Known | None:
    """Return the mass that follows from density and volume, unless one is usual of its class; None if it does not."""
    density = base.number(name, "density")
    if density is None or base.default(name, "mass") is not None:
        return None
    if "Liquid" in base.types.classes[name]:
        stated = base.stated(name, "volume")
        known = (stated, "volume") if stated is not None else _volume_by_host(base, name)
    else:
        known = derived.volume(_shape(base, name), lambda p: base.number(name, p), lambda: base.text(name, "file"))
    return _derived(density * known[0], "kg", f"density * {known[1]}") if known else None


def _volume(base: KnowledgeBase, name: str) -> Known | None:
    if "Liquid" not in base.types.classes[name]:
        return None
    by_host = _volume_by_host(base, name)
    if by_host is not None:
        return _derived(by_host[0], "m3", by_host[1])
    mass, density = base.number(name, "mass"), base.number(name, "density")
    return _derived(mass / density, "m3", "mass / density") if mass and density else None


def _volume_by_host(base: KnowledgeBase, name: str) -> tuple[float, str] | None:
    """Return the volume of a liquid by what it fills or soaks [m^3], and how that is known."""
    fill = base.stated(name, "fill")
    for vessel in base.subjects("contains", name):
        capacity = base.number(vessel, "capacity")
        if fill is not None and capacity is not None:
            return fill * capacity, f"fill * capacity of {vessel}"
    for sponge in base.subjects("absorbs", name):
        names = ("saturation", "absorbentCapacity", "mass")
        saturation, ratio, mass = (base.number(sponge, p) for p in names)
        density = base.number(name, "density")
        if saturation and ratio and mass and density:
            volume = saturation * ratio * mass / density
            return volume, f"saturation * absorbentCapacity * mass of {sponge} / density"
    return None


def _capacity(base: KnowledgeBase, name: str) -> Known | None:
    found = derived.capacity(_shape(base, name), lambda p: base.number(name, p))
    return _derived(found, "m3", "volume of its cavity up to the brim") if found else None


_RULES: dict[str, Callable[[KnowledgeBase, str], Known | None]] = {
    "mass": _mass,
    "volume": _volume,
    "capacity": _capacity,
}


def _on_a_curve(base: KnowledgeBase, name: str, property_name: str) -> Known | None:
    """Return a value by the curve of the most specific class, unless a more specific one has a plain default."""
    classes = base.types.classes[name]
    curves = {c: curve for c in classes for curve in base.vocabulary.classes[c].curves}
    curves = {c: curve for c, curve in curves.items() if curve.property == property_name}
    plain = [c for c in classes for d in base.vocabulary.classes[c].defaults if d.property == property_name]
    best = [c for c in curves if not any(c in base.types.superclasses(o) for o in (*plain, *curves) if o != c)]
    if not best:
        return None
    curve = curves[best[0]]
    where = base.find(name, curve.over)
    if where is None or not isinstance(where.value, float):
        return None
    value = curve.at(where.value)
    if value is None:
        low, high, unit = curve.points[0][0], curve.points[-1][0], where.unit
        raise KnowledgeError(
            f"{base.situation.locations[name]}: {name}: {curve.over} = {where.value:g} {unit}: the {property_name} of "
            f"{best[0]} is known from {low:g} to {high:g} {unit} only; allowed: that, or a stated {property_name}"
        )
    return Known(
        value=value,
        unit=base.vocabulary.properties[property_name].si_unit,
        origin="derived",
        source=f"{best[0]}: {curve.source}, at a {curve.over} of {where.value:g} {where.unit}",
        certainty=curve.certainty,
    )


def _shape(base: KnowledgeBase, name: str) -> str:
    known = base.find(name, "shape")
    return "" if known is None else str(known.value)


def _derived(value: float, unit: str, source: str) -> Known:
    return Known(value=value, unit=unit, origin="derived", source=source)
