"""Reading terms: an operator precedence parser for the part of Prolog's syntax that data is written in."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import NoReturn

from prolepsis.terms.errors import InputError, brief
from prolepsis.terms.terms import INFIX, PARTIAL_LIST, PREFIX, SYMBOLS, Term, Value, Variable

DEEPEST = 150
"""Deepest nesting that is read; deeper ones would exhaust Python's own stack."""

TOO_DEEP = f"at most {DEEPEST} levels of nesting"
LAST_CHARACTER = 0x10FFFF
"""Code of Unicode's last character."""
SHOWN = 80
"""Most characters of the text that a message shows."""

_LAYOUT = re.compile(r"(?:\s+|%[^\n]*|/\*.*?\*/)*", re.DOTALL)
_TOKEN = re.compile(
    rf"""
    (?P<rational>\d+r\d+)
    |(?P<number>0x[0-9a-fA-F]+|0o[0-7]+|0b[01]+|0'(?:\\.|''|[^\\'])
       |\d+\.\d+(?:[eE][+-]?\d+|Inf|NaN)?|\d+[eE][+-]?\d+|\d+)
    |(?P<variable>[A-Z_]\w*)
    |(?P<name>[^\W\d_]\w*)
    |(?P<quoted>'(?:\\x[0-9a-fA-F]+\\|\\[0-7]+\\|\\.|''|[^\\'])*')
    |(?P<string>"(?:\\x[0-9a-fA-F]+\\|\\[0-7]+\\|\\.|""|[^\\"])*")
    |(?P<symbol>(?:[{re.escape(SYMBOLS)}]|[^\w\s\x00-\x7f])+|;|!)
    |(?P<punctuation>[()\[\]{{}},|])
    """,
    re.VERBOSE | re.DOTALL,
)
_ESCAPE = re.compile(r"\\(x[0-9a-fA-F]+\\?|[0-7]+\\?|u[0-9a-fA-F]{4}|U[0-9a-fA-F]{8}|\n|.)", re.DOTALL)
_LETTERS = {"n": "\n", "t": "\t", "r": "\r", "a": "\a", "b": "\b", "f": "\f", "v": "\v", "e": "\x1b", "s": " "}
_CLOSERS = frozenset({")", "]", "}", ",", "|", ""})


class _UnreadableError(ValueError):
    """A token that stands for nothing; the message says what it is."""


@dataclass(frozen=True, slots=True)
class _Token:
    kind: str
    text: str
    start: int
    end: int


def _unescape(match: re.Match[str]) -> str:
    code = match.group(1)
    if code == "\n":
        return ""
    if code[0] in "xuU" and len(code) > 1:
        return _character(int(code[1:].rstrip("\\"), 16))
    if code[0] in "01234567":
        return _character(int(code.rstrip("\\"), 8))
    return _LETTERS.get(code, code)


def _character(code: int) -> str:
    if not 0 <= code <= LAST_CHARACTER or 0xD800 <= code <= 0xDFFF:
        raise _UnreadableError("an escape that is no character")
    return chr(code)


def _unquote(text: str) -> str:
    quote = text[0]
    return _ESCAPE.sub(_unescape, text[1:-1].replace(quote * 2, quote))


def _number(text: str) -> int | float:
    if text.startswith("0'"):
        character = _ESCAPE.sub(_unescape, text[2:])
        if not character:
            raise _UnreadableError("a line that goes on is no character")
        return ord(character[0])
    if text.endswith("Inf"):
        return float("inf")
    if text.endswith("NaN"):
        return float("nan")
    if text[:2] in ("0x", "0o", "0b"):
        return int(text, 0)
    return float(text) if "." in text or "e" in text or "E" in text else int(text)


def _rational(text: str) -> Value:
    above, below = text.split("r")
    return Term("rdiv", (int(above), int(below)))


