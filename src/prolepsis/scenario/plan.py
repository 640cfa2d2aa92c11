"""A plan as it is written: a term, whose variables are the scenario's parameters."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from prolepsis.terms.errors import InputError, PlanError, brief
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import PARTIAL_LIST, Term, Value, Variable


def read_plan(text: str, path: Path) -> Value:
    """Return the plan in a text of the scenario at ``path``.

    Raises:
        PlanError: If it cannot be read.
    """
    try:
        plan = parse_term(text, where=f"{path}: plan")
    except InputError as error:
        raise PlanError(f"{error}{_hint(text)}") from error
    for each in _within(plan):
        if isinstance(each, Term) and each.functor == PARTIAL_LIST:
            raise PlanError(f"{path}: plan: [A|B] is no list of actions or numbers; write all of it, [A, B]")
    return plan


def _hint(text: str) -> str:
    """Return what a plan that cannot be read may suffer from, for a message."""
    if capital := re.search(r"\b[A-Z]\w*(?=\()", text):
        word = capital.group()
        meant = word.lower() if word.isupper() else word[0].lower() + word[1:]
        return f"; only variables begin with a capital letter: write {brief(meant)}(...)"
    if re.search(r"(?<![\w.])[\d.]+\s*(?![eE][-+\d])[A-Za-z]", text):
        return '; numbers are in SI units, without a unit: write 0.1, or give a parameter { value = 10, unit = "cm" }'
    return ""


def variables(value: Value) -> Iterator[str]:
    """Yield the names of the variables in ``value``, as often as they occur."""
    for each in _within(value):
        if isinstance(each, Variable):
            yield each.name


def _within(value: Value) -> Iterator[Value]:
    """Yield ``value`` and all that it is made of."""
    waiting = [value]
    while waiting:
        each = waiting.pop()
        yield each
        if isinstance(each, Term):
            waiting += each.args
        elif isinstance(each, tuple):
            waiting += each


def bind(value: Value, values: Mapping[str, float | str]) -> Value:
    """Return ``value`` with its variables replaced."""
    if isinstance(value, Variable):
        return values[value.name]
    if isinstance(value, Term):
        return Term(value.functor, tuple(bind(argument, values) for argument in value.args))
    if isinstance(value, tuple):
        return tuple(bind(item, values) for item in value)
    return value
