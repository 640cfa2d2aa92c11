"""Evidence: every number behind a fact has a range, and none is ever outside it."""

from __future__ import annotations

import ast
import math
from pathlib import Path

import pytest
from tests.fluents.worlds import FLOOR, box, of_type, watch, world
from tests.synthetic import egg_drop_log

import prolepsis.fluents
from prolepsis.fluents.evidence import RANGES
from prolepsis.fluents.observation import observe
from prolepsis.log.timeline import Fact
from prolepsis.terms.errors import InvalidSimulationError

GROUNDINGS = Path(prolepsis.fluents.__file__).parent
PAGE = Path(__file__).parents[2] / "docs" / "grounding.md"
WORDS = {"outcome", "by", "source", "edge", "result"}
"""Evidence that is a name."""


def numbers_named() -> set[str]:
    """Return the keys of all evidence that the groundings write, read from their source."""
    found: set[str] = set()
    for file in GROUNDINGS.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Dict):
                found |= {
                    key.value for key in node.keys if isinstance(key, ast.Constant) and isinstance(key.value, str)
                }
            elif isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name) and node.value.id == "evidence":
                found |= {str(node.slice.value)} if isinstance(node.slice, ast.Constant) else set()
    return found


def test_every_number_that_a_grounding_names_has_a_range() -> None:
    # The force that a gripper reached is told under two names, by way of a tuple.
    assert numbers_named() | {"force", "command"} == set(RANGES) | WORDS


def test_the_page_tells_of_every_number() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert not [name for name in RANGES if f"`{name}`" not in page]


@pytest.mark.parametrize("name", RANGES)
def test_a_number_outside_its_range_is_no_evidence(name: str) -> None:
    observation, known = observe(egg_drop_log()), RANGES[name]
    wrong = [math.nan, math.inf, known.least - 1e-3, *([known.greatest + 1e-3] if known.greatest < math.inf else [])]
    for value in wrong:
        with pytest.raises(InvalidSimulationError, match=rf"supports\(a,b\) from 0.000 s: {name} would be"):
            observation.fact("fluent", "supports", ("a", "b"), (0, 5), {name: value})
    within = min(known.least + 0.5, known.greatest)
    fact: Fact = observation.fact("fluent", "supports", ("a", "b"), (0, 5), {name: within})
    assert fact.evidence == {name: within}


def test_rounding_is_no_error_and_is_not_shown() -> None:
    observation = observe(egg_drop_log())
    fact: Fact = observation.fact("fluent", "contains", ("a", "b"), (0, 5), {"fraction": 1.0 + 1e-15})
    assert fact.evidence == {"fraction": 1.0}


def test_what_actions_note_must_be_finite() -> None:
    with pytest.raises(InvalidSimulationError, match="asked would be nan"):
        observe(egg_drop_log()).fact("event", "waiting", (), (0, 5), {"asked": math.nan})


def test_what_bears_a_stack_bears_all_of_each_thing_in_it() -> None:
    timeline = watch(world(FLOOR + box("a", "0 0 .05", mass=0.1) + box("b", "0 0 .15", mass=10.0)), 0.6)
    assert of_type(timeline, "supports") == {"supports(floor,a)", "supports(a,b)"}
    shares = {str(f.term): float(f.evidence["share"]) for f in timeline.select(type="supports")}
    assert shares == {"supports(floor,a)": pytest.approx(1.0, abs=0.02), "supports(a,b)": pytest.approx(1.0, abs=0.02)}
    assert all(share <= 1.0 for share in shares.values())


def test_two_piers_share_a_bridge() -> None:
    piers = box("left", "-.15 0 .05") + box("right", ".15 0 .05")
    timeline = watch(world(FLOOR + piers + box("plank", "0 0 .11", ".2 .05 .01")), 0.6)
    shares = [float(f.evidence["share"]) for f in timeline.select(type="supports") if f.args[1] == "plank"]
    assert shares == [pytest.approx(0.5, abs=0.05)] * 2
