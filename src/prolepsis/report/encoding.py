"""A video (H.264 in MP4) from pictures, by ffmpeg in a process of its own, which says so if it cannot write it."""

from __future__ import annotations

import errno
import os
import subprocess
import tempfile
from collections.abc import Callable, Generator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, cast

from prolepsis.report.liquid import Picture

RATE_FACTOR = 10
"""Of libx264 [1]: 0 keeps all, 23 is usual; at 10 no loss is seen."""


@contextmanager
def encoder(file: Path, size: tuple[int, int], frame_rate: int) -> Generator[Callable[[Picture], None]]:
    """Yield what takes the pictures of a video one after the other; at the end the video is whole, or it is an error.

    Args:
        file: To be written, ``.mp4``.
        size: Width and height of the pictures [pixel], each even.
        frame_rate: Pictures a second.

    Raises:
        OSError: If ffmpeg could not write it: a disk that is full, say.
    """
    import imageio_ffmpeg  # pyright: ignore[reportMissingTypeStubs]

    program = str(cast(Any, imageio_ffmpeg).get_ffmpeg_exe())
    taken = f"-f rawvideo -pix_fmt rgb24 -s {size[0]}x{size[1]} -r {frame_rate} -i -"
    made = f"-an -c:v libx264 -pix_fmt yuv420p -crf {RATE_FACTOR}"
    command = [program, "-y", "-v", "error", *taken.split(), *made.split(), str(file)]
    with tempfile.TemporaryFile() as said:
        # In a session of its own, so that Ctrl-C ends us first, who then end it.
        process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=said, start_new_session=True
        )
        stream = cast(Any, process.stdin)

        def encode(picture: Picture) -> None:
            try:
                stream.write(picture.tobytes())
            except BrokenPipeError:
                raise _failure(process, said) from None

        try:
            yield encode
            with suppress(BrokenPipeError):
                stream.close()
            if process.wait():
                raise _failure(process, said)
        finally:
            with suppress(OSError):
                stream.close()
            process.kill()
            process.wait()


def _failure(process: subprocess.Popen[bytes], said: Any) -> OSError:
    """Return why ffmpeg has ended: that the disk is full, or its own last words."""
    process.wait()
    said.seek(0)
    words = said.read().decode("utf-8", "replace").strip()
    full = next((n for n in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG) if os.strerror(n) in words), None)
    last = words.splitlines()[-1] if words else "it gave no reason"
    return OSError(full or errno.EIO, os.strerror(full) if full else f"ffmpeg could not write the video: {last}")
