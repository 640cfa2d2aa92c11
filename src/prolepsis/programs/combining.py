"""What joins actions: one after the other, all at once, again and again until something is sensed."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from prolepsis.robots.commands import ActionFailedError, Behaviour, Command, Sense, is_instant

Maker = Callable[[Sense], Behaviour]
"""Starts an action, given what is sensed then."""
MOST_TIMES = 1000
"""Nothing is repeated more often."""


def in_sequence(makers: Sequence[Maker]) -> Maker:
    """Return what does one after the other; an action that fails ends it.

    What is dropped ends nothing: a robot that has lost what it held does not know it by itself.
    """

    def begin(sense: Sense) -> Behaviour:
        for maker in makers:
            sense = yield from maker(sense)
        return sense

    return begin


def all_together(makers: Sequence[Maker]) -> Maker:
    """Return what does all at once; it ends when the last one ends, and fails then if one has failed."""

    def begin(sense: Sense) -> Behaviour:
        fresh = [maker(sense) for maker in makers]
        going: list[Behaviour] = []
        failure: ActionFailedError | None = None
        while fresh or going:
            instant: list[Command] = []
            commands: list[Command] = []
            still: list[Behaviour] = []
            for behaviour in (*going, *fresh):
                try:
                    made = behaviour.send(sense) if behaviour in going else next(behaviour)
                    while is_instant(made):
                        instant += made
                        made = behaviour.send(sense)
                    commands += made
                    still.append(behaviour)
                except StopIteration:
                    pass
                except ActionFailedError as failed:
                    failure = failure or failed
            going, fresh = still, []
            if instant:
                sense = yield tuple(instant)
            if going:
                sense = yield tuple(commands)
        if failure is not None:
            raise failure
        return sense

    return begin


def repeated(holds: Callable[[Sense], bool], maker: Maker, condition: str) -> Maker:
    """Return what does an action again and again until ``holds`` is true between two of them, or at once."""

    def begin(sense: Sense) -> Behaviour:
        for _ in range(MOST_TIMES):
            if holds(sense):
                return sense
            sense = yield from maker(sense)
            # What takes no time would change nothing.
            sense = yield ()
        raise ActionFailedError("timed_out", f"{condition} does not hold after {MOST_TIMES} times")

    return begin
