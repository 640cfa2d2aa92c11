"""The page on grounding: its example runs as it stands, and it names every constant's value as it is."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from tests.fluents.worlds import FLOOR, STEP, ball, box, cup_geoms, free, roll, times, world

import prolepsis
from prolepsis.fluents import recognize
from prolepsis.fluents.observation import Observation
from prolepsis.fluents.registry import GROUNDINGS, fluent
from prolepsis.log.fact_types import EVENTS, FLUENTS
from prolepsis.log.log import Log
from prolepsis.log.timeline import Fact, Kind
from prolepsis.terms.errors import InputError

PAGE = Path(__file__).parents[2] / "docs" / "grounding.md"


def test_the_example_of_a_new_fluent_runs() -> None:
    _, source = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    groundings = list(GROUNDINGS)
    try:
        exec(compile(source, str(PAGE), "exec"), {"__name__": "page"})
        assert FLUENTS["upsideDown"].doc == "The thing's own upward axis points down."
        model, states = roll(world(FLOOR + box("a", "0 0 .05", turn="180 0 0") + box("b", ".3 0 .05")), 0.3)
        timeline = recognize(Log.from_mujoco(model, states, STEP))
        assert times(timeline, "upsideDown(a)") == [(0.0, 0.3)]
        assert not times(timeline, "upsideDown(b)")
    finally:
        GROUNDINGS[:] = groundings
        FLUENTS.pop("upsideDown", None)


def test_the_example_of_a_stuff_runs() -> None:
    source, _ = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    beads = "".join(ball(f"bead{k}", f"{0.02 * k - 0.01} 0 .0101", 0.006, 0.001) for k in range(2))
    model, states = roll(world(FLOOR + free("cup", "0 0 .0001", cup_geoms(0.03, 0.06)) + beads), 0.3)
    *statements, asked = source.strip().splitlines()
    known: dict[str, Any] = {"prolepsis": prolepsis, "model": model, "states": states}
    exec(compile("\n".join(statements), str(PAGE), "exec"), known)
    (answer,) = eval(asked, known)
    assert (answer["V"], answer["F"]) == ("cup", pytest.approx(1.0))


@pytest.mark.parametrize(
    ("kind", "type", "args", "message"),
    [
        ("fluent", "upsideDwon", ("a",), "not declared: no fluent named 'upsideDwon'; did you mean 'upsideDown'"),
        ("event", "upsideDown", ("a",), "not declared: no event named 'upsideDown'; known: absorbing, "),
        ("fluent", "upsideDown", ("a", "b"), r"finds upsideDown with 2 arguments; declared: upsideDown\(o\)"),
    ],
)
def test_what_a_grounding_finds_must_be_declared(kind: Kind, type: str, args: tuple[str, ...], message: str) -> None:
    groundings = list(GROUNDINGS)
    try:

        @fluent("upsideDown", "o")
        def upside_down(observation: Observation) -> list[Fact]:
            """The thing lies on its head."""
            return [observation.fact(kind, type, args, (0, 1))]

        model, states = roll(world(FLOOR + box("a", "0 0 .05")), 0.01)
        with pytest.raises(InputError, match=message):
            recognize(Log.from_mujoco(model, states, STEP))
    finally:
        GROUNDINGS[:] = groundings
        FLUENTS.pop("upsideDown", None)


def test_the_page_names_every_fluent_and_event() -> None:
    page = PAGE.read_text()
    for name in (*FLUENTS, *EVENTS):
        assert f"`{name}(" in page


def test_a_fluent_is_defined_once_with_the_same_arguments() -> None:
    with pytest.raises(InputError, match=r"fluent contacts: arguments \('a',\), but elsewhere \('o1', 'o2'\)"):
        fluent("contacts", "a")(lambda observation: [])
