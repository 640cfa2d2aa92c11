"""A second judge of axioms, which shares nothing with the first: is there a model with so many things? An integer
programme knows; counts are sums."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from scipy import optimize  # pyright: ignore[reportMissingTypeStubs]

from prolepsis.knowledge.structures import Tree, parse_axiom


def has_model(texts: Iterable[str], people: tuple[str, ...], more: int) -> bool:
    """Return whether the axioms have a model of the individuals, all different, and at most so many other things."""
    return any(_Model(tuple(people), count).found(map(parse_axiom, texts)) for count in range(more + 1))


class _Model:
    """One unknown of 0 or 1 for each thing and expression, and for each link."""

    def __init__(self, people: tuple[str, ...], more: int) -> None:
        self._things = range(len(people) + more)
        self._number = {name: k for k, name in enumerate(people)}
        self._unknowns: dict[tuple[object, ...], int] = {}
        self._rows: list[tuple[dict[int, float], float]] = []  # A sum of multiples is at least a number.

    def found(self, axioms: Iterable[Tree]) -> bool:
        for axiom in axioms:
            self._say(axiom)
        count = len(self._unknowns)
        if not self._rows:
            return True
        matrix = np.zeros((len(self._rows), count))
        for k, (terms, _) in enumerate(self._rows):
            for unknown, factor in terms.items():
                matrix[k, unknown] += factor
        least: Any = np.array([number for _, number in self._rows])
        solver: Any = optimize
        solution = solver.milp(
            np.zeros(count),
            constraints=solver.LinearConstraint(matrix, least, np.inf),
            integrality=np.ones(count),
            bounds=solver.Bounds(0, 1),
        )
        assert solution.status in (0, 2), solution.message
        return bool(solution.status == 0)

    def _new(self, *key: object) -> int:
        return self._unknowns.setdefault(key, len(self._unknowns))

    def _least(self, least: float, *terms: tuple[int, float]) -> None:
        row: dict[int, float] = {}
        for unknown, factor in terms:
            row[unknown] = row.get(unknown, 0.0) + factor
        self._rows.append((row, least))

    def _link(self, role: Tree, one: int, other: int) -> int:
        return (
            self._new("link", role[1], other, one) if isinstance(role, tuple) else self._new("link", role, one, other)
        )

    def _fixed(self, truth: bool) -> int:
        unknown = self._new("fixed", truth)
        self._least(1.0, (unknown, 1.0)) if truth else self._least(0.0, (unknown, -1.0))
        return unknown

    def _at_least(self, unknown: int, number: int, terms: list[int]) -> None:
        """Say that an unknown is whether so many of others are so."""
        if number <= 0:
            self._least(1.0, (unknown, 1.0))
            return
        self._least(0.0, *((t, 1.0) for t in terms), (unknown, -float(number)))
        self._least(1.0 - number, *((t, -1.0) for t in terms), (unknown, float(len(terms) + 1)))

    def _both(self, one: int, other: int) -> int:
        unknown = self._new("both", one, other)
        self._at_least(unknown, 2, [one, other]) if one != other else self._at_least(unknown, 1, [one])
        return unknown

    def _is(self, tree: Tree, thing: int) -> int:
        """Return the unknown of whether a thing belongs to an expression."""
        if isinstance(tree, str):
            if tree.endswith("#Thing>") or tree.endswith("#Nothing>"):
                return self._fixed(tree.endswith("#Thing>"))
            return self._new(tree, thing)
        if (tree, thing) in self._unknowns:
            return self._unknowns[tree, thing]
        unknown = self._new(tree, thing)
        match tree:
            case ("ObjectIntersectionOf", *parts):
                self._at_least(unknown, len(parts), [self._is(part, thing) for part in parts])
            case ("ObjectUnionOf", *parts):
                self._at_least(unknown, 1, [self._is(part, thing) for part in parts])
            case ("ObjectComplementOf", part):
                self._opposite(unknown, self._is(part, thing))
            case ("ObjectOneOf", *names):
                there = any(self._number[str(name)] == thing for name in names)
                self._least(1.0, (unknown, 1.0)) if there else self._least(0.0, (unknown, -1.0))
            case ("ObjectHasValue", role, value):
                self._at_least(unknown, 1, [self._link(role, thing, self._number[str(value)])])
            case ("ObjectSomeValuesFrom", role, filler):
                self._at_least(unknown, 1, self._values(role, filler, thing))
            case ("ObjectAllValuesFrom", role, filler):
                some = self._is(("ObjectSomeValuesFrom", role, ("ObjectComplementOf", filler)), thing)
                self._opposite(unknown, some)
            case ("ObjectMinCardinality", str(number), role, filler):
                self._at_least(unknown, int(number), self._values(role, filler, thing))
            case ("ObjectMaxCardinality", str(number), role, filler):
                more: Tree = ("ObjectMinCardinality", str(int(number) + 1), role, filler)
                self._opposite(unknown, self._is(more, thing))
            case ("ObjectExactCardinality", number, role, filler):
                both: Tree = tuple((f"Object{each}Cardinality", number, role, filler) for each in ("Min", "Max"))
                self._at_least(unknown, 2, [self._is(part, thing) for part in both])
            case _:
                raise ValueError(f"no class expression: {tree}")
        return unknown

    def _values(self, role: Tree, filler: Tree, thing: int) -> list[int]:
        return [self._both(self._link(role, thing, other), self._is(filler, other)) for other in self._things]

    def _opposite(self, one: int, other: int) -> None:
        self._least(1.0, (one, 1.0), (other, 1.0))
        self._least(-1.0, (one, -1.0), (other, -1.0))

    def _implies(self, one: int, other: int) -> None:
        self._least(0.0, (one, -1.0), (other, 1.0))

    def _say(self, axiom: Tree) -> None:
        things = self._things
        match axiom:
            case ("Declaration" | "DifferentIndividuals", *_):
                pass
            case ("SubClassOf", left, right):
                for thing in things:
                    self._implies(self._is(left, thing), self._is(right, thing))
            case ("EquivalentClasses", left, right):
                self._say(("SubClassOf", left, right))
                self._say(("SubClassOf", right, left))
            case ("DisjointClasses", left, right):
                for thing in things:
                    self._least(-1.0, (self._is(left, thing), -1.0), (self._is(right, thing), -1.0))
            case ("ClassAssertion", expression, str(name)):
                self._least(1.0, (self._is(expression, self._number[name]), 1.0))
            case ("ObjectPropertyAssertion", role, str(one), str(other)):
                self._least(1.0, (self._link(role, self._number[one], self._number[other]), 1.0))
            case ("ObjectPropertyDomain", role, right):
                self._say(("SubClassOf", ("ObjectSomeValuesFrom", role, _ANYTHING), right))
            case ("ObjectPropertyRange", role, right):
                self._say(("SubClassOf", _ANYTHING, ("ObjectAllValuesFrom", role, right)))
            case ("FunctionalObjectProperty", role):
                self._say(("SubClassOf", _ANYTHING, ("ObjectMaxCardinality", "1", role, _ANYTHING)))
            case ("InverseFunctionalObjectProperty", role):
                self._say(("FunctionalObjectProperty", ("ObjectInverseOf", role)))
            case ("SymmetricObjectProperty", role):
                self._say(("SubObjectPropertyOf", role, ("ObjectInverseOf", role)))
            case ("SubObjectPropertyOf", lower, upper):
                for one in things:
                    for other in things:
                        self._implies(self._link(lower, one, other), self._link(upper, one, other))
            case ("InverseObjectProperties", one, other):
                self._say(("SubObjectPropertyOf", one, ("ObjectInverseOf", other)))
                self._say(("SubObjectPropertyOf", other, ("ObjectInverseOf", one)))
            case _:
                raise ValueError(f"no axiom: {axiom}")


_ANYTHING = "<http://www.w3.org/2002/07/owl#Thing>"
