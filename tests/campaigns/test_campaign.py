"""A sweep keeps the order of its values, and one run that fails does not spoil the others."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from prolepsis.campaigns.campaign import Outcomes, Row, sweep
from prolepsis.campaigns.outcome import Grasp
from prolepsis.cli import main
from prolepsis.terms.errors import InputError

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    shutil.copy(EXAMPLES / "dropped_egg.ttl", tmp_path)
    file = tmp_path / "short.toml"
    file.write_text('situation = "dropped_egg.ttl"\nplan = "wait(Time)"\nduration = 0.05\n[parameters]\nTime = 0.03\n')
    return file


def test_rows_stand_in_the_order_of_the_values_and_a_failing_run_is_a_row(scenario: Path) -> None:
    outcomes = sweep(scenario, {"Time": [0.04, -1.0, 0.02]}, ask="occurs(waiting(T), _)")
    assert [row.values["Time"] for row in outcomes.rows] == [0.04, -1.0, 0.02]
    assert [row.answers for row in outcomes.rows] == [[{"T": 0.04}], None, [{"T": 0.02}]]
    failed = outcomes.rows[1]
    assert failed.error is not None
    assert "wait" in failed.error
    assert not failed.invalid


def test_the_command_prints_a_row_for_each_value(scenario: Path, capfd: pytest.CaptureFixture[str]) -> None:
    arguments = ["sweep", str(scenario), "--over", "time=0.01,0.02", "--ask", "occurs(waiting(0.02), T)"]
    assert main([*arguments, "--json"]) == 0
    rows = [json.loads(line) for line in capfd.readouterr().out.splitlines()]
    assert [row["values"] for row in rows] == [{"time": "0.01"}, {"time": "0.02"}]
    assert [len(row["answers"]) for row in rows] == [0, 1]
    assert main(["sweep", str(scenario), "--over", "Time=0.01", "--ask", "occurs(falling(egg1), T)"]) == 1
    assert [line.split() for line in capfd.readouterr().out.splitlines()] == [
        ["Time", "outcome"],
        ["0.01", "done"],
        ["no"],
        ["0", "of", "1", "runs", "have", "an", "answer"],
    ]


def test_the_seed_can_be_varied(scenario: Path) -> None:
    assert [row.error for row in sweep(scenario, {"seed": [1.0, 2.0]}).rows] == [None, None]
    for seed, message in ((1.5, "seed = 1.5: must be a whole number"), (-1.0, "seed = -1: allowed: 0 to")):
        with pytest.raises(InputError, match=message):
            sweep(scenario, {"seed": [seed]})


def test_runs_with_the_same_force_are_no_transition() -> None:
    held = Grasp(hand="hand1", object="egg1", level=5.0, outcome="hold", slip=0.0, peak_force=5.0, bonds_broken=0)
    rows = (
        Row(values={"seed": 1.0}, level=5.0, grasp=held),
        Row(values={"seed": 2.0}, level=5.0, grasp=replace(held, outcome="crush")),
    )
    assert not Outcomes(rows=rows).transitions()


def test_transitions_are_narrowed_down_by_further_runs() -> None:
    wide = sweep(EXAMPLES / "grasp_egg.toml", {"Force": [0.1, 5.0]})
    narrow = sweep(EXAMPLES / "grasp_egg.toml", {"Force": [0.1, 5.0]}, refine=2)
    assert len(narrow.rows) == 2
    assert len(narrow.between) == 2
    (before,), (after,) = wide.transitions(), narrow.transitions()
    assert (
        (before.below.outcome, before.above.outcome) == (after.below.outcome, after.above.outcome) == ("slip", "hold")
    )
    assert after.high / after.low == pytest.approx((before.high / before.low) ** 0.25)


def test_only_one_name_can_be_refined() -> None:
    with pytest.raises(InputError, match="only a sweep over one name"):
        sweep(EXAMPLES / "grasp_egg.toml", {"Force": [1.0], "Acceleration": [1.0, 2.0]}, refine=1)


def test_a_sweep_tells_an_action_that_fell_short_by_its_outcome(tmp_path: Path) -> None:
    (tmp_path / "s.ttl").write_text(
        "@prefix : <https://w3id.org/prolepsis#> . :floor a :Floor . :table1 a :Table . :hand1 a :Gripper ; :z 1.0 ."
    )
    (tmp_path / "s.toml").write_text(
        'situation = "s.ttl"\nplan = "lift(hand1, H)"\n[parameters]\nH = { value = -0.1, unit = "m" }\n'
    )
    outcomes = sweep(tmp_path / "s.toml", {"H": [-0.1, -0.6]})
    assert [row.outcome for row in outcomes.rows] == ["done", "in_collision"]


def test_a_sweep_tells_notes_with_the_run_that_they_are_about(
    scenario: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    goal = "occurs(falling(egg1), 0.5)"
    assert [row.notes for row in sweep(scenario, {"Time": [0.01, 0.02]}, ask="holds(broken(egg1), T)").rows] == [(), ()]
    assert main(["sweep", str(scenario), "--over", "Time=0.01,0.02", "--ask", goal]) == 1
    told = capfd.readouterr().err.splitlines()
    assert [line.partition(": no, but ")[0] for line in told] == ["prolepsis: note: Time=0.01; Time=0.02"]
    assert ".py" not in "".join(told)
    assert main(["sweep", str(scenario), "--over", "Time=0.01,0.02", "--ask", goal, "--json"]) == 1
    rows = [json.loads(line) for line in capfd.readouterr().out.splitlines()]
    assert all("the log tells nothing of 0.5 s" in row["notes"][0] for row in rows)
