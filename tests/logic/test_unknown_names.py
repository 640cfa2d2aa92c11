"""A name that nothing has is an error with the nearest names, and no confident "no"; a name that is known is none."""

from __future__ import annotations

import ast
import importlib.util
from collections.abc import Iterator
from itertools import permutations
from pathlib import Path

import pytest

from prolepsis.fluents.evidence import RANGES
from prolepsis.log.domain import Domain
from prolepsis.log.evidence_names import EVIDENCE_UNITS
from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.logic.process import PROLOG_FILES
from prolepsis.logic.session import Session
from prolepsis.terms.errors import GoalError, InputError, Note

ROOT = Path(__file__).parents[2]


def timeline() -> Timeline:
    facts = [
        Fact(kind="fluent", type="broken", args=("egg1",), start=0.5, end=2.0, evidence={"force": 44.0}),
        Fact(
            kind="event",
            type="grasping",
            args=("hand1", "egg1", "force7"),
            start=0.1,
            end=0.2,
            evidence={"outcome": "done"},
        ),
        Fact(
            kind="fluent",
            type="glued",
            args=("knob", "drawer", "left", 3),
            start=0.0,
            end=1.0,
            evidence={"made_with": "white glue"},
        ),
        Fact(kind="event", type="snapping_off", args=("knob",), start=1.0, end=1.1, evidence={"crackle": 2.0}),
    ]
    domain = Domain(
        instances=(("egg1", "Egg"), ("egg1", "Oddity")),
        parts=(("egg1", "eggshell1"),),
        values=(("egg1", "mass", 0.06), ("egg1", "oddness", 3.0)),
        relations=(("near", "egg1", "table1"),),
    )
    return make_timeline(facts, dt=0.001, duration=4.0, domain=domain)


RUN1 = timeline()
"""The first run of a session, and the only one while it is kept here."""


@pytest.fixture(scope="module")
def session() -> Iterator[Session]:
    session = Session()
    yield session
    session.close()


