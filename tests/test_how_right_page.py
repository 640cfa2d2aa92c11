"""The page "How right is it?" has all comparisons, and tells what falls short."""

from __future__ import annotations

import ast
import contextlib
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.comparing import PROPERTY, Row, comparing
from tools.how_right import PAGE, files, page

ROOT = Path(__file__).parents[1]


def compared(file: str) -> Iterator[str]:
    """Yield what a file of tests compares, as the calls of ``compare`` say."""
    for function in ast.walk(ast.parse((ROOT / file).read_text(encoding="utf-8"))):
        if not isinstance(function, ast.FunctionDef):
            continue
        known: dict[str, str] = {}
        for node in ast.walk(function):
            match node:
                case ast.Assign(targets=[ast.Tuple(elts=names)], value=ast.Tuple(elts=values)):
                    pairs = zip(names, values, strict=True)
                    known |= {name.id: value.value for name, value in pairs if _is_text(name, value)}  # type: ignore[attr-defined]
                case ast.Assign(targets=[ast.Name(id=name)], value=ast.Constant(value=str(text))):
                    known[name] = text
                case _:
                    pass
        for node in ast.walk(function):
            match node:
                case ast.Call(func=ast.Name(id="compare"), args=[ast.Constant(value=str(text)), *_]):
                    yield text
                case ast.Call(func=ast.Name(id="compare"), args=[ast.Name(id=name), *_]):
                    yield known[name]
                case _:
                    pass


def _is_text(name: ast.expr, value: ast.expr) -> bool:
    return isinstance(name, ast.Name) and isinstance(value, ast.Constant) and isinstance(value.value, str)


@pytest.mark.parametrize("file", files())
def test_the_page_has_each_comparison(file: str) -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert {*compared(file)} <= {*re.findall(r"^\| (.*?) \|", text, re.MULTILINE)}


def row(measured: float, expected: float, **more: Any) -> Row:
    """Return the row of a comparison of two lengths."""
    found: list[Any] = []
    compare = comparing(lambda _, each: found.append(each))
    with contextlib.suppress(AssertionError):
        compare("how long", measured, expected, by="a ruler", **more)
    return Row(**found[0])


def test_a_row_gives_the_case_that_is_farthest_off() -> None:
    rows = [row(1.01, 1.0, share=0.05, unit="m"), row(2.06, 2.0, share=0.05, unit="m")]
    text = page([("tests/comparing.py::test", each, "") for each in rows])
    assert "| how long | a ruler | 2 | 2.06 m, expected 2 m | 3 % | 5 % |" in text
    assert "falls short\n\nKnown" not in text


def test_what_is_known_to_fail_falls_short_with_its_reason() -> None:
    text = page([("tests/comparing.py::test[long]", row(3.0, 2.0, within=0.5, unit="m"), "it is bent")])
    assert "| how long | long | a ruler | 3 m | 2 m | it is bent |" in text


def test_a_truth_is_counted() -> None:
    rows = [row(True, True), row(False, False), row(True, False)]
    text = page([("tests/comparing.py::test", each, "") for each in rows])
    assert "| how long | a ruler | 3 | 2 of 3 right | | |" in text


def test_what_is_too_far_off_fails_and_is_told() -> None:
    told: list[tuple[str, Any]] = []
    compare = comparing(lambda name, each: told.append((name, each)))
    compare("how long", 1.5, (1.0, 2.0), by="a ruler", unit="m")
    with pytest.raises(AssertionError, match="how long: 2.5 m, expected 1 to 2, 0 beside it at most"):
        compare("how long", 2.5, (1.0, 2.0), by="a ruler", unit="m")
    assert [name for name, _ in told] == [PROPERTY, PROPERTY]