def parse_term(text: str, *, where: str = "term") -> Value:
    """Return the value that ``text`` denotes in Prolog's syntax; a final full stop may be left out.

    Args:
        text: One term, such as ``sequence([grasp(hand1, egg3, Force), lift(hand1, 0.1)])``.
        where: What the text is, for the error message: ``"egg.toml: plan"``.

    Raises:
        InputError: With the position and what was expected, if the text is not one term.
    """
    if not isinstance(text, str):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(f"{where}: a term is read from text, not from {brief(type(text).__name__)}")
    return read_term(text, where)


def read_term(text: str, where: str) -> Value:
    """Return the one value in ``text``; see ``prolepsis.terms.terms.parse_term``."""
    try:
        return _Reader(text, where).read()
    except _UnreadableError as error:
        raise InputError(f"{where}: syntax error: {error}: {brief(repr(text.strip()), SHOWN)}") from error
    except ValueError as error:  # Python reads no integer that is longer than 4300 digits.
        raise InputError(f"{where}: a number has too many digits") from error


def _is_too_deep(value: Value) -> bool:
    """Return whether terms are nested more deeply than may be; a list is as deep as its items, however long."""
    waiting = [(value, 0)]
    while waiting:
        each, depth = waiting.pop()
        if depth > DEEPEST:
            return True
        if isinstance(each, tuple):
            waiting += [(item, depth + 1) for item in each]
        elif isinstance(each, Term):
            *items, last = each.args
            waiting += [(item, depth + 1) for item in items]
            waiting.append((last, depth if each.functor == PARTIAL_LIST else depth + 1))
    return False


