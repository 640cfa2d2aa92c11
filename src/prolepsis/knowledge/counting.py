"""Counts in the condition of an axiom, said in its conclusion instead: pyhermit overlooks them in a condition.

What is a block on at least two tables is a bridge: what is a block is a bridge, or on at most one table.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from prolepsis.knowledge.expressions import THING
from prolepsis.knowledge.structures import Tree, parse_axiom


class OverlookedError(Exception):
    """A count stands where it cannot be moved from."""


def counted_on_the_right(texts: Iterable[str]) -> Iterator[str]:
    """Yield axioms in functional syntax that say the same without counts of two or more in a condition.

    Raises:
        OverlookedError: If one stands within something else there.
    """
    for text in texts:
        if "Cardinality(" not in text:
            yield text
            continue
        match parse_axiom(text):
            case ("SubClassOf", left, right):
                yield from map(_text, _moved(left, right))
            case ("EquivalentClasses", *parts) if any(map(_counts, parts)):
                ring = zip(parts, [*parts[1:], parts[0]], strict=True)
                yield from (_text(axiom) for left, right in ring for axiom in _moved(left, right))
            case _:
                yield text


def _moved(left: Tree, right: Tree) -> Iterator[Tree]:
    match left:
        case ("ObjectUnionOf", *parts):
            for part in parts:
                yield from _moved(part, right)
            return
        case ("ObjectIntersectionOf", *parts):
            pass
        case _:
            parts = [left]
    kept: list[Tree] = []
    alternatives: list[Tree] = [right]
    for part in parts:
        match part:
            case ("ObjectMinCardinality" | "ObjectExactCardinality" as kind, str(number), *rest) if int(number) > 1:
                alternatives.append(("ObjectMaxCardinality", str(int(number) - 1), *rest))
                if kind == "ObjectExactCardinality":
                    kept.append(("ObjectMaxCardinality", number, *rest))
            case _:
                if _counts(part):
                    raise OverlookedError
                kept.append(part)
    condition: Tree = THING[0] if not kept else kept[0] if len(kept) == 1 else ("ObjectIntersectionOf", *kept)
    conclusion: Tree = right if len(alternatives) == 1 else ("ObjectUnionOf", *alternatives)
    yield ("SubClassOf", condition, conclusion)


def _counts(tree: Tree) -> bool:
    """Return whether two or more are counted anywhere in an expression."""
    if isinstance(tree, str):
        return False
    counted = tree[0] in ("ObjectMinCardinality", "ObjectExactCardinality") and str(tree[1]).isdigit()
    return (counted and int(str(tree[1])) > 1) or any(map(_counts, tree[1:]))


def _text(tree: Tree) -> str:
    return tree if isinstance(tree, str) else f"{tree[0]}({' '.join(map(_text, tree[1:]))})"