@pytest.mark.parametrize(
    ("goal", "message"),
    [
        ("holds(brocken(X), T)", r"^no fluent brocken/1; did you mean broken\(X\)\?$"),
        ("holds(broken(eggg1), T)", "^no individual named eggg1 in .*; did you mean egg1"),
        ("holds(broken(X, Y), T)", r"^no fluent broken/2; it is written broken\(X\)$"),
        ("holds(supports(X), T)", r"^no fluent supports/1; it is written supports\(X, Y\)$"),
        ("holds('Broken'(X), T)", r"no fluent 'Broken'/1; did you mean broken\(X\)"),
        ("holds(falling(X), T)", r"^falling is an event, no fluent; ask occurs\(falling\(X\), T\)$"),
        ("occurs(broken(X), T)", r"^broken is a fluent, no event; ask holds\(broken\(X\), T\)$"),
        ("occurs(faling(X), T)", r"no event faling/1; did you mean falling\(X\)"),
        ("occurs(xyzzy(X), T)", "^no event xyzzy/1; known: absorbing"),
        ("holds(broken(egg-1), T)", "no individual named egg-1"),
        # What was measured of a thing is no thing.
        ("holds(broken(situation), T)", "no individual named situation .*; known: [^;]*$"),
        ("value('white glue', mass, M)", "no individual named 'white glue'"),
        ("holds(broken(f(X)), T)", r"no individual named f\(_\)"),
        ("occurs(dropped(X), T)", r"^no event dropped/1; did you mean dropping\(X, Y\)\?$"),
        ('holds("broken(egg1)", T)', r"a fact is a term and no text: write broken\(egg1\)$"),
        ("holds('broken(egg1)', T)", r"a fact is a term and no text: write broken\(egg1\)$"),
        ("occurs(grasping(hand1, egg1), T)", r"it is written grasping\(X, Y, Z\)"),
        ("occurs(picking_up(hand2, egg1), T)", "no individual named hand2 .*; did you mean hand1"),
        ("holds_at(brocken(X), 0.5)", "no fluent brocken/1"),
        ('holds(broken("egg1"), T)', 'no individual named "egg1" .*; did you mean egg1'),
        ("holds(3, T)", "no fluent 3"),
        ("evidence(brocken(X), T, N, V)", "no fluent or event brocken/1"),
        ("evidence(broken(X), T, forse, V)", "no evidence named forse .*; did you mean force"),
        ("ongoing(brocken(X))", "no fluent or event brocken/1"),
        ("instance_of(eggg1, C)", "no individual named eggg1"),
        ("instance_of(X, 'Eggg')", "no class named 'Eggg' .*; did you mean 'Egg'"),
        ("has_part(egg1, eggshel1)", "no individual named eggshel1 .*; did you mean eggshell1"),
        ("value(egg1, color, V)", "no property named color .*; did you mean colour"),
        ("value(egg2, mass, V)", "no individual named egg2"),
        ("holds(F, T), fluentT(F, 'Brocken')", "no fluent named 'Brocken' .*; did you mean broken"),
        ("holds(F, T), eventT(F, falling), eventT(F, fallling)", "no event named fallling"),
        ("holds(F, T), objOf(F, eggg1)", "no individual named eggg1"),
        ("argsOf(brocken(egg1), [egg1])", "no fluent or event brocken/1"),
        ("in(rum1, holds(broken(X), T))", "no run named rum1 .*; did you mean run1"),
        ("fact(R, I, brocken, A, S, E)", "no fluent or event named brocken .*; did you mean broken"),
        ("fact(R, I, broken, [eg1], S, E)", "no individual named eg1 .*; did you mean egg1"),
        ("fact(R, I, T, [egg1, eg1|More], S, E)", "no individual named eg1 .*; did you mean egg1"),
        ("value(egg1, shape, elipsoid)", "no value of shape named elipsoid .*; did you mean ellipsoid"),
        ("value(egg1, wet, yes)", "no value of wet named yes .*; known: false, true"),
        ("evidence(E, T, outcome, dropt)", "no value of outcome named dropt .*; known: crushed, done, dropped"),
        ("value(egg1, mass, heavy)", r"^mass is a number \[kg\], not heavy$"),
        ('value(egg1, friction, "0.4")', '^friction is a number, not "0.4"$'),
        ("value(egg1, on, X)", r"^on is a relation and no value; ask holds\(on\(X, Y\), T\)$"),
        ("holds(hasPart(egg1, X), T)", r"^no fluent hasPart/2; ask has_part\(Whole, Part\)$"),
        ("holds(shape(egg1, X), T)", r"^no fluent shape/2; ask value\(Thing, shape, Shape\)$"),
        # Wherever it stands, and whether or not it is reached.
        ("\\+ holds(broken(egg2), T)", "no individual named egg2"),
        ("fail, holds(brocken(X), T)", "no fluent brocken/1"),
        ("findall(X, (holds(broken(X), T) ; occurs(faling(X), T)), L)", "no event faling/1"),
        ("setof(X, T^holds(brocken(X), T), L)", "no fluent brocken/1"),
        ("maplist([X]>>holds(brocken(X), _), [egg1])", "no fluent brocken/1"),
        ("maplist(holds(broken(egg2)), [T])", "no individual named egg2"),
        # What a variable is compared with is what it stands for.
        ("holds(F, T), F = brocken(X)", "no fluent brocken/1"),
        ("occurs(E, T), faling(egg1) == E", "no event faling/1"),
        ("holds(F, T), fluentT(F, Type), Type \\= brocken", "no fluent named brocken"),
        ("instance_of(egg1, C), \\+ C == 'Eggg'", "no class named 'Eggg'"),
        # What is known only when the goal runs.
        ("F = brocken(X), holds(F, T)", "no fluent brocken/1"),
        ("member(X, [egg1, egg2]), holds(broken(X), T)", "no individual named egg2"),
        ("O = eggg1, occurs(E, T), objOf(E, O)", "no individual named eggg1"),
        ("atom_concat(forse, '', N), evidence(broken(X), T, N, V)", "no evidence named forse"),
        ("maplist([C]>>instance_of(egg1, C), ['Egg', 'Eggg'])", "no class named 'Eggg'"),
        ("atom_concat(elip, soid, S), value(egg1, shape, S)", "no value of shape named elipsoid"),
        ("member(P, [mass, on]), value(eggshell1, P, V)", "on is a relation and no value"),
    ],
)
def test_what_nothing_is_called_is_an_error(session: Session, goal: str, message: str) -> None:
    with pytest.raises(GoalError, match=message) as refused:
        session.ask(RUN1, goal)
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 400


