"""A strip of pictures may show a part of the whole view, larger."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from tests.scenes import EGG_IN_HAND, run

from prolepsis.report.render import render_strip
from prolepsis.terms.errors import InputError


def test_a_part_is_what_the_whole_shows_there(tmp_path: Path) -> None:
    log = run(EGG_IN_HAND, "wait(0.01)")
    render_strip(log, tmp_path / "whole.png", times=[0.0], size=(320, 240))
    render_strip(log, tmp_path / "part.png", times=[0.0], size=(160, 120), part=(0.5, 0.5, 1.0, 1.0))
    whole, part = (np.asarray(Image.open(tmp_path / f"{name}.png"), dtype=float) for name in ("whole", "part"))
    # Below the label, which each picture has in its own corner.
    assert part[60:] == pytest.approx(whole[180:, 160:])


def test_no_part_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="left < right"):
        render_strip(run(EGG_IN_HAND, "wait(0.01)"), tmp_path / "a.png", part=(0.5, 0.0, 0.5, 1.0))
