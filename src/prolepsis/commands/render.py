"""``prolepsis render``: pictures of a saved projection, or of any saved log."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

from prolepsis.commands.output import add_command, add_progress, progress_line
from prolepsis.terms.errors import InputError

EXAMPLE = """\
  prolepsis render out/drop --out out/drop.mp4 --speed 0.25
  prolepsis render out/drop --frames out/frames --count 12
  prolepsis render out/drop --strip out/drop.png --times 0,0.3,0.5,1.0
"""


def add_to(commands: Any) -> None:
    """Add the command and its arguments."""
    parser = add_command(commands, "render", "draw a saved projection: video, frames or strip", EXAMPLE, run)
    parser.add_argument("folder", metavar="DIR", help="folder that `prolepsis project --out` saved")
    parser.add_argument("--out", metavar="VIDEO.mp4", help="write a video")
    parser.add_argument("--frames", metavar="DIR", help="write PNG frames into this folder")
    parser.add_argument("--strip", metavar="FILE.png", help="write one PNG with moments side by side")
    parser.add_argument(
        "--speed", type=float, default=1.0, metavar="X", help="simulated seconds a second of video; 0.25 is slow motion"
    )
    parser.add_argument("--count", type=int, metavar="N", help="number of frames (24) or moments of a strip (5)")
    parser.add_argument("--times", metavar="T1,T2,...", help="moments of the strip [s] instead of evenly spaced ones")
    parser.add_argument("--size", default="960x720", metavar="WxH", help="size of video and frames [pixel]")
    add_progress(parser)


def run(given: argparse.Namespace) -> int:
    """Draw what was asked for and print the names of the files."""
    if not (given.out or given.frames or given.strip):
        raise InputError("nothing to draw: give --out VIDEO.mp4, --frames DIR or --strip FILE.png")
    folder = Path(given.folder).resolve()
    for name in filter(None, (given.out, given.frames, given.strip)):
        if Path(name).resolve().is_relative_to(folder):
            # The next run would find a file that it did not write, and leave the folder alone.
            raise InputError(f"{name}: lies in the saved folder; give a name outside of {given.folder}")
    size = _size(given.size)
    times = None if given.times is None else [_number(time, "--times") for time in given.times.split(",")]
    from prolepsis.log.files import read_log
    from prolepsis.report.render import render_frames, render_strip, render_video

    log = read_log(given.folder)
    with progress_line(given.progress) as show:

        def tell(fraction: float) -> None:
            show(f"drawing: {fraction:.0%}")

        if given.out:
            render_video(log, given.out, speed=given.speed, size=size, progress=tell)
            print(given.out)
        if given.frames:
            count = 24 if given.count is None else given.count
            for file in render_frames(log, given.frames, count=count, size=size, progress=tell):
                print(file)
        if given.strip:
            count = 5 if given.count is None else given.count
            render_strip(log, given.strip, times=times, count=count, progress=tell)
            print(given.strip)
    return 0


def _size(text: str) -> tuple[int, int]:
    width, cross, height = text.partition("x")
    if not cross or not width.isdigit() or not height.isdigit():
        raise InputError(f"--size {text}: is not of the form WIDTHxHEIGHT, such as 960x720")
    size = int(width), int(height)
    if not all(16 <= side <= 4096 and side % 2 == 0 for side in size):
        raise InputError(f"--size {text}: each side is an even number from 16 to 4096")
    return size


def _number(text: str, option: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise InputError(f"{option}: {text!r} is no number of seconds")
    return number
