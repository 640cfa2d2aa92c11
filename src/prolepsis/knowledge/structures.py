"""A finite structure, things with types and links, and whether it is a model of axioms: a model is a proof that they do
not contradict each other, and that nothing else follows."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from prolepsis.knowledge.expressions import NOTHING, THING

Tree = str | tuple["Tree", ...]
"""An axiom or expression: an IRI, or a functor with its arguments."""

_TOKENS = re.compile(r"<[^<>]*>|\"[^\"]*\"|[A-Za-z]+\(|\)|[^\s()]+")


def parse_axiom(text: str) -> Tree:
    """Return the tree of one axiom in functional syntax."""
    stack: list[list[Tree]] = [[]]
    for token in _TOKENS.findall(text):
        if token.endswith("("):
            stack.append([token[:-1]])
        elif token == ")":
            closed = tuple(stack.pop())
            stack[-1].append(closed)
        else:
            stack[-1].append(token)
    return stack[0][0]


class Structure:
    """Things, each with its types and its links; all are different. It grows while it is made."""

    def __init__(self) -> None:
        self.types: dict[str, dict[str, None]] = {}
        """Thing to the classes that it belongs to, in the order in which they were found."""
        self.members: dict[str, dict[str, None]] = {}
        """Class to what belongs to it."""
        self.out: dict[str, dict[str, dict[str, None]]] = {}
        """Role to subject to its values."""
        self.into: dict[str, dict[str, dict[str, None]]] = {}
        """Role to value to its subjects."""

    def values(self, role: Tree, node: str) -> Iterable[str]:
        """Return what ``node`` is linked to by a role or by its inverse."""
        match role:
            case ("ObjectInverseOf", str(name)):
                return self.into.get(name, {}).get(node, {})
            case str(name):
                return self.out.get(name, {}).get(node, {})
            case _:
                raise ValueError(f"no role: {role}")

    def pairs(self, role: str) -> Iterator[tuple[str, str]]:
        """Yield subject and value of every link."""
        for subject, values in self.out.get(role, {}).items():
            for value in values:
                yield subject, value

    def belongs(self, node: str, expression: Tree) -> bool:
        """Return whether ``node`` belongs to a class expression, taking the structure for all there is.

        Raises:
            ValueError: If the expression is of a kind that is not known here.
        """
        match expression:
            case str(name):
                # What belongs to nothing is a contradiction, and no member that could make an axiom true.
                return name == THING[0] or (name != NOTHING[0] and name in self.types[node])
            case ("ObjectIntersectionOf", *parts):
                return all(self.belongs(node, part) for part in parts)
            case ("ObjectUnionOf", *parts):
                return any(self.belongs(node, part) for part in parts)
            case ("ObjectComplementOf", part):
                return not self.belongs(node, part)
            case ("ObjectOneOf", *names):
                return node in names
            case ("ObjectHasValue", role, str(value)):
                return value in self.values(role, node)
            case ("ObjectSomeValuesFrom", role, filler):
                return any(self.belongs(value, filler) for value in self.values(role, node))
            case ("ObjectAllValuesFrom", role, filler):
                return all(self.belongs(value, filler) for value in self.values(role, node))
            case (str(functor), str(number), role, filler) if functor in _COUNTS:
                count = sum(self.belongs(value, filler) for value in self.values(role, node))
                least, most = _COUNTS[functor]
                return (not least or count >= int(number)) and (not most or count <= int(number))
            case _:
                raise ValueError(f"no class expression: {expression}")

    def candidates(self, expression: Tree) -> Iterable[str]:
        """Return the things among which are all that belong to a class expression."""
        match expression:
            case str(name) if name != THING[0]:
                return self.members.get(name, {})
            case ("ObjectIntersectionOf", *parts):
                return min((self.candidates(part) for part in parts), key=lambda found: len(tuple(found)))
            case ("ObjectSomeValuesFrom", str(role), _):
                return self.out.get(role, {})
            case ("ObjectSomeValuesFrom", ("ObjectInverseOf", str(role)), _):
                return self.into.get(role, {})
            case _:
                return self.types

    def is_model_of(self, axioms: Iterable[Tree]) -> bool:
        """Return whether all axioms hold in it; one of a kind that is not known here does not."""
        try:
            return all(self._satisfies(axiom) for axiom in axioms)
        except ValueError:
            return False

    def _below(self, left: Tree, right: Tree) -> bool:
        return all(self.belongs(node, right) for node in self.candidates(left) if self.belongs(node, left))

    def _satisfies(self, axiom: Tree) -> bool:
        match axiom:
            case ("Declaration" | "DifferentIndividuals", *_):
                return True
            case ("SubClassOf", left, right):
                return self._below(left, right)
            case ("EquivalentClasses", left, right):
                return self._below(left, right) and self._below(right, left)
            case ("DisjointClasses", *classes):
                return self._apart(classes)
            case ("ClassAssertion", expression, str(individual)):
                return self.belongs(individual, expression)
            case ("ObjectPropertyAssertion", str(role), str(subject), str(value)):
                return value in self.values(role, subject)
            case ("ObjectPropertyDomain", str(role), right):
                return all(self.belongs(node, right) for node in self.out.get(role, {}))
            case ("ObjectPropertyRange", str(role), right):
                return all(self.belongs(node, right) for node in self.into.get(role, {}))
            case _:
                return self._satisfies_of_roles(axiom)

    def _apart(self, classes: list[Tree]) -> bool:
        seen: set[str] = set()
        for name in classes:
            for node in self.candidates(name):
                if self.belongs(node, name):
                    if node in seen:
                        return False
                    seen.add(node)
        return True

    def _satisfies_of_roles(self, axiom: Tree) -> bool:
        match axiom:
            case ("FunctionalObjectProperty", str(role)):
                return all(len(values) <= 1 for values in self.out.get(role, {}).values())
            case ("InverseFunctionalObjectProperty", str(role)):
                return all(len(subjects) <= 1 for subjects in self.into.get(role, {}).values())
            case ("SubObjectPropertyOf", ("ObjectPropertyChain", *roles), str(upper)):
                return all(
                    end in self.values(upper, node) for node in self.types for end in self._ends(node, tuple(roles))
                )
            case ("SubObjectPropertyOf", str(lower), str(upper)):
                return all(value in self.values(upper, subject) for subject, value in self.pairs(lower))
            case ("EquivalentObjectProperties", str(one), str(other)):
                return set(self.pairs(one)) == set(self.pairs(other))
            case ("InverseObjectProperties", str(one), str(other)):
                return {(value, subject) for subject, value in self.pairs(one)} == set(self.pairs(other))
            case ("DisjointObjectProperties", str(one), str(other)):
                return set(self.pairs(one)).isdisjoint(self.pairs(other))
            case ("SymmetricObjectProperty", str(role)):
                return all(subject in self.values(role, value) for subject, value in self.pairs(role))
            case ("AsymmetricObjectProperty", str(role)):
                return not any(subject in self.values(role, value) for subject, value in self.pairs(role))
            case ("ReflexiveObjectProperty", str(role)):
                return all(node in self.values(role, node) for node in self.types)
            case ("IrreflexiveObjectProperty", str(role)):
                return not any(subject == value for subject, value in self.pairs(role))
            case ("TransitiveObjectProperty", str(role)):
                return all(
                    end in self.values(role, subject)
                    for subject, value in self.pairs(role)
                    for end in self.values(role, value)
                )
            case _:
                raise ValueError(f"no axiom that is known here: {axiom}")

    def _ends(self, node: str, roles: tuple[Tree, ...]) -> set[str]:
        ends = {node}
        for role in roles:
            ends = {value for end in ends for value in self.values(role, end)}
        return ends


_COUNTS = {
    "ObjectMinCardinality": (True, False),
    "ObjectMaxCardinality": (False, True),
    "ObjectExactCardinality": (True, True),
}
"""Whether the number bounds from below, and from above."""
