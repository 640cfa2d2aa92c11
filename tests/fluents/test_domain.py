"""Queries know all things of a log by class, whole and mass: shards, contents and fingers too."""

from __future__ import annotations

from tests.scenes import EGG_IN_HAND, run, scene

from prolepsis.fluents import recognize


def test_all_things_have_a_class_and_the_parts_a_whole() -> None:
    egg = scene(EGG_IN_HAND)
    timeline = recognize(run(EGG_IN_HAND, duration=0.002), domain=egg.domain)
    domain = timeline.domain
    assert {thing.name for thing in egg.things} <= {name for name, _ in domain.instances}
    assert {(thing.whole, thing.name) for thing in egg.things if thing.whole} <= {*domain.parts}
    assert len({*domain.instances}) == len(domain.instances) and len({*domain.parts}) == len(domain.parts)
    shards = "instance_of(X, 'EggShellPiece'), instance_of(X, 'Piece'), has_part(eggshell1, X), value(X, mass, _M)"
    assert len(timeline.ask(shards)) == len([thing for thing in egg.things if thing.emerges]) > 1
    assert timeline.ask("occurs(colliding('eggshell1/piece0', floor), T)") == []


def test_a_log_without_a_domain_says_what_its_things_are() -> None:
    told = recognize(run(EGG_IN_HAND, duration=0.002))
    assert told.ask("instance_of(egg1, 'Egg'), has_part(egg1, yolk1), value(egg1, mass, M)") != []
