"""Stories on logs made by hand: an egg that is intact, cracks, falls apart and spills."""

from __future__ import annotations

import numpy as np
import pytest
from tests.fluents.logs import PLATES, Draft, egg, floor
from tests.fluents.worlds import at_end, ever, of_type, times

from prolepsis.fluents import recognize
from prolepsis.log.log import Detachments
from prolepsis.log.timeline import Timeline

APART = 300
"""Tick at which the shell falls apart."""


def broken_egg(*, whites_stay: bool = False) -> Timeline:
    """Return the timeline of an egg that cracks at tick 200 and falls into two halves at tick 300.

    The half of the first five pieces lies on the floor like a tray and holds one yolk blob; two yolk blobs lie on the
    floor. The white goes on the floor, or stays in the half.
    """
    draft = Draft(800, [floor(), *egg()])
    index = draft.index
    whole = index("egg1")
    parts = [i for i, thing in enumerate(draft.things) if thing.name not in ("floor", "egg1")]
    draft.carrier[:APART, parts] = whole
    gone = [index(name) for name in ("egg1", "eggshell1", "yolk1", "white1")]
    draft.carrier[APART:, gone] = -1
    for k in range(2 * PLATES):
        piece = index(f"eggshell1/piece{k}")
        draft.carrier[APART:, piece] = index(f"eggshell1/piece{0 if k < PLATES else PLATES}")
        draft.poses[APART:, piece, 2] += 0.001 - 0.5
    draft.poses[:, whole, 2] = 0.0285
    draft.rest("floor", "egg1", 0, APART, 0.058 * 9.81)
    for half in ("eggshell1/piece0", "eggshell1/piece5"):
        # In the tick in which the shell falls apart what presses is told of the pieces already.
        draft.rest("floor", half, APART - 1, 800, 0.005 * 9.81)
    places = {"yolk1/blob0": (0.1, 0.0), "yolk1/blob1": (0.0, 0.2), "yolk1/blob2": (0.0, 0.3)}
    places |= {f"white1/blob{k}": (0.1 + 0.008 * (2 * k - 1), 0.01) if whites_stay else (0.2, 0.1 * k) for k in (0, 1)}
    for name, (x, y) in places.items():
        inside = abs(x - 0.1) < 0.02
        blob = index(name)
        draft.poses[APART:, blob, :3] = (x, y, 0.008 if inside else 0.006)
        weight = draft.things[blob].mass * 9.81
        draft.rest("eggshell1/piece0" if inside else "floor", name, APART + 20, 800, weight)
    bonds = [(200, 0, 1), (201, 1, 2), (APART - 1, 2, 3)]
    detachments = Detachments(
        tick=np.array([bond[0] for bond in bonds]),
        thing=np.full(3, whole),
        a=np.array([index(f"eggshell1/piece{bond[1]}") for bond in bonds]),
        b=np.array([index(f"eggshell1/piece{bond[2]}") for bond in bonds]),
        force=np.array([36.0, 30.0, 20.0]),
    )
    return recognize(draft.log(detachments=detachments))


def test_an_intact_egg_contains_its_yolk_and_white_and_nothing_is_spilled() -> None:
    draft = Draft(300, [floor(), *egg()])
    parts = [i for i, thing in enumerate(draft.things) if thing.name not in ("floor", "egg1")]
    draft.carrier[:, parts] = draft.index("egg1")
    draft.poses[:, :, 2] -= 0.4715
    draft.rest("floor", "egg1", 0, 300, 0.058 * 9.81)
    assert ever(recognize(draft.log())) == {
        "contains(egg1,yolk1)", "contains(egg1,white1)", "supports(floor,egg1)", "contacts(egg1,floor)",
    }  # fmt: skip


def test_each_burst_of_detachments_is_one_breaking_and_broken_lasts() -> None:
    timeline = broken_egg()
    assert times(timeline, "breaking(egg1)") == [(0.2, 0.202), (0.299, 0.3)]
    assert times(timeline, "broken(egg1)") == [(0.2, 0.8)]
    first, second = timeline.select(type="breaking")
    assert (first.evidence["bonds"], first.evidence["force"], second.evidence["bonds"]) == (2.0, 36.0, 1.0)


def test_what_cracks_is_open_once_it_falls_apart_and_two_halves_are_not_crushed() -> None:
    timeline = broken_egg()
    assert times(timeline, "cracked(egg1)") == [(0.2, 0.3)]
    assert times(timeline, "open(egg1)") == [(0.3, 0.8)]
    (cracked,), (opened,) = timeline.select(type="cracked"), timeline.select(type="open")
    assert (cracked.evidence["bonds"], opened.evidence["parts"]) == (3.0, 2.0)
    assert opened.evidence["equal_parts"] == pytest.approx(2.0)
    assert timeline.ask("holds(crushed(egg1), T)") == []
    assert not [fact for fact in timeline.near_misses if fact.type == "crushed"]


