"""A video is whole, or its making is an error that says why."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from prolepsis.report.encoding import encoder

SIZE = (64, 48)


def test_a_video_that_cannot_be_written_is_an_error_that_says_why(tmp_path: Path) -> None:
    full = tmp_path / "video.mp4"
    full.symlink_to("/dev/full")
    with pytest.raises(OSError, match="No space left on device"), encoder(full, SIZE, 30) as encode:
        for _ in range(30):
            encode(np.random.default_rng(1).integers(0, 255, (SIZE[1], SIZE[0], 3)).astype(np.uint8))


def test_what_ffmpeg_says_else_is_told(tmp_path: Path) -> None:
    with (
        pytest.raises(OSError, match="ffmpeg could not write the video: .*"),
        encoder(tmp_path / "none" / "video.mp4", SIZE, 30) as encode,
    ):
        encode(np.zeros((SIZE[1], SIZE[0], 3), dtype=np.uint8))


def test_an_error_on_the_way_ends_ffmpeg_and_is_told_as_it_is(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="^mine$"), encoder(tmp_path / "video.mp4", SIZE, 30):
        raise ValueError("mine")
