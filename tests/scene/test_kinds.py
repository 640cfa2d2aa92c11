"""Kinds claim things by what is inferred of them, never by a name; what nobody can make is refused at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest
from tests.knowledge.situations import load
from tests.scenes import run, scene

from prolepsis.engine.placing import resting_height
from prolepsis.engine.simulation import simulate
from prolepsis.engine.world import compile_world
from prolepsis.geometry.shape import Geom
from prolepsis.log.files import read_log, write_log
from prolepsis.log.happenings import DETACHMENT, Happening, HappeningType
from prolepsis.log.log import Log
from prolepsis.log.things import FREE, Thing, falling_apart, jointed, own_solids
from prolepsis.matter.kinds import known_kinds
from prolepsis.programs import read_program
from prolepsis.scene.compose import compose
from prolepsis.scene.kind import Channel, Controller, Individuals, Kind, Made
from prolepsis.scene.parts import Panel, Shard
from prolepsis.scene.running import TICK, Running
from prolepsis.terms.errors import InputError, KnowledgeError, UnknownNameError
from prolepsis.terms.reader import parse_term

FLOOR = ":floor a :Floor . "


def simulated(turtle: str, plan: str, *kinds: Kind) -> Log:
    """Return the log of a run with some kinds more."""
    known = scene(turtle)
    world = compile_world(replace(known, kinds=(*known.kinds, *kinds)))
    return simulate(world, read_program(parse_term(plan), known))


@pytest.mark.parametrize("name", ["fish_finger", "left_finger", "palm", "panel0", "piece1"])
def test_a_name_decides_nothing(name: str) -> None:
    log = run(FLOOR + f":{name} a :Block ; :z 0.5 .", duration=2.0)
    heights = log.poses[:, log.index(name), 2]
    assert log.things[log.index(name)].mount == FREE
    assert heights[0] == pytest.approx(0.5)
    assert heights[-1] == pytest.approx(0.05, abs=2e-3)


def test_parts_are_typed() -> None:
    made = scene(FLOOR + ":egg1 a :Egg ; :on :floor . :bowl1 a :PaperBowl ; :on :floor ; :x 0.3 .")
    shards, panels = made.each(Shard), made.each(Panel)
    assert {shard.whole for shard in shards} == {"egg1"}
    assert falling_apart(made.things) == {"egg1", "eggshell1"}
    assert {panel.whole for panel in panels} == {"bowl1"}
    assert [made.thing(shard.name).emerges for shard in shards] == [True] * len(shards)
    assert [made.thing(panel.name).mount for panel in panels] == [jointed("bowl1")] * len(panels)
    surface = sum(shard.area for shard in shards)
    assert surface == pytest.approx(7.0e-3, rel=0.1)  # of an ellipsoid of 57 mm by 44 mm


@pytest.mark.parametrize(
    ("turtle", "message"),
    [
        (":a a :Block , :Breakable ; :on :floor .", "a .Block. is Breakable, but does not break here; what does"),
        (":t a :Table ; :hasPart :b . :b a :Egg .", "t .Table. is Breakable, but does not break here"),
        (":a a :Block ; :breakingForce 30.0 ; :on :floor .", "has a breakingForce, but does not break here"),
        (
            ':a a :Block ; :colour "red" ; :on :floor .',
            "colour 'red'; allowed: red, green, blue and opacity, each from 0",
        ),
        (':a a :Block ; :colour "1 0 2" ; :on :floor .', "colour '1 0 2'; allowed"),
    ],
)
def test_what_cannot_be_is_refused_where_it_is_composed(turtle: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        scene(FLOOR + turtle)


class Claiming(Kind):
    """A kind that claims what another one does."""

    claims = "Egg"


def test_what_two_kinds_claim_is_refused(tmp_path: Path) -> None:
    known = load(tmp_path, FLOOR + ":egg1 a :Egg ; :on :floor .")
    with pytest.raises(KnowledgeError, match="egg1 .Egg. is each of Egg, Shelled; allowed: one of them"):
        compose(known, (*known_kinds(), Claiming()), resting_height, 100)


class ClaimingLiquid(Kind):
    """A kind that claims what flows by another one."""

    claims = "Water"


def test_what_flows_and_is_claimed_is_refused(tmp_path: Path) -> None:
    known = load(tmp_path, FLOOR + ":w a :Water ; :on :floor ; :volume '5 ml' .")
    with pytest.raises(KnowledgeError, match="w .Water. is each of Water, Liquids; allowed: one of them"):
        compose(known, (*known_kinds(), ClaimingLiquid()), resting_height, 100)


@pytest.mark.parametrize("shape", ["", "; :shape :box ; :length 1 ; :width 1 ; :height 1 ; :mass 1"])
def test_a_stuff_that_nothing_makes_is_refused(tmp_path: Path, shape: str) -> None:
    known = load(tmp_path, FLOOR + f":s a :Stuff ; :on :floor {shape} .")
    with pytest.raises(KnowledgeError, match="s .Stuff. is a stuff that nothing tells how to make; allowed: a Liquid"):
        compose(known, known_kinds(), resting_height, 100)


class Ageing(Kind):
    """A kind whose particles age, and which tells when they are a twentieth of a second old."""

    order = 90
    happenings = (HappeningType(name="birthday", things=("liquid",), numbers=("age",)),)

    def start(self, state: Running) -> Sequence[Controller]:
        return [Aging()]


class Aging(Controller):
    """The controller of all ages."""

    def bind(self, state: Running) -> None:
        assert state.particles is not None
        state.particles.columns.setdefault("age", np.zeros(len(state.particles.mass)))

    def end_tick(self, state: Running) -> None:
        assert state.particles is not None
        state.particles.columns["age"] += TICK
        if abs(state.particles.columns["age"][0] - 0.05) < TICK / 2:
            liquid = int(state.particles.stuff[0])
            state.report(Happening(type="birthday", things={"liquid": liquid}, numbers={"age": 0.05}))


def test_a_kind_may_add_columns_to_particles_and_happenings(tmp_path: Path) -> None:
    water = ":liq1 a :Water ; :on :floor ; :volume 20.0e-6 ."
    log = simulated(FLOOR + water, "wait(0.1)", Ageing())
    write_log(log, tmp_path / "log")
    for each in (log, read_log(tmp_path / "log")):
        ages = each.particles.columns["age"]
        assert ages.shape == each.particles.holder.shape
        assert ages[:, -1] == pytest.approx(each.particles.tick * TICK, rel=1e-5)
        birthday = each.happenings["birthday"]
        assert (birthday.tick.tolist(), birthday.things["liquid"].tolist()) == ([49], [log.index("liq1")])
        assert birthday.numbers["age"].tolist() == [0.05]


class Misfitting(Kind):
    """A kind that changes the columns of particles when it must not."""

    def __init__(self, late: bool) -> None:
        self.late = late

    def start(self, state: Running) -> Sequence[Controller]:
        def tell(state: Running) -> None:
            assert state.particles is not None
            state.particles.columns["age"] = np.zeros(len(state.particles.mass) if self.late else 3)

        if not self.late:
            tell(state)
        return [Telling(tell)]


@pytest.mark.parametrize(
    ("late", "message"),
    [
        (True, "at tick 20 their columns are age, at the start none; a kind adds its own when it starts"),
        (False, r"particles: age is of shape \(3,\); needed: \(\d+,\), one for each"),
    ],
)
def test_columns_of_particles_are_one_for_each_from_the_start_on(late: bool, message: str) -> None:
    with pytest.raises(InputError, match=message):
        simulated(FLOOR + ":liq1 a :Water ; :on :floor ; :volume 20.0e-6 .", "wait(0.03)", Misfitting(late))


def test_what_has_particles_of_its_own_is_seen_where_it_is() -> None:
    log = run(FLOOR + ":egg1 a :Egg ; :z 0.5 .", duration=0.1)
    egg, seen = log.index("egg1"), log.particles
    middle = np.average(seen.position, axis=1, weights=seen.mass)
    assert (seen.holder == egg).all()
    away = middle - log.poses[seen.tick, egg, :3]
    assert np.abs(away - away[0]).max() < 1e-5
    assert middle[-1, 2] < middle[0, 2] - 0.03


class Loading(Kind):
    """A kind that calls its channel as shells call one of theirs."""

    channels = (Channel(name="load", doc="what it bears [N]"),)


class Detaching(Kind):
    """A kind that tells of other detachments than shells do."""

    happenings = (HappeningType(name=DETACHMENT.name, things=("thing",)),)


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        (Loading(), "(Loading|Shells): load is declared otherwise by (Shells|Loading); take another name"),
        (Detaching(), "detachment is declared otherwise by"),
    ],
)
def test_two_kinds_cannot_mean_two_things_by_one_name(tmp_path: Path, kind: Kind, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        compose(load(tmp_path, FLOOR), (*known_kinds(), kind), resting_height, 100)


class Polishing(Kind):
    """A kind of what may be polished; tables are from the start."""

    channels = (Channel(name="polished", doc="1 where it is polished, else 0", begins="Table"),)


def test_what_a_thing_has_at_the_start_is_told_by_its_class(tmp_path: Path) -> None:
    turtle = FLOOR + ":table1 a :Table . :b a :Block ; :on :table1 ; :wet true . :wet_c a :Block ; :on :floor ; :x 2 ."
    made = compose(load(tmp_path, turtle), (*known_kinds(), Polishing()), resting_height, 100)
    shown = {name: ["wet", "dirty", "polished"] for name in ("table1", "b", "wet_c")}
    log = simulate(compile_world(made), read_program(parse_term("wait(0.001)"), made), duration=0.01, monitors=shown)
    having = {name for name, series in log.channels.items() if series.all()}
    assert having == {"table1.polished", "b.wet"}


WATER = ":liq1 a :Water ; :on :floor ; :volume 20.0e-6"


@pytest.mark.parametrize(
    ("turtle", "message"),
    [
        (
            f"{WATER} ; :membraneForce 0.1 .",
            "ttl:2: liq1 .Water. makes no use of membraneForce",
        ),
        (
            f"{WATER} ; :absorbentCapacity 15.0 .",
            "liq1 .Water. makes no use of absorbentCapacity; .*what does: Absorbent",
        ),
        (
            ":egg1 a :Egg ; :on :floor ; :membraneForce 0.1 .",
            "egg1 .Egg. makes no use of membraneForce; .*does: ShellContent",
        ),
        (
            ":egg1 a :Egg ; :on :floor ; :shellThickness 0.001 .",
            "egg1 .Egg. makes no use of shellThickness; .*what does: Shell",
        ),
        (
            ":egg1 a :Egg ; :on :floor ; :absorbentCapacity 15.0 .",
            "egg1 .Egg. makes no use of absorbentCapacity; what does: Absorbent",
        ),
        (":egg1 a :Egg ; :on :floor ; :viscosity 0.1 .", "egg1 .Egg. makes no use of viscosity; .*what does: Liquid"),
        (
            ":bowl1 a :Bowl ; :on :floor ; :bucklingForce 3.0 .",
            "bowl1 .Bowl. makes no use of bucklingForce; .*YieldingBowl",
        ),
        (":b a :Block ; :on :floor ; :volume 0.001 .", "b .Block. makes no use of volume; .*what does: Liquid"),
    ],
)
def test_a_quantity_of_which_nothing_makes_use_is_refused(turtle: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        scene(FLOOR + turtle)


@pytest.mark.parametrize(
    ("turtle", "message"),
    [
        (
            ":b a :Block ; :on :floor ; :radius 0.3 .",
            "b .Block.: a box makes no use of radius; what it does: height, le",
        ),
        (":b a :Block ; :on :floor ; :lid true .", "b .Block.: a box makes no use of lid"),
        (":b a :Ball ; :on :floor ; :length 0.1 .", "b .Ball.: a sphere makes no use of length; what it does: radius"),
        (
            ":c a :Cup ; :on :floor ; :holeHeight 0.05 .",
            "c .Cup.: a cup makes no use of holeHeight; what it does: bott",
        ),
        (":b a :Block ; :on :floor ; :scale 2.0 .", "b .Block.: a box makes no use of scale"),
    ],
)
def test_an_extent_that_a_shape_has_not_is_refused(turtle: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        scene(FLOOR + turtle)


@pytest.mark.parametrize(
    ("said", "message"),
    [
        (":fill 0.5 ; :volume 1.0e-4", "l .Water.: its volume and fill are stated; allowed: one of volume, mass, fill"),
        (":mass 0.5 ; :volume 1.0e-4", "l .Water.: its volume and mass are stated; allowed: one of"),
        (":mass 0.05 ; :fill 0.5", "l .Water.: its mass and fill are stated; allowed: one of"),
    ],
)
def test_two_amounts_of_a_liquid_are_refused(said: str, message: str) -> None:
    with pytest.raises(KnowledgeError, match=message):
        scene(FLOOR + f":c a :Cup ; :on :floor ; :contains :l . :l a :Water ; {said} .")


def test_a_mass_that_is_that_of_the_volume_may_be_told_too() -> None:
    made = scene(FLOOR + ":c a :Cup ; :on :floor ; :contains :l . :l a :Water ; :mass 0.0998 ; :volume 1.0e-4 .")
    assert made.thing("l").mass == pytest.approx(0.0998)


def test_a_useless_quantity_is_refused_however_it_is_told() -> None:
    with pytest.raises(KnowledgeError, match="block1 .Block. makes no use of viscosity"):
        scene(FLOOR + ":block1 a :Block ; :on :floor .", {"block1.viscosity": 1.0})


@pytest.mark.parametrize(
    "turtle",
    [
        ":b a :Block ; :on :floor ; :hasPart :c . :c a :Ball .",
        ":hand1 a :Gripper ; :z 0.5 ; :hasPart :c . :c a :Ball .",
        ":bowl1 a :PaperBowl ; :on :floor ; :hasPart :c . :c a :Ball .",
        ":egg1 a :Egg ; :on :floor ; :hasPart :c . :c a :Ball .",
        ":b a :Block ; :on :floor . :c a :Ball ; :partOf :b .",
    ],
)
def test_a_part_of_what_has_no_such_parts_is_refused(turtle: str) -> None:
    with pytest.raises(
        KnowledgeError, match="ttl:2: c .Ball. is a part of .* has no such part; allowed: a thing of its"
    ):
        scene(FLOOR + turtle)


class Misspelt(Kind):
    """A kind of a class that there is not."""

    roles = frozenset({"Absorbant"})


def test_a_kind_of_an_unknown_class_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UnknownNameError, match="Misspelt: no class named 'Absorbant'; did you mean 'Absorbent'"):
        compose(load(tmp_path, FLOOR), (*known_kinds(), Misspelt()), resting_height, 100)


class Telling(Controller):
    """A controller that tells something in the first tick."""

    def __init__(self, tell: Callable[[Running], None]) -> None:
        self._tell = tell

    def end_tick(self, state: Running) -> None:
        self._tell(state)


class Teller(Kind):
    """A kind that declares one thing, and tells what it is told to."""

    channels = (Channel(name="weariness", doc="how weary it is [1]", role="Breakable"),)
    happenings = (HappeningType(name="yawn", things=("thing",), numbers=("width",)),)

    def __init__(self, tell: Callable[[Running], None]) -> None:
        self.tell = tell

    def start(self, state: Running) -> Sequence[Controller]:
        return [Telling(self.tell)]


def sets(name: str, attribute: str) -> Callable[[Running], None]:
    """Return what sets an attribute of a thing."""
    return lambda state: state.set_attribute(name, attribute, 1.0)


def yawn(type: str = "yawn", number: str = "width", **things: int) -> Callable[[Running], None]:
    """Return what reports a yawn."""
    return lambda state: state.report(Happening(type=type, things=things, numbers={number: 1.0}))


@pytest.mark.parametrize(
    ("tell", "message"),
    [
        (sets("block1", "wearyness"), "no channel that is set named 'wearyness'; did you mean 'weariness'.; known: br"),
        (sets("block1", "speed"), "no channel that is set named 'speed'"),
        (sets("block2", "wet"), "no object named 'block2'; did you mean 'block1'"),
        (sets("block1", "weariness"), "block1: weariness is of a Breakable, which"),
        (
            yawn("yown", thing=0),
            "no type of happenings named 'yown'; did you mean 'yawn'.; known: detachment, film",
        ),
        (yawn(think=0), "yawn: reported with think; declared: thing"),
        (yawn(number="breadth", thing=0), "yawn: reported with breadth; declared: width"),
        (yawn(thing=7), "yawn: thing is 7, which is no index of the 2 things"),
    ],
)
def test_what_no_kind_declares_is_neither_set_nor_reported(tell: Callable[[Running], None], message: str) -> None:
    with pytest.raises(InputError, match=message):
        simulated(FLOOR + ":block1 a :Block ; :on :floor .", "wait(0.002)", Teller(tell))


def test_what_a_kind_declares_is_set_and_reported() -> None:
    def tell(state: Running) -> None:
        state.set_attribute("egg1", "weariness", 0.5)
        state.report(Happening(type="yawn", things={"thing": 0}, numbers={"width": 1.0}))

    log = simulated(FLOOR + ":egg1 a :Egg ; :on :floor .", "wait(0.002)", Teller(tell))
    assert len(log.happenings["yawn"]) == log.tick_count


class MisspeltQuantity(Kind):
    """A kind that makes use of a property that there is not."""

    quantities = MappingProxyType({"viscocity": "Liquid"})


def test_a_kind_of_an_unknown_property_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UnknownNameError, match="MisspeltQuantity: no property named 'viscocity'; did you mean 'visc"):
        compose(load(tmp_path, FLOOR), (*known_kinds(), MisspeltQuantity()), resting_height, 100)


def test_a_number_without_a_unit_is_no_text(tmp_path: Path) -> None:
    property = ":waxiness a owl:DatatypeProperty ; rdfs:range <http://www.w3.org/2001/XMLSchema#double> ."
    with pytest.raises(KnowledgeError, match="waxiness is a number without a unit; state qudt:hasUnit"):
        load(tmp_path, property + FLOOR)


SOAKED = """:b a :Block ; :on :floor ; :absorbentCapacity 15.0 ; :drippingRetention 0.7 ; :squeezedCapacity 2.0 ;
    :youngsModulus 12000.0 ; :uptakeSpeed 0.005 ; :pressingTime 0.15 ; :recoveryTime 1.0 ; :drippingTime 10.0 ;
    :density 50.0 ; :length 0.06 ; :width 0.05 ; :height 0.02 ; :saturation 0.5 ; :absorbs :w . :w a :Water ."""


def test_what_is_told_to_absorb_is_a_sponge_whatever_it_is_called() -> None:
    made = scene(FLOOR + SOAKED, particles=200)
    assert "Absorbent" in made.thing("b").roles
    with pytest.raises(KnowledgeError, match="b .Block. absorbs, but has no drippingRetention, squeezedCapacity"):
        scene(FLOOR + ":b a :Block ; :on :floor ; :absorbentCapacity 5.0 .")
    with pytest.raises(KnowledgeError, match="p .Furniture. is fixed, and what is fixed absorbs nothing"):
        scene(FLOOR + ":p a :Sponge , :Furniture ; :z 0.1 .")


def test_what_never_moves_does_not_break_or_yield() -> None:
    with pytest.raises(
        KnowledgeError, match="b .Egg. is Furniture, which never moves, and Shelled; allowed: one of them"
    ):
        scene(FLOOR + ":b a :Egg , :Furniture ; :z 0.75 .")


def test_what_has_a_membrane_must_say_how_strong_it_is() -> None:
    white = ":e a :Egg ; :on :floor ; :hasPart :w , :yolk9 . :yolk9 a :EggYolk . :w a :EggWhite , :Membraned ."
    with pytest.raises(
        KnowledgeError, match="w .EggWhite. has a membrane; state its membraneForce and the probeRadius"
    ):
        scene(FLOOR + white)


def test_a_solid_is_a_part_s_only_where_it_is_that_part_s() -> None:
    known = scene(FLOOR + ":bowl1 a :PaperBowl ; :on :floor .")
    own = own_solids(known.things)
    assert own["bowl1"] == (0,)  # the foot; the wall is the panels'
    assert len(own["bowl1/panel0"]) == len(known.thing("bowl1/panel0").shape.geoms)
    link = Thing(name="arm", kind="Thing", shape=known.thing("bowl1/panel0").shape, mount=jointed())
    next_link = replace(link, name="arm/next", whole="arm", position=(0.3, 0.0, 0.0), mount=jointed("arm"))
    assert own_solids((link, next_link))["arm"] == tuple(range(len(link.shape.geoms)))


class Trestles(Kind):
    """A kind that builds its things itself: a board on a leg that is a part of its own."""

    claims = "Trestle"
    shapes = ("trestle",)

    def parts(self, individuals: Individuals, whole: Thing) -> Made:
        board = Geom(type="box", size=(0.1, 0.1, 0.01))
        leg = Geom(type="box", size=(0.02, 0.02, 0.05), position=(0.0, 0.0, -0.06))
        part = Thing(
            name=f"{whole.name}/leg",
            kind="Leg",
            shape=replace(whole.shape, geoms=(leg,)),
            position=whole.position,
            orientation=whole.orientation,
            mass=0.1,
            whole=whole.name,
            mount=jointed(whole.name),
        )
        return Made(things=(replace(whole, shape=replace(whole.shape, geoms=(board,))), part))


TRESTLE = """@prefix owl: <http://www.w3.org/2002/07/owl#> . @prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
    :trestle a :ShapeKind . :Trestle a owl:Class ; rdfs:subClassOf :Solid ; rdfs:comment "A board on a leg." . """


@pytest.mark.parametrize("yaw", [0.0, 30.0])
def test_what_its_kind_builds_rests_on_what_it_is_on(tmp_path: Path, yaw: float) -> None:
    trestle = f":t a :Trestle ; :shape :trestle ; :mass 1.0 ; :yaw {yaw} ; :on :table1 . "
    kb = load(tmp_path, TRESTLE + FLOOR + ":table1 a :Table ; :x 1.0 . " + trestle)
    made = compose(kb, (*known_kinds(), Trestles()), resting_height, 100)
    top = 0.7
    assert made.thing("t").position == pytest.approx((1.0, 0.0, top + 0.11), abs=1e-5)
    assert made.thing("t/leg").position == made.thing("t").position


class Sticks(Kind):
    """A kind of what breaks without a shell."""

    claims = "Stick"
    happenings = (DETACHMENT,)


STICK = """@prefix owl: <http://www.w3.org/2002/07/owl#> . @prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
    :Stick a owl:Class ; rdfs:subClassOf :Block ; rdfs:comment "It snaps." . """


def test_what_another_kind_breaks_may_be_breakable(tmp_path: Path) -> None:
    stick = load(tmp_path, STICK + FLOOR + ":s a :Stick ; :breakingForce 5.0 ; :on :floor .")
    made = compose(stick, (*known_kinds(), Sticks()), resting_height, 100)
    assert "Breakable" in made.thing("s").roles
    block = load(tmp_path, STICK + FLOOR + ":b a :Block ; :breakingForce 5.0 ; :on :floor .")
    with pytest.raises(KnowledgeError, match="b .Block. has a breakingForce, but .* what does: .*Shelled, Stick"):
        compose(block, (*known_kinds(), Sticks()), resting_height, 100)


class Oiling(Kind):
    """A kind that gives a block a friction which no other surface has."""

    order = 90

    def __init__(self, friction: float) -> None:
        self._friction = friction

    def start(self, state: Running) -> Sequence[Controller]:
        state.set_friction(state.scene.index("block1"), self._friction)
        return ()


@pytest.mark.parametrize(("friction", "slides"), [(0.4, False), (0.123, True)])
def test_a_kind_may_give_a_surface_any_friction(friction: float, slides: bool) -> None:
    slope = ":table1 a :Table ; :pitch 15.0 . :block1 a :Block ; :on :table1 ; :pitch 15.0 . "
    log = simulated(FLOOR + slope, "wait(0.4)", Oiling(friction))
    path = log.poses[-1, log.index("block1"), :3] - log.poses[100, log.index("block1"), :3]
    assert (float(np.linalg.norm(path)) > 0.05) == slides
