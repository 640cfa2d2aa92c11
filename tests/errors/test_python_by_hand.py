"""What is wrong in a call from Python is said where it is given: an error of ours, in one line."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import pytest

import prolepsis
from prolepsis import Fact, KnowledgeBase, Term, format_value, parse_term, project, read_log, recognize, sweep
from prolepsis.log.timeline import Timeline, make_timeline
from prolepsis.scenario.scenario import Scenario
from prolepsis.terms.errors import InputError, ProlepsisError

DROP = Path(__file__).parent.parent.parent / "examples" / "dropped_egg.toml"
HUGE = 10**5000
FACT: dict[str, Any] = {"kind": "fluent", "type": "broken", "args": ("egg1",), "start": 0.0, "end": 1.0}


def timeline(**changed: Any) -> Timeline:
    """Return a timeline of one fact, some of whose fields are as given."""
    return make_timeline([Fact(**{**FACT, **changed})], dt=0.001, duration=2.0)


NO_PATHS: list[Any] = [None, 3, b"x", object(), [], {}, "a\0b", "x" * 100_000, HUGE]
READERS: dict[str, Callable[[Any], object]] = {
    "project": project,
    "sweep": lambda path: sweep(path, {"seed": [1]}),
    "read_log": read_log,
    "Projection.load": prolepsis.Projection.load,
    "KnowledgeBase.load": KnowledgeBase.load,
    "out": lambda path: project(DROP, out=path if path is not None else 0),  # type: ignore[arg-type]
}


@pytest.mark.parametrize("path", NO_PATHS, ids=lambda path: type(path).__name__)
@pytest.mark.parametrize("reader", READERS)
def test_what_is_no_path_is_refused(reader: str, path: Any) -> None:
    with pytest.raises(InputError) as refused:
        READERS[reader](path)
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 300


WRONG: dict[str, tuple[Callable[[], object], str]] = {
    "settings": (lambda: project(DROP, settings=cast(Any, 3)), "settings are numbers or texts by name"),
    "a setting": (lambda: project(DROP, settings={"seed": cast(Any, object())}), "settings are numbers or texts"),
    "a seed that is true": (lambda: project(DROP, settings={"seed": True}), "seed = True"),
    "a seed that floats cannot tell": (
        lambda: project(DROP, settings={"seed": 2.0**53}),
        "seed = 9007199254740992.0: must",
    ),
    "a seed that is rounded": (
        lambda: project(DROP, settings={"seed": "9007199254740993.0"}),
        "must be a whole number",
    ),
    "a fraction of a seed": (lambda: replace(Scenario.load(DROP), seed=cast(Any, 1.5)), "seed = 1.5: must be a whole"),
    "a number of particles": (lambda: replace(Scenario.load(DROP), particles=cast(Any, "5")), "particles = 5: must be"),
    "parameters": (lambda: replace(Scenario.load(DROP), parameters=cast(Any, [3])), r"parameters = \[3\]: give each"),
    "a parameter": (lambda: replace(Scenario.load(DROP), parameters={"F": cast(Any, 3)}), "give each variable's Param"),
    "knowledge": (
        lambda: replace(Scenario.load(DROP), knowledge=cast(Any, "x")),
        "knowledge = 'x': give numbers",
    ),
    "monitors": (lambda: replace(Scenario.load(DROP), monitors={"egg1": cast(Any, "load")}), "give lists of names by"),
    "a robot": (
        lambda: replace(Scenario.load(DROP), robot=cast(Any, ["pr2"])),
        "give the name of a robot",
    ),
    "a duration": (
        lambda: replace(Scenario.load(DROP), duration=cast(Any, "1 s")),
        "duration = '1 s': give a number",
    ),
    "a long duration": (
        lambda: replace(Scenario.load(DROP), duration=HUGE),
        "greater than 0 and at most 86,400",
    ),
    "a path of a scenario": (lambda: replace(Scenario.load(DROP), path=cast(Any, None)), "path = None: give a Path"),
    "a draw that is a text": (lambda: replace(Scenario.load(DROP), draw=cast(Any, "false")), "draw = false: must be"),
    "values": (lambda: sweep(DROP, {"seed": "123"}), "values to sweep over are lists by name"),
    "a value": (lambda: sweep(DROP, {"seed": [cast(Any, None)]}), "settings are numbers or texts"),
    "a fact": (lambda: make_timeline([cast(Any, None)], dt=0.001, duration=1.0), "fact 1: not a fact: None"),
    "kind": (lambda: timeline(kind=None), "fact 1: no kind None; known: fluent, event"),
    "type": (lambda: timeline(type=None), "fact 1: not a fact"),
    "args": (lambda: timeline(args=None), "fact 1: not a fact"),
    "an argument": (lambda: timeline(args=(HUGE,)), "fact 1: not a fact"),
    "start": (lambda: timeline(start=math.nan), "fact 1: not a fact"),
    "end": (lambda: timeline(end=None), "fact 1: not a fact"),
    "evidence": (lambda: timeline(evidence=None), "fact 1: not a fact"),
    "a piece of evidence": (lambda: timeline(evidence={"force": math.nan}), "fact 1: not a fact"),
    "no tick": (lambda: make_timeline([Fact(**FACT)], dt=0.0, duration=1.0), "dt: a time above 0 s, not 0.0"),
    "a tick of nan": (lambda: make_timeline([], dt=math.nan, duration=1.0), "dt: a time above 0 s, not nan"),
    "duration": (lambda: make_timeline([], dt=0.001, duration=-1.0), "duration: a time above 0 s, not -1"),
    "no goal": (lambda: timeline().ask(cast(Any, None)), "a goal is text"),
    "bytes": (lambda: timeline().ask(cast(Any, b"holds(F, T)")), "a goal is text, as 'holds.F, T.', not bytes"),
    "limit": (lambda: timeline().ask("true", limit=cast(Any, "3")), "limit: a whole number"),
    "time limit": (lambda: timeline().ask("true", time_limit=cast(Any, "x")), "time_limit: a number of seconds"),
    "log": (lambda: recognize(cast(Any, None)), "a log is recognized, .* not NoneType"),
    "term": (lambda: parse_term(cast(Any, None)), "term: a term is read from text, not from NoneType"),
    "a number of a term": (lambda: format_value(Term("f", (HUGE,))), "a number of some 4,9.* digits is too long"),
}


@pytest.mark.parametrize("what", WRONG)
def test_what_is_wrong_in_a_call_is_said_where_it_is_given(what: str) -> None:
    call, words = WRONG[what]
    with pytest.raises(ProlepsisError, match=words) as refused:
        call()
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 300


@pytest.mark.parametrize("seed", [2**53 + 1, 2**63 - 1, str(2**63 - 1)])
def test_a_large_seed_is_what_it_is(seed: int | str) -> None:
    assert Scenario.load(DROP, {"seed": seed}).seed == int(seed)
