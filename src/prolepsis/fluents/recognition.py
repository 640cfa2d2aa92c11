"""From a log to a timeline: every registered grounding looks at the same observation."""

from __future__ import annotations

from dataclasses import replace

from prolepsis.fluents.agents.actions import action_facts
from prolepsis.fluents.margins import NearMiss
from prolepsis.fluents.observation import observe
from prolepsis.fluents.registry import GROUNDINGS, check_declared
from prolepsis.log.domain import Domain, with_things
from prolepsis.log.fact_types import NEEDS, ONLY_OF
from prolepsis.log.log import Log
from prolepsis.log.things import falling_apart
from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.system.threads import one_thread
from prolepsis.terms.errors import LogError, brief


@one_thread()
def recognize(log: Log, *, domain: Domain | None = None) -> Timeline:
    """Return which fluents held and which events occurred in a log.

    Args:
        log: What a run, a rollout or a recording left behind.
        domain: What is known of the individuals, for queries; without it, what the log's things say.

    Raises:
        LogError: If it is given something else than a log.
        InputError: If a grounding finds a fact that is not declared.
    """
    if not isinstance(log, Log):  # pyright: ignore[reportUnnecessaryIsInstance]
        given = brief(type(log).__name__)
        raise LogError(f"a log is recognized, as `read_log` or `Log.from_mujoco` gives it, not {given}")
    observation = observe(log)
    found = [each for grounding in GROUNDINGS for each in grounding(observation)]
    facts: list[Fact] = [_rounded(each) for each in found if isinstance(each, Fact)]
    nearly = [_rounded(each.fact) for each in found if isinstance(each, NearMiss)]
    for kind, name, count in dict.fromkeys((fact.kind, fact.type, len(fact.args)) for fact in (*facts, *nearly)):
        check_declared(kind, name, count)
    facts += action_facts(observation)
    known = domain or replace(with_things(Domain(), log.things), untold=_untold(log))
    return make_timeline(facts, dt=log.dt, duration=log.duration, domain=known, near_misses=nearly)


def _untold(log: Log) -> tuple[tuple[str], ...]:
    """Return each class that no thing of a log is told to be of, though facts are found of nothing else.

    A log of a simulation here has channels, and decides whatever was simulated.
    """
    if log.channels:
        return ()
    told = {role for thing in log.things for role in (thing.kind, *thing.roles)}
    if not falling_apart(log.things) and not len(log.detachments.tick):
        # What has no parts to break into does not break, whatever it is said to be.
        told -= {"Breakable"}
    asked = {role for roles in (*ONLY_OF.values(), NEEDS.values()) for each in roles for role in each}
    return tuple((role,) for role in sorted(asked - told))


def _rounded(fact: Fact) -> Fact:
    """Return a fact whose numbers are as they are told: 0.999999999999998 of a liquid is all of it."""
    told = {
        name: float(f"{value:.12g}") if isinstance(value, float) else value for name, value in fact.evidence.items()
    }
    return replace(fact, evidence=told)
