"""Nothing goes through solid matter, or stays in it, and the run is still an answer."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from tests.scenes import PREFIX, run

from prolepsis.cli import main
from prolepsis.projection import project
from prolepsis.terms.errors import InvalidSimulationError, KnowledgeError

FLOOR = ":floor a :Floor . "
TABLE = FLOOR + ":table1 a :Table . "


def block(name: str, size: tuple[float, float, float], rest: str) -> str:
    """Return a block of a length, width and height [m]."""
    x, y, z = size
    return f":{name} a :Block ; :length {x!r} ; :width {y!r} ; :height {z!r} ; {rest} . "


def board(length: float, width: float, height: float, rest: str = ":x 0.0") -> str:
    """Return a board that is fixed half a metre above the floor."""
    return f":board a :Obstacle ; :z 0.5 ; :length {length!r} ; :width {width!r} ; :height {height!r} ; {rest} . "


FAST = {
    "a cube of 1 cm from 8 m": (TABLE + block("b", (0.01, 0.01, 0.01), ":z 8.0"), 1.4, "table1"),
    "a plate of 2 mm from 10 m": (TABLE + block("b", (0.1, 0.1, 0.002), ":z 10.0"), 1.6, "table1"),
    "a block of 100 kg from 20 m": (TABLE + block("b", (0.15, 0.15, 0.15), ":z 20.0 ; :mass 100.0"), 2.2, "table1"),
    "a plank from 10 m with one end over the table": (
        TABLE + block("b", (0.8, 0.02, 0.01), ":x 0.55 ; :z 10.0"),
        1.6,
        "table1",
    ),
    "a cube of 3 mm from 15 m on the floor": (FLOOR + block("b", (0.003, 0.003, 0.003), ":z 15.0"), 2.0, "floor"),
    "a cube of 1 cm from 3 m on a fixed board of 2 mm": (
        FLOOR + board(0.3, 0.3, 0.002) + block("b", (0.01, 0.01, 0.01), ":z 3.5"),
        1.0,
        "board",
    ),
    "two cubes, the upper from 20 m through one of a kilogram": (
        FLOOR + block("a", (0.1, 0.1, 0.02), ":on :floor ; :mass 1.0") + block("b", (0.01, 0.01, 0.01), ":z 20.0"),
        2.2,
        "a",
    ),
}
"""What is dropped, for how long it is simulated [s], and what it falls on."""


@pytest.mark.parametrize("what", FAST)
def test_what_falls_fast_or_on_something_thin_is_an_answer(what: str) -> None:
    turtle, duration, obstacle = FAST[what]
    log = run(turtle, duration=duration)
    assert {log.index("b"), log.index(obstacle)} in [
        {*pair} for pair in zip(log.contacts.a, log.contacts.b, strict=True)
    ]


CROSSED: dict[str, tuple[str, dict[str, tuple[float, ...]], str]] = {
    "a bullet": (
        FLOOR + board(0.3, 0.3, 0.0005) + block("b", (0.001, 0.001, 0.001), ":z 1.5"),
        {"b": (0.0, 0.0, -180.0, 0.0, 0.0, 0.0)},
        "b has gone into board",
    ),
    "sheets of a fiftieth of a millimetre": (
        TABLE
        + "".join(block(f"s{k}", (0.1, 0.1, 2.0e-5), f":on :{'table1' if k == 0 else f's{k - 1}'}") for k in range(5))
        + block("b", (0.1, 0.1, 0.1), ":on :s4"),
        {},
        "s0 has gone into s1",
    ),
}
"""What goes through something all the same: what there is, how fast it moves at first, and what is said."""


@pytest.mark.parametrize("what", CROSSED)
def test_what_crosses_solid_matter_is_no_answer(what: str) -> None:
    turtle, thrown, told = CROSSED[what]
    with pytest.raises(InvalidSimulationError, match=rf"at [0-9.]+ s {told} or through it"):
        run(turtle, duration=0.3, thrown=thrown)


HOUSEHOLD = {
    "coin": block("b", (0.024, 0.024, 0.002), ":z {!r}"),
    "cube of 1 cm": block("b", (0.01, 0.01, 0.01), ":z {!r}"),
    "cube of 5 cm": block("b", (0.05, 0.05, 0.05), ":z {!r}"),
    "cup": ":b a :Cup ; :z {!r} . ",
    "book": block("b", (0.24, 0.16, 0.03), ":z {!r} ; :mass 0.8"),
}


def dropped(what: str, below: str, height: float, max_step: float) -> float:
    """Drop something and return where it ends [m]."""
    top = 0.7 if below == TABLE else 0.0
    duration = math.sqrt(2.0 * height / 9.81) + 0.2
    log = run(below + HOUSEHOLD[what].format(top + height), duration=duration, max_step=max_step)
    return float(log.poses[-1, [thing.name for thing in log.things].index("b"), 2]) - top


@pytest.mark.parametrize("what", ["coin", "cup"])
def test_what_falls_two_metres_in_a_household_comes_back(what: str) -> None:
    assert dropped(what, TABLE, 2.0, 0.0005) > -0.002


@pytest.mark.parametrize("height", [1.0, 2.0])
def test_shards_that_sink_into_the_floor_for_a_moment_come_back(height: float) -> None:
    log = run(f"{FLOOR} :egg1 a :Egg ; :z {height!r} .", duration=math.sqrt(height / 4.905) + 0.2)
    assert len(log.detachments.tick) > 0


@pytest.mark.laws
@pytest.mark.parametrize("max_step", [0.001, 0.0005, 0.00025])
@pytest.mark.parametrize("height", [1.0, 2.0, 3.0])
@pytest.mark.parametrize("below", [FLOOR, TABLE], ids=["floor", "table"])
@pytest.mark.parametrize("what", HOUSEHOLD)
def test_what_falls_in_a_household_comes_back_at_every_substep(
    what: str, below: str, height: float, max_step: float
) -> None:
    assert dropped(what, below, height, max_step) > -0.002
    assert dropped(what, below, height + 1e-6, max_step) > -0.002


def test_what_begins_inside_solid_matter_is_refused() -> None:
    with pytest.raises(KnowledgeError, match="b and board overlap by 210.0 mm at the start"):
        run(FLOOR + board(0.4, 0.4, 0.4) + block("b", (0.02, 0.02, 0.02), ":z 0.5"), duration=0.1)


PRESSED = {
    "a cube of 10 g under 100 kg": (
        TABLE
        + block("e", (0.05, 0.05, 0.05), ":on :table1 ; :mass 0.01")
        + block("b", (0.15, 0.15, 0.15), ":on :e ; :mass 100.0"),
        "table1",
    ),
    "a light cube that 100 kg squeeze out below a board of 4 mm": (
        FLOOR
        + board(0.3, 0.3, 0.004)
        + block("e", (0.02, 0.02, 0.02), ":on :board ; :mass 0.002")
        + block("c", (0.15, 0.15, 0.15), ":on :e ; :mass 100.0"),
        "(e|board)",
    ),
}
"""What lies under what, and what is pressed into what."""


@pytest.mark.parametrize("what", PRESSED)
def test_what_is_pressed_into_something_is_no_answer(what: str) -> None:
    turtle, below = PRESSED[what]
    with pytest.raises(InvalidSimulationError, match=rf"at 0\.[0-9]+ s [ec] is pressed [0-9.]+ mm into {below}"):
        run(turtle, duration=0.3)


SHEET = block("sheet", (0.2, 0.2, 0.0001), ":on :table1")
HEAVY = block("b", (0.15, 0.15, 0.15), ":on :sheet ; :mass 100.0")


@pytest.mark.parametrize(
    ("turtle", "first"),
    [
        (TABLE + SHEET + HEAVY, "table1"),
        (FLOOR + board(0.3, 0.3, 0.02) + SHEET.replace("table1", "board") + HEAVY, "board"),
    ],
)
def test_what_touches_through_a_sheet_is_no_answer(turtle: str, first: str) -> None:
    words = (
        rf"at 0\.0[0-9]+ s ({first} reaches b|b reaches {first}) through sheet: .* too soft for what is 0\.1 mm thick"
    )
    with pytest.raises(InvalidSimulationError, match=words):
        run(turtle, duration=0.3)


def test_thin_sheets_bear_a_book() -> None:
    sheets = "".join(
        block(f"cd{k}", (0.12, 0.12, 0.0005), f":on :{'table1' if k == 1 else f'cd{k - 1}'}") for k in range(1, 5)
    )
    log = run(TABLE + sheets + block("b", (0.2, 0.14, 0.03), ":on :cd4 ; :mass 0.5"), duration=0.3)
    assert log.poses[-1, log.index("b"), 2] == pytest.approx(0.7 + 0.002 + 0.015, abs=5e-4)


def test_what_stands_beside_is_not_between() -> None:
    upright = block("sheet", (0.0006, 0.1, 0.1), ":on :table1 ; :x 0.0504")
    log = run(TABLE + block("b", (0.1, 0.1, 0.1), ":on :table1") + upright, duration=0.4)
    assert len(log.contacts.tick)


@pytest.mark.parametrize("height", [1.6, 4.0])
def test_no_shard_goes_through_the_bottom_of_a_bowl(height: float) -> None:
    bowl = ":bowl1 a :Bowl ; :on :table1 ; :radius 0.12 ; :height 0.08 . "
    log = run(TABLE + bowl + f":egg1 a :Egg ; :z {height} . ", duration=math.sqrt(2 * (height - 0.72) / 9.81) + 0.3)
    bodies: list[int] = np.unique(log.carrier[-1]).tolist()
    shards = [i for i in bodies if "Piece" in log.things[i].roles]
    assert len(shards) > 5
    # The table is 0.7 m high, and the bowl as thick as 2 mm.
    assert (log.poses[-1, shards, 2] > 0.705).all()


def test_a_crossing_ends_a_projection_with_status_3(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "s.ttl").write_text(PREFIX + CROSSED["sheets of a fiftieth of a millimetre"][0], encoding="utf-8")
    (tmp_path / "s.toml").write_text('situation = "s.ttl"\nplan = "wait(0.5)"\nduration = 0.6\n', encoding="utf-8")
    with pytest.raises(InvalidSimulationError, match="s0 has gone into s1"):
        project(tmp_path / "s.toml")
    assert main(["project", str(tmp_path / "s.toml"), "--out", str(tmp_path / "out")]) == 3
    told = capsys.readouterr().err.strip()
    assert re.fullmatch(r"prolepsis: at 0\.0\d\d s s0 has gone into s1 or through it: contacts are too soft .*", told)
    assert not (tmp_path / "out").exists()


FRAME = "".join(
    f":side{k} a :Obstacle ; :z 0.5 ; {place} . "
    for k, place in enumerate(
        (
            ":x 0.06 ; :length 0.06 ; :width 0.2 ; :height 0.01",
            ":x -0.06 ; :length 0.06 ; :width 0.2 ; :height 0.01",
            ":y 0.06 ; :length 0.06 ; :width 0.06 ; :height 0.01",
            ":y -0.06 ; :length 0.06 ; :width 0.06 ; :height 0.01",
        )
    )
)
"""A board with a square opening of 6 cm."""
NOT_CROSSED = {
    "a ball through an opening": FLOOR + FRAME + ":b a :Ball ; :z 1.0 ; :radius 0.025 .",
    "a ball into a bowl": TABLE + ":bowl1 a :Bowl ; :on :table1 . :b a :Ball ; :z 1.2 ; :radius 0.02 .",
    "a cube of 1 cm from a metre": TABLE + block("b", (0.01, 0.01, 0.01), ":z 1.7"),
    "a lid of 2 mm from half a metre": TABLE + block("b", (0.1, 0.1, 0.002), ":z 1.2"),
    "card under a heavy book": TABLE
    + block("b", (0.2, 0.1, 0.002), ":on :table1")
    + block("book", (0.2, 0.15, 0.04), ":on :b ; :mass 2.0"),
    "a heavy book that falls on a sheet": TABLE
    + block("b", (0.2, 0.1, 0.002), ":on :table1")
    + block("book", (0.2, 0.15, 0.04), ":z 0.9 ; :mass 2.0"),
    "a ruler that slides off the edge": TABLE + block("b", (0.3, 0.03, 0.003), ":x 0.4 ; :z 0.72 ; :pitch 20.0"),
    "cubes side by side": TABLE
    + block("a", (0.05, 0.05, 0.05), ":on :table1")
    + block("b", (0.05, 0.05, 0.05), ":on :table1 ; :x 0.0501"),
}


@pytest.mark.parametrize("what", NOT_CROSSED)
def test_what_goes_round_or_gives_way_a_little_is_an_answer(what: str) -> None:
    log = run(NOT_CROSSED[what], duration=0.7)
    assert log.poses[-1, log.index("b"), 2] > 0.0
