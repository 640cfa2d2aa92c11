"""A campaign: the same scenario at several values, each a projection in a process of its own."""

from __future__ import annotations

import itertools
import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

from prolepsis.campaigns.outcome import Grasp, judge_grasp
from prolepsis.log.plan_end import plan_outcome
from prolepsis.projection import Progress, project, read_scenario
from prolepsis.scenario.scenario import Scenario
from prolepsis.system.workers import Lost, carry_out
from prolepsis.terms.errors import InputError, InvalidSimulationError, Note, ProlepsisError, brief, error_line
from prolepsis.terms.terms import Value

WORKERS = 2
"""Projections at a time; each takes one core."""
MOST_RUNS = 10_000
"""Runs of one sweep: more would take days."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """What came out at one value, or why nothing did."""

    values: Mapping[str, float | str]
    """The swept values of this run by name, as given."""
    level: float | None = None
    """Commanded force of the grasp [N], also when the value is the name of a level."""
    grasp: Grasp | None = None
    """What became of the grasp, if the plan has one."""
    outcome: str = "done"
    """That of the plan: of the action that ended it, else of the last that fell short, else ``done``."""
    answers: Sequence[Mapping[str, Value]] | None = None
    """Answers to the goal, if one was given."""
    error: str | None = None
    """Why the run gave no answer, in one line."""
    invalid: bool = False
    """Whether it was the physics that failed."""
    unexpected: str | None = None
    """Of a failure that nobody foresaw, where it happened as Python tells it, or what became of the process."""
    notes: tuple[str, ...] = ()
    """What should be known of the run and its answers, each once."""
    unchecked: str = ""
    """Why it was not decided whether its knowledge contradicts itself; empty if it does not."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Transition:
    """Two neighbouring levels between which the outcome changes."""

    below: Grasp
    """At the lower level."""
    above: Grasp
    """At the higher level."""
    low: float
    """The lower level [N]."""
    high: float
    """The higher level [N]."""

    @property
    def force(self) -> float:
        """Middle of the two levels [N]; the true transition lies within ``(high - low) / 2`` of it."""
        return (self.low + self.high) / 2


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcomes:
    """One row for each combination of values, in the order given."""

    rows: tuple[Row, ...]
    """Outcomes, or errors."""
    between: tuple[Row, ...] = ()
    """Further runs between neighbouring levels of different outcome, which narrow the transitions down."""

    def __repr__(self) -> str:
        """Return it in a line, as a prompt shows it."""
        return f"Outcomes({len(self.rows)} runs, {sum(row.error is not None for row in self.rows)} of them failed)"

    def transitions(self) -> tuple[Transition, ...]:
        """Return where the outcome changes from one force level to the next higher one."""
        ranked = sorted(
            (
                (row.level, row.grasp)
                for row in (*self.rows, *self.between)
                if row.grasp is not None and row.level is not None
            ),
            key=lambda pair: pair[0],
        )
        return tuple(
            Transition(below=below, above=above, low=low, high=high)
            for (low, below), (high, above) in itertools.pairwise(ranked)
            if low < high and below.outcome != above.outcome
        )


