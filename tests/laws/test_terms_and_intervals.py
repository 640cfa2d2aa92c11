"""Laws: terms read back as they were printed; the thirteen relations are exhaustive, disjoint and inverse."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.terms.allen import INVERSES, RELATIONS, Interval, relation
from prolepsis.terms.errors import InputError
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import Term, Value, Variable, format_value

NAMES = st.sampled_from(
    ["egg1", "-", "+", ":-", "is", "mod", ",", "|", "[]", "{}", "don't", "A b", "é", "\\+"]
) | st.text(st.characters(codec="utf-8"), max_size=5)
LEAVES = (
    NAMES
    | st.integers()
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.sampled_from(["X", "_a", "Force"]).map(Variable)
)
VALUES: st.SearchStrategy[Value] = st.recursive(
    LEAVES,
    lambda inner: (
        st.lists(inner, max_size=3).map(tuple)
        | st.builds(Term, NAMES.filter(lambda n: n != "[]"), st.lists(inner, min_size=1, max_size=3).map(tuple))
    ),
    max_leaves=12,
)


@given(VALUES)
def test_a_term_reads_back_as_it_was_printed(value: Value) -> None:
    assert parse_term(format_value(value)) == value


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("grasp(hand1", "column 12: expected ',' or '\\)', found the end"),
        ("[a b]", "column 4: expected ',', '\\|' or '\\]', found 'b'"),
        ("a b", "column 3"),
        ("'open", "closing quote"),
        ("f(,)", "column 3: expected a term"),
        ("f(" * 500, "levels of nesting"),
    ],
)
def test_what_is_not_a_term_is_refused_with_its_position(text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        parse_term(text, where="plan")


ENDS = st.tuples(st.integers(0, 6), st.integers(0, 6)).filter(lambda e: e[0] < e[1])
INTERVALS = ENDS.map(lambda e: Interval(start=float(e[0]), end=float(e[1])))

DEFINITIONS: dict[str, Callable[[Interval, Interval], bool]] = {
    "before": lambda i, j: i.end < j.start,
    "after": lambda i, j: j.end < i.start,
    "meets": lambda i, j: i.end == j.start,
    "met_by": lambda i, j: j.end == i.start,
    "overlaps": lambda i, j: i.start < j.start < i.end < j.end,
    "overlapped_by": lambda i, j: j.start < i.start < j.end < i.end,
    "starts": lambda i, j: i.start == j.start and i.end < j.end,
    "started_by": lambda i, j: i.start == j.start and i.end > j.end,
    "during": lambda i, j: j.start < i.start and i.end < j.end,
    "contains": lambda i, j: i.start < j.start and j.end < i.end,
    "finishes": lambda i, j: i.end == j.end and i.start > j.start,
    "finished_by": lambda i, j: i.end == j.end and i.start < j.start,
    "equals": lambda i, j: i == j,
}


@given(INTERVALS, INTERVALS)
def test_exactly_one_relation_holds_and_it_is_the_one_given(i: Interval, j: Interval) -> None:
    assert [name for name in RELATIONS if DEFINITIONS[name](i, j)] == [relation(i, j)]
    assert relation(j, i) == INVERSES[relation(i, j)]


@given(INTERVALS, INTERVALS, INTERVALS)
def test_before_and_during_compose_with_themselves(i: Interval, j: Interval, k: Interval) -> None:
    for name in ("before", "during", "starts", "finishes", "equals"):
        if relation(i, j) == name == relation(j, k):
            assert relation(i, k) == name
    if relation(i, j) == "meets" == relation(j, k):
        assert relation(i, k) == "before"


STRETCHES = st.lists(ENDS, max_size=8)


@given(STRETCHES)
def test_a_timeline_is_maximal_and_loses_no_instant(stretches: list[tuple[int, int]]) -> None:
    facts = [Fact(kind="fluent", type="wet", args=("a",), start=s, end=e) for s, e in stretches]
    timeline = make_timeline(facts, dt=1e-3, duration=6.0)
    for first, second in zip(timeline.facts, timeline.facts[1:], strict=False):
        assert first.end < second.start
    for middle in (n + 0.5 for n in range(6)):
        assert any(s <= middle < e for s, e in stretches) == any(f.start <= middle < f.end for f in timeline.facts)
    assert Timeline.from_json(timeline.to_json(), dt=1e-3, duration=6.0) == timeline