COMPARED = [
    ("holds(broken(X), T), X = eggg1", "no individual named eggg1 .*; did you mean egg1"),
    ("holds(broken(X), T), eggg1 == X", "no individual named eggg1"),
    ("holds(broken(X), T), X \\= eggg1", "no individual named eggg1"),
    ("holds(broken(X), T), Y = X, Y = Z, Z \\== eggg1", "no individual named eggg1"),
    ("holds(broken(X), T), member(X, [egg1, eggg1])", "no individual named eggg1"),
    ("holds(F, T), objOf(F, X), memberchk(X, [eggg1])", "no individual named eggg1"),
    ("has_part(X, Y), Y = eggshel", "no individual named eggshel .*; did you mean eggshell1"),
    ("\\+ (holds(broken(X), _), X = eggg1)", "no individual named eggg1"),
    ("aggregate_all(count, (holds(broken(X), _), X \\= eggg1), N)", "no individual named eggg1"),
    # Of facts that are taken apart.
    ("holds(F, T), F = broken(eggg1)", "no individual named eggg1"),
    ("holds(F, T), F =.. [brocken|_]", "no fluent named brocken .*; did you mean broken"),
    ("holds(F, T), F =.. [broken, eggg1]", "no individual named eggg1"),
    ("holds(F, T), functor(F, brocken, _)", "no fluent named brocken"),
    ("holds(F, T), functor(F, broken, 2)", r"no fluent broken/2; it is written broken\(X\)"),
    ("occurs(E, T), functor(E, N, _), N = faling", "no event named faling .*; did you mean falling"),
    ("holds(F, T), arg(1, F, eggg1)", "no individual named eggg1"),
    ("holds(F, T), F =.. L, L = [brocken, X]", "no fluent named brocken"),
    ("holds(F, T), F =.. L, L = [_, eggg1]", "no individual named eggg1"),
    ("fact(R, I, Type, Args, S, E), memberchk(eggg1, Args)", "no individual named eggg1"),
    # Of what is collected.
    ("findall(X, holds(broken(X), _), L), member(eggg1, L)", "no individual named eggg1"),
    ("findall(X, holds(broken(X), _), L), L == [eggg1]", "no individual named eggg1"),
    ("findall(X-S, holds(broken(X), S-_), L), memberchk(eggg1-_, L)", "no individual named eggg1"),
    ("member(X-S, [egg1-1, eggg1-2]), holds(broken(X), S)", "no individual named eggg1"),
    ("L = [egg1, Y], Y = eggg1, forall(member(X, L), holds(broken(X), _))", "no individual named eggg1"),
    ("setof(X, T^holds(broken(X), T), L), subtract(L, [eggg1], M)", "no individual named eggg1"),
    ("findall(X, holds(broken(X), _), L), include([Y]>>(Y = eggg1), L, M)", "no individual named eggg1"),
    ("maplist([X]>>holds(broken(X), _), [egg1, eggg1])", "no individual named eggg1"),
    ("aggregate_all(max(S, X), holds(broken(X), S-_), max(M, eggg1))", "no individual named eggg1"),
    ("forall(member(X, [eggg1]), holds(broken(X), _))", "no individual named eggg1"),
    # Of other kinds.
    ("holds(F, T), T = [S, E]", r"^not an interval: \[_\]"),
    ("allen(R, 0-1, 1-2), R = befor", "^unknown relation 'befor'; known: before, after"),
    ("argsOf(E, egg1)", r"^not a list: egg1; arguments are a list, as \[egg1\]$"),
    ("argsOf(E, L), L == egg1", "^not a list: egg1"),
    ("fact(R, I, broken, egg1, S, E)", "^not a list: egg1"),
    ("eventT(E, broken)", r"^broken is a fluent, no event; ask fluentT\(X, broken\)$"),
    ("holds(F, T), fluentT(F, N), N = 'Falling'", "^'?Falling'? is an event, no fluent; ask eventT"),
    ("holds(broken(done), T)", "no individual named done"),
    ("instance_of(X, C), C = 'Eggg'", "no class named 'Eggg'"),
    ("value(egg1, P, V), P = color", "no property named color"),
    ("value(egg1, mass, V), V = heavy", r"^mass is a number \[kg\], not heavy$"),
    ("evidence(E, T, N, V), N = forse", "no evidence named forse"),
    ("evidence(E, T, outcome, V), member(V, [done, dropt])", "no value of outcome named dropt"),
    ("unit(mass, kilo)", "no unit named kilo .*; known: .*kg"),
    ("unit(N, U), U = kilo", "no unit named kilo"),
    ("in(R, holds(broken(X), T)), R = rum1", "no run named rum1"),
    ("holds(broken(X), T), T = abc", "^not an interval: abc"),
    ("holds(broken(X), S-E), S = abc", "^not a time: abc; a time is a finite number"),
]


