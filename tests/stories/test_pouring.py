"""Section 4.2 of the paper: what holds after a robot has poured a liquid from one container to another."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from prolepsis.projection import Projection, project

EXAMPLES = Path(__file__).parents[2] / "examples"

QUERY = """occurs(E, T1), eventT(E, pouringTo),
  argsOf(E, [cup1, liq1, cup2]),
  after(T2, T1), holds(F, T2)"""
"""The paper's, literally."""

STATED = {
    "a": {"contains(cup2,liq1)", "spilled(liq1)", "supports(table1,liq1)"},
    "b": {"spilled(liq1)", "supports(table1,liq1)", "supports(cup2,liq1)"},
    "c": {"spilled(liq1)", "supports(cup2,liq1)"},
    "d": {"contains(cup2,liq1)"},
    "e": {"contains(cup2,liq1)", "spilled(liq1)", "supports(table1,liq1)"},
}
"""What the paper states: (a) holes, (b) upside down, (c) honey, upside down, (d) done properly, (e) filled already."""


@cache
def poured(variant: str) -> Projection:
    return project(EXAMPLES / f"pour_{variant}.toml")


@pytest.mark.parametrize("variant", sorted(STATED))
def test_the_papers_query_binds_what_the_paper_states(variant: str) -> None:
    found = {str(answer["F"]) for answer in poured(variant).ask(QUERY)}
    assert {fact for fact in found if "liq1" in fact} == STATED[variant]


@pytest.mark.parametrize("variant", sorted(STATED))
def test_nothing_is_touched_but_the_cup_in_the_hand(variant: str) -> None:
    touching = poured(variant).ask("holds(contacts(A, B), T), \\+ B = liq1, \\+ A = liq1")
    pairs = {frozenset((str(a["A"]), str(a["B"]))) for a in touching}
    assert frozenset(("cup1", "cup2")) not in pairs
    assert frozenset(("hand1", "cup2")) not in pairs
    assert frozenset(("cup1", "hand1")) in pairs


def test_a_cup_with_holes_leaks_and_a_sound_one_does_not() -> None:
    assert poured("a").ask("occurs(leaking(cup2, liq1), T)")
    assert not poured("d").ask("occurs(leaking(cup2, _), T)")


def test_a_full_cup_overflows_and_an_empty_one_does_not() -> None:
    assert poured("e").ask("occurs(overflowing(cup2, _), T)")
    assert not poured("d").ask("occurs(overflowing(cup2, _), T)")
