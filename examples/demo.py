"""The paper's questions about an egg that is dropped and an egg that is grasped, answered by simulation.

Run it with ``make demo``. It prints the timeline of the drop, the answers to the paper's three queries, and what
twelve force levels do to the egg in a dry and in a wet hand; it leaves a video in ``out/``.
"""

from __future__ import annotations

from pathlib import Path

from prolepsis import Projection, project, sweep
from prolepsis.commands.output import bindings, progress_line, table
from prolepsis.commands.sweep import report
from prolepsis.commands.timeline import rows
from prolepsis.report.render import render_strip, render_video

HERE = Path(__file__).parent
OUT = Path("out")

AFTER_THE_SUPPORT = """\
holds(F1,T1), fluentT(F1,supports), objOf(F1,egg1),
after(T2,T1), occurs(E1,T2), objOf(E1,egg1)"""

AFTER_THE_GRASP = """\
occurs(E,T1), eventT(E,'ClosingGripper'),
argsOf(E, [rightGripper, {level}]), holds(F,T2),
after(T2,T1), fluent(F,Type), argsOf(F,Args)"""

SHOWN = 12
"""Answers that are printed of one query."""

LEVELS = [f"force{number}" for number in range(1, 13)]


def main() -> None:
    """Run the demo."""
    with progress_line(False) as show:
        drop = project(HERE / "dropped_egg.toml", out=OUT / "drop", progress=show)
    heading("An egg rests on a hand; the hand opens")
    print(table(rows(drop.timeline)))
    query(drop, AFTER_THE_SUPPORT)

    for level in ("force7", "force12"):
        heading(f"A dry hand grasps an egg with {level} and lifts it")
        with progress_line(False) as show:
            grasp = project(HERE / "grasp_egg.toml", out=OUT / level, progress=show, Force=level)
        query(grasp, AFTER_THE_GRASP.format(level=level))

    for hand, scenario in (("dry", "grasp_egg.toml"), ("wet", "wet_hand.toml")):
        heading(f"Twelve force levels, {hand} hand")
        with progress_line(False) as show:
            print(report(sweep(HERE / scenario, {"Force": LEVELS}, refine=3, progress=show)))

    heading("Pictures")
    render_strip(drop.log, OUT / "drop.png")
    with progress_line(False) as show:
        render_video(drop.log, OUT / "drop.mp4", speed=0.25, progress=lambda done: show(f"drawing: {done:.0%}"))
    print(f"{OUT / 'drop.mp4'} (four times slow motion) and {OUT / 'drop.png'}")


def heading(text: str) -> None:
    """Print a heading."""
    print(f"\n{text}\n{'=' * len(text)}", flush=True)


def query(projection: Projection, goal: str) -> None:
    """Print a goal and its answers."""
    print("\n?- " + goal.replace("\n", "\n   ") + ".\n")
    answers = projection.ask(goal)
    for answer in answers[:SHOWN]:
        print("   " + bindings(answer))
    if len(answers) > SHOWN:
        print(f"   ... and {len(answers) - SHOWN} more, later ones")


if __name__ == "__main__":
    main()
