"""Writes docs/experiments: runs each experiment from its files, and shows command, query, answer and pictures.

Run it with ``make experiments``; ``make experiments ARGS='--only pouring'`` writes one page, ``--keep`` uses what was
simulated before. An experiment is a TOML file beside this one, a page each, in the order of their titles. To add an
entry, write one of these tables into such a file (the keys below are all that there are):

    title = "Hitting an egg"             # of the page
    text = "What it asks, and what was found."
    [[run]]                              # one projection
    name = "gentle"                      # of its folder and pictures; unique on the page
    scenario = "pr2_hit.toml"            # in examples/
    set = { Speed = 0.1 }                # as --set; optional, as all below
    text = "A gentle blow."
    ask = ["holds(broken(X), T)"]        # goals, with their answers
    limit = 6                            # answers that are shown
    times = [0, 1.5, 2.0]                # of the strip of pictures [s]; without it there is none
    view = { azimuth = 150, elevation = -20 }    # of the camera [degree]
    part = [0.5, 0.3, 1.0, 0.8]          # of the view: left, top, right, bottom as shares
    plot = [{ channels = ["egg1.force"], label = "force on the egg [N]", start = 1.0, end = 2.0 }]
    must = ["broken(egg1)"]              # what is expected at the end: fluents, or goals with holds or occurs
    must_not = ["spilled(yolk1)"]        # and what is not; a table at the end of the page sets this beside the outcome
    miss = "Why the outcome is another."
    [[sweep]]                            # the same scenario at several values
    name = "levels"
    scenario = "pr2_grasp.toml"
    over = { Force = ["force1", "force2"] }
    refine = 3                           # halvings of each transition force

All runs come first on a page, then the sweeps, then the table of expectations.
"""

from __future__ import annotations

import argparse
import os
import shlex
import sys
import time
import tomllib
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
from pydantic import BaseModel, ConfigDict

from prolepsis import InputError, Projection, ProlepsisError, project, sweep
from prolepsis.commands.output import bindings, progress_line
from prolepsis.commands.sweep import report
from prolepsis.report.plot import Line, plot_lines
from prolepsis.report.render import render_strip

HERE = Path(os.path.relpath(Path(__file__).parent))
EXAMPLES = HERE.parent
PAGES = EXAMPLES.parent / "docs" / "experiments"
OUT = Path("out/experiments")
SHOWN = 8
"""Answers that are shown of a goal if nothing is said."""
PICTURE = (300, 300)
"""Size of each moment of a strip [pixel]."""
LARGEST = 150_000
"""Size of a picture's file [byte]."""

Number = int | float
Values = dict[str, Number | str | bool]


class Strict(BaseModel):
    """A table whose keys are checked."""

    model_config = ConfigDict(extra="forbid")


class Plot(Strict):
    """Channels of the log over time."""

    channels: list[str]
    label: str
    start: Number = 0.0
    end: Number | None = None


class Run(Strict):
    """One projection."""

    name: str
    scenario: str
    set: Values = {}
    text: str = ""
    ask: list[str] = []
    limit: int = SHOWN
    times: list[Number] = []
    view: dict[str, Number] = {}
    part: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0)
    plot: list[Plot] = []
    must: list[str] = []
    must_not: list[str] = []
    miss: str = ""


class Sweep(Strict):
    """The same scenario at several values."""

    name: str
    scenario: str
    over: dict[str, list[Number | str]]
    set: Values = {}
    text: str = ""
    ask: str | None = None
    limit: int | None = None
    refine: int = 0


class Experiment(Strict):
    """One page."""

    title: str
    text: str
    run: list[Run] = []
    sweep: list[Sweep] = []


