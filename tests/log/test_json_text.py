"""JSON is written as the standard library writes it."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from prolepsis.log.json_text import to_json

leaves = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text()
values = st.recursive(
    leaves, lambda inner: st.lists(inner) | st.tuples(inner, inner) | st.dictionaries(st.text(), inner), max_leaves=40
)


@given(values)
def test_values_are_written_as_the_standard_library_does(value: object) -> None:
    assert to_json(value) == json.dumps(value, indent=1, sort_keys=True, ensure_ascii=False) + "\n"


def test_numbers_of_numpy_are_numbers() -> None:
    assert to_json([np.float64(0.1), np.int64(3), np.bool_(True)]) == "[\n 0.1,\n 3,\n true\n]\n"


@pytest.mark.parametrize("number", [float("nan"), float("inf"), np.float64("-inf")])
def test_numbers_that_are_not_finite_are_refused(number: float) -> None:
    with pytest.raises(ValueError, match="is no number of JSON"):
        to_json({"a": [number]})


def test_what_is_no_value_is_refused() -> None:
    with pytest.raises(TypeError, match="set cannot be written as JSON"):
        to_json({"a": {1}})