class _Reader:
    """A position in one text. Only ``read_term`` makes one."""

    def __init__(self, text: str, where: str) -> None:
        self.text = text
        self.where = where
        self.depth = 0
        self.in_arguments = False
        self.token = self._scan(0)

    def read(self) -> Value:
        value = self._term(1200)
        if self.token.text == "." and self.token.kind == "symbol":
            self._next()
        if self.token.text:
            self._fail("an operator or the end")
        if len(self.text) > DEEPEST and _is_too_deep(value):
            # A chain such as 1+1+1+... is deep, though nothing in it is within anything else.
            self._fail(TOO_DEEP)
        return value

    def _fail(self, expected: str) -> NoReturn:
        line = self.text.count("\n", 0, self.token.start) + 1
        column = self.token.start - (self.text.rfind("\n", 0, self.token.start) + 1) + 1
        found = f"found {brief(repr(self.token.text), 32)}" if self.token.text else "found the end"
        at = f"column {column}" if "\n" not in self.text.strip() else f"line {line}, column {column}"
        raise InputError(
            f"{self.where}: syntax error at {at}: expected {expected}, {found}: {brief(repr(self.text.strip()), SHOWN)}"
        )

    def _scan(self, start: int) -> _Token:
        layout = _LAYOUT.match(self.text, start)
        start = layout.end() if layout else start
        if start >= len(self.text):
            return _Token("end", "", start, start)
        match = _TOKEN.match(self.text, start)
        if match is None:
            self.token = _Token("bad", self.text[start], start, start + 1)
            self._fail("a closing quote" if self.text[start] in "'\"" else "a term")
        return _Token(match.lastgroup or "", match.group(), start, match.end())

    def _next(self) -> _Token:
        token = self.token
        self.token = self._scan(token.end)
        return token

    def _take(self, text: str, expected: str) -> None:
        if self.token.text != text or self.token.kind != "punctuation":
            self._fail(expected)
        self._next()

    def _opens_arguments(self, token: _Token) -> bool:
        return self.token.text == "(" and self.token.kind == "punctuation" and self.token.start == token.end

    def _term(self, limit: int) -> Value:
        self.depth += 1
        if self.depth > DEEPEST:
            self._fail(TOO_DEEP)
        left, priority = self._primary(limit)
        value = self._infix(left, priority, limit)
        self.depth -= 1
        return value

    def _inside(self, arguments: bool) -> Value:
        """Return a term between brackets; among arguments, a comma or a bar ends it."""
        outer, self.in_arguments = self.in_arguments, arguments
        value = self._term(1200)
        self.in_arguments = outer
        return value

    def _infix(self, left: Value, priority: int, limit: int) -> Value:
        while True:
            name = self.token.text if self.token.kind in ("name", "symbol", "punctuation") else ""
            operator = INFIX.get(name)
            if operator is None or (self.in_arguments and name in (",", "|")):
                return left
            own, kind = operator
            if own > limit or priority > (own if kind[0] == "y" else own - 1):
                return left
            self._next()
            right = self._term(own if kind[2] == "y" else own - 1)
            left, priority = Term(name, (left, right)), own

    def _primary(self, limit: int) -> tuple[Value, int]:
        """Return one operand and its priority (0 but for prefix operators)."""
        token = self.token
        match token.kind:
            case "number":
                self._next()
                return _number(token.text), 0
            case "rational":
                self._next()
                return _rational(token.text), 0
            case "variable":
                self._next()
                return Variable(token.text), 0
            case "string":
                self._next()
                return _unquote(token.text), 0
            case "quoted":
                self._next()
                return self._compound(_unquote(token.text), token), 0
            case "name" | "symbol":
                self._next()
                return self._named(token, limit)
            case "punctuation" if token.text in "([{":
                self._next()
                return self._bracketed(token), 0
            case _:
                self._fail("a term")

    def _bracketed(self, token: _Token) -> Value:
        if token.text == "(":
            value = self._inside(arguments=False)
            self._take(")", "an operator or ')'")
            return value
        if token.text == "[":
            if self.token.text == "]":
                self._next()
                return () if not self._opens_arguments(token) else self._compound("[]", token)
            return self._list()
        if self.token.text == "}":
            close = self._next()
            return self._compound("{}", close)
        value = self._inside(arguments=False)
        self._take("}", "an operator or '}'")
        return Term("{}", (value,))

    def _named(self, token: _Token, limit: int) -> tuple[Value, int]:
        name = token.text
        if self._opens_arguments(token):
            return self._compound(name, token), 0
        if name == "-" and self.token.kind == "number" and self.token.start == token.end:
            return -_number(self._next().text), 0
        if name == "-" and self.token.kind == "rational" and self.token.start == token.end:
            return _rational("-" + self._next().text), 0
        operator = PREFIX.get(name)
        if operator is None or self._ends_operand():
            return name, 0
        own, kind = operator
        own = min(own, limit)
        return Term(name, (self._term(own if kind == "fy" else own - 1),)), own

    def _ends_operand(self) -> bool:
        """Return whether a prefix operator that was just read stands for itself: ``- = x``, ``f(-)``."""
        token = self.token
        if token.kind in ("punctuation", "end"):
            return token.text in _CLOSERS
        after = self._scan(token.end) if token.kind in ("name", "symbol") else token
        if after.kind == "end" and (token.text == "." or (token.text in INFIX and token.kind == "symbol")):
            return True
        return (
            token.kind in ("name", "symbol")
            and token.text in INFIX
            and token.text not in PREFIX
            and not (after.text == "(" and after.start == token.end)
        )

    def _compound(self, name: str, token: _Token) -> Value:
        if not self._opens_arguments(token):
            return name
        self._next()
        arguments = [self._inside(arguments=True)]
        while self.token.text == ",":
            self._next()
            arguments.append(self._inside(arguments=True))
        self._take(")", "',' or ')'")
        return Term(name, tuple(arguments))

    def _list(self) -> Value:
        items = [self._inside(arguments=True)]
        while self.token.text == ",":
            self._next()
            items.append(self._inside(arguments=True))
        if self.token.text != "|":
            self._take("]", "',', '|' or ']'")
            return tuple(items)
        self._next()
        tail = self._inside(arguments=True)
        self._take("]", "']'")
        if isinstance(tail, tuple):
            return (*items, *tail)
        for item in reversed(items):
            tail = Term(PARTIAL_LIST, (item, tail))
        return tail
