"""Answers as JSON: intervals as objects, lists as lists, other terms as Prolog writes them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, cast

from prolepsis.terms.answers import is_interval
from prolepsis.terms.terms import Term, Value, format_value


def json_value(value: Value | Sequence[Mapping[str, Value]] | Mapping[str, Value]) -> Any:
    """Return a value, an answer or several answers as ``json.dumps`` takes them.

    Names and finite numbers stay as they are; an interval, as ``0.5-2.0``, is ``{"start": 0.5, "end": 2.0}`` [s]; any
    other term, and a number that JSON has no sign for, is the text that Prolog would write, ``"broken(egg1)"``.

    Args:
        value: What ``ask`` has returned, or any part of it.
    """
    if isinstance(value, Term):
        return dict(zip(("start", "end"), value.args, strict=True)) if is_interval(value) else format_value(value)
    if isinstance(value, Mapping):
        return {name: json_value(each) for name, each in value.items()}
    if isinstance(value, list | tuple):
        return [json_value(each) for each in cast("Sequence[Value]", value)]
    is_plain = isinstance(value, str | int) or (isinstance(value, float) and math.isfinite(value))
    return value if is_plain else format_value(cast("Value", value))
