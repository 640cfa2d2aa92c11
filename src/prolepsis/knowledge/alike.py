"""Individuals that are alike: what the reasoner finds out of one holds of all, so it is asked of one only.

Take away the individuals to which many are related in the same way, such as a table with blocks on it: what is left
falls into groups. Two groups of which the same is said, and the same to those that were taken away, are alike: of a
model with one of them, copying all that belongs to it makes a model with both. That fails only where someone counts how
many are related to him, or where the axioms name individuals; then nothing is left out.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from prolepsis.knowledge.axioms import Axiom
from prolepsis.knowledge.structures import Tree, parse_axiom

ROUNDS = 4
"""So often groups are looked for: tables with one block left may be alike in turn."""
_TOKEN = re.compile(r"<[^<>]*>")
_Link = tuple[str, bool, str]
"""Role, whether it is followed backwards, and to whom."""


@dataclass(frozen=True, slots=True)
class Alike:
    """What is left of the facts when those that are like others are left out."""

    components: tuple[tuple[str, ...], ...]
    """Bracketed IRIs of the individuals that are left, those that are related together; what is said of one tells
    nothing of another. The first is the same whatever they are called."""
    stands_for: Mapping[str, str]
    """Each individual to the one that is asked about."""


def alike(facts: Iterable[Axiom], terms: Iterable[Axiom]) -> Alike:
    """Return who is like whom.

    Args:
        facts: Axioms of individuals.
        terms: Axioms of classes and properties.
    """
    trees = tuple(parse_axiom(axiom.text) for axiom in terms)
    people = _People.of(facts)
    stands_for = {name: name for name in people.said}
    if people.named_in(axiom.text for axiom in terms):
        return Alike((people.in_order(set(people.said), {}),), stands_for)
    counted = _Counted.of(trees)
    for _ in range(ROUNDS):
        found: dict[str, tuple[str, ...]] = {}
        hubs = people.hubs(counted)
        for group in people.groups(hubs):
            if group <= hubs:
                # Those that are related to it may count it.
                continue
            members = people.in_order(group, {hub: f"at {hub}" for hub in hubs})
            first = found.setdefault(people.told(members), members)
            stands_for |= dict(zip(members, first, strict=True))
        dropped = {member for member in people.said if stands_for[member] != member}
        if not dropped:
            break
        people = people.without(dropped)
    ends = {name: _end(stands_for, name) for name in stands_for}
    return Alike(tuple(people.in_order(group, {}) for group in people.groups(set())), ends)


def counts_along_chains(terms: Iterable[Axiom]) -> bool:
    """Return whether values are counted of a role that is transitive or follows from a chain: OWL 2 DL forbids that."""
    trees = tuple(parse_axiom(axiom.text) for axiom in terms)
    long = {str(tree[1]) for tree in trees if tree[0] == "TransitiveObjectProperty"}
    long |= {str(tree[2]) for tree in trees if tree[0] == "SubObjectPropertyOf" and isinstance(tree[1], tuple)}
    counted = _Counted.of(trees)
    return any(counted.counts((role, backwards)) for role in long for backwards in (False, True))


def _end(stands_for: Mapping[str, str], name: str) -> str:
    while stands_for[name] != name:
        name = stands_for[name]
    return name


@dataclass(frozen=True, slots=True)
class _Counted:
    """Roles whose values someone counts."""

    roles: frozenset[tuple[str, bool]]
    uppers: Mapping[str, tuple[tuple[str, bool], ...]]

    @classmethod
    def of(cls, trees: tuple[Tree, ...]) -> _Counted:
        roles: set[tuple[str, bool]] = set()
        uppers: dict[str, list[tuple[str, bool]]] = {}
        for tree in trees:
            match tree:
                case ("FunctionalObjectProperty", str(role)):
                    roles.add((role, False))
                case ("InverseFunctionalObjectProperty", str(role)):
                    roles.add((role, True))
                case ("SubObjectPropertyOf", str(lower), str(upper)):
                    uppers.setdefault(lower, []).append((upper, False))
                case ("EquivalentObjectProperties", str(one), str(other)):
                    uppers.setdefault(one, []).append((other, False))
                    uppers.setdefault(other, []).append((one, False))
                case ("InverseObjectProperties", str(one), str(other)):
                    uppers.setdefault(one, []).append((other, True))
                    uppers.setdefault(other, []).append((one, True))
                case ("SymmetricObjectProperty", str(role)):
                    uppers.setdefault(role, []).append((role, True))
                case _:
                    roles.update(_bounded(tree))
        return cls(frozenset(roles), {role: tuple(above) for role, above in uppers.items()})

    def counts(self, relation: tuple[str, bool]) -> bool:
        """Return whether someone may count those to whom he is related so: by a role, or backwards."""
        seen: set[tuple[str, bool]] = set()
        queue = [relation]
        while queue:
            role, backwards = each = queue.pop()
            if each not in seen:
                seen.add(each)
                queue += [(upper, backwards != inverse) for upper, inverse in self.uppers.get(role, ())]
        return not seen.isdisjoint(self.roles)


def _bounded(tree: Tree) -> Iterator[tuple[str, bool]]:
    if isinstance(tree, tuple):
        if tree[0] in ("ObjectMaxCardinality", "ObjectExactCardinality", "ObjectComplementOf", "ObjectMinCardinality"):
            # At least so many, denied or defined, is at most so many.
            for role in tree[2:3]:
                yield (str(role[1]), True) if isinstance(role, tuple) else (role, False)
        for part in tree[1:]:
            yield from _bounded(part)


@dataclass(frozen=True, slots=True)
class _People:
    """Individuals, what is said of each by itself, and how they are related."""

    said: Mapping[str, tuple[str, ...]]
    links: Mapping[str, tuple[_Link, ...]]

    @classmethod
    def of(cls, facts: Iterable[Axiom]) -> _People:
        said: dict[str, list[str]] = {}
        links: dict[str, list[_Link]] = {}
        for axiom in facts:
            match parse_axiom(axiom.text):
                case ("ObjectPropertyAssertion", str(role), str(one), str(other)):
                    for name in (one, other):
                        said.setdefault(name, [])
                    links.setdefault(one, []).append((role, False, other))
                    links.setdefault(other, []).append((role, True, one))
                case ("ClassAssertion", _, str(one)):
                    said.setdefault(one, []).append(axiom.text.removesuffix(f" {one})"))
                case ("DifferentIndividuals", *names):
                    for name in names:
                        said.setdefault(str(name), [])
                case _:
                    raise ValueError(f"no fact: {axiom.text}")
        return cls(
            {name: tuple(sorted(texts)) for name, texts in said.items()},
            {name: tuple(sorted(links.get(name, ()))) for name in said},
        )

    def named_in(self, texts: Iterable[str]) -> bool:
        return any(token in self.said for text in texts for token in _TOKEN.findall(text))

    def hubs(self, counted: _Counted) -> set[str]:
        """Return those to whom several are related in the same way, and who count none of those."""
        found: set[str] = set()
        for name, links in self.links.items():
            related = Counter((role, backwards, self.said[other]) for role, backwards, other in links)
            several = {(role, backwards) for (role, backwards, _), count in related.items() if count > 1}
            if several and not any(counted.counts(relation) for relation in several):
                found.add(name)
        return found

    def groups(self, hubs: set[str]) -> Iterator[set[str]]:
        """Yield those that are related to each other not only by hubs, and each hub by itself."""
        seen: set[str] = set()
        for name in self.said:
            group, queue = set[str](), [name]
            while queue:
                each = queue.pop()
                if each not in seen:
                    seen.add(each)
                    group.add(each)
                    if each not in hubs:
                        queue += [other for _, _, other in self.links[each] if other not in hubs]
            if group:
                yield group

    def in_order(self, group: set[str], names: Mapping[str, str]) -> tuple[str, ...]:
        """Return a group in an order that follows from what is said, not from how its members are called."""
        colours = {name: names.get(name, "") + repr(self.said[name]) for name in group}
        for _ in range(min(len(group), 8)):
            around = {
                name: sorted(
                    (role, back, colours.get(other, names.get(other, ""))) for role, back, other in self.links[name]
                )
                for name in group
            }
            ranks = {told: k for k, told in enumerate(sorted({repr((colours[n], around[n])) for n in group}))}
            finer = {name: f"{ranks[repr((colours[name], around[name]))]:06d}" for name in group}
            if len(set(finer.values())) == len(set(colours.values())):
                break
            colours = finer
        return tuple(sorted(group, key=lambda name: (colours[name], name)))

    def told(self, members: tuple[str, ...]) -> str:
        """Return all that is said of a group, its members numbered."""
        number = {name: f"{k}" for k, name in enumerate(members)}
        return repr(
            [
                (
                    self.said[name],
                    sorted((role, back, number.get(other, other)) for role, back, other in self.links[name]),
                )
                for name in members
            ]
        )

    def without(self, dropped: set[str]) -> _People:
        return _People(
            {name: texts for name, texts in self.said.items() if name not in dropped},
            {
                name: tuple(link for link in links if link[2] not in dropped)
                for name, links in self.links.items()
                if name not in dropped
            },
        )