@pytest.mark.parametrize(("parts", "is_crushed"), [(1, False), (2, False), (4, True), (10, True)])
def test_in_finer_parts_than_three_equal_ones_it_is_crushed(parts: int, is_crushed: bool) -> None:
    draft = Draft(400, [floor(), *egg()])
    whole, pieces = draft.index("egg1"), [draft.index(f"eggshell1/piece{k}") for k in range(2 * PLATES)]
    draft.carrier[:, [whole, *pieces]] = whole
    # A burst: it cracks and falls apart within a few milliseconds.
    lead = [pieces[k * parts // len(pieces) * len(pieces) // parts] for k in range(len(pieces))]
    if parts > 1:
        draft.carrier[105:, [whole, *pieces]] = [-1, *lead]
    bond = Detachments(
        tick=np.array([100]), thing=np.array([whole]), a=np.array([pieces[0]]), b=np.array([pieces[1]]),
        force=np.array([36.0]),
    )  # fmt: skip
    timeline = recognize(draft.log(detachments=bond))
    assert times(timeline, "cracked(egg1)") == ([(0.1, 0.4)] if parts == 1 else [])
    assert times(timeline, "open(egg1)") == ([(0.105, 0.4)] if parts > 1 else [])
    assert times(timeline, "crushed(egg1)") == ([(0.105, 0.4)] if is_crushed else [])


def test_a_cracked_egg_keeps_its_name_until_it_falls_apart() -> None:
    timeline = broken_egg()
    assert times(timeline, "supports(floor,egg1)")[0][1] == 0.3
    assert times(timeline, "contains(egg1,yolk1)") == [(0.0, 0.3)]
    assert {"supports(floor,eggshell1/piece0)", "supports(floor,eggshell1/piece5)"} <= {
        term.replace("'", "") for term in at_end(timeline)
    }
    assert not [fact for fact in timeline.facts if "eggshell1/piece1" in fact.args]


def test_a_piece_is_borne_from_when_it_is_free_and_by_as_much_as_it_weighs() -> None:
    borne = [fact for fact in broken_egg().select(type="supports") if str(fact.args[1]).startswith("eggshell1")]
    assert [(fact.start, fact.evidence["margin"]) for fact in borne] == [(0.3, pytest.approx(10.0))] * 2


def test_yolk_on_the_floor_is_spilled_and_supported_by_it() -> None:
    timeline = broken_egg()
    (spilled,) = [fact for fact in timeline.select(type="spilled") if fact.args == ("yolk1",)]
    assert spilled.end == timeline.duration
    assert 0.66 < float(spilled.evidence["fraction"]) < 0.67
    assert "supports(floor,yolk1)" in at_end(timeline)
    assert "supports(floor,white1)" in at_end(timeline)


def test_a_half_shell_contains_the_stuff_that_stays_in_it() -> None:
    timeline = broken_egg(whites_stay=True)
    contained = {fact.args for fact in timeline.select(type="contains") if fact.end == timeline.duration}
    assert contained == {("eggshell1/piece0", "yolk1"), ("eggshell1/piece0", "white1")}
    assert {fact.args for fact in timeline.select(type="spilled")} == {("yolk1",)}
    assert "supports(eggshell1/piece0,white1)" not in {term.replace("'", "") for term in ever(timeline)}


def test_stuffs_are_no_solids() -> None:
    timeline = broken_egg()
    for fact in timeline.facts:
        if fact.type in ("contacts", "colliding"):
            assert not {"yolk1", "white1"} & set(fact.args)
    assert not [fact for fact in timeline.facts if any("blob" in str(arg) for arg in fact.args)]


def test_a_stuff_that_flows_over_the_floor_is_spilling_until_it_stops() -> None:
    draft = Draft(600, [floor(), *egg()])
    index = draft.index
    for name in ("egg1", "eggshell1", "yolk1", "white1", *(f"eggshell1/piece{k}" for k in range(2 * PLATES))):
        draft.carrier[:, index(name)] = -1
    for k in range(3):
        blob = index(f"yolk1/blob{k}")
        draft.poses[:, blob, 0] = 0.1 * k + 0.3 * np.minimum(np.arange(600) / 1000, 0.3)
        draft.poses[:, blob, 2] = 0.006
        draft.rest("floor", f"yolk1/blob{k}", 0, 600, 0.006 * 9.81)
    timeline = recognize(draft.log())
    assert times(timeline, "spilling(yolk1)") == [(0.0, 0.3)]
    assert times(timeline, "spilled(yolk1)") == [(0.0, 0.6)]
    assert "moving(yolk1)" in ever(timeline)
    assert not of_type(timeline, "falling", "contains")
