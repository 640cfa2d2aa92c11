"""Prolog on 100,000 facts: loading, a point query, and the "broken after supports" join."""

from __future__ import annotations

import time
from collections.abc import Callable

from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.logic.session import Session

NEVER = "holds(supports(_,X),T1), \\+ (holds(broken(X),T2), after(T1,T2))"
FACT_COUNT = 100_000
OBJECT_COUNT = 2_000
HAND_COUNT = 50
LITERAL = (
    "holds(F1,T1), fluentT(F1,supports), objOf(F1,egg1), after(T2,T1), occurs(E1,T2), objOf(E1,egg1)",
    "holds(supports(_,X),T1), after(T2,T1), holds(broken(X),T2)",
)


def timeline_of(fact_count: int) -> Timeline:
    """Return a timeline of ``fact_count`` facts about eggs that are held, dropped and broken in turn."""
    facts: list[Fact] = []
    for number in range(fact_count):
        turn, phase = divmod(number, 5)
        egg, hand = f"egg{turn % OBJECT_COUNT}", f"hand{turn % HAND_COUNT}"
        start = turn * 0.01 + phase * 0.002
        match phase:
            case 0 | 1:
                fact = Fact(
                    kind="fluent",
                    type=("supports", "contacts")[phase],
                    args=(hand, egg),
                    start=start,
                    end=start + 0.004,
                )
            case 2 | 3:
                fact = Fact(
                    kind="event", type=("falling", "breaking")[phase - 2], args=(egg,), start=start, end=start + 0.003
                )
            case _:
                fact = Fact(kind="fluent", type="broken", args=(egg,), start=start, end=start + 1.0)
        facts.append(fact)
    return make_timeline(facts, dt=0.001, duration=fact_count * 0.002 + 2)


def _seconds(action: Callable[[], object], repeat: int = 1) -> float:
    start = time.perf_counter()
    for _ in range(repeat):
        action()
    return (time.perf_counter() - start) / repeat


def rows() -> list[tuple[str, str, str]]:
    """Return (name, measured, target) of each measurement."""
    session = Session()
    small, large = timeline_of(50), timeline_of(FACT_COUNT)
    session.ask(small, "holds(broken(egg1), T)")
    load = _seconds(lambda: session.load(large))
    join = _seconds(lambda: session.ask(large, f"aggregate_all(count, ({LITERAL[1]}), N)"))
    literal = _seconds(lambda: session.ask(large, LITERAL[0]))
    denied = _seconds(lambda: session.ask(large, f"aggregate_all(count, ({NEVER}), N)"))
    session.ask(large, "holds(broken(egg7), T)", limit=1)
    point = _seconds(lambda: session.ask(large, "holds(broken(egg7), T)", limit=1), 200)
    session.close()
    return [
        (f"load {len(large.facts):,} facts", f"{load:.2f} s", "< 2 s"),
        ("point query, with the round trip", f"{point * 1e3:.2f} ms", "< 1 ms"),
        ("join: broken after supports", f"{join:.2f} s", "< 0.5 s"),
        ("the query of section 3.6, literally", f"{literal:.2f} s", "< 0.5 s"),
        ("a negation in a count, with what is said of it", f"{denied:.2f} s", "< 0.5 s"),
    ]


def main() -> None:
    """Print the measurements."""
    for name, measured, target in rows():
        print(f"{name:<40} {measured:>10}   {target}")


if __name__ == "__main__":
    main()
