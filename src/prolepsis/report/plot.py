"""A plot of lines over a common axis, as a small PNG: axes with units, round ticks and a legend."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from prolepsis.geometry.shape import FloatArray
from prolepsis.system.aside import written_aside
from prolepsis.terms.errors import InputError

SCALE = 2
"""Everything is drawn so many times larger first, for smooth lines."""
LEFT, RIGHT, TOP, BOTTOM = 62, 14, 14, 44
"""Margins round the axes [pixel]."""
COLOURS = ("#1f5fa8", "#c2491d", "#2b8a3e", "#7b3fa0", "#8a6d1d", "#3a3a3a")
INK, GRID = "#303036", "#e2e2e6"
TICKS = 5
"""An axis has about so many."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Line:
    """One line of a plot."""

    name: str
    """In the legend."""
    x: FloatArray
    """Shape (n,), in the unit that the axis tells."""
    y: FloatArray
    """Likewise."""


def plot_lines(
    lines: Sequence[Line], out: str | Path, *, x_label: str, y_label: str, size: tuple[int, int] = (720, 300)
) -> None:
    """Write a PNG with lines over a common axis.

    Args:
        lines: What to draw.
        out: File to write, ``.png``.
        x_label: What the lines are over, with its unit in brackets.
        y_label: What they show, likewise.
        size: Width and height [pixel].

    Raises:
        InputError: If there is nothing to draw, or the file's suffix is wrong.
    """
    from PIL import Image, ImageDraw, ImageFont

    target = Path(out).absolute()
    if target.suffix != ".png":
        raise InputError(f"{out}: a plot's name ends in .png")
    if not lines or not all(len(line.x) == len(line.y) > 0 for line in lines):
        raise InputError("a plot needs at least one line, each with as many values as times")
    width, height = (SCALE * side for side in size)
    left, right = SCALE * LEFT, width - SCALE * RIGHT
    top, bottom = SCALE * TOP, height - SCALE * BOTTOM
    image = Image.new("RGB", (width, height), "white")
    draw = ImageDraw.Draw(image)
    font = ImageFont.load_default(size=11 * SCALE)
    across, up = _ticks([line.x for line in lines]), _ticks([line.y for line in lines])

    def pixels(x: FloatArray, y: FloatArray) -> list[tuple[float, float]]:
        columns = left + (x - across[0]) / (across[-1] - across[0]) * (right - left)
        rows = bottom - (y - up[0]) / (up[-1] - up[0]) * (bottom - top)
        return [(float(c), float(r)) for c, r in zip(columns, rows, strict=True)]

    for value, text in zip(across, _texts(across), strict=True):
        ((column, _),) = pixels(np.array([value]), np.array([up[0]]))
        draw.line([(column, top), (column, bottom)], fill=GRID, width=SCALE)
        draw.text((column, bottom + 4 * SCALE), text, font=font, fill=INK, anchor="ma")
    for value, text in zip(up, _texts(up), strict=True):
        ((_, row),) = pixels(np.array([across[0]]), np.array([value]))
        draw.line([(left, row), (right, row)], fill=GRID, width=SCALE)
        draw.text((left - 6 * SCALE, row), text, font=font, fill=INK, anchor="rm")
    draw.rectangle((left, top, right, bottom), outline=INK, width=SCALE)
    for line, colour in zip(lines, _colours(len(lines)), strict=True):
        points = pixels(*_thinned(line, right - left))
        draw.line(points if len(points) > 1 else [*points, *points], fill=colour, width=3 * SCALE // 2)
    draw.text(((left + right) / 2, height - 6 * SCALE), x_label, font=font, fill=INK, anchor="md")
    turned = Image.new("RGB", (height, 16 * SCALE), "white")
    ImageDraw.Draw(turned).text((height / 2, 8 * SCALE), y_label, font=font, fill=INK, anchor="mm")
    image.paste(turned.rotate(90, expand=True), (0, 0))
    if len(lines) > 1:
        for k, (line, colour) in enumerate(zip(lines, _colours(len(lines)), strict=True)):
            row = top + (10 + 15 * k) * SCALE
            draw.text((right - 32 * SCALE, row), line.name, font=font, fill=INK, anchor="rm")
            draw.line([(right - 26 * SCALE, row), (right - 8 * SCALE, row)], fill=colour, width=3 * SCALE)
    target.parent.mkdir(parents=True, exist_ok=True)
    with written_aside(target) as aside:
        image.resize(size, Image.Resampling.LANCZOS).save(aside, optimize=True)


def _ticks(values: Sequence[FloatArray]) -> FloatArray:
    """Return round values, evenly spaced, that enclose all of ``values``."""
    low, high = min(float(v.min()) for v in values), max(float(v.max()) for v in values)
    high = high if high > low else low + 1.0
    rough = (high - low) / TICKS
    power = 10.0 ** np.floor(np.log10(rough))
    step = power * next(factor for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= rough)
    return np.asarray(np.arange(np.floor(low / step + 1e-9), np.ceil(high / step - 1e-9) + 1) * step, dtype=np.float64)


def _texts(ticks: FloatArray) -> list[str]:
    return [f"{round(float(tick), 9):g}" for tick in ticks]


def _colours(count: int) -> list[str]:
    return [COLOURS[k % len(COLOURS)] for k in range(count)]


def _thinned(line: Line, columns: int) -> tuple[FloatArray, FloatArray]:
    """Return of a line the least and the greatest value of each column, in their order: no peak is lost."""
    if len(line.x) <= 4 * columns:
        return line.x, line.y
    starts = np.linspace(0, len(line.x), columns + 1).astype(int)
    kept = [
        first + k
        for first, last in zip(starts[:-1], starts[1:], strict=True)
        for k in sorted({int(np.argmin(line.y[first:last])), int(np.argmax(line.y[first:last]))})
    ]
    return line.x[kept], line.y[kept]
