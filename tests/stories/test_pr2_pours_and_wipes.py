"""Section 4.2 of the paper with its robot: a PR2 pours from cup to cup, and wipes a table with a sponge."""

from __future__ import annotations

from pathlib import Path

import pytest

from prolepsis.projection import project

EXAMPLES = Path(__file__).parents[2] / "examples"

POURED = """occurs(E, T1), eventT(E, pouringTo),
  argsOf(E, [cup1, liq1, cup2]),
  after(T2, T1), holds(F, T2)"""
WIPED = "occurs(E, T1), eventT(E, wiping), argsOf(E, [sponge1, table1]), after(T2, T1), holds(F, T2)"
"""The paper's queries, literally."""

STATED = {
    "a": {"contains(cup2,liq1)", "spilled(liq1)", "supports(table1,liq1)"},
    "b": {"spilled(liq1)", "supports(table1,liq1)", "supports(cup2,liq1)"},
    "c": {"spilled(liq1)", "supports(cup2,liq1)"},
    "d": {"contains(cup2,liq1)"},
    "e": {"contains(cup2,liq1)", "spilled(liq1)", "supports(table1,liq1)"},
}
"""What the paper states: (a) holes, (b) upside down, (c) honey, upside down, (d) done properly, (e) filled already."""
LONGER = pytest.mark.laws


@pytest.mark.parametrize("variant", ["d", *(pytest.param(v, marks=LONGER) for v in "abce")])
def test_pouring_ends_as_the_paper_states(variant: str) -> None:
    poured = project(EXAMPLES / f"pr2_pour_{variant}.toml")
    found = {str(answer["F"]) for answer in poured.ask(POURED)}
    assert {fact for fact in found if "liq1" in fact} == STATED[variant]
    # The liquid alone gets from cup to cup: neither the cup in the hand nor the hand touches the other.
    pairs = {frozenset((str(a["A"]), str(a["B"]))) for a in poured.ask("holds(contacts(A, B), T)")}
    assert frozenset(("cup1", "rightGripper")) in pairs
    assert not pairs & {frozenset(("cup1", "cup2")), frozenset(("rightGripper", "cup2"))}


def test_wiped_with_a_dry_sponge_the_table_is_clean_and_the_sponge_has_the_puddle() -> None:
    wiped = project(EXAMPLES / "pr2_wipe.toml")
    found = {str(answer["F"]) for answer in wiped.ask(WIPED) if "liq1" in str(answer["F"])}
    assert found == {"absorbs(sponge1,liq1)"}
