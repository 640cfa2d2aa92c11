"""Breaking against closed forms: impact force, plate compression, drops, and independence of the substep."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tests.comparing import Compare
from tests.scenes import EGG_IN_HAND, falling_egg, run, scene, started

from prolepsis.engine.state import State
from prolepsis.engine.world import compile_world
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.log import Log
from prolepsis.matter.shells.breaking import Breaking
from prolepsis.matter.shells.contact import local_stiffness
from prolepsis.scene.running import Running
from prolepsis.system.mujoco import mujoco
from prolepsis.terms.errors import InputError

SUBSTEPS = (6.25e-5, 1.25e-4, 2.5e-4)
MASS = 0.059
FORCE = 45.0
ALONE = 46.2
"""Forces that break a shell in the time of the test: between plates, and at one place only [N]."""
BEARS, STRETCH = 0.3 * FORCE, 2e-3
"""Force that a cracked shell bears [N], and how far it can be pressed in [m]."""
GIRDLE = local_stiffness(np.array([0.0285, 0.022, 0.022]), 0.0, 150e3, 1.3)
POLE = local_stiffness(np.array([0.0285, 0.022, 0.022]), 1.0, 150e3, 1.3)


def drop(height: float, *, standing: bool = False, force: float = FORCE, substep: float = 1e-3) -> Log:
    return run(
        falling_egg(height, standing=standing),
        values={"eggshell1.breakingForce": force},
        duration=math.sqrt(2 * height / 9.81) + 0.004,
        max_step=substep,
    )


def bonds_broken(log: Log) -> int:
    return len(log.detachments.tick)


def test_stiffness_between_plates_is_that_of_the_ontology() -> None:
    assert math.sqrt(GIRDLE * POLE) / 2 == pytest.approx(150e3)
    assert pytest.approx(1.3) == POLE / GIRDLE


def test_a_shard_of_one_egg_may_touch_the_whole_shell_of_another() -> None:
    below = ":egg2 a :QuailEgg ; :on :floor ; :x 0.012 ; :y -0.02 . "
    # Weaker than the quail's egg below, which is hit by its shards.
    above = ":egg1 a :Egg ; :x 0.013 ; :y -0.021 ; :z 0.55 ."
    log = run(":floor a :Floor . " + below + above, values={"eggshell1.breakingForce": 9.0}, duration=0.4)
    assert log.index("egg1") in log.detachments.thing
    own = {i for i, thing in enumerate(log.things) if thing.name.startswith("eggshell1/")}
    pairs = zip(log.contacts.a.tolist(), log.contacts.b.tolist(), strict=True)
    assert any(log.index("egg2") in pair and own & {*pair} for pair in pairs)


@pytest.mark.laws
@pytest.mark.parametrize("substep", SUBSTEPS)
@pytest.mark.parametrize("standing", [False, True])
@pytest.mark.parametrize("height", [0.001, 0.004])
def test_impact_force_is_speed_times_root_of_stiffness_and_mass(
    compare: Compare, height: float, standing: bool, substep: float
) -> None:
    log = drop(height, standing=standing, force=100.0, substep=substep)
    stiffness = POLE if standing else GIRDLE
    # A linear spring stopping a mass: F = v sqrt(k m), on top of the weight that it comes to bear.
    expected = math.sqrt(2 * 9.81 * height * stiffness * MASS) + MASS * 9.81
    assert bonds_broken(log) == 0
    peak = log.contacts.peak.max()
    compare("force of an egg's impact", peak, expected, by="`v sqrt(k m) + m g`", share=0.1, unit="N")


@pytest.mark.laws
@pytest.mark.parametrize("height", [0.001, 0.02, 0.3])
@pytest.mark.parametrize("standing", [False, True])
def test_whether_a_dropped_egg_breaks_does_not_depend_on_the_substep(height: float, standing: bool) -> None:
    outcomes = {bonds_broken(drop(height, standing=standing, substep=substep)) > 0 for substep in SUBSTEPS}
    assert outcomes == {height > 0.015}


RIM = ":bowl1 a :Bowl ; :on :floor . "


def fallen(where: str, speed: float, shift: float = 0.0) -> Log:
    """Return the log of an egg that meets the floor, lying or standing, or a bowl's rim at a speed [m/s].

    Args:
        where: ``lying``, ``standing`` or ``rim``.
        speed: That with which it meets it [m/s].
        shift: By which it is moved to the side and upwards [m].
    """
    height = speed**2 / (2 * 9.81)
    turtle = falling_egg(height + shift, standing=where == "standing").replace(" ; :z", f" ; :x {shift!r} ; :z")
    if where == "rim":
        egg = f":egg1 a :Egg ; :x {0.0775 + shift!r} ; :z {0.082 + height + shift!r} ; :yaw 90.0 ."
        turtle = ":floor a :Floor . " + RIM + egg
    return run(turtle, duration=math.sqrt(2 * height / 9.81) + 0.015, monitors={"egg1": ("pressed_in",)})


def came_of(log: Log) -> tuple[int, int]:
    """Return how many bonds have given way, and into how many parts the shell has fallen."""
    pieces = [i for i, thing in enumerate(log.things) if "Piece" in thing.roles]
    return bonds_broken(log), len({*log.carrier[-1, pieces].tolist()})


def take_finer_steps(monkeypatch: pytest.MonkeyPatch, finer: float) -> None:
    """Let what breaks ask for substeps that are shorter by a factor."""
    usual = Breaking.longest_step

    def shorter(breaking: Breaking, state: Running) -> float:
        return usual(breaking, state) / finer

    monkeypatch.setattr(Breaking, "longest_step", shorter)


def cracking_force(speed: float, stiffness: float) -> float:
    """Return the force at which a dropped egg cracks [N], infinity if none: slow cracks need some time.

    Args:
        speed: That with which it meets the floor [m/s].
        stiffness: That of its contact [N/m].
    """
    times = np.linspace(0, math.pi / 2 * math.sqrt(MASS / stiffness), 2000)
    load = speed * math.sqrt(stiffness * MASS) / ALONE * np.sin(times * math.sqrt(stiffness / MASS))
    spent = np.cumsum(load**30) * (times[1] - times[0]) * 31 / 5.0
    broken = np.flatnonzero((spent >= 1) | (load >= 1.5))
    return float(ALONE * load[broken[0]]) if len(broken) else math.inf


def opening_speed(stiffness: float) -> float:
    """Return the speed from which a dropped egg is pressed in until it opens [m/s].

    What is left of its energy when it cracks is spent on a dent, under the force that the cracked shell bears.
    """
    speed = 1.0
    for _ in range(10):
        force = cracking_force(speed, stiffness)
        cracks = force**2 / (2 * stiffness)
        dent = (BEARS - MASS * 9.81) * (STRETCH - (force - BEARS) / stiffness)
        speed = math.sqrt(2 * (cracks + dent) / MASS)
    return speed


@pytest.mark.parametrize("finer", [1, 2, 4])
def test_what_becomes_of_a_dropped_egg_does_not_depend_on_the_substep(
    monkeypatch: pytest.MonkeyPatch, finer: int
) -> None:
    take_finer_steps(monkeypatch, finer)
    outcomes = [came_of(fallen(where, speed)) for where, speed in (("lying", 0.8), ("lying", 1.2), ("rim", 1.2))]
    assert outcomes == [(1, 1), (10, 3), (8, 2)]


@pytest.mark.laws
@pytest.mark.parametrize("where", ["lying", "standing", "rim"])
@pytest.mark.parametrize("speed", [0.25, 0.4, 0.55, 0.6, 0.8, 0.9, 1.1, 1.2, 1.4, 1.6, 2.0, 3.0, 4.0])
def test_what_becomes_of_a_dropped_egg_does_not_depend_on_the_substep_or_a_micrometre(
    compare: Compare, monkeypatch: pytest.MonkeyPatch, where: str, speed: float
) -> None:
    outcomes = {came_of(fallen(where, speed, shift)) for shift in (0.0, 1e-6, -1e-6)}
    take_finer_steps(monkeypatch, 2)
    outcomes |= {came_of(fallen(where, speed))}
    take_finer_steps(monkeypatch, 2)
    outcomes |= {came_of(fallen(where, speed)), came_of(fallen(where, speed, 1e-6))}
    what = "bonds and parts of a dropped egg are the same at three substeps and 1 um aside"
    compare(what, len(outcomes) == 1, True, by="convergence")
    ((bonds, parts),) = outcomes
    assert (bonds > 0, parts > 1) == (speed > 0.5, speed > 1.0)


@pytest.mark.laws
@pytest.mark.parametrize("finer", [1, 4])
@pytest.mark.parametrize("standing", [False, True])
def test_a_dropped_egg_opens_where_a_dent_as_deep_as_its_membrane_stretches_takes_its_energy(
    compare: Compare, monkeypatch: pytest.MonkeyPatch, standing: bool, finer: int
) -> None:
    take_finer_steps(monkeypatch, finer)
    where = "standing" if standing else "lying"
    speed = opening_speed(POLE if standing else GIRDLE)
    assert 0.95 < speed < 1.1
    # 4 % of speed are 8 % of the depth; it comes out to 4 %, at the usual substep to 8 %.
    below = fallen(where, 0.96 * speed)
    what, by = "a dropped egg opens (4 % slower and faster)", "energy of the blow and of a dent of 2 mm"
    compare(what, came_of(below)[1] > 1, False, by=by)
    assert below.channels["egg1.pressed_in"][-1] == pytest.approx(0.92, abs=0.08)
    compare(what, came_of(fallen(where, 1.04 * speed))[1] == 2, True, by=by)


@pytest.mark.laws
@pytest.mark.parametrize("force", [20.0, 60.0])
def test_whether_a_grasped_egg_breaks_does_not_depend_on_the_substep(force: float) -> None:
    logs = [run(EGG_IN_HAND, f"close(hand1, {force})", duration=1.4, max_step=substep) for substep in SUBSTEPS]
    assert {bonds_broken(log) > 0 for log in logs} == {force > FORCE}


def test_slow_compression_between_pads_breaks_the_egg_as_between_plates(compare: Compare) -> None:
    log = run(EGG_IN_HAND, "close(hand1, 60)", duration=1.6)
    first = int(log.detachments.tick[0])
    # It takes 0.35 s instead of 5; orientations differ by 6 %.
    by = "45 N between plates in 5 s (Commun. Phys. 2025), 1.09 times that in 0.35 s"
    compare("force at which pads break an egg", log.detachments.force[0], 1.09 * FORCE, by=by, share=0.12, unit="N")
    approach = 0.044 - log.channels["hand1.opening"][first]
    by = "between plates, 0.2 to 0.35 mm"
    compare("how far pads come closer until it breaks", 1e3 * approach, (0.2, 0.35), by=by, unit="mm")


def test_a_standing_egg_breaks_from_less_height_than_a_lying_one() -> None:
    def breaks(height: float, *, standing: bool) -> bool:
        return bonds_broken(drop(height, standing=standing)) > 0

    between = 0.0105  # the drop table of docs/egg.md: standing 9.1 mm, lying 11.8 mm
    assert breaks(between, standing=True)
    assert not breaks(between, standing=False)


def test_a_stronger_shell_survives_what_breaks_a_weaker_one() -> None:
    assert bonds_broken(drop(0.012, force=38.0)) > 0
    assert bonds_broken(drop(0.012, force=52.0)) == 0


def test_pieces_move_on_as_their_whole_did_and_nothing_is_lost() -> None:
    state = State.of(compile_world(scene(falling_egg(0.3))))
    things = state.world.scene.things
    pieces = [i for i, thing in enumerate(things) if "Piece" in thing.roles]
    state.data.qvel[:] = (0.3, -0.2, -2.0, 3.0, 1.0, -2.0)
    mujoco.mj_forward(state.model, state.data)
    before = momentum(state)
    state.split("egg1", [pieces[:13], pieces[13:]])
    inside = sum(float(thing.mass) for thing in things if "Stuff" in thing.roles)
    # What was inside flows on as particles.
    assert sum(state.model.body_mass) == pytest.approx(MASS - inside)
    assert momentum(state) == pytest.approx(before * (MASS - inside) / MASS, abs=1e-4)
    assert {int(state.carrier[i]) for i in pieces} == {pieces[0], pieces[13]}
    assert state.carrier[state.world.scene.index("egg1")] == -1


def test_a_shell_that_is_whole_stays_as_stiff_when_another_falls_apart() -> None:
    state = State.of(
        compile_world(scene(":floor a :Floor . :egg1 a :Egg ; :on :floor . :egg2 a :Egg ; :on :floor ; :x 0.2 ."))
    )
    compiled = stiffness_of(state, "egg2/0")
    started(state, Breaking)
    before = stiffness_of(state, "egg2/0")
    assert not np.allclose(compiled, before)
    names = {thing.name: i for i, thing in enumerate(state.world.scene.things)}
    state.split("egg1", [[names[part.name]] for part in state.world.scene.parts("eggshell1")])
    assert np.allclose(stiffness_of(state, "egg2/0"), before)
    state.join(None, [])
    assert np.allclose(stiffness_of(state, "egg2/0"), before)


def test_a_piece_that_falls_apart_keeps_the_friction_that_it_was_given() -> None:
    state = State.of(compile_world(scene(":floor a :Floor . :egg1 a :Egg ; :on :floor .")))
    pieces = [state.scene.index(part.name) for part in state.scene.parts("eggshell1")]
    state.split("egg1", [pieces[:13], pieces[13:]])
    state.set_friction(pieces[3], 0.02)
    state.split(state.scene.things[pieces[0]].name, [pieces[:6], pieces[6:13]])
    geoms = [state.model.geom(f"{state.scene.things[piece].name}/0") for piece in (pieces[3], pieces[4])]
    assert geoms[0].friction[0] == 0.02
    assert geoms[0].priority[0] > geoms[1].priority[0]


def test_what_something_hangs_on_by_a_joint_does_not_fall_apart() -> None:
    state = State.of(compile_world(scene(":floor a :Floor . :bowl1 a :PaperBowl ; :on :floor .")))
    with pytest.raises(InputError, match="bowl1 cannot fall apart: bowl1/panel0, .* hangs on it by a joint"):
        state.split("bowl1", [[state.scene.index("bowl1")]])


def stiffness_of(state: State, name: str) -> FloatArray:
    """Return MuJoCo's reference of a geom's contact with the floor."""
    model: Any = state.model
    geoms = {int(model.geom(name).id), int(model.geom("floor/0").id)}
    (pair,) = [p for p in range(model.npair) if {int(model.pair_geom1[p]), int(model.pair_geom2[p])} == geoms]
    return np.array(model.pair_solref[pair])


def momentum(state: State) -> FloatArray:
    """Return the sum of mass times velocity [kg m/s], shape (3,)."""
    total = np.zeros(3)
    for body in range(1, state.model.nbody):
        velocity = np.zeros(6)
        mujoco.mj_objectVelocity(state.model, state.data, mujoco.mjtObj.mjOBJ_BODY, body, velocity, 0)
        total += state.model.body_mass[body] * velocity[3:]
    return total
