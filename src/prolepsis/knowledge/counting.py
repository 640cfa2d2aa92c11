"""Counts in the condition of an axiom, said in its conclusion instead: pyhermit overlooks them in a condition.

What bears at least two blocks is loaded: whatever there is is loaded, or bears at most one block. What stands within
something else is given a name of its own first, so that every count comes to stand in a conclusion.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import combinations

from prolepsis.knowledge.expressions import NOTHING, THING
from prolepsis.knowledge.structures import Tree, parse_axiom


def counted_on_the_right(texts: Iterable[str]) -> Iterator[str]:
    """Yield axioms in functional syntax that say the same of all that has a name, without counts in a condition."""
    named = _Named()
    for text in texts:
        if "Cardinality(" not in text:
            yield text
            continue
        for axiom in named.axioms(parse_axiom(text)):
            yield _text(axiom)
    for axiom in named.told:
        yield _text(axiom)


class _Named:
    """Expressions with counts get names; what is said of these is gathered."""

    def __init__(self) -> None:
        self.told: list[Tree] = []
        self._names: dict[tuple[Tree, bool], str] = {}

    def axioms(self, axiom: Tree) -> Iterator[Tree]:
        """Yield axioms that say the same."""
        match axiom:
            case ("SubClassOf", left, right):
                yield from self._below(_plain(left), _plain(right))
            case ("EquivalentClasses", *parts):
                for left, right in zip(parts, [*parts[1:], parts[0]], strict=True):
                    yield from self._below(_plain(left), _plain(right))
            case ("DisjointClasses", *parts):
                for one, other in combinations(map(_plain, parts), 2):
                    yield from self._below(("ObjectIntersectionOf", one, other), NOTHING[0])
            case ("ObjectPropertyDomain" | "ObjectPropertyRange" as functor, role, right):
                yield (functor, role, self._conclusion(_plain(right)))
            case ("ClassAssertion", expression, individual):
                yield ("ClassAssertion", self._conclusion(_plain(expression)), individual)
            case _:
                yield axiom

    def _below(self, left: Tree, right: Tree) -> Iterator[Tree]:
        if isinstance(left, tuple) and left[0] == "ObjectUnionOf":
            for part in left[1:]:
                yield from self._below(part, right)
            return
        parts = left[1:] if isinstance(left, tuple) and left[0] == "ObjectIntersectionOf" else (left,)
        kept = [part for part in parts if not _counts(part)]
        others = [self._conclusion(_denied(part)) for part in parts if _counts(part)]
        yield (
            "SubClassOf",
            _joined("ObjectIntersectionOf", kept),
            _joined("ObjectUnionOf", [self._conclusion(right), *others]),
        )

    def _conclusion(self, tree: Tree) -> Tree:
        """Return an expression that is as narrow where it is concluded, with names for counts within."""
        match tree:
            case ("ObjectIntersectionOf" | "ObjectUnionOf" as functor, *parts):
                return _joined(functor, [self._conclusion(part) for part in parts])
            case ("ObjectComplementOf", part) if _counts(part):
                return self._conclusion(_denied(part))
            case ("ObjectMinCardinality", number, role, filler):
                return ("ObjectMinCardinality", number, role, self._name(filler, within=True))
            case ("ObjectMaxCardinality", number, role, filler):
                return ("ObjectMaxCardinality", number, role, self._name(filler, within=False))
            case ("ObjectSomeValuesFrom" | "ObjectAllValuesFrom" as functor, role, filler):
                return (functor, role, self._name(filler, within=True))
            case _:
                return tree

    def _name(self, tree: Tree, *, within: bool) -> Tree:
        """Return a name for an expression with counts: of a class within it, or of one round it."""
        if not _counts(tree):
            return tree
        name = self._names.get((tree, within))
        if name is None:
            name = self._names[tree, within] = f"<urn:counted/{len(self._names)}>"
            self.told.append(("Declaration", ("Class", name)))
            self.told += self._below(name, tree) if within else self._below(tree, name)
        return name


def _plain(tree: Tree) -> Tree:
    """Return an expression in which counts of less than two, and exact ones, are said otherwise."""
    match tree:
        case (
            "ObjectMinCardinality" | "ObjectMaxCardinality" | "ObjectExactCardinality" as functor,
            str(number),
            role,
            filler,
        ):
            inner, count = _plain(filler), int(number)
            least: Tree = ("ObjectMinCardinality", str(count), role, inner)
            if count < 2:
                least = ("ObjectSomeValuesFrom", role, inner) if count else THING[0]
            most: Tree = (
                ("ObjectMaxCardinality", str(count), role, inner)
                if count
                else ("ObjectAllValuesFrom", role, _denied(inner))
            )
            if functor == "ObjectExactCardinality":
                return _joined("ObjectIntersectionOf", [least, most])
            return least if functor == "ObjectMinCardinality" else most
        case (str(functor), *parts) if functor != "ObjectInverseOf":
            return (functor, *map(_plain, parts))
        case _:
            return tree


def _denied(tree: Tree) -> Tree:
    """Return the complement of an expression that is plain, with the complement as far within as can be."""
    match tree:
        case ("ObjectComplementOf", part):
            return part
        case ("ObjectIntersectionOf", *parts):
            return _joined("ObjectUnionOf", [_denied(part) for part in parts])
        case ("ObjectUnionOf", *parts):
            return _joined("ObjectIntersectionOf", [_denied(part) for part in parts])
        case ("ObjectSomeValuesFrom", role, filler):
            return ("ObjectAllValuesFrom", role, _denied(filler))
        case ("ObjectAllValuesFrom", role, filler):
            return ("ObjectSomeValuesFrom", role, _denied(filler))
        case ("ObjectMinCardinality", number, role, filler):
            return ("ObjectMaxCardinality", str(int(str(number)) - 1), role, filler)
        case ("ObjectMaxCardinality", number, role, filler):
            return ("ObjectMinCardinality", str(int(str(number)) + 1), role, filler)
        case _ if tree in (THING[0], NOTHING[0]):
            return NOTHING[0] if tree == THING[0] else THING[0]
        case _:
            return ("ObjectComplementOf", tree)


def _joined(functor: str, parts: list[Tree]) -> Tree:
    """Return parts as one expression; those that say nothing, and those that are there already, are left out."""
    idle, ruling = (THING[0], NOTHING[0]) if functor == "ObjectIntersectionOf" else (NOTHING[0], THING[0])
    kept = [part for part in dict.fromkeys(parts) if part != idle]
    if ruling in kept:
        return ruling
    return idle if not kept else kept[0] if len(kept) == 1 else (functor, *kept)


def _counts(tree: Tree) -> bool:
    """Return whether anything is counted in an expression."""
    return isinstance(tree, tuple) and ("Cardinality" in str(tree[0]) or any(map(_counts, tree[1:])))


def _text(tree: Tree) -> str:
    return tree if isinstance(tree, str) else f"{tree[0]}({' '.join(map(_text, tree[1:]))})"
