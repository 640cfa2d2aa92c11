"""Terms: the one notation for plans, actions, fluents, events and answers (Prolog's).

An atom is a ``str``, a number an ``int`` or ``float``, a list a ``tuple``, a variable a ``Variable``,
anything else a ``Term``. A partial list ``[a|T]`` is ``Term("[|]", ("a", T))``, an interval ``S-E`` is
``Term("-", (S, E))``. Prolog strings are read as atoms.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from prolepsis.terms.errors import InputError


# Both are without slots: what an answer holds is a text or a table as well, which no class with slots can be.
@dataclass(frozen=True)
class Variable:
    """A named placeholder, ``Force``."""

    name: str
    """Begins with an upper-case letter or ``_``."""

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True)
class Term:
    """A functor with arguments, ``grasp(hand1, egg1, 20)``. Without arguments, use a ``str``."""

    functor: str
    """Name of the relation, action or function."""
    args: tuple[Value, ...] = ()
    """Arguments."""

    def __str__(self) -> str:
        return format_value(self)


Value = Term | Variable | str | int | float | tuple["Value", ...]

PARTIAL_LIST = "[|]"
"""Functor of a list cell whose tail is not a list, as in SWI-Prolog."""

# Priority and type of SWI-Prolog's operators: the ones that can occur in plans, goals and answers.
INFIX: dict[str, tuple[int, str]] = {
    **dict.fromkeys([":-", "-->"], (1200, "xfx")),
    **dict.fromkeys([";", "|"], (1100, "xfy")),
    **dict.fromkeys(["->", "*->"], (1050, "xfy")),
    ",": (1000, "xfy"),
    ":=": (990, "xfx"),
    **dict.fromkeys(
        [
            "<",
            "=",
            "=..",
            "=@=",
            "=:=",
            "=<",
            "==",
            "=\\=",
            ">",
            ">=",
            "@<",
            "@=<",
            "@>",
            "@>=",
            "\\=",
            "\\==",
            "\\=@=",
            "is",
            "as",
            ">:<",
            ":<",
        ],
        (700, "xfx"),
    ),
    ":": (600, "xfy"),
    **dict.fromkeys(["+", "-", "/\\", "\\/", "xor"], (500, "yfx")),
    **dict.fromkeys(["*", "/", "//", "mod", "rdiv", "<<", ">>", "div", "rem"], (400, "yfx")),
    "**": (200, "xfx"),
    "^": (200, "xfy"),
}
PREFIX: dict[str, tuple[int, str]] = {
    **dict.fromkeys([":-", "?-"], (1200, "fx")),
    **dict.fromkeys(["dynamic", "discontiguous", "initialization", "multifile", "table"], (1150, "fx")),
    "\\+": (900, "fy"),
    **dict.fromkeys(["-", "+", "\\"], (200, "fy")),
    "$": (1, "fx"),
}
SYMBOLS = "#$&*+-./:<=>?@^~\\"

_PLAIN_SYMBOL = re.compile(rf"[{re.escape(SYMBOLS)}]+|\{{\}}|!|;")
_ESCAPES = {
    "\\": "\\\\",
    "'": "\\'",
    "\n": "\\n",
    "\r": "\\r",
    "\t": "\\t",
    "\a": "\\a",
    "\b": "\\b",
    "\f": "\\f",
    "\v": "\\v",
}


def format_value(value: Value) -> str:
    """Return ``value`` as Prolog's ``writeq`` prints it, ``grasp(hand1,egg1,20)``; ``parse_term`` reads it back."""
    return _format(value, 1200)


def format_atom(name: str) -> str:
    """Return the atom called ``name``, quoted where Prolog needs it; symbols beyond ASCII always are."""
    if name.isidentifier():
        plain = name[0] != "_" and not (name[0].isupper() or name[0].istitle())
    else:
        plain = _PLAIN_SYMBOL.fullmatch(name) is not None and name != "." and not name.startswith("/*")
    if plain:
        return name
    return "'" + "".join(map(_escape, name)) + "'"


def _escape(character: str) -> str:
    # SWI-Prolog 9.0 takes escapes of the unused planes D8 to DF for surrogates, and reads the character itself.
    if character in _ESCAPES or character.isprintable() or "\U000d8000" <= character <= "\U000dffff":
        return _ESCAPES.get(character, character)
    return f"\\x{ord(character):X}\\"


