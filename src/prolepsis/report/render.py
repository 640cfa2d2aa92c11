"""Pictures of a log: a video, numbered frames, or a strip of moments with their times."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

import numpy as np

from prolepsis.log.log import Log
from prolepsis.report.encoding import encoder
from prolepsis.report.liquid import Picture, painted
from prolepsis.report.offscreen import Camera, opened_by_parent
from prolepsis.system.aside import check_replaceable, written_aside
from prolepsis.terms.errors import InputError

FRAME_RATE = 30
"""Frames of a video a second of watching."""
MARK = "prolepsis"
"""Key of a text in each frame, the SHA-256 of its pixels, by which a frame of ours is known."""
MOST_FRAMES = 20_000
"""Pictures that are drawn at most: eleven minutes of a video, and some gigabytes of PNG files."""
MOST_MOMENTS, MOST_PIXELS = 100, 100_000_000
"""Moments of a strip, and pixels of all together."""
SMALLEST, LARGEST = 16, 4096
"""Sides of a picture [pixel]."""
BEHIND = 0.6
"""Part of what a vessel adds to a picture that is due to its far walls [1]: three of the five surfaces in line."""


def render_video(
    log: Log,
    out: str | Path,
    *,
    speed: float = 1.0,
    size: tuple[int, int] = (960, 720),
    progress: Callable[[float], None] | None = None,
) -> None:
    """Write an MP4 (H.264) of the whole log.

    Args:
        log: What to show.
        out: File to write, ``.mp4``.
        speed: Simulated seconds a second of watching; 0.25 is four times slow motion [1].
        size: Width and height [pixel], each even.
        progress: Called with the fraction done.

    Raises:
        InputError: If ``speed`` or the file's suffix is wrong, or the log is empty.
        OSError: If the video cannot be written.
        MissingToolError: If there is no off-screen OpenGL.
    """
    target = Path(out).absolute()
    if target.suffix != ".mp4":
        raise InputError(f"{out}: a video's name ends in .mp4")
    if not 0.001 <= speed <= 100.0:
        raise InputError(f"speed {speed:g}: is not between 0.001 and 100")
    count = max(2, round(log.duration / speed * FRAME_RATE))
    if count > MOST_FRAMES:
        raise InputError(
            f"speed {speed:g}: a video of {log.duration:g} s would have {count} frames; allowed: {MOST_FRAMES}, "
            f"so a speed of at least {log.duration * FRAME_RATE / MOST_FRAMES:.3g}"
        )
    _refuse_size(size)
    ticks = _ticks(log, np.arange(count) * speed / FRAME_RATE)
    with (
        written_aside(target) as aside,
        encoder(aside, size, FRAME_RATE) as encode,
        closing(pictures(log, ticks, size=size)) as shown,
    ):
        for picture in _report(shown, len(ticks), progress):
            encode(picture)


def render_frames(
    log: Log,
    folder: str | Path,
    *,
    count: int = 24,
    size: tuple[int, int] = (960, 720),
    progress: Callable[[float], None] | None = None,
) -> list[Path]:
    """Write ``count`` PNG files, evenly spaced in time from first to last tick, and return their paths.

    Raises:
        InputError: If ``folder`` holds other files than frames, or the log is empty.
    """
    target = Path(folder).absolute()
    check_replaceable(target, _our_frames)
    ticks = _evenly(log, count, MOST_FRAMES)
    _refuse_size(size)
    names: list[str] = []
    with written_aside(target, _our_frames) as aside, closing(pictures(log, ticks, size=size)) as shown:
        aside.mkdir()
        for i, picture in enumerate(_report(shown, len(ticks), progress)):
            names.append(f"frame{i:04d}_{log.time[ticks[i]]:.3f}s.png")
            _save(picture, aside / names[-1])
    return [target / name for name in names]


def render_strip(
    log: Log,
    out: str | Path,
    *,
    times: Sequence[float] | None = None,
    count: int = 5,
    size: tuple[int, int] = (360, 420),
    part: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0),
    progress: Callable[[float], None] | None = None,
    **view: float,
) -> None:
    """Write one PNG with moments side by side, each with its time.

    Args:
        log: What to show.
        out: File to write, ``.png``.
        times: Moments to show [s]; by default ``count`` evenly spaced ones.
        count: How many moments when ``times`` are not given.
        size: Width and height of each picture [pixel].
        part: Which part of the whole view is shown: left, top, right and bottom edge as shares of it [1].
        progress: Called with the fraction done.
        view: ``azimuth`` and ``elevation`` of the camera [degree].

    Raises:
        InputError: If the file's suffix is wrong, the log is empty, or the part is none.
    """
    from PIL import Image

    target = Path(out).absolute()
    if target.suffix != ".png":
        raise InputError(f"{out}: a strip's name ends in .png")
    if not (0.0 <= part[0] < part[2] <= 1.0 and 0.0 <= part[1] < part[3] <= 1.0):
        raise InputError(f"part {part}: must be left < right and top < bottom, each between 0 and 1")
    if times is not None and not 0 < len(times) <= MOST_MOMENTS:
        raise InputError(f"{len(times)} moments: allowed: 1 to {MOST_MOMENTS}")
    ticks = _evenly(log, count, MOST_MOMENTS) if times is None else _ticks(log, np.asarray(times))
    width, height = size
    whole = round(width / (part[2] - part[0])), round(height / (part[3] - part[1]))
    _refuse_size(size)
    _refuse_size(whole)
    if len(ticks) * width * height > MOST_PIXELS:
        raise InputError(f"a strip of {len(ticks)} pictures of {width} by {height} pixels: allowed: {MOST_PIXELS:g}")
    left, top = round(part[0] * whole[0]), round(part[1] * whole[1])
    with closing(pictures(log, ticks, size=whole, **view)) as made:
        shown = [
            _with_time(picture[top : top + height, left : left + width], float(log.time[tick]))
            for tick, picture in zip(ticks, _report(made, len(ticks), progress), strict=True)
        ]
    strip = Image.new("RGB", (len(shown) * (width + 4) - 4, height), "white")
    for i, picture in enumerate(shown):
        strip.paste(Image.fromarray(picture), (i * (width + 4), 0))
    with written_aside(target) as aside:
        strip.save(aside)


def pictures(log: Log, ticks: Sequence[int], *, size: tuple[int, int], **view: float) -> Generator[Picture]:
    """Yield a picture of ``log`` at each of ``ticks``, all from one fixed camera.

    Close it when an error leaves pictures over: OpenGL that is still open when Python ends takes the process down.
    """
    if opened_by_parent():
        from prolepsis.report.forked import pictures_elsewhere

        yield from pictures_elsewhere(pictures, log, ticks, size, view)
        return
    width, height = size
    from prolepsis.report.stage import Stage

    stage = Stage(log, width=width, height=height)
    with Camera(stage.model, width=width, height=height, view=stage.view(list(ticks), **view)) as camera:
        for tick in ticks:
            liquid = stage.liquid(tick)
            if liquid is None:
                yield camera.take(stage.show(tick))
                continue
            bare = camera.take(stage.show(tick, vessels=False))
            wet, solid = painted(bare, camera.distances(), camera.eye(), *liquid)
            if not stage.has_vessels(tick):
                yield wet
                continue
            # What vessels add is seen over the liquid too, but for their walls behind it.
            added = camera.take(stage.show(tick)).astype(np.float64) - bare
            yield np.clip(wet + added * (1.0 - BEHIND * solid[..., None]), 0, 255).astype(np.uint8)


def _ticks(log: Log, times: Any) -> list[int]:
    if log.tick_count == 0:
        raise InputError("the log has no ticks, so there is nothing to show")
    return [int(tick) for tick in np.clip(np.rint(times / log.dt), 0, log.tick_count - 1)]


def _refuse_size(size: tuple[int, int]) -> None:
    if not all(SMALLEST <= side <= LARGEST for side in size):
        raise InputError(f"a picture of {size[0]} by {size[1]} pixels: allowed: each side {SMALLEST} to {LARGEST}")


def _evenly(log: Log, count: int, most: int) -> list[int]:
    if not 1 <= count <= most:
        raise InputError(f"{count} pictures: allowed: 1 to {most}")
    return _ticks(log, np.linspace(0.0, max(0, log.tick_count - 1) * log.dt, count))


def _report(shown: Iterator[Picture], count: int, progress: Callable[[float], None] | None) -> Iterator[Picture]:
    for i, picture in enumerate(shown):
        yield picture
        if progress is not None:
            progress((i + 1) / count)


def _our_frames(folder: Path) -> set[str]:
    """Return the names of the frames in a folder that are as they were drawn."""
    from PIL import Image

    names: set[str] = set()
    for file in folder.glob("frame*_*s.png"):
        if file.is_symlink() or not file.is_file():
            continue
        with suppress(OSError, SyntaxError, ValueError), Image.open(file, formats=["PNG"]) as image:
            if MARK in image.info and max(image.size) <= LARGEST and image.info[MARK] == _seal(np.asarray(image)):
                names.add(file.name)
    return names


def _seal(picture: Picture) -> str:
    return hashlib.sha256(str(picture.shape).encode() + picture.tobytes()).hexdigest()


def _save(picture: Picture, file: Path) -> None:
    from PIL import Image, PngImagePlugin

    said = PngImagePlugin.PngInfo()
    said.add_text(MARK, _seal(picture))
    Image.fromarray(picture).save(file, pnginfo=said)


def _with_time(picture: Picture, time: float) -> Picture:
    from PIL import Image, ImageDraw, ImageFont

    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image, "RGBA")
    font = ImageFont.load_default(size=max(12, image.height // 22))
    text = f"{time:.3f} s"
    left, top, right, bottom = draw.textbbox((12, 10), text, font=font)
    draw.rounded_rectangle((left - 7, top - 5, right + 7, bottom + 5), 5, fill=(255, 255, 255, 190))
    draw.text((12, 10), text, font=font, fill=(30, 30, 35, 255))
    return np.asarray(image, dtype=np.uint8)
