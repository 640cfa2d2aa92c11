"""Names of fluents and events come from one table, which has all that is on any timeline."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from prolepsis.cli import main
from prolepsis.fluents import fact_types
from prolepsis.log.fact_types import SYMMETRIC, arguments_of
from prolepsis.log.timeline import Fact
from prolepsis.programs import ACTIONS
from prolepsis.terms.reader import parse_term
from prolepsis.terms.terms import Term

DIGESTS = json.loads((Path(__file__).parents[2] / "tools" / "digests.json").read_text())["examples"]


def on_timelines() -> set[tuple[str, str, int]]:
    """Return kind, type and number of arguments of all facts of all examples."""
    found: set[tuple[str, str, int]] = set()
    for digest in DIGESTS.values():
        for line in digest.get("facts", ()):
            _, _, kind, text = line.split(" ", 3)
            term = parse_term(text)
            assert isinstance(term, Term)
            found.add((kind, term.functor, len(term.args)))
    return found


def test_all_that_is_on_the_timelines_of_the_examples_is_listed() -> None:
    known = fact_types()
    seen = on_timelines()
    assert {"splitting", "peeling", "wiping", "supports"} <= {name for _, name, _ in seen}
    for kind, name, count in seen:
        assert known[name].kind == kind, name
        at_most = len(known[name].arguments)
        assert count <= at_most if name in {spec.event for spec in ACTIONS.values()} else count == at_most, name


def test_every_action_is_a_listed_event(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "events"]) == 0
    listed = [line.split("(")[0] for line in capfd.readouterr().out.splitlines()]
    assert sorted(listed) == listed and len(set(listed)) == len(listed)
    assert {spec.event for spec in ACTIONS.values()} <= {*listed}


def test_an_event_of_an_action_is_described_with_its_arguments(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["describe", "splitting"]) == 0
    told = capfd.readouterr().out
    assert told.startswith("splitting(hand, other, object, force, angle, distance): event\n")
    assert "action split;" in told
    # What is found in the log says more than that the program ran.
    assert main(["describe", "wiping"]) == 0
    assert capfd.readouterr().out.startswith("wiping(o1, o2): event\n")


def test_arguments_of_a_fact_have_names() -> None:
    fact = Fact(kind="event", type="grasping", args=("hand1", "egg1", 5), start=0.0, end=1.0)
    assert arguments_of(fact) == {"hand": "hand1", "object": "egg1", "force": 5}
    assert arguments_of(Fact(kind="event", type="stirring", args=("hand1",), start=0.0, end=1.0)) == {}


def test_what_is_symmetric_is_declared_of_two_things_named_alike() -> None:
    for name in SYMMETRIC:
        assert [argument.rstrip("12") for argument in fact_types()[name].arguments] == ["o", "o"]
