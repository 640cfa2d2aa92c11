"""What sticks: the shell of a boiled egg to its kernel, and wet pieces of shell to what they touch."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.comparing import Compare
from tests.scenes import run, scene, started

from prolepsis.engine.state import State
from prolepsis.engine.world import compile_world
from prolepsis.fluents import recognize
from prolepsis.log.log import FREE, Log
from prolepsis.matter.films.adhesion import Adhesion, AdhesiveJoint
from prolepsis.scene.parts import Shard
from prolepsis.system.mujoco import mujoco


@pytest.fixture(scope="module")
def dropped() -> Log:
    return run(":floor a :Floor . :egg1 a :HardBoiledEgg ; :z 0.22 .", duration=0.9)


def test_a_boiled_egg_s_kernel_stays_one_body_when_its_shell_cracks(dropped: Log) -> None:
    kernel = dropped.index("kernel1")
    assert len(dropped.detachments.tick)
    assert dropped.carrier[0, kernel] == dropped.index("egg1")
    assert dropped.carrier[-1, kernel] == kernel
    assert not len(dropped.particles.mass)


def test_a_cracked_boiled_egg_keeps_its_shell(dropped: Log) -> None:
    kernel = dropped.poses[-1, dropped.index("kernel1"), :3]
    pieces = [i for i, thing in enumerate(dropped.things) if "/piece" in thing.name]
    away = np.linalg.norm(dropped.poses[-1, pieces, :3] - kernel, axis=1)
    assert len(set(dropped.carrier[-1, pieces].tolist())) > 1
    assert (away < 0.032).all()
    timeline = recognize(dropped)
    assert timeline.ask("holds(broken(egg1), _), holds_at(attached(kernel1, P), 0.7)")
    assert not timeline.ask("holds(spilled(_), _)")


def apart(turtle: str) -> tuple[State, Adhesion]:
    """Return a run in which the shell of egg1 has fallen into single pieces, and what makes them stick."""
    state = State.of(compile_world(scene(turtle)))
    (controller,) = started(state, Adhesion)
    things = state.world.scene.things
    groups = [[i] for i, thing in enumerate(things) if "Piece" in thing.roles]
    state.split("egg1", groups)
    return state, controller


def go_on(state: State, controller: Adhesion) -> None:
    """Do one tick of rigid-body physics and sticking."""
    mujoco.mj_step1(state.model, state.data)
    state.softening.soften(state.model, state.data)
    mujoco.mj_step2(state.model, state.data)
    controller.act(state)
    controller.end_tick(state)


def test_a_piece_comes_off_a_boiled_egg_at_the_force_of_the_ontology(compare: Compare) -> None:
    state, controller = apart(":floor a :Floor . :egg1 a :HardBoiledEgg ; :z 0.5 .")
    state.model.opt.gravity[:] = 0.0
    pulled = state.world.scene.thing("eggshell1/piece17")
    (area,) = (shard.area for shard in state.scene.each(Shard) if shard.name == pulled.name)
    kernel = state.world.scene.index("kernel1")
    go_on(state, controller)
    go_on(state, controller)
    assert len(state.joints) == 30
    out = next(hold.normal for hold in controller.holds if hold.held == state.world.scene.index(pulled.name))
    force = 0.0
    while (kernel, state.world.scene.index(pulled.name)) in state.joints and force < 5.0:
        state.data.joint("kernel1").qvel[:] = 0.0  # held fast
        force += 1.0e-3  # 1 N/s, slow against the joint's 2 ms
        state.data.qfrc_applied[:] = 0.0
        body = state.data.body(pulled.name)
        nothing = np.zeros(3)
        mujoco.mj_applyFT(state.model, state.data, force * out, nothing, body.xpos, body.id, state.data.qfrc_applied)
        go_on(state, controller)
    compare("a piece of shell comes off a kernel", force, 2500.0 * area, by="strength times area", share=0.05, unit="N")
    assert len(state.joints) == 29


def test_a_piece_that_is_pressed_on_its_kernel_does_not_come_off_by_that() -> None:
    state, controller = apart(":floor a :Floor . :egg1 a :HardBoiledEgg ; :z 0.5 .")
    state.model.opt.gravity[:] = 0.0
    go_on(state, controller)
    go_on(state, controller)
    pressed = state.world.scene.thing("eggshell1/piece17").name
    out = next(hold.normal for hold in controller.holds if hold.held == state.world.scene.index(pressed))
    body = state.data.body(pressed)
    for tick in range(100):
        state.data.joint("kernel1").qvel[:] = 0.0  # held fast
        state.data.qfrc_applied[:] = 0.0
        # In the end more than twice as much as it is held by.
        force, nothing = -1.5 * min(tick / 60, 1.0) * out, np.zeros(3)
        mujoco.mj_applyFT(state.model, state.data, force, nothing, body.xpos, body.id, state.data.qfrc_applied)
        go_on(state, controller)
    assert len(state.joints) == 30


def test_joints_stay_in_place_when_a_shard_falls_apart() -> None:
    state = State.of(compile_world(scene(":floor a :Floor . :egg1 a :HardBoiledEgg ; :z 0.5 .")))
    (controller,) = started(state, Adhesion)
    pieces = [i for i, thing in enumerate(state.world.scene.things) if "Piece" in thing.roles]
    state.split("egg1", [pieces[:1], pieces[1:20], *([piece] for piece in pieces[20:])])
    away = state.world.scene.things[pieces[-1]].name
    state.data.joint(away).qpos[:3] += [0.05, 0.0, 0.0]  # it is no more where the model was built
    for _ in range(2):
        go_on(state, controller)
    joint_count = len(state.joint_forces())
    shard = state.world.scene.things[pieces[1]].name
    state.split(shard, [pieces[1:10], pieces[10:20]])
    left = len(state.joint_forces())
    assert 0 < left < joint_count
    assert strain(state) < 1.0e-4
    controller.rejoin(state)
    assert len(state.joint_forces()) == joint_count
    assert strain(state) < 1.0e-4


def strain(state: State) -> float:
    """Return how far the points that joints hold together are apart at most [m]."""
    return float(np.abs(state.data.efc_pos[: state.data.ne]).max())


@pytest.mark.parametrize("wet", [True, False])
def test_a_wet_piece_sticks_to_a_wall_until_the_film_has_run_out(wet: bool) -> None:
    state, controller = apart(":floor a :Floor . :wall1 a :Wall ; :x 0.3 ; :yaw 90.0 . :egg1 a :Egg ; :z 0.3 .")
    piece = state.world.scene.thing("eggshell1/piece29")
    assert state.particles is not None
    state.particles.holder[:] = FREE
    if wet:
        state.set_attribute(piece.name, "wet", 1.0)
    joint = state.data.joint(piece.name)
    face = 0.29  # the wall is 2 cm thick
    joint.qpos[:3] = (face - 0.0005, 0.0, 0.3)
    pressing = 0.3
    fell_at = stuck_at = 0.0
    for tick in range(12000):
        joint = state.data.joint(piece.name)
        if tick * 1e-3 < pressing:
            joint.qvel[2] = 0.0
            state.data.body(piece.name).xfrc_applied[0] = 0.004
        else:
            state.data.body(piece.name).xfrc_applied[:] = 0.0
        go_on(state, controller)
        stuck_at = stuck_at or (tick * 1e-3 if state.joints else 0.0)
        if joint.qpos[2] < 0.25:
            fell_at = tick * 1e-3
            break
    assert bool(stuck_at) == wet
    if not wet:
        assert 0.3 < fell_at < 0.5
        return
    # 4 pi gamma R cos(theta) sinks to the piece's weight while the film runs out in eta L / (rho g h^2).
    (shard,) = (each for each in state.scene.each(Shard) if each.name == piece.name)
    strength = 4 * math.pi * 0.0475 * shard.radius * math.cos(math.radians(50.0))
    lasting = 0.1 * math.sqrt(shard.area) / (1035.0 * 9.81 * 0.2e-3**2)
    longest = lasting * math.log(strength / (piece.mass * 9.81))
    # Its middle is a little off the wall, so that it pulls outwards too, by less than its weight.
    shortest = lasting * math.log(strength / (2 * piece.mass * 9.81))
    assert shortest < fell_at - pressing < longest


def test_a_hold_weakens_with_time() -> None:
    hold = AdhesiveJoint(holder=0, held=1, point=np.zeros(3), normal=np.zeros(3), strength=1.0, lasting=2.0, since=1.0)
    assert hold.strength_at(1.0) == 1.0
    assert hold.strength_at(3.0) == pytest.approx(math.exp(-1.0))
