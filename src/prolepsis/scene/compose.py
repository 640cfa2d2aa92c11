"""From knowledge to a scene: each individual becomes a thing with a shape, a place and quantities."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from prolepsis.geometry.rotations import inverse, product, rotated, turned
from prolepsis.geometry.shape import IDENTITY, Shape, triple
from prolepsis.knowledge.knowledge_base import KnowledgeBase
from prolepsis.knowledge.situation import MOST_INDIVIDUALS
from prolepsis.log.domain import Domain, with_things
from prolepsis.log.happenings import HappeningType
from prolepsis.log.things import FIXED, FREE, Thing
from prolepsis.scene.coherence import ANGLES, refuse_nonsense, refuse_placed, refuse_shaped
from prolepsis.scene.colours import colour_of
from prolepsis.scene.extent import place_on, support
from prolepsis.scene.kind import Channel, Draft, Individuals, Kind, Made, RestingHeight, Roles
from prolepsis.scene.scene import Pool, Scene
from prolepsis.scene.shapes import EXTENTS, SHAPES, Extents
from prolepsis.scene.shapes.holes import refuse_holes
from prolepsis.scene.shapes.mesh import mesh
from prolepsis.system.threads import one_thread
from prolepsis.terms.errors import KnowledgeError, UnknownNameError, brief_list

ROLES = frozenset({"Container", "Stuff", "Liquid", "Furniture", "Floor", "Table"})
"""Classes that physics or recognition goes by, whatever the kinds."""
FEATURES = ("lid",)
"""What a shape may have or not."""
MESH_SHAPE = "mesh"
OF_TABLES = "table"
"""The family of shapes that a box is of when it is a Table."""
STATED = (*(shape for shape in SHAPES if shape != OF_TABLES), MESH_SHAPE)
"""Shapes that may be stated of any whole."""

UNEVEN = 5.0e-3
"""What is on several things may be this far above one of them [m]: it tips, and is on it after a moment."""

IN = 1.0e-4
"""What a vessel contains comes below its highest point by this at least [m]."""


@one_thread()
def compose(kb: KnowledgeBase, kinds: Sequence[Kind], resting_height: RestingHeight, particles: int) -> Scene:
    """Return the scene of a situation.

    Args:
        kb: The situation.
        kinds: The kinds of matter, hands and robots that there may be.
        resting_height: Finds where a thing rests.
        particles: Number of particles of the largest liquid.

    Raises:
        KnowledgeError: If something has no shape or place that can be simulated.
    """
    if len(kb.objects) > MOST_INDIVIDUALS:
        raise KnowledgeError(f"the situation has {len(kb.objects)} individuals; allowed: {MOST_INDIVIDUALS}")
    kinds = sorted(kinds, key=lambda kind: kind.order)
    _refuse_misspelt(kb, kinds)
    begins = {each.name: each.begins for kind in kinds for each in kind.channels if each.begins is not None}
    flowing: dict[str, list[Kind]] = {}
    for kind in kinds:
        for name in kind.flowing(kb):
            flowing.setdefault(name, []).append(kind)
    names = [name for name in kb.objects if kb.whole(name) is None]
    owners = {name: _owner(kb, name, kinds, flowing.get(name, ())) for name in names}
    wholes = [name for name in names if name not in flowing]
    refuse_nonsense(kb, wholes)
    for kind in kinds:
        kind.refuse(kb, kinds)
    _refuse_useless(kb, kinds)
    refuse_shaped(kb, flowing)
    refuse_placed(kb, flowing)
    roles = partial(_roles, kb, ROLES.union(*(kind.roles for kind in kinds)))
    thing_of = partial(_thing, kb, roles, begins)
    individuals = Individuals(
        kb=kb,
        roles=roles,
        bodiless=lambda name: thing_of(name, None),
        solid=lambda name: thing_of(name, ()),
        attributes=partial(_attributes, kb, begins),
    )
    below = _hosts(kb, wholes)
    made: dict[str, Made] = {}
    for name in [name for name in wholes if not owners[name].rests]:
        if name in below:
            raise KnowledgeError(
                f"{kb.location(name)}: {name} ({kb.kind(name)}) is on {' and '.join(below[name])}, but it is not "
                "lowered onto anything; state its x, y and z instead"
            )
        made[name] = owners[name].parts(individuals, thing_of(name, owners[name].shapes))
    for name in _supporters_first([name for name in wholes if name not in made], below):
        thing = thing_of(name, owners[name].shapes)
        if name in below:
            under = {host: made[host].things for host in below[name]}
            if thing.shape.geoms:
                thing = _put_on(thing, under, resting_height)
            else:
                # Its kind builds its shape: it is lowered as what it is made of.
                made_of = _all_of(thing, owners[name].parts(individuals, thing).things)
                thing = replace(_put_on(made_of, under, resting_height), shape=thing.shape)
            _refuse_outside(kb, thing, made[below[name][0]].things)
        if thing.fixed and owners[name].claims is not None:
            raise KnowledgeError(
                f"{kb.location(name)}: {name} ({thing.kind}) is Furniture, which never moves, and {owners[name].claims}"
                "; allowed: one of them"
            )
        made[name] = owners[name].parts(individuals, thing)
    things = {name: each.things for name, each in made.items()}
    pools: tuple[Pool, ...] = ()
    for kind in kinds:
        new, more = kind.fill(
            Draft(
                individuals=individuals, things=things, pools=pools, particles=particles, resting_height=resting_height
            )
        )
        things, pools = {**things, **new}, pools + more
    found = tuple(thing for name in names for thing in things[name])
    _refuse_dropped(kb, {thing.name for thing in found})
    return Scene(
        things=found,
        domain=with_things(_with_volumes(kb.domain(), [thing for name in flowing for thing in things[name]]), found),
        pools=pools,
        parts_known=tuple(part for name in names if name in made for part in made[name].parts),
        kinds=tuple(kinds),
    )


def _refuse_misspelt(kb: KnowledgeBase, kinds: Sequence[Kind]) -> None:
    """Refuse kinds that name what is not in the ontology, or declare otherwise what another one declares."""
    known = kb.vocabulary
    declared: dict[tuple[type, str], tuple[str, Channel | HappeningType]] = {}
    for kind in kinds:
        where = type(kind).__name__
        for each in (*kind.channels, *kind.happenings):
            other, same = declared.setdefault((type(each), each.name), (where, each))
            if same != each:
                raise KnowledgeError(f"{where}: {each.name} is declared otherwise by {other}; take another name")
        begins = [each.begins for each in kind.channels if each.begins is not None]
        claims = () if kind.claims is None else (kind.claims,)
        for name in (*kind.roles, *begins, *claims, *kind.quantities.values()):
            if name not in known.classes:
                raise UnknownNameError.of("class", name, known.classes, where)
        for name in kind.quantities:
            if name not in known.properties:
                raise UnknownNameError.of("property", name, known.properties, where)


def _refuse_useless(kb: KnowledgeBase, kinds: Sequence[Kind]) -> None:
    """Refuse a quantity that is told of something of which no kind makes use of it."""
    for (name, prop), said in kb.situation.said.items():
        classes = [kind.quantities[prop] for kind in kinds if prop in kind.quantities]
        if classes and said[0].where != "drawn" and name in kb.objects and not any(kb.is_a(name, c) for c in classes):
            raise KnowledgeError(
                f"{said[0].where}: {name} ({kb.kind(name)}) makes no use of {prop}; what does: {brief_list(classes)}"
            )


def _refuse_dropped(kb: KnowledgeBase, made: Collection[str]) -> None:
    """Refuse parts of which nothing has been made: they would be missing without a word."""
    for name in kb.objects:
        whole = kb.whole(name)
        if whole is not None and name not in made:
            raise KnowledgeError(
                f"{kb.location(name)}: {name} ({kb.kind(name)}) is a part of {whole}, but a {kb.kind(whole)} has no "
                "such part; allowed: a thing of its own, without :hasPart"
            )


def _with_volumes(domain: Domain, flowing: Sequence[Thing]) -> Domain:
    """Return what is known, with the volume and mass of what flows as it has been filled in, where that is another."""
    made = {thing.name: thing.quantities for thing in flowing}
    known = {name: value for name, prop, value in domain.values if prop == "volume"}
    other = {name for name, value in known.items() if name in made and made[name].get("volume") != value}
    values = (
        (name, prop, made[name].get(prop, value) if name in other and prop in ("volume", "mass") else value)
        for name, prop, value in domain.values
    )
    return replace(domain, values=tuple(values)) if other else domain


def _owner(kb: KnowledgeBase, name: str, kinds: Sequence[Kind], flowing: Sequence[Kind]) -> Kind:
    """Return the kind that makes a whole; one that nobody claims stays as it is, or flows."""
    claiming = [kind for kind in kinds if kind.claims is not None and kb.is_a(name, kind.claims)]
    where = f"{kb.location(name)}: {name} ({kb.kind(name)})"
    if len(claiming) + len(flowing) > 1:
        makers = brief_list([*(str(kind.claims) for kind in claiming), *(type(kind).__name__ for kind in flowing)])
        raise KnowledgeError(f"{where} is each of {makers}; allowed: one of them")
    if kb.is_a(name, "Stuff") and not flowing:
        raise KnowledgeError(f"{where} is a stuff that nothing tells how to make; allowed: a Liquid or a Granular")
    return claiming[0] if claiming else Kind()


def _roles(kb: KnowledgeBase, known: frozenset[str], name: str) -> frozenset[str]:
    return frozenset(c for c in kb.classes(name) if c in known)


def _hosts(kb: KnowledgeBase, wholes: Collection[str]) -> dict[str, tuple[str, ...]]:
    """Return what each whole is lowered onto: all that it is on, or the innermost vessel that it is in.

    Raises:
        KnowledgeError: If it is told to be in several places.
    """
    on: dict[str, tuple[str, ...]] = {}
    inside: dict[str, tuple[str, ...]] = {}
    for relation, subject, host in kb.relations():
        if relation == "on" and subject in wholes:
            on[subject] = (*on.get(subject, ()), host)
        elif relation == "contains" and host in wholes:
            inside[host] = (*inside.get(host, ()), subject)
    for name, hosts in inside.items():
        inside[name] = tuple(host for host in hosts if {*kb.objects_of("contains", host)}.isdisjoint(hosts))
        if len(inside[name]) != 1 or not {*on.get(name, ())} <= {*hosts}:
            told = brief_list([*(f"in {host}" for host in hosts), *(f"on {host}" for host in on.get(name, ()))])
            raise KnowledgeError(
                f"{kb.location(name)}: {name} ({kb.kind(name)}) is in several places: {told}; allowed: one"
            )
    return on | inside


def _supporters_first(names: list[str], below: Mapping[str, Collection[str]]) -> list[str]:
    """Return the names such that what others rest on comes before them."""
    ordered: list[str] = []
    waiting = list(names)
    while waiting:
        ready = [name for name in waiting if not set(below.get(name, ())).intersection(waiting)]
        if not ready:
            raise KnowledgeError(f"{brief_list(waiting)} rest on or are in each other, in a circle")
        ordered += ready
        waiting = [name for name in waiting if name not in ready]
    return ordered


def _attributes(kb: KnowledgeBase, begins: Mapping[str, str], name: str) -> dict[str, float]:
    """Return the attributes of an individual at the start, where ``begins`` is the class of those that have each."""
    return {attribute: 1.0 for attribute, cls in begins.items() if kb.is_a(name, cls)}


def _thing(
    kb: KnowledgeBase, roles: Roles, begins: Mapping[str, str], name: str, later: Collection[str] | None
) -> Thing:
    """Return a whole as a thing at its stated place.

    Args:
        kb: The situation.
        roles: Finds the classes that physics or recognition goes by.
        begins: The class of the things that have an attribute at the start, by the attribute.
        name: The whole.
        later: Shapes that are built later and left out here; all if None.

    Raises:
        KnowledgeError: If it cannot be simulated.
    """
    known, kind = kb.quantities(name), kb.kind(name)
    where = f"{kb.location(name)}: {name} ({kind})"
    if "shape" not in known:
        raise KnowledgeError(f"{where} has no shape; state :shape, one of {', '.join(STATED)}")
    shape = str(known["shape"].value)
    quantities = {p: float(k.value) for p, k in known.items() if isinstance(k.value, float)}
    quantities |= {feature: 1.0 for feature in FEATURES if feature in known and known[feature].value == "true"}
    quantities |= _attributes(kb, begins, name)
    fixed = kb.is_a(name, "Furniture")
    built = Shape() if later is None or shape in later else _built(kb, name, shape, quantities)
    if not fixed and built.geoms and "mass" not in quantities:
        for part in kb.parts(name):
            if kb.number(part, "mass") is None:
                raise KnowledgeError(f"{where} has no mass, since its part {part} ({kb.kind(part)}) has none; state it")
        raise KnowledgeError(f"{where} has no mass and no density to derive it from")
    default_height = 0.0
    if fixed and built.geoms and built.geoms[0].type != "plane":
        default_height = quantities.get("height", 0.0) / 2
    yaw, pitch, roll = (quantities.get(angle, 0.0) for angle in ANGLES)
    return Thing(
        name=name,
        kind=kind,
        shape=replace(built, colour=colour_of(kb, name)),
        position=(quantities.get("x", 0.0), quantities.get("y", 0.0), quantities.get("z", default_height)),
        orientation=turned(IDENTITY, (yaw, pitch, roll)),
        mass=quantities.get("mass", 0.0),
        roles=roles(name),
        mount=FIXED if fixed else FREE,
        quantities=quantities,
    )


def _built(kb: KnowledgeBase, name: str, shape: str, quantities: dict[str, float]) -> Shape:
    """Return the shape of a whole in its own frame."""
    where = f"{kb.location(name)}: {name} ({kb.kind(name)})"
    if shape == MESH_SHAPE:
        file = kb.text(name, "file")
        if file is None:
            raise KnowledgeError(f"{where} is a mesh but has no file")
        refuse_holes(quantities, "a mesh")
        _refuse_unasked(kb, name, shape, {"scale"})
        return mesh(Path(file), quantities.get("scale", 1.0))
    if shape not in SHAPES:
        raise KnowledgeError(f"{where} has a shape that cannot be built here, {shape}; allowed: {', '.join(STATED)}")
    family = OF_TABLES if kb.is_a(name, "Table") and shape == "box" else shape
    extents = Extents(quantities)
    try:
        built = SHAPES[family](extents)
    except KeyError as missing:
        raise KnowledgeError(f"{where} is of shape {shape}, but has no {missing.args[0]}; state it") from None
    except KnowledgeError as error:
        raise KnowledgeError(f"{where}: {error}") from None
    _refuse_unasked(kb, name, family, extents.asked)
    return built


def _refuse_unasked(kb: KnowledgeBase, name: str, shape: str, asked: Collection[str]) -> None:
    """Refuse an extent that is told of what has another shape: nothing would come of it."""
    for extent in sorted(EXTENTS.difference(asked)):
        for said in kb.situation.said.get((name, extent), ())[:1]:
            if said.where != "drawn" and said.value != "false":
                used = brief_list(sorted(EXTENTS.intersection(asked)))
                raise KnowledgeError(
                    f"{said.where}: {name} ({kb.kind(name)}): a {shape} makes no use of {extent}; what it does: {used}"
                )


def _refuse_outside(kb: KnowledgeBase, thing: Thing, host: Sequence[Thing]) -> None:
    """Refuse what a thing is said to contain, but what comes to lie on top of it."""
    if host[0].name not in kb.subjects("contains", thing.name) or not thing.shape.geoms:
        return
    up = np.array([0.0, 0.0, 1.0])
    top = max(each.position[2] + support(each, up) for each in host if each.shape.geoms and each.is_body)
    if thing.position[2] - support(thing, -up) > top - IN:
        raise KnowledgeError(
            f"{kb.location(thing.name)}: {thing.name} cannot be in the {host[0].kind} {host[0].name}: lowered onto it, "
            "it stays on top; needed: a vessel that is open above, and in which it has room"
        )


def _all_of(whole: Thing, parts: Sequence[Thing]) -> Thing:
    """Return a whole that is one with its parts, each where it is: all bodies that it is made of."""
    back, origin = inverse(whole.orientation), np.asarray(whole.position)
    geoms = [
        replace(
            geom,
            position=triple(
                rotated(back, triple(np.asarray(part.position) + rotated(part.orientation, geom.position) - origin))
            ),
            orientation=product(back, product(part.orientation, geom.orientation)),
        )
        for part in parts
        if part.is_body
        for geom in part.shape.geoms
    ]
    return replace(whole, shape=replace(whole.shape, geoms=tuple(geoms)))


def _put_on(thing: Thing, under: Mapping[str, Sequence[Thing]], resting_height: RestingHeight) -> Thing:
    """Return the thing lowered onto what it rests on, at its x and y from there."""
    on = " and ".join(under)
    solid = {host: [t for t in things if t.shape.geoms and t.is_body] for host, things in under.items()}
    if not thing.shape.geoms:
        raise KnowledgeError(f"{thing.name} is on {on}, but a {thing.kind} does not rest on anything; state its z")
    for host, bodies in solid.items():
        if not bodies:
            raise KnowledgeError(f"{thing.name} is on {host}, which has no body to rest on")
    if "z" in thing.quantities:
        raise KnowledgeError(f"{thing.name} is on {on} and has z stated too; state one of the two")
    x, y = place_on(thing, list(under.values()))
    heights = {host: resting_height(replace(thing, position=(x, y, 0.0)), bodies) for host, bodies in solid.items()}
    lowest, highest = (choose(heights, key=lambda host: heights[host]) for choose in (min, max))
    gap = heights[highest] - heights[lowest]
    if gap > UNEVEN:
        raise KnowledgeError(
            f"{thing.name} is on {on}, but on {highest} it is {1000 * gap:.3g} mm above {lowest}; allowed: at most "
            f"{1000 * UNEVEN:g} mm, or one of them"
        )
    height = heights[highest]
    return replace(thing, position=(x, y, height))