@pytest.mark.parametrize(("goal", "message"), COMPARED)
def test_what_a_variable_is_compared_with_is_known_as_what_it_stands_for(
    session: Session, goal: str, message: str
) -> None:
    with pytest.raises(GoalError, match=message):
        session.ask(RUN1, goal)


@pytest.mark.parametrize(
    ("goal", "answer"),
    [
        # What one branch gives when there is none bears on nothing in the other.
        ("(holds(broken(table1), S-_) -> true ; S = never)", "never"),
        ("(X = nobody ; holds(broken(X), _)), S = X", "nobody"),
        ("holds(F, T), L = [F, 1, T, 'Two words', nobody], last(L, S)", "nobody"),
        ("occurs(E, _), argsOf(E, [_, X, S]), instance_of(X, _), S \\= force99", "force7"),
        ("evidence(_, _, N, _), unit(N, U), U \\== '', S = N", "force"),
        # Known as one of two kinds is known.
        ("holds(broken(S), _), unit(U, _), (U = S ; U = mass), S = egg1", "egg1"),
        ("findall(X, holds(broken(X), _), L), atomic_list_concat(L, ', ', Text), Text \\= nothing, S = Text", "egg1"),
        ("occurs(E, _), argsOf(E, [_, _, L]), L \\= force99, S = L", "force7"),
    ],
)
def test_what_a_variable_stands_for_elsewhere_is_not_asked_of_it(session: Session, goal: str, answer: str) -> None:
    assert session.ask(RUN1, goal)[0]["S"] == answer


@pytest.mark.filterwarnings("ignore:no, but broken has no (crackle|tilt) here")
@pytest.mark.parametrize(
    "goal",
    [
        "holds(dented(egg1), T)",  # in the vocabulary
        "occurs(picking_up(hand1, egg1), T)",  # a chronicle
        "occurs(E, T), eventT(E, 'PickingUp')",
        "holds(on(egg1, table1), 0.0)",  # a relation of the ontology
        "holds(near(table1, egg1), 0.0)",  # one that the situation asserts
        "occurs(snapping_off(drawer), T)",  # of a log from elsewhere
        "occurs(E, T), eventT(E, 'SnappingOff'), eventT(E, falling)",
        "holds(glued(drawer, knob, left, 4), T)",
        "holds(broken(left), T)",
        "evidence(broken(egg1), T, crackle, V)",
        "evidence(broken(egg1), T, tilt, V)",
        "instance_of(eggshell1, 'Oddity')",
        "instance_of(egg1, 'Sponge')",
        "value(eggshell1, oddness, V)",
        "value(egg1, breakingForce, V)",
        "argsOf(broken(egg1), [whatever])",  # lists of arguments are matched, as they are
        "occurs(E, T), eventT(E, grasping), argsOf(E, [leftGripper, force99])",
        "holds(broken(7), T)",
        "fact(R, I, broken, [table1, left, 3], S, E)",
        "value(egg1, shape, sphere)",
        "value(egg1, colour, mauve)",
        "value(egg1, mass, 0.07)",
        "evidence(E, T, outcome, dropped)",
        "evidence(E, T, reason, whatever)",
    ],
)
def test_no_is_the_answer_where_all_names_are_known(session: Session, goal: str) -> None:
    assert session.ask(RUN1, goal) == []