def main() -> None:
    """Write the pages that are asked for."""
    parser = argparse.ArgumentParser(description="Run the experiments and write docs/experiments.")
    parser.add_argument("--only", action="append", metavar="NAME", help="write this page only; may be repeated")
    parser.add_argument("--keep", action="store_true", help="use projections in out/experiments that are there")
    given = parser.parse_args()
    files = {file.stem: file for file in sorted(HERE.glob("*.toml"))}
    for name in given.only or []:
        if name not in files:
            sys.exit(f"--only {name}: no such experiment; known: {', '.join(files)}")
    experiments = {name: Experiment.model_validate(tomllib.loads(file.read_text())) for name, file in files.items()}
    experiments = dict(sorted(experiments.items(), key=lambda item: item[1].title))
    PAGES.mkdir(parents=True, exist_ok=True)
    for name, experiment in experiments.items():
        if given.only and name not in given.only:
            continue
        page = "\n\n".join(_page(name, experiment, keep=given.keep))
        (PAGES / f"{name}.md").write_text(page + "\n", encoding="utf-8")
        _tell(f"{PAGES / name}.md written")
    rows = [f"| [{each.title}]({name}.md) | {_first_sentence(each.text)} |" for name, each in experiments.items()]
    index = ["# The experiments", "Written by `make experiments` from `examples/experiments/*.toml`."]
    index.append("\n".join(["| experiment | asks |", "|---|---|", *rows]))
    (PAGES / "README.md").write_text("\n\n".join(index) + "\n", encoding="utf-8")


def _page(name: str, experiment: Experiment, *, keep: bool) -> Iterator[str]:
    """Yield the paragraphs of a page."""
    yield f"# {experiment.title}"
    yield experiment.text.strip()
    expectations: list[str] = []
    for run in experiment.run:
        _tell(f"{name}: {run.name}")
        try:
            done = _projection(name, run, keep=keep)
        except ProlepsisError as error:
            # That it is refused may be what is expected: the message is the answer.
            yield from _heading(run, "project")
            yield _quoted(f"{type(error).__name__}: {error}")
            expectations.append(_row(run, "refused", ["refused"] if "refused" in run.must else []))
            continue
        yield from _shown(name, run, done)
        if run.must or run.must_not:
            expectations.append(_outcome(run, done))
    for each in experiment.sweep:
        _tell(f"{name}: {each.name}")
        yield from _swept(each)
    if expectations:
        yield "## Expected and projected"
        head = ["| file | expected at the end | not expected | projected | why |", "|---|---|---|---|---|"]
        yield "\n".join([*head, *expectations])


def _projection(page: str, run: Run, *, keep: bool) -> Projection:
    folder = OUT / page / run.name
    if keep and folder.exists():
        return Projection.load(folder)
    with progress_line(True) as show:
        return project(EXAMPLES / run.scenario, out=folder, settings=_settings(run.set), progress=show)


def _shown(page: str, run: Run, done: Projection) -> Iterator[str]:
    """Yield what is told of one projection."""
    yield from _heading(run, f"project --out {shlex.quote(str(OUT / page / run.name))}")
    for goal in run.ask:
        answers = done.ask(goal)
        lines = [bindings(answer) for answer in answers[: run.limit]] or ["no"]
        if len(answers) > run.limit:
            lines.append(f"... and {len(answers) - run.limit} more")
        yield "```prolog\n?- " + goal.strip().replace("\n", "\n   ") + ".\n\n" + "\n".join(lines) + "\n```"
    # A run that ends sooner than others of its page is shown at its end once.
    times = list(dict.fromkeys(min(float(t), round(done.log.tick_count * done.log.dt, 1)) for t in run.times))
    if times:
        file = _picture(page, run.name)
        render_strip(done.log, file, times=times, size=PICTURE, part=run.part, **run.view)
        _shrink(file)
        yield f"![{run.name} at {', '.join(f'{t:g}' for t in times)} s](pictures/{file.name})"
    for k, plot in enumerate(run.plot):
        file = _picture(page, f"{run.name}_plot{k}")
        _draw(done, plot, file)
        yield f"![{plot.label} over time](pictures/{file.name})"


