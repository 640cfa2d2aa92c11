"""The examples of docs/queries.md give the answers that the page shows."""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path

import pytest

from prolepsis.logic.session import Session
from prolepsis.terms import format_value
from prolepsis.timeline import Fact, Timeline, make_timeline

PAGE = (Path(__file__).parents[1] / "docs" / "queries.md").read_text()


def timeline_of_page() -> Timeline:
    facts = [
        Fact(kind="fluent", type="attached", args=("hand1", "egg1"), start=0.0, end=0.2),
        Fact(kind="event", type="falling", args=("egg1",), start=0.2, end=0.5),
        Fact(kind="event", type="colliding", args=("egg1", "floor"), start=0.5, end=0.51),
        Fact(kind="event", type="breaking", args=("egg1",), start=0.501, end=0.505, evidence={"force": 44.0}),
        Fact(kind="fluent", type="broken", args=("egg1",), start=0.501, end=2.0),
    ]
    return make_timeline(facts, dt=0.001, duration=2.0)


def test_the_goals_are_answered_as_shown() -> None:
    examples = re.findall(r"^\?- (.*)\.\n% (.*)$", PAGE, re.MULTILINE)
    assert len(examples) == 5
    for goal, shown in examples:
        answers = timeline_of_page().ask(goal)
        assert [", ".join(f"{k} = {format_value(v)}" for k, v in a.items()) or "yes" for a in answers] == [shown]


def test_the_chronicle_is_added_as_shown(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (rule,) = re.findall(r"```chronicle\n(.*?)```", PAGE, re.DOTALL)
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    (tmp_path / "shattering.pl").write_text(rule)
    monkeypatch.chdir(tmp_path)
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(code, {"Session": Session, "timeline": timeline_of_page()})
    assert f"# {printed.getvalue().strip()}" in code