def test_what_another_run_of_the_session_names_is_known() -> None:
    session = Session()
    other = make_timeline([Fact(kind="fluent", type="bent", args=("wire1",), start=0, end=1)], dt=0.001, duration=1.0)
    mine = timeline()
    with pytest.raises(GoalError, match="no fluent bent/1"):
        session.ask(mine, "holds(bent(wire1), T)")
    session.load(other)
    assert session.ask(mine, "holds(bent(wire1), T)") == []
    session.close()


def asked(tmp_path: Path, rules: str, goal: str) -> list[object]:
    file = tmp_path / "rules.pl"
    file.write_text(rules)
    session = Session(chronicles=(file,))
    try:
        return list(session.ask(timeline(), goal))
    finally:
        session.close()


def test_what_a_rule_may_find_is_known_though_it_finds_nothing(tmp_path: Path) -> None:
    rules = "chronicle(shaking(X, hard), T) :- holds(dented(X), T)."
    assert asked(tmp_path, rules, "occurs(shaking(egg1, hard), T)") == []
    with pytest.raises(GoalError, match=r"no event shakin/2; did you mean shaking\(X, Y\)"):
        asked(tmp_path, rules, "occurs(shakin(egg1, hard), T)")


@pytest.mark.parametrize(
    "rules",
    [
        "chronicle(shaking(X), T) :- holds(brocken(X), T).",
        "chronicle(shaking(X), T) :- aid(X, T).\naid(X, T) :- fail, holds(brocken(X), T).",
        "chronicle(shaking(X), T) :- F = brocken(X), holds(F, T).",
    ],
)
def test_a_rule_that_names_what_nothing_is_called_is_an_error(tmp_path: Path, rules: str) -> None:
    with pytest.raises(InputError, match=r"rules.pl: .*no fluent brocken/1; did you mean broken\(X\)"):
        asked(tmp_path, rules, "true")


def test_the_vocabulary_is_that_of_the_program() -> None:
    spec = importlib.util.spec_from_file_location("vocabulary", ROOT / "tools" / "vocabulary.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    told = (PROLOG_FILES / "vocabulary.pl").read_text()
    # What tests have registered meanwhile is no part of it.
    assert set(told.splitlines()) <= set(module.vocabulary_text().splitlines()), "run tools/vocabulary.py"
    sources = [*(ROOT / "src/prolepsis/fluents").rglob("*.py"), *(ROOT / "src/prolepsis/programs/actions").glob("*.py")]
    registered = [name for file in sources for name in registered_in(file)]
    assert len(registered) > 40
    assert not [name for name in registered if f"fact_type({name}, " not in told], "run tools/vocabulary.py"


def registered_in(file: Path) -> Iterator[str]:
    """Yield the types of the fluents, events and actions that a file registers."""
    from prolepsis.log.fact_types import event_of

    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.FunctionDef):
            for call in node.decorator_list:
                if isinstance(call, ast.Call) and isinstance(call.func, ast.Name):
                    if call.func.id in ("fluent", "event") and isinstance(call.args[0], ast.Constant):
                        yield str(call.args[0].value)
                    elif call.func.id == "action":
                        yield event_of(node.name)


def test_all_evidence_is_told_of() -> None:
    assert RANGES.keys() <= EVIDENCE_UNITS.keys()
    sources = [file for room in ("fluents", "programs") for file in (ROOT / "src/prolepsis" / room).rglob("*.py")]
    named = {name for file in sources for name in evidence_in(file)}
    assert len(named) > 20
    assert named <= EVIDENCE_UNITS.keys()


def evidence_in(file: Path) -> Iterator[str]:
    """Yield the names of the evidence that a file writes as a table, or into one."""
    for node in ast.walk(ast.parse(file.read_text())):
        match node:
            case ast.keyword(arg="evidence", value=ast.Dict(keys=keys)):
                pass
            case ast.Assign(targets=[ast.Name(id="evidence")], value=ast.Dict(keys=keys)):
                pass
            case ast.AnnAssign(target=ast.Name(id="evidence"), value=ast.Dict(keys=keys)):
                pass
            case ast.Subscript(value=ast.Name(id="evidence"), slice=ast.Constant() as key):
                keys = [key]
            case _:
                continue
        yield from (str(key.value) for key in keys if isinstance(key, ast.Constant))


