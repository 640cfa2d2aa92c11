"""Forward chaining: the types of individuals that follow step by step; the reasoner certifies that there are no others.

Each rule here is a valid inference, so what it derives is right; it does not find everything (no reasoning by
cases), which is why the reasoner has the last word.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from prolepsis.knowledge.axioms import THING, Axiom

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


class Chaining:
    """Types and links of individuals, growing until nothing new follows.

    This is the one mutable value here, made and used up within ``chain``.
    """

    def __init__(self, axioms: Iterable[Axiom]) -> None:
        self.types: dict[str, set[str]] = {}
        self.links: set[tuple[str, str, str]] = set()
        self.rules: list[tuple[Tree, Tree]] = []
        self.roles: list[tuple[str, str, bool]] = []
        for axiom in axioms:
            self._take(parse_axiom(axiom.text))

    def _take(self, tree: Tree) -> None:
        match tree:
            case ("SubClassOf", left, right):
                self.rules.append((left, right))
            case ("EquivalentClasses", left, right):
                self.rules += [(left, right), (right, left)]
            case ("ObjectPropertyDomain", role, right):
                self.rules.append((("ObjectSomeValuesFrom", role, THING[0]), right))
            case ("ObjectPropertyRange", role, right):
                self.rules.append((("ObjectSomeValuesFrom", ("ObjectInverseOf", role), THING[0]), right))
            case ("SubObjectPropertyOf", str(lower), str(upper)):
                self.roles.append((lower, upper, False))
            case ("InverseObjectProperties", str(one), str(other)):
                self.roles += [(one, other, True), (other, one, True)]
            case ("ClassAssertion", expression, str(individual)):
                self.types.setdefault(individual, set())
                self._derive(individual, expression)
            case ("ObjectPropertyAssertion", str(role), str(subject), str(value)):
                self._link(role, subject, value)
            case _:
                pass

    def _link(self, role: str, subject: str, value: str) -> bool:
        self.types.setdefault(subject, set())
        self.types.setdefault(value, set())
        known = len(self.links)
        self.links.add((role, subject, value))
        return len(self.links) > known

    def _successors(self, role: Tree, node: str) -> Iterator[str]:
        match role:
            case ("ObjectInverseOf", str(name)):
                return (s for r, s, v in sorted(self.links) if r == name and v == node)
            case _:
                return (v for r, s, v in sorted(self.links) if r == role and s == node)

    def _holds(self, node: str, expression: Tree) -> bool:
        match expression:
            case str(name):
                return name == THING[0] or name in self.types[node]
            case ("ObjectIntersectionOf", *parts):
                return all(self._holds(node, part) for part in parts)
            case ("ObjectUnionOf", *parts):
                return any(self._holds(node, part) for part in parts)
            case ("ObjectSomeValuesFrom", role, filler):
                return any(self._holds(value, filler) for value in self._successors(role, node))
            case ("ObjectHasValue", role, str(value)):
                return value in self._successors(role, node)
            case _:
                return False

    def _derive(self, node: str, expression: Tree) -> bool:
        match expression:
            case str(name):
                new = name not in self.types[node]
                self.types[node].add(name)
                return new
            case ("ObjectIntersectionOf", *parts):
                return any([self._derive(node, part) for part in parts])
            case ("ObjectSomeValuesFrom", str(role), filler) if not self._holds(node, expression):
                # An unnamed value; only one step away from a named individual, so that chaining ends.
                if node.startswith("_:"):
                    return False
                unnamed = f"_:{len(self.types)}"
                self._link(role, node, unnamed)
                self._derive(unnamed, filler)
                return True
            case ("ObjectHasValue", str(role), str(value)):
                return self._link(role, node, value)
            case _:
                return False

    def step(self) -> bool:
        """Apply every rule once everywhere; return whether anything new followed."""
        new = False
        for role, other, inverse in self.roles:
            for name, subject, value in sorted(self.links):
                if name == role:
                    new = (self._link(other, value, subject) if inverse else self._link(other, subject, value)) or new
        for node in list(self.types):
            for left, right in self.rules:
                if self._holds(node, left):
                    new = self._derive(node, right) or new
        return new


def clashes(axioms: Iterable[Axiom]) -> bool:
    """Return whether chaining finds something that belongs to two disjoint classes; if not, nothing is decided."""
    axioms = tuple(axioms)
    chaining = Chaining(axioms)
    while chaining.step():
        pass
    trees = [parse_axiom(axiom.text) for axiom in axioms if axiom.text.startswith("DisjointClasses")]
    groups = [tree[1:] for tree in trees if isinstance(tree, tuple)]
    return any(sum(c in types for c in classes) > 1 for classes in groups for types in chaining.types.values())


def chain(axioms: Iterable[Axiom]) -> dict[str, set[str]]:
    """Return individual to classes, both as bracketed IRIs, for all that follows by chaining."""
    chaining = Chaining(axioms)
    while chaining.step():
        pass
    return {node: types for node, types in chaining.types.items() if not node.startswith("_:")}