def _draw(done: Projection, plot: Plot, file: Path) -> None:
    log = done.log
    for channel in plot.channels:
        if channel not in log.channels:
            raise InputError(f"no channel {channel!r} in the log; known: {', '.join(sorted(log.channels))}")
    shown = (log.time >= plot.start) & (log.time <= (np.inf if plot.end is None else plot.end))
    lines = [Line(name=each, x=log.time[shown], y=log.channels[each][shown]) for each in plot.channels]
    plot_lines(lines, file, x_label="time [s]", y_label=plot.label)


def _swept(given: Sweep) -> Iterator[str]:
    """Yield what is told of a sweep."""
    over = [f"--over {shlex.quote(f'{name}=' + ','.join(map(str, values)))}" for name, values in given.over.items()]
    ask = [f"--ask {shlex.quote(given.ask)}"] if given.ask else []
    refine = [f"--refine {given.refine}"] if given.refine else []
    yield from _heading(given, " ".join(["sweep", *over, *ask, *refine]))
    start = time.perf_counter()
    with progress_line(True) as show:
        outcomes = sweep(
            EXAMPLES / given.scenario,
            given.over,
            ask=given.ask,
            settings=_settings(given.set),
            limit=given.limit,
            refine=given.refine,
            progress=show,
        )
    _tell(f"  {time.perf_counter() - start:.0f} s")
    yield _quoted(report(outcomes))
    counts = Counter(row.grasp.outcome for row in outcomes.rows if row.grasp is not None)
    if counts:
        yield "Together: " + ", ".join(f"{outcome} {count}" for outcome, count in counts.items()) + "."


def _heading(given: Run | Sweep, command: str) -> Iterator[str]:
    verb, _, options = command.partition(" ")
    chosen = [f"--set {shlex.quote(f'{name}={value}')}" for name, value in given.set.items()]
    yield f"## {given.name}"
    if given.text:
        yield given.text.strip()
    words = ["prolepsis", verb, f"examples/{given.scenario}", *chosen, *([options] if options else [])]
    yield f"```sh\n{' '.join(words)}\n```"


def _outcome(run: Run, done: Projection) -> str:
    """Return the row of a run in the table of expectations."""
    end = done.timeline.duration - done.log.dt

    def holds(goal: str) -> bool:
        asked = goal if "holds" in goal or "occurs" in goal else f"holds_at({goal}, {end!r})"
        return bool(done.ask(asked, 1))

    right = [goal for goal in run.must if holds(goal)]
    wrong = [f"not {goal}" for goal in run.must if goal not in right]
    wrong += [goal for goal in run.must_not if holds(goal)]
    return _row(run, "as expected" if not wrong else "but: " + _cell(wrong), right if wrong else [])


def _row(run: Run, outcome: str, right: list[str]) -> str:
    shown = f"{_cell(right)}; {outcome}" if right and outcome != "refused" else outcome
    link = f"[{run.scenario}](../../examples/{run.scenario})" + "".join(f", {n} = {v}" for n, v in run.set.items())
    return f"| {link} | {_cell(run.must)} | {_cell(run.must_not)} | {shown} | {run.miss} |"


def _cell(goals: list[str]) -> str:
    return ", ".join(f"`{goal}`" for goal in goals)


def _quoted(text: str) -> str:
    return f"```\n{text}\n```"


def _settings(values: Mapping[str, Number | str | bool]) -> dict[str, float | str]:
    return {name: str(value).lower() if isinstance(value, bool) else value for name, value in values.items()}


def _first_sentence(text: str) -> str:
    return " ".join(text.split()).partition(". ")[0].rstrip(".") + "."


def _picture(page: str, name: str) -> Path:
    # A link must not have spaces in it.
    return PAGES / "pictures" / f"{page}_{name.replace(' ', '_')}.png"


def _shrink(file: Path) -> None:
    """Write a picture with as many colours as fit."""
    from PIL import Image

    picture = Image.open(file).convert("RGB")
    for colours in (256, 128, 64, 32):
        # The default method spends its colours on large areas: a yolk, which is small, turns brown.
        few = picture.quantize(colours, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
        few.save(file, optimize=True)
        if file.stat().st_size <= LARGEST:
            return


def _tell(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
