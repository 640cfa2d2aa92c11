"""What joins actions: one after the other, all at once, again and again until something is sensed."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from prolepsis.programs.commands import ActionFailedError, Behaviour, Command, End, Sense

Maker = Callable[[Sense], Behaviour]
"""Starts an action, given what is sensed then."""
MOST_TIMES = 1000
"""Nothing is repeated more often."""


def in_sequence(makers: Sequence[Maker]) -> Maker:
    """Return what does one after the other; an action that fails ends it."""

    def begin(sense: Sense) -> Behaviour:
        ended: tuple[Command, ...] = ()
        for maker in makers:
            behaviour, fresh = maker(sense), True
            while True:
                try:
                    made = next(behaviour) if fresh else behaviour.send(sense)
                except StopIteration as stopped:
                    sense = stopped.value
                    break
                except ActionFailedError:
                    if ended:
                        yield ended
                    raise
                fresh = False
                # That an action has ended takes no time: the next one begins at the same tick.
                if made and all(isinstance(command, End) and command.outcome in GOES_ON for command in made):
                    ended += made
                    continue
                sense = yield (*ended, *made)
                ended = ()
        if ended:
            sense = yield ended
        return sense

    return begin


GOES_ON = ("done", "dropped")
"""Outcomes after which a sequence goes on: a robot that has lost what it held does not know it by itself."""


def all_together(makers: Sequence[Maker]) -> Maker:
    """Return what does all at once; it ends when the last one ends, and fails then if one has failed."""

    def begin(sense: Sense) -> Behaviour:
        fresh = [maker(sense) for maker in makers]
        going: list[Behaviour] = []
        failure: ActionFailedError | None = None
        while fresh or going:
            commands: list[Command] = []
            still: list[Behaviour] = []
            for behaviour in (*going, *fresh):
                try:
                    commands += behaviour.send(sense) if behaviour in going else next(behaviour)
                    still.append(behaviour)
                except StopIteration:
                    pass
                except ActionFailedError as failed:
                    failure = failure or failed
            going, fresh = still, []
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
        raise ActionFailedError("timed_out", f"{condition} does not hold after {MOST_TIMES} times")

    return begin
