"""The examples of docs/queries.md give the answers that the page shows."""

from __future__ import annotations

import contextlib
import io
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from prolepsis.log.domain import Domain
from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.logic.process import PROLOG_FILES
from prolepsis.logic.session import Session
from prolepsis.terms.terms import format_value

INTERNAL = {"matching", "args_of", "interval", "relation_names", "same_type", "open_ends", "open_fields"}
"""Predicates that the modules share, and that a goal may not call."""
PAGE = (Path(__file__).parents[2] / "docs" / "queries.md").read_text()


@pytest.fixture(scope="module")
def session() -> Iterator[Session]:
    session = Session()
    yield session
    session.close()


def timeline_of_page() -> Timeline:
    facts = [
        Fact(kind="event", type="closingGripper", args=("hand1",), start=0.0, end=0.1, evidence={"level": "force7"}),
        Fact(kind="fluent", type="attached", args=("hand1", "egg1"), start=0.0, end=0.2),
        Fact(kind="event", type="falling", args=("egg1",), start=0.2, end=0.5),
        Fact(kind="event", type="colliding", args=("egg1", "floor"), start=0.5, end=0.51),
        Fact(kind="event", type="breaking", args=("egg1",), start=0.501, end=0.505, evidence={"force": 44.0}),
        Fact(kind="fluent", type="broken", args=("egg1",), start=0.501, end=2.0),
    ]
    domain = Domain(
        instances=(("egg1", "Egg"), ("egg1", "Breakable")),
        parts=(("egg1", "eggshell1"),),
        values=(("egg1", "mass", 0.058),),
    )
    nearly = [Fact(kind="fluent", type="spilled", args=("yolk1",), start=0.6, end=2.0, evidence={"margin": 0.95})]
    return make_timeline(facts, dt=0.001, duration=2.0, domain=domain, near_misses=nearly)


EXAMPLES = re.findall(r"^\?- (.*)\.\n((?:% .*\n)+)", PAGE, re.MULTILINE)


@pytest.mark.parametrize(("goal", "shown"), EXAMPLES, ids=[goal[:50] for goal, _ in EXAMPLES])
def test_the_goals_are_answered_as_shown(session: Session, goal: str, shown: str) -> None:
    answers = session.ask(timeline_of_page(), goal)
    lines = [", ".join(f"{k} = {format_value(v)}" for k, v in answer.items()) or "yes" for answer in answers]
    assert (lines or ["no"]) == [line.removeprefix("% ") for line in shown.splitlines()]


def test_every_predicate_of_a_timeline_has_an_example() -> None:
    exports = [
        re.search(r"module\(\w+,\s*\[(.*?)\]\)", (PROLOG_FILES / f"{name}.pl").read_text(), re.DOTALL)
        for name in ("timeline", "allen", "knowledge", "open_ends")
    ]
    names = {name for export in exports if export for name in re.findall(r"(\w+)/\d", export.group(1))}
    goals = " ".join(goal for goal, _ in EXAMPLES)
    assert {name for name in names if f"{name}(" not in goals} == INTERNAL


def test_the_chronicle_is_added_as_shown(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (rule,) = re.findall(r"```chronicle\n(.*?)```", PAGE, re.DOTALL)
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "shattering.pl").write_text(rule)
    monkeypatch.chdir(tmp_path)
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(code, {"Session": Session, "timeline": timeline_of_page()})
    assert f"# {printed.getvalue().strip()}" in code
