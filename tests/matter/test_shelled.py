"""Things with a shell other than the hen's raw egg: each breaks at its own force, or does not."""

from __future__ import annotations

import numpy as np
import pytest
from tests.scenes import run, scene

from prolepsis.log.log import Log
from prolepsis.matter.shells.cutting import ellipsoid_shell
from prolepsis.terms.errors import KnowledgeError


def pressed(kind: str, height: float, opening: float, force: float, duration: float = 1.6) -> Log:
    """Return the log of a thing on a table, ``height`` [m] to its middle, between pads that close up to a force."""
    above = max(height, 0.019)  # the pads clear the table
    turtle = (
        f":floor a :Floor . :table1 a :Table . :egg1 a :{kind} ; :on :table1 .\n"
        f":hand1 a :Gripper ; :pitch 90.0 ; :z {0.7 + above!r} ; :opening {opening!r} ."
    )
    return run(turtle, f"close(hand1, {force})", duration=duration)


@pytest.mark.parametrize("kind", ["Egg", "QuailEgg", "MandM", "Coconut"])
def test_contact_is_stable_at_the_longer_substeps_of_what_rests(kind: str) -> None:
    log = run(f":floor a :Floor . :table1 a :Table . :egg1 a :{kind} ; :on :table1 .", duration=0.6)
    weight = 9.81 * sum(thing.mass for thing in log.things if thing.whole is None and "Breakable" in thing.roles)
    assert log.channels["egg1.force"][-100:] == pytest.approx(np.full(100, weight), rel=0.01)


@pytest.fixture(scope="module")
def quail() -> Log:
    return pressed("QuailEgg", 0.0131, 0.03, 40.0)


def test_a_quail_s_egg_breaks_between_plates_at_its_own_force(quail: Log) -> None:
    # The pads close within a third of a second instead of 5 s.
    assert quail.detachments.force[0] == pytest.approx(1.09 * 10.5, rel=0.12)


def test_a_quail_s_egg_that_is_pressed_less_stays_whole() -> None:
    assert not len(pressed("QuailEgg", 0.0131, 0.03, 7.0).detachments.tick)


def test_what_is_in_a_quail_s_egg_flows_out(quail: Log) -> None:
    particles = quail.particles
    assert particles.mass.sum() == pytest.approx(0.01145, rel=1e-6)
    assert (particles.holder[0] >= 0).all() and (particles.holder[-1] < 0).all()


def test_a_coconut_survives_what_crushes_an_egg() -> None:
    log = pressed("Coconut", 0.0455, 0.09, 100.0)
    assert not len(log.detachments.tick)


def test_a_coconut_breaks_at_the_force_of_its_shell() -> None:
    # v sqrt(k m): 2500 N at a contact of 2000 N/mm and 0.43 kg need 2.7 m/s.
    def dropped(speed: float) -> Log:
        height = speed**2 / (2 * 9.81)
        turtle = f":floor a :Floor . :coconut1 a :Coconut ; :z {height + 0.0455!r} ."
        return run(turtle, duration=speed / 9.81 + 0.01)

    assert not len(dropped(2.2).detachments.tick)
    assert len(dropped(3.2).detachments.tick)


def test_an_oblate_shell_is_closed_by_pieces_and_bonds() -> None:
    shell = ellipsoid_shell((0.0035, 0.00675, 0.00675), 12, 0.0005)
    neighbours = np.bincount(shell.bonds.ravel(), minlength=12)
    assert (neighbours >= 3).all()
    # Surface of an oblate spheroid, e^2 = 1 - c^2 / a^2: 2 pi a^2 (1 + (1 - e^2) / e artanh e).
    e = np.sqrt(1 - (3.5 / 6.75) ** 2)
    expected = 2 * np.pi * 6.75e-3**2 * (1 + (1 - e**2) / e * np.arctanh(e))
    assert shell.areas.sum() == pytest.approx(expected, rel=0.011)


def test_a_shell_that_is_too_flat_is_refused() -> None:
    with pytest.raises(KnowledgeError, match=r"0.003 m long and 0.0135 m broad; allowed: a breadth of 0.5 to 2 times"):
        scene(":floor a :Floor . :sweet1 a :MandM ; :on :floor ; :length 0.003 .")


@pytest.fixture(scope="module")
def sweet() -> Log:
    return pressed("MandM", 0.0035, 0.02, 100.0)


def test_a_sweet_s_shell_is_crushed_between_plates_at_its_own_force(sweet: Log) -> None:
    assert sweet.detachments.force[0] == pytest.approx(60.0, rel=0.2)  # spread over orientations: 10 %


def test_the_chocolate_of_a_crushed_sweet_is_one_body(sweet: Log) -> None:
    kernel = sweet.index("egg1/kernel")
    assert sweet.carrier[0, kernel] == sweet.index("egg1")
    assert sweet.carrier[-1, kernel] == kernel
    assert np.isfinite(sweet.poses).all()


def test_an_egg_that_breaks_at_once_lets_its_contents_out_where_it_is() -> None:
    log = run(":floor a :Floor . :egg1 a :Egg ; :x 0.5 ; :z 0.0216 .", duration=0.01)  # pressed in by 0.4 mm
    assert log.detachments.tick[0] == 0
    inside = log.particles.position[-1]
    assert (np.linalg.norm(inside - [0.5, 0.0, 0.0216], axis=1) < 0.04).all()
