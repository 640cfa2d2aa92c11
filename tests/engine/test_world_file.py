"""The world file opens in plain MuJoCo, shows what wholes are made of, and moves as if it did not."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from tests.scenes import EGG_IN_HAND, scene

from prolepsis.engine.world import World, compile_world
from prolepsis.engine.world_file import CONTENTS, PIECES, world_file
from prolepsis.fluents import recognize
from prolepsis.log.log import Log
from prolepsis.log.things import Thing
from prolepsis.system.mujoco import mujoco

CUP = ":cup1 a :Cup ; :on :table1 ; :x 0.2 ; :roll 20.0 ; :contains :liq-1--a . :liq-1--a a :Water ; :fill 0.2 . "
SPONGE = ":sponge1 a :Sponge ; :on :table1 ; :x -0.2 ; :saturation 0.5 ; :absorbs :liq2 . :liq2 a :Water . "
SITUATIONS = {
    "an egg in a hand": EGG_IN_HAND,
    "a tilted egg with a firm kernel": ":floor a :Floor . :nut a :Coconut ; :z 1.0 ; :pitch 40.0 ; :yaw 70.0 .",
    "liquids": ":floor a :Floor . :table1 a :Table ; :y 0.3 . " + CUP + SPONGE,
    "bowls": ":floor a :Floor . :bowl1 a :Bowl ; :on :floor . :bowl2 a :PaperBowl ; :x 0.3 ; :on :floor .",
}


@pytest.fixture(scope="module", params=sorted(SITUATIONS))
def world(request: pytest.FixtureRequest) -> World:
    return compile_world(scene(SITUATIONS[request.param], particles=1500))


def plain(world: World) -> Any:
    """Return the model of a world as MuJoCo writes it, without anything that is only shown."""
    spec = world.spec.copy()
    spec.compile()
    return mujoco.MjModel.from_xml_string(spec.to_xml())


def shown(world: World) -> Any:
    return mujoco.MjModel.from_xml_string(world_file(world))


def stepped(model: Any, count: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the full integration states of some steps, shape (count, n)."""
    data = mujoco.MjData(model)
    full = mujoco.mjtState.mjSTATE_INTEGRATION
    states = np.zeros((count, mujoco.mj_stateSize(model, full)))
    for state in states:
        mujoco.mj_getState(model, data, state, full)
        mujoco.mj_step(model, data)
    return states


def test_what_is_shown_changes_no_physics(world: World) -> None:
    with_it, without = shown(world), plain(world)
    for field in ("nq", "nv", "nu", "nbody", "njnt", "npair"):
        assert getattr(with_it, field) == getattr(without, field)
    for field in ("body_mass", "body_inertia", "body_ipos", "body_iquat"):
        assert (getattr(with_it, field) == getattr(without, field)).all()
    assert (stepped(with_it, 50) == stepped(without, 50)).all()


def test_a_log_made_with_the_world_file_is_recognized_alike(world: World) -> None:
    logs = [Log.from_mujoco(model, stepped(model, 200), 0.001) for model in (shown(world), plain(world))]
    assert recognize(logs[0]).facts == recognize(logs[1]).facts
    assert [thing.shape for thing in logs[0].things] == [thing.shape for thing in logs[1].things]


def test_all_that_emerges_is_shown_at_its_place(world: World) -> None:
    model = shown(world)
    data = mujoco.MjData(model)
    for name, value in world.posture.items():
        data.joint(name).qpos[0] = value
    mujoco.mj_forward(model, data)
    for thing in world.scene.things:
        for k, geom in enumerate(thing.shape.geoms if thing.emerges else ()):
            made = model.geom(f"{thing.name}/{k}")
            assert made.group[0] in (PIECES, CONTENTS) and not (made.contype[0] or made.conaffinity[0])
            if geom.type == "mesh":
                assert np.abs(corners(model, data, made.id) - placed(thing, np.array(geom.vertices))).max() < 1e-6


def corners(model: Any, data: Any, geom: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return the vertices of a mesh in the world, shape (v, 3)."""
    first, count = model.mesh_vertadr[model.geom_dataid[geom]], model.mesh_vertnum[model.geom_dataid[geom]]
    return data.geom_xpos[geom] + model.mesh_vert[first : first + count] @ data.geom_xmat[geom].reshape(3, 3).T


def placed(thing: Thing, points: np.ndarray[Any, np.dtype[np.float64]]) -> np.ndarray[Any, np.dtype[np.float64]]:
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, np.array(thing.orientation))
    return np.array(thing.position) + points @ turn.reshape(3, 3).T


def test_bonds_join_all_pieces_of_a_whole() -> None:
    model = shown(compile_world(scene(EGG_IN_HAND)))
    pieces = {model.geom(g).name.removesuffix("/0") for g in range(model.ngeom) if model.geom_group[g] == PIECES}
    bonds = [model.site(s).name.split(":") for s in range(model.nsite) if model.site_group[s] == PIECES]
    assert len(pieces) == 30 and {name for bond in bonds for name in bond} == pieces
    together = {min(pieces)}
    for _ in pieces:
        together |= {name for bond in bonds if together.intersection(bond) for name in bond}
    assert together == pieces


def test_contents_are_where_the_particles_are_and_move_with_what_they_are_in() -> None:
    known = scene(SITUATIONS["liquids"], particles=1500)
    model = shown(compile_world(known))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for pool, holder in zip(known.pools, ("cup1", "sponge1"), strict=True):
        sites = [s for s in range(model.nsite) if model.site(s).name.startswith(f"{pool.stuff}/")]
        assert 500 <= len(sites) <= 1000
        assert {model.body(model.site_bodyid[s]).name for s in sites} == {holder}
        assert set(model.site_group[sites]) == {CONTENTS}
        numbers = [int(model.site(s).name.rpartition("/")[2]) for s in sites]
        assert np.abs(data.site_xpos[sites] - pool.position[numbers]).max() < 1e-6
        volume = 8 * (model.site_size[sites, 0] ** 3).sum()
        assert volume == pytest.approx(len(pool.position) * pool.spacing**3, rel=0.01)


def test_comments_tell_what_each_thing_is() -> None:
    builder = ElementTree.TreeBuilder(insert_comments=True)
    text = world_file(compile_world(scene(EGG_IN_HAND + CUP, particles=1500)))
    root = ElementTree.fromstring(text, ElementTree.XMLParser(target=builder))
    comments = [str(each.text).strip() for each in root.iter() if each.tag is ElementTree.Comment]
    shell = next(each for each in comments if each.startswith("eggshell1: EggShell in egg1, 30 pieces of "))
    assert "78 bonds" in shell and "breakingForce 45" in shell
    assert any(each.startswith("yolk1: EggYolk in egg1, ") and "mass 0.018" in each for each in comments)
    assert any(each.startswith("liq-1- -a: Water in cup1, 1500 particles; ") for each in comments)
