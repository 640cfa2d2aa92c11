"""A sponge takes up, keeps, drips and gives off liquid, and not a particle is lost."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.comparing import Compare
from tests.scenes import run, scene, started

from prolepsis.engine.state import State
from prolepsis.engine.world import compile_world
from prolepsis.geometry.shape import FloatArray
from prolepsis.log.log import FREE, Log
from prolepsis.matter.sponges import absorbing
from prolepsis.matter.sponges.carried_mass import CarriedMass
from prolepsis.matter.sponges.sponge_law import SpongeLaw
from prolepsis.system.mujoco import mujoco

SIZE = ":length 0.06 ; :width 0.05 ; :height 0.02"
DRY = 0.003
"""Dry mass of a sponge of this size [kg]: 50 kg/m^3 times 60 cm^3."""
FULL = 15 * DRY
"""What it can hold [kg]."""
WATER = 998.0
TABLE = ":floor a :Floor . :table1 a :Table . "
SOAKED = f":sponge1 a :Sponge ; {SIZE} ; :on :table1 ; :saturation 1.0 ; :absorbs :liq1 . :liq1 a :Water . "
GRIP = 1.2
"""Force of a pad [N]: enough to carry it soaked."""
GRIPPED = 1 - GRIP / (0.06 * 0.02) / 12e3
"""Share of its capacity that is left when it is gripped so, on a face of 6 by 2 cm, at a modulus of 12 kPa."""
HAND = ":hand1 a :Gripper ; :pitch 90.0 ; :z 0.7355 ; :opening 0.06 . "


def held(log: Log, liquid: str = "liq1") -> FloatArray:
    """Return the mass of a liquid that the sponge holds in each frame [kg], shape (F,)."""
    p = log.particles
    own = p.stuff == log.index(liquid)
    return (p.holder[:, own] == log.index("sponge1")) @ p.mass[own]


@pytest.fixture(scope="module")
def bathed() -> Log:
    bowl = ":bowl1 a :Bowl ; :on :table1 ; :y 0.2 ; :contains :liq1 . :liq1 a :Water ; :volume 0.0002 . "
    dip = "carry(hand1, [0, 0.2, 0]), carry(hand1, [0, 0, -0.06]), hold(hand1, 6.0)"
    plan = f"sequence([grasp(hand1, sponge1, {GRIP}, 0.012), lift(hand1, 0.08), {dip}])"
    return run(TABLE + bowl + f":sponge1 a :Sponge ; {SIZE} ; :on :table1 . " + HAND, plan, particles=1000)


@pytest.fixture(scope="module")
def squeezed() -> Log:
    plan = "sequence([grasp(hand1, sponge1, 2, 0.012), lift(hand1, 0.05), squeeze(hand1, sponge1, 60, 1.0)])"
    return run(TABLE + SOAKED + HAND, plan, particles=800)


def test_a_dry_sponge_that_is_dipped_in_water_fills_to_its_capacity_and_no_further(
    compare: Compare, bathed: Log
) -> None:
    taken = held(bathed)
    assert taken[0] == 0.0
    assert taken.max() <= FULL
    # The hand's pressure hardly varies, and at the end few particles are missing.
    by = "15 times its mass, less what the grip presses out"
    compare("a gripped sponge that is dipped fills", taken[-1], GRIPPED * FULL, by=by, share=0.02, unit="kg")


def test_it_fills_first_quickly_and_then_ever_more_slowly(bathed: Log) -> None:
    taken = held(bathed)
    # From where the front is deeper than a spacing on.
    times = [float(np.argmax(taken > share * FULL)) for share in (0.3, 0.45, 0.6, 0.75)]
    first, second, third = np.diff(times)
    assert 0 < first < second < third


def test_no_particle_and_no_mass_is_lost_between_table_sponge_and_bowl(bathed: Log, squeezed: Log) -> None:
    for log in (bathed, squeezed):
        p = log.particles
        holders = {FREE, log.index("sponge1")}
        assert set(np.unique(p.holder).tolist()) == holders
        total = sum((p.holder == holder) @ p.mass for holder in holders)
        assert total == pytest.approx(np.full(len(p.tick), p.mass.sum()), rel=1e-12)
        assert np.isfinite(p.position).all()


def test_what_it_holds_is_inside_it_and_moves_with_it(squeezed: Log) -> None:
    p, sponge = squeezed.particles, squeezed.index("sponge1")
    moved = np.ptp(squeezed.poses[:, sponge, 2])
    assert moved > 0.04
    half = np.array([0.03, 0.025, 0.01])
    for frame in range(0, len(p.tick), 10):
        pose = squeezed.poses[p.tick[frame], sponge]
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, pose[3:])
        local = (p.position[frame][p.holder[frame] == sponge] - pose[:3]) @ turn.reshape(3, 3)
        # A frame may be a tick older than the pose.
        assert (np.abs(local) < half + 1e-3).all()


def test_pressed_hard_it_keeps_what_a_hand_leaves_in_it(squeezed: Log) -> None:
    pressing = next(action for action in squeezed.actions if action.term.functor == "squeeze")
    end = int(np.searchsorted(squeezed.particles.tick, pressing.end)) - 1
    assert held(squeezed)[:end].min() == pytest.approx(2 * DRY, abs=2 * squeezed.particles.mass[0])


def test_what_comes_out_is_beside_it_and_takes_the_place_of_nothing() -> None:
    state = State.of(
        compile_world(scene(f":floor a :Floor . {SOAKED.replace(':on :table1', ':z 0.5')}", particles=800))
    )
    (sponge,) = started(state, absorbing.Absorbing)
    particles = state.particles
    assert particles is not None
    # Nothing flows away here, so what comes out finds ever fewer free places.
    for _ in range(40):
        sponge.pressure = 1e4
        for _ in range(absorbing.LOOK_TICKS):
            sponge.end_tick(state)
    free = particles.position[particles.free]
    assert 300 < len(free) < 800
    apart = np.linalg.norm(free[:, None] - free[None], axis=2) + np.eye(len(free))
    assert apart.min() > 0.89 * particles.spacing
    outside = np.abs(free - (0.0, 0.0, 0.5)) - (0.03, 0.025, 0.01)
    assert outside.max(axis=1).min() > 0.3 * particles.spacing
    assert not particles.velocity[particles.free].any()


def test_a_soaked_sponge_that_is_lifted_drips_down_to_what_it_retains(compare: Compare) -> None:
    quick = {"sponge1.drippingTime": 1.0}
    plan = f"sequence([grasp(hand1, sponge1, {GRIP}, 0.012), lift(hand1, 0.05), hold(hand1, 5.0)])"
    log = run(TABLE + SOAKED + HAND, plan, particles=800, values=quick)
    kept = held(log)
    compare("a lifted sponge drips", kept[-1], 0.7 * FULL, by="70 % of what it can hold", share=0.02, unit="kg")
    assert kept.min() > 0.7 * FULL - 1.01 * log.particles.mass[0]


def test_a_soaked_sponge_that_lies_on_a_table_does_not_drip() -> None:
    log = run(TABLE + SOAKED, "wait(2.0)", particles=500)
    # Its own weight presses some of it out: 45 g on 30 cm^2, against a modulus of 12 kPa.
    assert held(log)[-1] > 0.97 * FULL


def test_the_table_bears_the_weight_of_the_sponge_with_what_it_holds(compare: Compare) -> None:
    log = run(TABLE + SOAKED, "wait(1.0)", particles=500)
    sponge, table = log.index("sponge1"), log.index("table1")
    rows = (log.contacts.tick > 500) & (log.contacts.a == min(sponge, table)) & (log.contacts.b == max(sponge, table))
    force = abs(log.contacts.force[rows, 2].sum()) / (log.tick_count - 501)
    weight = (DRY + held(log)[-1]) * 9.81
    compare("a sponge with water weighs on a table", force, weight, by="its weight", share=0.01, unit="N")


def test_honey_hardly_enters_a_sponge_in_the_time_in_which_water_does() -> None:
    puddle = ":liq1 a :{} ; :on :table1 ; :volume 3e-6 . :sponge1 a :Sponge ; " + SIZE + " ; :on :table1 ; :x 0.047 . "
    water, honey = (held(run(TABLE + puddle.format(kind), "wait(2.0)", particles=100)) for kind in ("Water", "Honey"))
    assert water[-1] > 3e-4
    assert honey[-1] == 0.0


def test_the_model_is_as_if_it_had_been_compiled_with_the_heavier_body() -> None:
    state = State.of(compile_world(scene(TABLE + f":sponge1 a :Sponge ; {SIZE} ; :on :table1 .")))
    carried = CarriedMass("sponge1", DRY)
    carried.set(state, 0.02)
    carried.set(state, 0.005)
    changed = {name: np.array(getattr(state.model, name)) for name in DERIVED}
    mujoco.mj_setConst(state.model, mujoco.MjData(state.model))
    assert state.model.body("sponge1").mass == pytest.approx(DRY + 0.005)
    for name, values in changed.items():
        assert values == pytest.approx(np.array(getattr(state.model, name)), rel=1e-9), name


DERIVED = ("body_subtreemass", "body_invweight0", "dof_invweight0", "dof_M0")


def test_what_it_takes_up_gives_it_its_momentum() -> None:
    state = State.of(compile_world(scene(f":sponge1 a :Sponge ; {SIZE} ; :z 1.0 ; :yaw 30.0 .")))
    rng = np.random.default_rng(3)
    state.data.qvel[:] = rng.normal(size=6)
    mujoco.mj_forward(state.model, state.data)
    places = state.data.xpos[1] + rng.normal(size=(40, 3)) * 0.02
    velocity, mass = rng.normal(size=(40, 3)), np.full(40, 1e-5)
    frame = state.data.xmat[1].reshape(3, 3)
    inertia = frame @ np.diag(DRY / 12 * np.array([0.05**2 + 0.02**2, 0.06**2 + 0.02**2, 0.06**2 + 0.05**2])) @ frame.T
    arms, middle = places - state.data.xpos[1], state.data.qvel[:3].copy()
    linear = DRY * middle + mass @ velocity
    angular = inertia @ (frame @ state.data.qvel[3:6]) + mass @ np.cross(arms, velocity - middle)
    CarriedMass("sponge1", DRY).collide(state, places, velocity, mass)
    heavier = (DRY + mass.sum()) / DRY
    assert heavier * DRY * state.data.qvel[:3] == pytest.approx(linear, rel=1e-9)
    assert heavier * inertia @ (frame @ state.data.qvel[3:6]) == pytest.approx(angular, rel=1e-6)


def test_the_law_of_a_sponge() -> None:
    known = {
        "absorbentCapacity": 15.0,
        "drippingRetention": 0.7,
        "squeezedCapacity": 2.0,
        "youngsModulus": 12e3,
        "uptakeSpeed": 0.005,
        "pressingTime": 0.15,
        "recoveryTime": 1.0,
        "drippingTime": 10.0,
    }
    law = SpongeLaw.of(known, mass=0.01, thickness=0.03)
    assert (law.capacity, law.retained, law.squeezed) == pytest.approx((0.15, 0.105, 0.02))
    assert law.capacity_under(0.0) == law.capacity
    assert law.capacity_under(3e3) == pytest.approx(0.75 * law.capacity)
    assert law.capacity_under(1e6) == law.squeezed
    # Laid in water, dry, it fills through its thickness in the time that the mean speed tells.
    depth, time, dt = 1e-5, 0.0, 1e-4
    while depth < law.thickness:
        held = law.capacity * depth / law.thickness
        depth += float(law.front_speed(held, np.array([1e-3]), 1e-5)[0]) * dt
        time += dt
    assert time == pytest.approx(0.03 / 0.005, rel=0.01)
    assert law.front_speed(0.1, np.array([1.0]), 1e-3) == pytest.approx(
        1e-3 * law.front_speed(0.1, np.array([1e-3]), 1e-3)
    )
    # Springing back takes time, giving way does not.
    assert law.pressure_after(0.0, 5e3, 0.005) == 5e3
    assert law.pressure_after(5e3, 0.0, 1.0) == pytest.approx(5e3 / math.e)


def test_in_a_scene_without_liquid_nothing_looks_after_a_sponge() -> None:
    state = State.of(compile_world(scene(TABLE + f":sponge1 a :Sponge ; {SIZE} ; :on :table1 .")))
    assert not started(state, absorbing.Absorbing)
