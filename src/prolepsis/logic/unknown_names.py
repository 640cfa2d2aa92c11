"""What is said of a name in a goal that nothing has: what it should have named, and the nearest that are known."""

from __future__ import annotations

import difflib
import re

from prolepsis.terms.errors import brief, brief_list

PREDICATES = {"fluent": "holds", "event": "occurs"}
WHAT = {
    "fact": "fluent or event",
    "evidence": "evidence",
    "individual": "individual",
    "class": "class",
    "property": "property",
    "quantity": "property or evidence",
    "run": "run",
}
OTHERWISE = {
    "hasPart": "has_part(Whole, Part)",
    "partOf": "has_part(Whole, Part)",
    "shape": "value(Thing, shape, Shape)",
}
"""Relations of the ontology that are no facts, and what tells of them."""
LEAST_STEM, STEM = 4, 0.7
"""Letters, and share of a name, with which another begins that may have been meant."""
_FACT = re.compile(r"(.*)/(\d+)-(fluent|event)")


def unknown_name(body: str) -> str:
    """Return what is wrong with a name.

    Args:
        body: What Prolog tells: the kind, the name as it stands in the goal, and the names of that kind, in lines. Of
            fluents and events these are ``name/arity``, and of the known ones ``name/arity-kind``.
    """
    kind, name, known = (body.split("\n") + ["", ""])[:3]
    names = known.split("\t") if known else []
    facts = [(found[1], int(found[2]), found[3]) for found in map(_FACT.fullmatch, names) if found]
    what = WHAT.get(kind, kind)
    if facts:
        return _unknown_fact(kind, name, facts)
    near = nearest(name, names)
    names.sort(key=lambda each: "/" in each)
    told = f"; did you mean {_either(near)}?" if near else f"; known: {brief_list(names)}" if names else ""
    return f"no {what} named {brief(name)} in the vocabulary, the domain or the timelines{told}"


def _unknown_fact(kind: str, name: str, facts: list[tuple[str, int, str]]) -> str:
    plain, _, arity = name.rpartition("/")
    what = WHAT.get(kind, kind)
    if kind == "occurring":
        told = " or ".join(pattern(plain, count) for other, count, _ in facts if other == plain)
        return f"{brief(name)} does not occur; what does is written {told}, as the plan has it"
    bare = (plain or name).strip("'\"")
    if bare != (plain or name) and re.fullmatch(r"\w+\(.*\)", bare):
        return f"no {what} {brief(name)}; a fact is a term and no text: write {brief(bare)}"
    for other, count, its in facts:
        if other == plain and str(count) == arity:
            return f"{plain} is {a_kind(its)}, no {what}; ask {PREDICATES[its]}({pattern(plain, count)}, T)"
    if plain in OTHERWISE:
        return f"no {what} {brief(name)}; ask {OTHERWISE[plain]}"
    same = [(count, its) for other, count, its in facts if other == plain and kind in (its, "fact")]
    if same:
        told = " or ".join(pattern(plain, count) for count, _ in same)
        return f"no {what} {brief(name)}; it is written {told}"
    of_kind = [other for other, _, its in facts if kind in (its, "fact")]
    ranked = nearest(plain, of_kind) or _of_one_stem(plain, of_kind)
    if ranked:
        shown = [pattern(other, count) for each in ranked for other, count, _ in facts if other == each][:3]
        return f"no {what} {brief(name)}; did you mean {_either(shown)}?"
    for each in nearest(plain, [other for other, _, _ in facts]):
        count, its = next((count, its) for other, count, its in facts if other == each)
        return f"no {what} {brief(name)}; did you mean the {its} {pattern(each, count)}?"
    known = sorted({other for other, _, its in facts if kind in (its, "fact")})
    return f"no {what} {brief(name)}; known: {brief_list(known)}"


def pattern(name: str, arity: int) -> str:
    """Return how a fact is written: ``contacts(X, Y)``."""
    variables = ("X", "Y", "Z", "U", "V", "W", *(f"X{number}" for number in range(7, arity + 1)))
    return f"{name}({', '.join(variables[:arity])})" if arity else name


def nearest(name: str, known: list[str]) -> list[str]:
    """Return up to three names like ``name``, the nearest first; quotes and capitals count for nothing."""
    plain: dict[str, str] = {}
    for each in known:
        plain.setdefault(_plain(each), each)
    return [plain[each] for each in difflib.get_close_matches(_plain(name), list(plain), n=3, cutoff=0.7)]


def _of_one_stem(name: str, known: list[str]) -> list[str]:
    """Return up to three names that begin as ``name`` does: ``dropping`` for ``dropped``."""
    stem = _plain(name)[: max(LEAST_STEM, round(STEM * len(_plain(name))))]
    return sorted({each for each in known if len(stem) >= LEAST_STEM and _plain(each).startswith(stem)})[:3]


def _plain(name: str) -> str:
    return name.strip("'\"").replace("_", "").casefold()


def a_kind(kind: str) -> str:
    """Return the name of a kind of fact with its article."""
    return f"an {kind}" if kind[0] in "aeiou" else f"a {kind}"


def _either(names: list[str]) -> str:
    return " or ".join(brief(name) for name in names)
