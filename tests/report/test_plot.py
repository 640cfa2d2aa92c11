"""Plots of channels: what is drawn can be seen, what cannot be drawn is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from prolepsis.report.plot import COLOURS, Line, plot_lines
from prolepsis.terms.errors import InputError

TIME = np.linspace(0.0, 2.0, 20001)


def coloured(file: Path, colour: str) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Return where a picture has about a colour, shape (height, width)."""
    wanted = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)])
    shown = np.asarray(Image.open(file).convert("RGB"), dtype=np.int64)
    return np.abs(shown - wanted).max(axis=2) < 90


def test_a_peak_of_one_sample_is_drawn_up_to_its_top(tmp_path: Path) -> None:
    force = np.where(np.arange(len(TIME)) == 7777, 40.0, 0.0)
    plot_lines([Line(name="force", x=TIME, y=force)], tmp_path / "a.png", x_label="time [s]", y_label="force [N]")
    rows, columns = np.nonzero(coloured(tmp_path / "a.png", COLOURS[0])[16:250, 70:700])
    assert rows.min() < 10
    assert columns[rows < 100].mean() + 70 == pytest.approx(62 + 0.77770 / 2.0 * (720 - 62 - 14), abs=3)


def test_each_line_has_its_colour(tmp_path: Path) -> None:
    lines = [Line(name=f"line {k}", x=TIME, y=np.full(len(TIME), float(k))) for k in range(2)]
    plot_lines(lines, tmp_path / "a.png", x_label="time [s]", y_label="force [N]")
    assert all(coloured(tmp_path / "a.png", colour).sum() > 500 for colour in COLOURS[:2])


@pytest.mark.parametrize(("lines", "name"), [([], "a.png"), ([Line(name="x", x=TIME, y=TIME)], "a.jpg")])
def test_what_cannot_be_drawn_is_refused(tmp_path: Path, lines: list[Line], name: str) -> None:
    with pytest.raises(InputError):
        plot_lines(lines, tmp_path / name, x_label="time [s]", y_label="force [N]")
    assert not list(tmp_path.iterdir())
