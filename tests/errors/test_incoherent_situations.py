"""What cannot be so is refused before anything moves: names, whole numbers, strengths, places, and what is held."""

from __future__ import annotations

import pytest
from tests.scenes import scene

from prolepsis.engine.world import compile_world
from prolepsis.programs import read_program
from prolepsis.programs.action import ACTIONS, NEEDS
from prolepsis.scene.scene import Scene
from prolepsis.terms.errors import InputError, KnowledgeError, PlanError
from prolepsis.terms.reader import parse_term

BASE = ":floor a :Floor . :table1 a :Table . :hand1 a :Gripper ; :z 1.2 ."
BLOCK = ":block1 a :Block ; :on :table1 ; :length 0.05 ; :width 0.05 ; :height 0.05 ."
EGG = ":egg1 a :Egg ; :hasPart :shell1 . :shell1 a :EggShell ."
WATER = ':volume "20 ml"'

NAMES = {
    ": a :Block .": "has no name",
    "<http://x.org/things/> a :Block .": "has no name",
    ":world a :Block .": "world is what everything stands in",
    "<http://x.org/a%20b> a :Block .": "'a%20b' cannot be a name",
    "<http://x.org/a(b> a :Block .": "cannot be a name",
    ":-a a :Block .": "'-a' cannot be a name",
    f":{'a' * 101} a :Block .": "cannot be a name; allowed: letters, digits",
    ":\ufb01sh a :Block .": "looks like 'fish'; write it so",
    "<http://x.org/A\u030a> a :Block .": "looks like",
    "<http://x.org/hand1\u202e> a :Block .": "'hand1.u202e' cannot be a name",
}


@pytest.mark.parametrize(("turtle", "message"), NAMES.items(), ids=[ascii(name) for name in NAMES])
def test_a_name_that_could_not_be_told_from_others_is_refused(turtle: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        scene(f"{BASE} {turtle}")


def test_a_name_decides_nothing() -> None:
    names = (
        "fish_finger",
        "\u0939\u093f\u0928\u094d\u0926\u0940",
        "palm",
        "a.gripper",
        "hand1-left_finger",
        "Große_Schüssel",
        "_1",
    )
    made = " ".join(
        BLOCK.replace("block1", name) + f" :{name} :x {0.1 * k - 0.2:.1f} ." for k, name in enumerate(names)
    )
    model = compile_world(scene(BASE + made.replace(":on :table1 ;", ":z 1.0 ;"))).model
    for name in names:
        assert model.body(name).parentid == 0
        assert model.body(name).dofnum == 6, f"{name} hangs in the air"


INCOHERENT = {
    ":cup1 a :Cup ; :on :table1 ; :holeCount 2.5 ; :holeRadius 0.004 ; :holeHeight 0.02 .": "a whole number",
    ":bowl1 a :PaperBowl ; :on :table1 ; :panelCount 9.5 .": "panelCount = 9.5: must be finite and a whole number",
    ":egg1 a :Egg ; :on :table1 . :eggshell1 a :EggShell ; :pieceCount 20.5 . :egg1 :hasPart :eggshell1 .": "a whole",
    f"{BLOCK} :block1 :breakingForce 5.0 .": r"block1 \(Block\) has a breakingForce, but .* what does: Coconut, Egg,",
    ":table1 :breakingForce 5.0 .": "table1 .* does not break here",
    ":hand1 :breakingForce 5.0 .": "hand1 .* does not break here",
    ":cup1 a :Cup ; :on :table1 ; :breakingForce 20.0 .": "cup1 .* does not break here",
    ":egg1 a :Egg ; :on :table1 ; :breakingForce 20.0 .": "egg1 breaks by its shell; .* breakingForce of eggshell1",
    f":l a :Water ; {WATER} ; :contains :l .": "l cannot be in itself",
    f":l a :Water ; {WATER} ; :on :l .": "l cannot be on itself",
    f":l a :Water ; {WATER} ; :on :m . :m a :Honey ; {WATER} ; :on :l .": "l cannot be on the Honey m; needed",
    f":l a :Water ; {WATER} ; :on :table1 . {BLOCK.replace(':table1', ':l')}": "block1 cannot be on the Water l",
    f":l a :Water ; {WATER} ; :on :shell1 . {EGG}": "l cannot be on the EggShell shell1",
    f"{BLOCK.replace(':table1', ':block1')}": "block1 cannot be on itself",
    f"{BLOCK.replace(':table1', ':b')} {BLOCK.replace('block1', 'b').replace(':table1', ':block1')}": "in a circle",
    ":cup1 a :Cup ; :contains :cup2 . :cup2 a :Cup ; :contains :cup1 .": "in a circle",
    f"{BLOCK.replace(':on :table1 ;', ':z 1 ;')} :block1 :contains :cup1 . :cup1 a :Cup .": "has no cavity",
}


@pytest.mark.parametrize(("turtle", "message"), INCOHERENT.items())
def test_what_cannot_be_so_is_refused(turtle: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        scene(f"{BASE} {turtle}")


def test_a_situation_without_things_is_refused() -> None:
    with pytest.raises(KnowledgeError, match="names no physical object"):
        scene("")


THINGS = f"""{BASE} {BLOCK} :cup1 a :Cup ; :on :table1 ; :x 0.2 . :egg1 a :Egg ; :on :table1 ; :x -0.2 .
    :water1 a :Water ; {WATER} . :cup1 :contains :water1 . :hand2 a :Gripper ; :x 0.4 ; :z 1.2 ."""
ARGUMENTS = {
    "hand": "hand1",
    "robot": "hand1",
    "part": "top",
    "displacement": "[0.05, 0, 0]",
    "position": "[0.1, 0.1]",
    "file": "'absent.csv'",
}


@pytest.fixture(scope="module")
def things() -> Scene:
    """One of each kind: fixed, solid, hollow, fragile, liquid."""
    return scene(THINGS, particles=1000)


@pytest.mark.parametrize("name", sorted(ACTIONS))
def test_every_action_refuses_what_it_cannot_be_done_with(name: str, things: Scene) -> None:
    spec = ACTIONS[name]
    objects = [k for k, each in enumerate(spec.parameters) if each.kind == "object"]
    for k in objects:
        for wrong, needs in (("water1", ("solid", "loose")), ("floor", ("loose",)), ("table1", ("loose",))):
            if spec.parameters[k].needs not in needs:
                continue
            arguments = [ARGUMENTS.get(each.kind, "0.5") for each in spec.parameters]
            for other, thing in zip(objects, ("block1", "cup1"), strict=False):
                arguments[other] = thing
            arguments[k] = wrong
            given = [a for a, each in zip(arguments, spec.parameters, strict=True) if each.default is None]
            with pytest.raises(InputError):
                read_program(parse_term(f"{name}({', '.join(given)})"), things)
    assert all(each.needs in NEEDS for each in spec.parameters)


def test_what_is_fixed_cannot_be_held(things: Scene) -> None:
    needed = (
        "object of grasp.* must be an object with a body of its own that is not fixed, not the Floor floor; known: "
    )
    with pytest.raises(PlanError, match=needed + "block1, cup1, egg1"):
        read_program(parse_term("grasp(hand1, floor, 5)"), things)
    with pytest.raises(PlanError, match="tries of peel.* must be a whole number, not 2.5"):
        read_program(parse_term("peel(hand1, hand2, egg1, 3, 2.5)"), things)