def test_a_fact_that_occurs_with_other_arguments_is_told_and_not_denied(session: Session) -> None:
    with pytest.raises(GoalError, match=r"^grasping/4 does not occur; what does is written grasping\(X, Y, Z\)"):
        session.ask(RUN1, "occurs(grasping(hand1, egg1, Force, Height), T)")


@pytest.mark.parametrize(
    "goal",
    [
        "holds(broken(egg1), T), T > 1",
        "1 >= T, occurs(E, T)",
        "holds(F, T), T - 1 =:= 0",
        "holds(F, T), X is T / 2",
        "aggregate_all(max(T), holds(broken(egg1), T), M)",
        "aggregate_all(sum(T), (holds(F, T), fluentT(F, broken)), M)",
        "aggregate_all(min(T, F), holds(F, T), min(_, M))",
        "findall(T, holds(F, T), Ts), max_list(Ts, M)",
    ],
)
def test_an_interval_is_not_compared_as_if_it_were_a_number(session: Session, goal: str) -> None:
    with pytest.raises(GoalError, match="gives an interval and no number to compare; write S-E for it"):
        session.ask(RUN1, goal)


@pytest.mark.parametrize("time", ["abc", "'0.9'", "a-b", "0.9-0.1", "[0, 1]", "1+1"])
@pytest.mark.parametrize(
    "goal", ["holds(broken(egg1), {})", "evidence(broken(egg1), {}, force, V)", "instance_of(egg1, 'Egg', {})"]
)
def test_what_is_no_time_is_not_denied(session: Session, goal: str, time: str) -> None:
    with pytest.raises(GoalError, match="not an interval: .*; an interval is Start-End"):
        session.ask(RUN1, goal.format(time))


@pytest.mark.parametrize(
    ("goal", "told"),
    [
        ("holds(F, T), fluentT(F, Wet)", "Wet is a variable and stands for any fluent; write wet for one"),
        ("occurs(E, T), eventT(E, Picking_Up)", "Picking_Up is a variable and stands for any event; write picking_up"),
        ("occurs(E, T), event(E, SnappingOff)", "SnappingOff is .*; write snapping_off for one"),
        ("holds(Broken, T)", r"Broken is a variable and stands for any fluent; write broken\(_\) for one"),
        ("instance_of(X, Egg)", "Egg is a variable and stands for any class; write 'Egg' for one"),
        ("value(egg1, Mass, 0.06)", "Mass is a variable and stands for any property; write mass for one"),
        ("evidence(F, T, Force, 44.0)", "Force is a variable and stands for any evidence; write force for one"),
        ("findall(X, instance_of(X, Egg, _), L)", "Egg is a variable"),
        ("holds(broken(Drawer), T)", "Drawer is a variable and stands for any individual; write drawer for one"),
        ("\\+ holds(broken(Egg1), T)", "Egg1 is a variable and stands for any individual; write egg1 for one"),
        ("holds(broken(Knob), T), occurs(snapping_off(Knob), _)", "Knob is a variable"),
        ("holds(F, _), objOf(F, EGG1), fail", "EGG1 is a variable .*; write egg1 for one"),
    ],
)
def test_a_known_name_with_a_capital_is_told_to_be_a_variable(session: Session, goal: str, told: str) -> None:
    with pytest.warns(Note, match=told):
        session.ask(RUN1, goal)


@pytest.mark.parametrize("goal", ["value(egg1, X, Y)", "instance_of(egg1, O), fail", "evidence(F, T, X, 44.0)"])
def test_one_letter_is_how_variables_are_written(goal: str) -> None:
    session = Session()
    domain = Domain(instances=(("egg1", "Egg"), ("egg1", "o")), values=(("egg1", "x", 1.0),))
    fact = Fact(kind="fluent", type="broken", args=("egg1",), start=0.5, end=2.0, evidence={"force": 44.0, "x": 1.0})
    session.ask(make_timeline([fact], dt=0.001, duration=4.0, domain=domain), goal)
    session.close()


