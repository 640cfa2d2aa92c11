"""Pictures for a forked process: the OpenGL that its parent has opened would hang in it, so a fresh process draws."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from prolepsis.log.log import Log
from prolepsis.report.liquid import Picture
from prolepsis.system.workers import Lost, Worker
from prolepsis.terms.errors import MissingToolError, ProlepsisError

Draw = Callable[..., Iterator[Picture]]
"""Draws a log at ticks, with a size and a view."""

_drawn: Iterator[Picture] = iter(())
"""In the process that draws: its pictures."""


def pictures_elsewhere(
    draw: Draw, log: Log, ticks: Sequence[int], size: tuple[int, int], view: Mapping[str, float]
) -> Iterator[Picture]:
    """Yield what ``draw`` yields, a function of a module, in another process."""
    worker = Worker()
    try:
        _answer(worker, _begin, draw, log, ticks, size, view)
        for _ in ticks:
            yield _answer(worker, _next)
    finally:
        worker.end()


def _answer(worker: Worker, task: Any, *arguments: Any) -> Any:
    worker.send(task, arguments)
    try:
        found = worker.result()
    except EOFError:
        raise MissingToolError("the process that draws has died; is memory short?") from None
    if isinstance(found, ProlepsisError):
        raise found
    if isinstance(found, Lost):
        raise RuntimeError(found.reason)
    return found


def _begin(draw: Draw, log: Log, ticks: Sequence[int], size: tuple[int, int], view: Mapping[str, float]) -> None:
    global _drawn
    _drawn = draw(log, ticks, size=size, **view)


def _next() -> Picture | ProlepsisError:
    try:
        return next(_drawn)
    except ProlepsisError as error:
        return error
