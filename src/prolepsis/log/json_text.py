"""Readable JSON, byte-equal for equal values: a line for each value, one space deeper in each list and table.

The same text as ``json.dumps`` writes with an indent, which the standard library does token by token.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from json.encoder import encode_basestring
from typing import Any, cast


def to_json(value: Any) -> str:
    """Return readable JSON of plain values, and of numbers of numpy's; keys are sorted.

    Raises:
        ValueError: If a number is not finite.
        TypeError: If something is no value of JSON.
    """
    return _text(value, "\n") + "\n"


def _text(value: Any, line: str) -> str:
    """Return the text of a value that begins in a line; ``line`` ends one, and indents the next."""
    write = _WRITERS.get(cast("type[Any]", type(value)))
    if write is not None:
        return write(value)
    deeper = line + " "
    if isinstance(value, Mapping):
        table = cast("Mapping[Any, Any]", value)
        if not table:
            return "{}"
        rows = [f"{encode_basestring(name)}: {_text(table[name], deeper)}" for name in sorted(table)]
        return f"{{{deeper}{f',{deeper}'.join(rows)}{line}}}"
    if isinstance(value, list | tuple):
        items = [_text(item, deeper) for item in cast("list[Any]", value)]
        return f"[{deeper}{f',{deeper}'.join(items)}{line}]" if items else "[]"
    if isinstance(value, str):
        return encode_basestring(value)
    if hasattr(value, "item"):  # a numpy scalar
        return _text(value.item(), line)
    raise TypeError(f"{type(value).__name__} cannot be written as JSON")


def _number(value: float) -> str:
    if not math.isfinite(value):
        raise ValueError(f"{value} is no number of JSON")
    return repr(value)


def _truth(value: bool) -> str:
    return "true" if value else "false"


_WRITERS: Mapping[type[Any], Callable[[Any], str]] = {
    str: encode_basestring,
    float: _number,
    int: repr,
    bool: _truth,
    type(None): lambda _: "null",
}
