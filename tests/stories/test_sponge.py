"""Section 4.2 of the paper: a table wiped with a dry sponge, with a full one, and with one that was pressed out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from prolepsis.log.log import FREE, PARKED
from prolepsis.projection import Projection, project

EXAMPLES = Path(__file__).parents[2] / "examples"

THE_QUERY = "occurs(E, T1), eventT(E, wiping), argsOf(E, [sponge1, table1]), after(T2, T1), holds(F, T2)"


@pytest.fixture(scope="module")
def dry() -> Projection:
    return project(EXAMPLES / "sponge_dry.toml")


@pytest.fixture(scope="module")
def saturated() -> Projection:
    return project(EXAMPLES / "sponge_saturated.toml")


@pytest.fixture(scope="module")
def pressed() -> Projection:
    return project(EXAMPLES / "sponge_pressed.toml")


def assert_nothing_is_lost(projection: Projection) -> None:
    """Check that table, sponge and bowl have all the mass between them, in every frame."""
    log = projection.log
    p, sponge = log.particles, log.index("sponge1")
    assert set(np.unique(p.holder).tolist()) <= {FREE, sponge, PARKED}
    shares = [(p.holder == holder) @ p.mass for holder in (FREE, sponge, PARKED)]
    assert sum(shares) == pytest.approx(np.full(len(p.tick), p.mass.sum()), rel=1e-12)
    assert not (p.holder[-1] == PARKED).any()


def of_the_puddle(projection: Projection) -> set[str]:
    """Return the fluents that the paper's query gives of the liquid on the table."""
    return {str(answer["F"]) for answer in projection.ask(THE_QUERY) if "liq1" in str(answer["F"])}


def in_the_end(projection: Projection) -> set[str]:
    """Return the fluents of the liquid on the table when all is over."""
    end = projection.timeline.duration - 0.001
    return {str(answer["F"]) for answer in projection.ask(f"holds_at(F, {end})") if "liq1" in str(answer["F"])}


def test_wiped_with_a_dry_sponge_the_table_is_clean_and_the_sponge_has_the_puddle(dry: Projection) -> None:
    assert_nothing_is_lost(dry)
    assert of_the_puddle(dry) == {"absorbs(sponge1,liq1)"}
    assert in_the_end(dry) == {"absorbs(sponge1,liq1)"}
    assert dry.ask("holds(dirty(table1), 0.0-_), \\+ holds(dirty(table1), 8.0), \\+ holds(wet(table1), 8.0)")
    assert dry.ask("instance_of(table1, 'WetThing', 0.0), \\+ instance_of(table1, 'WetThing', 8.0)")


def test_wiped_with_a_full_sponge_it_stays_wet(saturated: Projection) -> None:
    assert_nothing_is_lost(saturated)
    assert in_the_end(saturated) == {"on(liq1,table1)", "spilled(liq1)", "supports(table1,liq1)"}
    assert saturated.ask("holds(dirty(table1), 0.0-_), holds(dirty(table1), 8.0)")
    assert saturated.ask("occurs(wiping(sponge1, table1), _)")
    assert saturated.ask("holds(absorbs(sponge1, liq2), 0.0-_)")


@pytest.mark.filterwarnings("ignore:near its threshold")  # 2 % of the drops that fell beside the bowl
def test_pressed_out_into_a_bowl_first_it_cleans_again(pressed: Projection) -> None:
    assert_nothing_is_lost(pressed)
    assert of_the_puddle(pressed) == {"absorbs(sponge1,liq1)"}
    assert in_the_end(pressed) == {"absorbs(sponge1,liq1)"}
    end = pressed.timeline.duration - 0.001
    assert pressed.ask(f"holds_at(contains(bowl1, liq2), {end})")