def sweep(
    scenario: Scenario | str | Path,
    over: Mapping[str, Sequence[float | str]],
    *,
    ask: str | None = None,
    settings: Mapping[str, float | str] | None = None,
    limit: int | None = None,
    refine: int = 0,
    workers: int = WORKERS,
    progress: Progress | None = None,
) -> Outcomes:
    """Project a scenario at every combination of values.

    Args:
        scenario: A scenario, or its TOML file.
        over: Values by the name of a parameter or knowledge value, ``{"Force": [5, 20]}``.
        ask: Goal to ask of every run.
        settings: Values that are the same in all runs.
        limit: Greatest number of answers a run.
        refine: How many times to halve the interval of each transition force, by a run at its geometric middle.
        workers: Number of processes.
        progress: Called with how many runs are done.

    Returns:
        The outcomes, in the order of the values. A run that fails is a row with its error.

    Raises:
        InputError: If the scenario or the name of a value is wrong, so that no run could succeed.
    """
    if not _is_over(over):
        raise InputError(f"values to sweep over are lists by name, as {{'Force': [5, 20]}}, not {brief(over)}")
    if not over or not all(over.values()):
        raise InputError("there is nothing to sweep over; give at least one name with at least one value")
    names = list(over)
    if refine and len(names) > 1:
        raise InputError("only a sweep over one name, the force of a grasp, can be refined")
    count = math.prod(len(values) for values in over.values())
    if count > MOST_RUNS:
        raise InputError(f"{count} combinations of values; allowed: {MOST_RUNS}")
    runs = [dict(zip(names, values, strict=True)) for values in itertools.product(*over.values())]
    # What is wrong with a file or a name is told once, before any process starts.
    base = read_scenario(scenario, settings or {})
    base.refuse_twice([*(settings or {}), *over])
    scenarios = [base.with_settings(run) for run in runs]
    outcomes = Outcomes(rows=_all(workers, scenarios, runs, ask, limit, progress))
    for _ in range(refine):
        middles = [(each.low * each.high) ** 0.5 for each in outcomes.transitions()]
        halves: list[dict[str, float | str]] = [{names[0]: middle} for middle in middles]
        if halves:
            more = _all(workers, [base.with_settings(half) for half in halves], halves, ask, limit, progress)
            outcomes = replace(outcomes, between=(*outcomes.between, *more))
    return outcomes


def _is_over(over: object) -> bool:
    if not isinstance(over, Mapping):
        return False
    values = cast("Mapping[object, object]", over).values()
    return all(isinstance(each, Sequence) and not isinstance(each, str) for each in values)


def _all(
    workers: int,
    scenarios: Sequence[Scenario],
    runs: Sequence[dict[str, float | str]],
    ask: str | None,
    limit: int | None,
    progress: Progress | None,
) -> tuple[Row, ...]:
    """Return the rows of scenarios, in their order."""
    rows: dict[int, Row] = {}
    tasks = [(scenarios[i], run, ask, limit) for i, run in enumerate(runs)]
    with closing(carry_out(_run, tasks, workers)) as results:
        for number, found in results:
            rows[number] = _lost(runs[number], found) if isinstance(found, Lost) else found
            if progress is not None:
                progress(f"{len(rows)} of {len(runs)} runs done")
    return tuple(rows[i] for i in range(len(runs)))


def _lost(values: dict[str, float | str], lost: Lost) -> Row:
    return Row(values=values, error=error_line(lost.reason), unexpected=lost.trace or lost.reason)


def _run(scenario: Scenario, values: dict[str, float | str], ask: str | None, limit: int | None) -> Row:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", Note)
        row = _row(scenario, values, ask, limit)
    for each in caught:
        if not issubclass(each.category, Note):
            warnings.warn_explicit(each.message, each.category, each.filename, each.lineno)
    notes = dict.fromkeys(str(each.message) for each in caught if issubclass(each.category, Note))
    return replace(row, notes=tuple(notes))


def _row(scenario: Scenario, values: dict[str, float | str], ask: str | None, limit: int | None) -> Row:
    try:
        result = project(scenario)
        answers = None if ask is None else result.ask(ask, limit)
        grasp = judge_grasp(result.timeline, result.log) if result.timeline.select(type="grasping") else None
    except ProlepsisError as error:
        return Row(values=values, error=str(error), invalid=isinstance(error, InvalidSimulationError))
    unchecked = result.timeline.domain.unchecked
    level = _newtons(grasp, result.scene.number)
    outcome = plan_outcome(result.timeline)
    return Row(values=values, level=level, grasp=grasp, outcome=outcome, answers=answers, unchecked=unchecked)


def _newtons(grasp: Grasp | None, number: Callable[[str, str], float | None]) -> float | None:
    """Return the commanded force [N] of a grasp; of a named level, what the knowledge base says."""
    if grasp is None or grasp.level is None:
        return None
    return number(grasp.level, "force") if isinstance(grasp.level, str) else float(grasp.level)