@pytest.mark.parametrize("goal", ["evidence(F, T, by, {})", "evidence(F, T, by, V), V == {}"])
def test_no_is_not_all_that_is_said_of_a_text_that_nothing_has(session: Session, goal: str) -> None:
    with pytest.warns(Note, match="no, but no value of by is situatio here; did you mean situation?"):
        assert session.ask(RUN1, goal.format("situatio")) == []
    with pytest.warns(Note, match="no, but no value of by is screwdriver here; those told are situation"):
        assert session.ask(RUN1, goal.format("screwdriver")) == []


@pytest.mark.parametrize(
    "goal", ["holds(broken(egg1), 99)", "occurs(grasping(_, _, _), -0.5)", "\\+ \\+ holds(broken(egg1), 4.5)"]
)
def test_no_is_not_all_that_is_said_of_an_instant_outside_the_log(session: Session, goal: str) -> None:
    with pytest.warns(Note, match="the log tells nothing of (99|-0.5|4.5) s: it lasts from 0 to 4 s"):
        assert session.ask(RUN1, goal) == []


@pytest.mark.parametrize(
    "goal",
    [
        "holds(F, T), fluentT(F, Type)",
        "holds(broken(X), T), X \\= table1",
        "holds(Broken, T), fluentT(Broken, broken)",
        "holds(broken(Egg1), T)",
        "instance_of(Egg, Class)",
        "instance_of(egg1, Egg), Egg = 'Egg'",
        "evidence(broken(egg1), T, force, Force)",
        "holds(broken(Drawer), T), Drawer = egg1",
        "holds(F, T), fluentT(F, _Wet)",
    ],
)
def test_no_word_is_lost_about_a_variable_that_is_meant(session: Session, goal: str) -> None:
    assert session.ask(RUN1, goal)


def test_an_instant_and_the_ends_of_an_interval_are_compared(session: Session) -> None:
    assert session.ask(RUN1, "T = 1.0, holds(broken(egg1), T), T > 0.5")
    assert session.ask(RUN1, "member(T, [0.1, 1.0]), holds(broken(egg1), T), T > 0.5") == [{"T": 1.0}]
    assert session.ask(RUN1, "holds(broken(egg1), T), T = S-E, S < 1, E > 1")


@pytest.mark.parametrize(
    "goal",
    [
        "objOf(F, egg1), fluentT(F, broken), holds(F, T)",
        "eventT(F, grasping), objOf(F, egg1), \\+ holds(F, _)",
        "evidence(F, T, N, _V), holds(F, T)",
        "objOf(F, egg1), (holds(F, T) ; occurs(F, T))",
        "ongoing(F), holds(F, T) ; holds(F, T)",
        "evidence(F, T, N, _V), fluentT(F, broken)",
        "argsOf(F, A), functor(F, N, _), fluentT(G, N)",
        "instance_of(egg1, C), \\+ has_part(C, _)",
        "evidence(_, _, outcome, V), \\+ value(V, mass, _)",
        "evidence(_, _, N, _V), \\+ value(_, N, _)",
        "evidence(_, _, _N, V), \\+ value(_, mass, V)",
        "fact(_, _, N, _, _, _), \\+ instance_of(_, N)",
    ],
)
def test_what_a_goal_finds_is_no_name_that_is_wrong(session: Session, goal: str) -> None:
    assert session.ask(RUN1, goal)


@pytest.mark.filterwarnings("ignore::prolepsis.terms.errors.Note")
@pytest.mark.parametrize(
    ("goals", "count"),
    [
        (("objOf(F, egg1)", "holds(F, T)"), 2),
        (("evidence(F, T, _N, _V)", "occurs(F, T)"), 2),
        (("fluentT(F, broken)", "holds(F, T)", "objOf(F, egg1)"), 1),
        (("ongoing(F)", "holds(F, T)"), 1),
    ],
)
def test_the_order_of_goals_makes_no_error(session: Session, goals: tuple[str, ...], count: int) -> None:
    for order in permutations(goals):
        assert len(session.ask(RUN1, ", ".join(order))) == count


@pytest.mark.parametrize("goal", ["holds(F, T), occurs(F, T)", "fluentT(F, broken), occurs(F, T)"])
def test_no_says_that_nothing_is_fluent_and_event(session: Session, goal: str) -> None:
    with pytest.warns(Note, match="^no, but F stands for a fluent, and for an event, and nothing is both"):
        assert session.ask(RUN1, goal) == []
