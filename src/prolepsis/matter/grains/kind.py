"""Grains: a stuff that consists of solid bodies, each of which moves as any body does and is told of as the stuff."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.log.things import WITHIN, Thing
from prolepsis.scene.extent import place_on
from prolepsis.scene.kind import Draft, Individuals, Kind
from prolepsis.scene.scene import Pool
from prolepsis.terms.errors import KnowledgeError, brief_list

OF_A_STUFF = frozenset({"grainCount", "mass", "x", "y"})
"""Quantities that may be stated of a granular stuff itself."""
BLOB = frozenset({"Blob"})
"""Role of what facts name by its stuff."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Placement:
    """Where a body of a stuff is at the start."""

    relation: str
    """``contains``, ``on``, or ``at`` where it states its own height."""
    host: str = ""
    """The vessel, or what it is on."""
    own: bool = False
    """Whether it is told of the body itself, and not of the stuff."""


class Grains(Kind):
    """The kind of stuffs that consist of solid bodies."""

    order = 5
    quantities = MappingProxyType({"grainCount": "Granular"})

    def flowing(self, kb: KnowledgeBase) -> Sequence[str]:
        """Return the granular stuffs that are no part of anything."""
        return [name for name in kb.objects if kb.is_a(name, "Granular") and kb.whole(name) is None]

    def refuse(self, kb: KnowledgeBase, kinds: Sequence[Kind]) -> None:
        """Refuse stuffs of nothing or of what is no plain solid body, and those of which some are nowhere."""
        for name in self.flowing(kb):
            where, parts = f"{kb.location(name)}: {name} ({kb.kind(name)})", kb.parts(name)
            if not parts:
                raise KnowledgeError(
                    f"{where} consists of nothing; state its bodies, as in :hasPart :bead1 , :bead2, or take a class "
                    "that has some by default, as Beads"
                )
            count = kb.stated(name, "grainCount")
            if count is not None and count != len(parts):
                raise KnowledgeError(
                    f"{where} has a grainCount of {count:g}, but {len(parts)} parts; allowed: either a count, or parts"
                )
            _refuse_quantities(kb, name, where)
            for part in parts:
                _refuse_unlike(kb, part, f"{where}: its part {part} ({kb.kind(part)})", kinds)
                placement_of(kb, part)

    def fill(self, draft: Draft) -> tuple[Mapping[str, tuple[Thing, ...]], tuple[Pool, ...]]:
        """Return each stuff with its bodies, at their places among the other solids."""
        kb, found = draft.individuals.kb, dict[str, tuple[Thing, ...]]()
        names = self.flowing(kb)
        grains = {part: draft.individuals.solid(part) for name in names for part in kb.parts(name)}
        placed = {part: _lowered(draft, grain, placement_of(kb, part)) for part, grain in grains.items()}
        at_once: dict[tuple[str, Placement], list[Thing]] = {}
        for part, grain in grains.items():
            if placed[part] is None:
                at_once.setdefault((kb.whole(part) or "", placement_of(kb, part)), []).append(grain)
        if at_once:
            # Imported here: scenes without grains are composed without it.
            from prolepsis.matter.grains.packing import layer, packed

            bodies = [thing for each in draft.things.values() for thing in each if thing.is_body]
            for (name, placement), several in at_once.items():
                here = [*bodies, *(grain for grain in placed.values() if grain is not None)]
                under = [thing for thing in draft.things[placement.host] if thing.is_body]
                if placement.relation == "contains":
                    made = packed(several, name, under, here)
                else:
                    stuff = _stuff(draft.individuals, name)
                    x, y = place_on(stuff, [draft.things[placement.host]])
                    made = layer(several, name, (x, y), under, here, draft.resting_height)
                placed |= {grain.name: grain for grain in made}
        for name in names:
            parts = tuple(
                replace(grain, whole=name, roles=grain.roles | BLOB)
                for part in kb.parts(name)
                if (grain := placed[part]) is not None
            )
            stuff = _stuff(draft.individuals, name)
            found[name] = (replace(stuff, mass=sum(part.mass for part in parts)), *parts)
        return found, ()


def _stuff(individuals: Individuals, name: str) -> Thing:
    """Return a stuff as a thing without a body."""
    kb = individuals.kb
    quantities = {p: float(k.value) for p, k in kb.quantities(name).items() if isinstance(k.value, float)}
    quantities |= individuals.attributes(name)
    return Thing(name=name, kind=kb.kind(name), mount=WITHIN, roles=individuals.roles(name), quantities=quantities)


def placement_of(kb: KnowledgeBase, part: str) -> Placement:
    """Return where a body of a stuff is told to be: itself, or with all others.

    Raises:
        KnowledgeError: If it is told to be nowhere, or in several places.
    """
    stuff = kb.whole(part) or ""
    for name in (part, stuff):
        own = name == part
        told = [Placement(relation="contains", host=host, own=own) for host in kb.subjects("contains", name)]
        told += [Placement(relation="on", host=host, own=own) for host in kb.objects_of("on", name)]
        told += [Placement(relation="at", own=own)] if kb.stated(name, "z") is not None else []
        where = f"{kb.location(name)}: {name} ({kb.kind(name)})"
        if len(told) > 1:
            hosts = ", ".join(placement.host or "at its z" for placement in told)
            raise KnowledgeError(f"{where} is in several places: {hosts}; allowed: one")
        if told and (own or told[0].relation != "at"):
            return told[0]
    raise KnowledgeError(
        f"{where} is nowhere; state what :contains it, what it is :on, or where each of its bodies is, as {part}"
    )


def _refuse_quantities(kb: KnowledgeBase, name: str, where: str) -> None:
    """Refuse what is stated of a stuff as if it were a body: it would come to nothing."""
    properties = kb.vocabulary.properties
    stated = {p for who, p in kb.situation.said if who == name and p in properties}
    lost = sorted(p for p in stated if properties[p].kind == "quantity" and p not in OF_A_STUFF)
    if lost:
        raise KnowledgeError(
            f"{where} is given {brief_list(lost)}, which its bodies have; state that of their class, or of each"
        )


def _refuse_unlike(kb: KnowledgeBase, part: str, where: str, kinds: Sequence[Kind]) -> None:
    claims = [kind.claims for kind in kinds if kind.claims is not None and kb.is_a(part, kind.claims)]
    if kb.is_a(part, "Furniture") or not kb.is_a(part, "Solid") or kb.parts(part) or claims:
        raise KnowledgeError(f"{where} is no solid body of one piece that moves; allowed: such as a Bead or a Block")
    hosted = [host for relation, host in _held_by(kb, part) if relation]
    if hosted:
        raise KnowledgeError(f"{where} cannot hold {brief_list(hosted)}; needed: a whole that is solid")


def _held_by(kb: KnowledgeBase, part: str) -> list[tuple[str, str]]:
    """Return what is said to be in or soaked up by a body of a stuff: the relation, and what."""
    return [(relation, held) for relation in ("contains", "absorbs") for held in kb.objects_of(relation, part)]


def _lowered(draft: Draft, grain: Thing, placement: Placement) -> Thing | None:
    """Return a body at its own place, or None if it is to be placed with others."""
    if placement.relation == "at":
        return grain
    if placement.relation == "on" and placement.own:
        under = draft.things[placement.host]
        x, y = place_on(grain, [under])
        height = draft.resting_height(
            replace(grain, position=(x, y, 0.0)), [thing for thing in under if thing.is_body and thing.shape.geoms]
        )
        return replace(grain, position=(x, y, height))
    return None


KIND = Grains()
