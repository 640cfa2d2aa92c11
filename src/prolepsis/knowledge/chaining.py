"""Forward chaining: the types of individuals that follow step by step, and a model that shows that no others do.

Each rule here is a valid inference, so what it derives is right. What has been derived is a structure of things with
types and links; if all axioms hold in it, it is a model, and what is not in it does not follow. Only where it is none
(reasoning by cases, counting) the reasoner has the last word. The work grows like the number of individuals: a rule is
looked at again only where something new touches it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from prolepsis.knowledge.axioms import Axiom
from prolepsis.knowledge.expressions import NOTHING, THING
from prolepsis.knowledge.structures import Structure, Tree, parse_axiom

DEPTH = 3
"""Values without a name are made up to this many steps away from a named individual: an egg's shell's strength ..."""
MOST_STEPS = 20_000_000
"""... and chaining ends, undecided, after so many steps: about a minute, but the same on every machine."""

MOST_VALUES = 20
"""Of a count in a conclusion, at most so many values without a name are made; more are left to the reasoner."""

_Rule = tuple[Tree, Tree]
_Want = tuple[str, Tree, Tree, int]
"""A thing that needs values by a role, of which kind, and how many."""


class StepsError(Exception):
    """Chaining took more steps than it may."""


class Chaining:
    """A structure that grows until nothing new follows. This is the one mutable value here."""

    def __init__(self, axioms: Iterable[Axiom]) -> None:
        self.axioms = tuple(parse_axiom(axiom.text) for axiom in axioms)
        self.structure = Structure()
        self.clash: str | None = None
        """A thing that can be nothing."""
        self.steps = 0
        self._rules: dict[str, list[_Rule]] = {}
        self._some: dict[str, list[tuple[Tree, str]]] = {}
        self._least: dict[str, int] = {}
        """How many values are needed for a name, where that is not one."""
        self._fillers: dict[tuple[str, bool], list[tuple[str, str]]] = {}
        self._uppers: dict[str, list[tuple[str, bool]]] = {}
        self.functional: set[str] = set()
        """Roles with at most one value."""
        self._transitive: set[str] = set()
        self._only: dict[tuple[str, Tree], list[Tree]] = {}
        self._news: deque[tuple[str, str]] = deque()
        self._wanted: deque[_Want] = deque()
        self._put_off: deque[_Want] = deque()
        self._origin: dict[str, tuple[str, int]] = {}
        self._choices: deque[tuple[str, tuple[Tree, ...]]] = deque()
        """Things without a name that must be one of several: which, decides nothing of those that have one."""
        self._shared: dict[_Want, str] | None = None
        for tree in self.axioms:
            self._read_term(tree)
        for tree in self.axioms:
            self._read_fact(tree)

    def _read_term(self, tree: Tree) -> None:
        match tree:
            case ("SubClassOf", left, right):
                self._rule(left, right)
            case ("EquivalentClasses", left, right):
                self._rule(left, right)
                self._rule(right, left)
            case ("ObjectPropertyDomain", role, right):
                self._rule(("ObjectSomeValuesFrom", role, THING[0]), right)
            case ("ObjectPropertyRange", role, right):
                self._rule(("ObjectSomeValuesFrom", ("ObjectInverseOf", role), THING[0]), right)
            case ("SubObjectPropertyOf", str(lower), str(upper)):
                self._uppers.setdefault(lower, []).append((upper, False))
            case ("EquivalentObjectProperties", str(one), str(other)):
                self._uppers.setdefault(one, []).append((other, False))
                self._uppers.setdefault(other, []).append((one, False))
            case ("InverseObjectProperties", str(one), str(other)):
                self._uppers.setdefault(one, []).append((other, True))
                self._uppers.setdefault(other, []).append((one, True))
            case ("SymmetricObjectProperty", str(role)):
                self._uppers.setdefault(role, []).append((role, True))
            case ("FunctionalObjectProperty", str(role)):
                self.functional.add(role)
            case ("TransitiveObjectProperty", str(role)):
                self._transitive.add(role)
            case _:
                pass

    def _read_fact(self, tree: Tree) -> None:
        match tree:
            case ("ClassAssertion", expression, str(individual)):
                self._node(individual)
                self._derive(individual, expression)
            case ("ObjectPropertyAssertion", str(role), str(subject), str(value)):
                self._link(role, subject, value)
            case ("DifferentIndividuals", *individuals):
                for individual in individuals:
                    self._node(str(individual))
            case _:
                pass

    def _rule(self, left: Tree, right: Tree) -> None:
        if isinstance(right, tuple) and right[0] == "ObjectComplementOf":
            left, right = ("ObjectIntersectionOf", left, right[1]), NOTHING[0]
        condition = self._condition(left)
        for name in _atoms(condition):
            self._rules.setdefault(name, []).append((condition, right))

    def _condition(self, left: Tree) -> Tree:
        """Return an expression as a combination of names; a step over a role gets a name of its own.

        What can never be derived here, such as a complement, is named too, and nothing ever gets that name.
        """
        match left:
            case str(name):
                return name
            case ("ObjectIntersectionOf" | "ObjectUnionOf" as functor, *parts):
                return (functor, *(self._condition(part) for part in parts))
            case ("ObjectMinCardinality", "1", role, filler):
                return self._condition(("ObjectSomeValuesFrom", role, filler))
            case ("ObjectComplementOf", ("ObjectMaxCardinality", str(number), role, filler)):
                return self._condition(("ObjectMinCardinality", str(int(number) + 1), role, filler))
            case ("ObjectMinCardinality", str(number), role, filler) if number != "0":
                self._least[f"is {left}"] = int(number)
                return self._step(role, self._filler(filler), left)
            case ("ObjectHasValue", role, str(value)):
                return self._step(role, f"one {value}", left)
            case ("ObjectOneOf", *values):
                return ("ObjectUnionOf", *(f"one {value}" for value in values))
            case ("ObjectSomeValuesFrom", role, filler):
                return self._step(role, self._filler(filler), left)
            case _:
                return f"never {left}"

    def _filler(self, filler: Tree) -> str:
        if isinstance(filler, str):
            return filler
        named = f"is {filler}"
        if named not in self._some:
            self._some.setdefault(named, [])
            self._rule(filler, named)
        return named

    def _step(self, role: Tree, filler: str, expression: Tree) -> str:
        name = f"is {expression}"
        inverse, plain = (True, str(role[1])) if isinstance(role, tuple) else (False, role)
        fillers = self._fillers.setdefault((plain, inverse), [])
        if (filler, name) not in fillers:
            fillers.append((filler, name))
            # What has the filler now, tells this to those that are linked to it: from the other end of the role.
            back: Tree = plain if inverse else ("ObjectInverseOf", plain)
            self._some.setdefault(filler, []).append((back, name))
        return name

    def _node(self, node: str, root: str = "", depth: int = 0) -> None:
        if node not in self.structure.types:
            self.structure.types[node] = {}
            self._origin[node] = (root or node, depth)
            self._add(node, THING[0])
            self._add(node, f"one {node}")

    def _add(self, node: str, name: str) -> None:
        types = self.structure.types[node]
        if name not in types:
            types[name] = None
            self.structure.members.setdefault(name, {})[node] = None
            self._news.append((node, name))
            if name == NOTHING[0]:
                self.clash = self.clash or node

    def _link(self, role: str, subject: str, value: str) -> None:
        new = [(role, subject, value)]
        while new:
            role, subject, value = new.pop()
            self._node(subject)
            self._node(value)
            values = self.structure.out.setdefault(role, {}).setdefault(subject, {})
            if value in values:
                continue
            self.steps += 1
            values[value] = None
            self.structure.into.setdefault(role, {}).setdefault(value, {})[subject] = None
            for upper, inverse in self._uppers.get(role, ()):
                new.append((upper, value, subject) if inverse else (upper, subject, value))
            if role in self._transitive:
                new += [(role, subject, end) for end in self.structure.values(role, value)]
                new += [(role, start, value) for start in self.structure.values(("ObjectInverseOf", role), subject)]
            for inverse, here, there in ((False, subject, value), (True, value, subject)):
                for filler, name in self._fillers.get((role, inverse), ()):
                    if filler in self.structure.types[there]:
                        self._tell(here, ("ObjectInverseOf", role) if inverse else role, filler, name)
                key: Tree = ("ObjectInverseOf", role) if inverse else role
                for filler in self._only.get((here, key), ()):
                    self._derive(there, filler)

    def _derive(self, node: str, expression: Tree) -> None:
        match expression:
            case str(name):
                self._add(node, name)
            case ("ObjectComplementOf", str(name)) if name in self.structure.types[node]:
                self._add(node, NOTHING[0])
            case ("ObjectIntersectionOf", *parts):
                for part in parts:
                    self._derive(node, part)
            case ("ObjectUnionOf", *parts) if node.startswith("_:"):
                self._choices.append((node, tuple(parts)))
            case ("ObjectSomeValuesFrom", role, filler):
                self._wanted.append((node, role, filler, 1))
            case ("ObjectMinCardinality" | "ObjectExactCardinality", str(number), role, filler) if number != "0":
                self._wanted.append((node, role, filler, min(int(number), MOST_VALUES)))
            case ("ObjectHasValue", str(role), str(value)):
                self._link(role, node, value)
            case ("ObjectHasValue", ("ObjectInverseOf", str(role)), str(value)):
                self._link(role, value, node)
            case ("ObjectAllValuesFrom", role, filler):
                known = self._only.setdefault((node, role), [])
                if filler not in known:
                    known.append(filler)
                    for value in tuple(self.structure.values(role, node)):
                        self._derive(value, filler)
            case _:
                pass  # Left to the check of the model.

    def _holds(self, node: str, condition: Tree) -> bool:
        match condition:
            case str(name):
                return name in self.structure.types[node]
            case ("ObjectIntersectionOf", *parts):
                return all(self._holds(node, part) for part in parts)
            case (_, *parts):
                return any(self._holds(node, part) for part in parts)
            case _:
                return False

    def _give(self, node: str, role: Tree, filler: Tree, number: int) -> None:
        """Give a thing values of a kind, unless it has so many."""
        values = tuple(self.structure.values(role, node))
        there = sum(self._is(value, filler) for value in values)
        if there >= number:
            return
        if values and role in self.functional:
            self._derive(values[0], filler)
            return
        root, depth = self._origin[node]
        if depth >= DEPTH and self._shared is None:
            self._put_off.append((node, role, filler, number))
            return
        for k in range(there, number):
            key = (root, role, filler, k)
            value = self._shared.get(key) if self._shared is not None else None
            if value is None:
                value = f"_:{len(self.structure.types)}"
                self._node(value, root, depth + 1)
                if self._shared is not None:
                    self._shared[key] = value
            if isinstance(role, str):
                self._link(role, node, value)
            else:
                self._link(str(role[1]), value, node)
            self._derive(value, filler)

    def _is(self, node: str, expression: Tree) -> bool:
        try:
            return self.structure.belongs(node, expression)
        except ValueError:
            return False

    def run(self) -> None:
        """Apply all rules until nothing new follows.

        Raises:
            StepsError: If there is no end to it.
        """
        while self._news or self._wanted:
            # What follows for what is there comes before things that are made for want of a value.
            while self._news:
                self._pass_on(*self._news.popleft())
            if self._wanted:
                self._give(*self._wanted.popleft())
            if self.steps > MOST_STEPS:
                raise StepsError

    def _pass_on(self, node: str, name: str) -> None:
        for condition, right in self._rules.get(name, ()):
            self.steps += 1
            if self._holds(node, condition):
                self._derive(node, right)
        for back, named in self._some.get(name, ()):
            for other in tuple(self.structure.values(back, node)):
                self.steps += 1
                forth = back[1] if isinstance(back, tuple) else ("ObjectInverseOf", back)
                self._tell(other, forth, name, named)

    def _tell(self, node: str, role: Tree, filler: str, name: str) -> None:
        """Give a thing the name of those with a value of a kind, or with so many: only what is named is surely two."""
        least = self._least.get(name, 1)
        if least > 1:
            if name in self.structure.types[node]:
                return
            values = [value for value in self.structure.values(role, node) if not value.startswith("_:")]
            self.steps += len(values)
            if sum(filler in self.structure.types[value] for value in values) < least:
                return
        self._add(node, name)

    def share(self) -> bool:
        """Let things without a name be the values of several others, and one of those that they must be one of, and go
        on; return whether that was needed.

        What follows from then on need not be right of others, but the structure can come to an end, and be a model.
        """
        if not (self._put_off or self._choices):
            return False
        self._shared = {}
        self._wanted, self._put_off = self._put_off, deque()
        self.run()
        while self._choices:
            node, parts = self._choices.popleft()
            if not any(self._is(node, part) for part in parts):
                self._derive(node, next((part for part in parts if not self._excluded(node, part)), parts[0]))
                self.run()
        return True

    def _excluded(self, node: str, part: Tree) -> bool:
        types = self.structure.types[node]
        apart = (tree[1:] for tree in self.axioms if isinstance(tree, tuple) and tree[0] == "DisjointClasses")
        return any(part in names and any(each in types for each in names if each != part) for names in apart)

    def named(self) -> dict[str, frozenset[str]]:
        """Return individual to classes, both as bracketed IRIs."""
        return {
            node: frozenset(name for name in types if name[0] == "<" and name != THING[0])
            for node, types in self.structure.types.items()
            if not node.startswith("_:")
        }


def _atoms(condition: Tree) -> dict[str, None]:
    if isinstance(condition, str):
        return {condition: None}
    return {name: None for part in condition[1:] for name in _atoms(part)}


def chain(axioms: Iterable[Axiom]) -> Chaining:
    """Return what follows from the axioms step by step.

    Raises:
        StepsError: If there is no end to it.
    """
    chaining = Chaining(axioms)
    chaining.run()
    return chaining


def clashing(chaining: Chaining) -> str | None:
    """Return a thing of which chaining shows that it cannot be; if there is none, nothing is decided."""
    if chaining.clash is not None:
        return chaining.clash
    structure = chaining.structure
    for tree in chaining.axioms:
        if isinstance(tree, tuple) and tree[0] == "DisjointClasses":
            seen: set[str] = set()
            for name in tree[1:]:
                members = structure.members.get(name, {}) if isinstance(name, str) else {}
                twice = next((node for node in members if node in seen), None)
                if twice is not None:
                    return twice
                seen.update(members)
    for role in sorted(chaining.functional):
        for node, values in structure.out.get(role, {}).items():
            if sum(not value.startswith("_:") for value in values) > 1:
                return node
    return None


def clashes(axioms: Iterable[Axiom]) -> bool:
    """Return whether chaining shows that the axioms contradict each other; if not, nothing is decided."""
    return clashing(chain(axioms)) is not None


def is_whole(chaining: Chaining) -> bool:
    """Return whether a model shows that the axioms do not contradict each other, and nothing else follows from them.

    After this nothing more may be read from ``chaining`` than what followed before.
    """
    follows = chaining.named()
    try:
        if chaining.share() and chaining.named() != follows:
            return False
    except StepsError:
        return False
    return chaining.clash is None and chaining.structure.is_model_of(chaining.axioms)
