"""QuickXplain alone: what it returns is a conflict, and nothing in it can be left out."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from prolepsis.knowledge.conflict import smallest_conflict

Conflicts = list[frozenset[int]]
SETS = st.frozensets(st.integers(0, 15), min_size=1, max_size=5)


def consistent_with(conflicts: Conflicts, some: tuple[int, ...]) -> bool:
    """Return whether ``some`` includes none of ``conflicts``."""
    return not any(conflict <= set(some) for conflict in conflicts)


@given(st.lists(SETS, min_size=1, max_size=4), st.frozensets(st.integers(0, 15), max_size=3))
def test_a_conflict_is_found_and_is_minimal(conflicts: Conflicts, certain: frozenset[int]) -> None:
    background = tuple(sorted(certain))
    items = tuple(i for i in range(16) if i not in certain)
    found = smallest_conflict(background, items, lambda some: consistent_with(conflicts, some))
    assert not consistent_with(conflicts, background + found)
    for left_out in found:
        rest = tuple(item for item in found if item != left_out)
        assert consistent_with(conflicts, background + rest)
    assert list(found) == sorted(found)


def test_the_number_of_questions_grows_with_the_conflict_and_not_with_the_axioms() -> None:
    asked: list[int] = []

    def consistent(some: tuple[int, ...]) -> bool:
        asked.append(len(some))
        return not {17, 900} <= set(some)

    assert smallest_conflict((), tuple(range(1000)), consistent) == (17, 900)
    assert len(asked) < 50


def test_an_inconsistent_background_needs_no_items_and_no_conflict_is_an_error() -> None:
    assert smallest_conflict((1,), (2, 3), lambda some: 1 not in some) == ()
    with pytest.raises(ValueError, match="no conflict"):
        smallest_conflict((), (1, 2), lambda some: True)
