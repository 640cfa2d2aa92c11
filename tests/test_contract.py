"""Hand-written timelines, goals, and the answers that they must give."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.logic.session import Session
from prolepsis.terms.errors import GoalError
from prolepsis.terms.terms import format_value

CASES: list[dict[str, Any]] = json.loads((Path(__file__).parent / "contract" / "timelines.json").read_text())
GOALS = [(case, goal) for case in CASES for goal in case["goals"]]


def timelines(case: dict[str, Any]) -> dict[str, Timeline]:
    """Return the timelines of a case by the name of their run."""
    facts: dict[str, list[Fact]] = {"run1": []}
    for kind, type_, args, start, end, *more in case["facts"]:
        evidence: dict[str, Any] = more[0] if more else {}
        run = more[1] if len(more) > 1 else "run1"
        fact = Fact(kind=kind, type=type_, args=tuple(args), start=start, end=end, evidence=evidence)
        facts.setdefault(run, []).append(fact)
    return {run: make_timeline(some, dt=0.001, duration=10.0) for run, some in facts.items()}


@pytest.fixture(scope="module")
def session() -> Any:
    session = Session()
    yield session
    session.close()


@pytest.mark.parametrize(("case", "goal"), GOALS, ids=[goal["goal"][:60] for _, goal in GOALS])
def test_contract(session: Session, case: dict[str, Any], goal: dict[str, Any]) -> None:
    runs = timelines(case)
    for name, timeline in runs.items():
        session.load(timeline, run=name)
    timeline = runs["run1"]
    if "error" in goal:
        with pytest.raises(GoalError, match=re.escape(goal["error"].removesuffix(", ..."))):
            session.ask(timeline, goal["goal"], time_limit=0.5 if "memory" not in goal["error"] else 20.0)
        assert session.ask(timeline, "holds(contacts(a, b), _)") == [{}]
        return
    answers = session.ask(timeline, goal["goal"])
    found = {tuple(format_value(answer[name]) for name in goal["vars"]) for answer in answers}
    assert found == {tuple(answer) for answer in goal["answers"]}