def _format_number(number: int | float) -> str:
    if not isinstance(number, float):
        try:
            return str(int(number))
        except ValueError:
            raise InputError(f"a number of some {int(number).bit_length() * 3 // 10:,} digits is too long") from None
    if math.isnan(number):
        return "1.5NaN"
    if math.isinf(number):
        return "1.0Inf" if number > 0 else "-1.0Inf"
    # A float of numpy tells its type.
    text = float.__repr__(number)
    if abs(number) >= 1e15 and text.endswith(".0"):  # Prolog changes to exponents one place earlier
        digits = text.removesuffix(".0").lstrip("-")
        text = f"{'-' if number < 0 else ''}{digits[0]}.{digits[1:].rstrip('0') or '0'}e{len(digits) - 1}"
    mantissa, _, exponent = text.partition("e")
    if not exponent:
        return mantissa
    return f"{mantissa if '.' in mantissa else mantissa + '.0'}e{int(exponent):+d}"


def _format_operand(value: Value, limit: int) -> str:
    """Return an operand of an operator: an atom that is itself an operator stands in parentheses."""
    if isinstance(value, str) and (value in INFIX or value in PREFIX):
        return f"({format_atom(value)})"
    return _format(value, limit)


def _glue(left: str, right: str) -> str:
    """Join two texts, with a space where they would otherwise be read as one token."""
    kinds = [("w" if c.isalnum() or c == "_" else "s" if c in SYMBOLS else c) for c in (left[-1], right[0])]
    return f"{left} {right}" if kinds[0] == kinds[1] and kinds[0] in "ws" else left + right


def _format_prefix(name: str, argument: Value) -> str:
    priority, kind = PREFIX[name]
    operand = _format_operand(argument, priority if kind == "fy" else priority - 1)
    # Without the space, "- 1" would be the number -1.
    if operand.startswith("(") or (name == "-" and operand[0].isdigit()):
        return f"{format_atom(name)} {operand}"
    return _glue(format_atom(name), operand)


def _format_infix(name: str, left: Value, right: Value) -> str:
    priority, kind = INFIX[name]
    first = _format_operand(left, priority if kind[0] == "y" else priority - 1)
    second = _format_operand(right, priority if kind[2] == "y" else priority - 1)
    if name == ",":
        return f"{first},{second}"
    if name[0].isalpha():
        # Before "(" the operator would be a functor.
        return _glue(first, name) + ("" if second[0] in "[{'" else " ") + second
    return _glue(_glue(first, name), second)


def _format(value: Value, limit: int) -> str:
    """Return the text of ``value`` where operators up to priority ``limit`` need no parentheses."""
    match value:
        case Variable():
            return value.name
        case str() if not isinstance(value, Term):
            return format_atom(value)
        case int() | float():
            return _format_number(value)
        case tuple():
            return "[" + ",".join(_format(item, 999) for item in value) + "]"
        case Term(functor=name, args=(argument,)) if name in PREFIX:
            text, priority = _format_prefix(name, argument), PREFIX[name][0]
        case Term(functor=name, args=(left, right)) if name in INFIX:
            text, priority = _format_infix(name, left, right), INFIX[name][0]
        case Term(functor="{}", args=(argument,)):
            return "{" + _format(argument, 1200) + "}"
        case Term(functor="[|]", args=(_, _)):
            return _format_partial_list(value)
        case Term(functor=name, args=arguments):
            return f"{format_atom(name)}(" + ",".join(_format(argument, 999) for argument in arguments) + ")"
        case _:  # pyright: ignore[reportUnnecessaryComparison]
            raise TypeError(f"no term: {type(value).__name__}")
    return f"({text})" if priority > limit else text


def _format_partial_list(value: Value) -> str:
    items: list[str] = []
    while isinstance(value, Term) and value.functor == PARTIAL_LIST and len(value.args) == 2:
        items.append(_format(value.args[0], 999))
        value = value.args[1]
    if isinstance(value, tuple):
        return "[" + ",".join([*items, *(_format(item, 999) for item in value)]) + "]"
    return "[" + ",".join(items) + "|" + _format(value, 999) + "]"
