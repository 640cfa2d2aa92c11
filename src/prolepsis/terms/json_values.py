"""Answers as JSON: intervals as objects, lists as lists, other terms as Prolog writes them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, cast

from prolepsis.terms.terms import Term, Value, format_value


def json_value(value: Value | Sequence[Mapping[str, Value]] | Mapping[str, Value]) -> Any:
    """Return a value, an answer or several answers as ``json.dumps`` takes them.

    Numbers and names stay as they are; an interval, as ``0.5-2.0``, is ``{"start": 0.5, "end": 2.0}`` [s]; any other
    term is the text that Prolog would write, ``"broken(egg1)"``.

    Args:
        value: What ``ask`` has returned, or any part of it.
    """
    if isinstance(value, Mapping):
        return {name: json_value(each) for name, each in value.items()}
    if isinstance(value, list | tuple):
        return [json_value(each) for each in cast("Sequence[Value]", value)]
    if isinstance(value, Term) and value.functor == "-" and len(value.args) == 2:
        start, end = value.args
        if isinstance(start, int | float) and isinstance(end, int | float):
            return {"start": start, "end": end}
    return value if isinstance(value, str | int | float) else format_value(cast("Value", value))
