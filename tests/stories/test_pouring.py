"""Section 4.2 of the paper: what holds after a robot has poured a liquid from one container to another."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.projection import project

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


LEAKING, OVERFLOWING = {"a"}, {"e"}
"""Variants in which cup2 leaks, or overflows."""


# What overflows runs over the table; whether one drop more falls from its edge is near a threshold.
@pytest.mark.filterwarnings(r"ignore:near its threshold.*(wet|dirty)\(floor\)")
@pytest.mark.parametrize("variant", sorted(STATED))
def test_pouring_ends_as_the_paper_states(variant: str) -> None:
    poured = project(EXAMPLES / f"pour_{variant}.toml")
    found = {str(answer["F"]) for answer in poured.ask(QUERY)}
    assert {fact for fact in found if "liq1" in fact} == STATED[variant]
    assert bool(poured.ask("occurs(leaking(cup2, _), T)")) == (variant in LEAKING)
    assert bool(poured.ask("occurs(overflowing(cup2, _), T)")) == (variant in OVERFLOWING)
    # The liquid alone gets from cup to cup: neither the cup in the hand nor the hand touches the other.
    pairs = {frozenset((str(a["A"]), str(a["B"]))) for a in poured.ask("holds(contacts(A, B), T)")}
    assert frozenset(("cup1", "hand1")) in pairs
    assert not pairs & {frozenset(("cup1", "cup2")), frozenset(("hand1", "cup2"))}


@pytest.mark.laws
def test_warm_honey_runs_off_where_cool_honey_stays() -> None:
    poured = project(EXAMPLES / "pour_c.toml", settings={"liq1.temperature": 40})
    assert "supports(table1,liq1)" in {str(answer["F"]) for answer in poured.ask(QUERY)}
