"""The session: what it refuses and says, that it survives, that runs are apart and threads may ask at once."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest

from prolepsis.log.domain import Domain
from prolepsis.log.timeline import Fact, Timeline, make_timeline
from prolepsis.logic.session import Session
from prolepsis.terms.errors import GoalError, GoalLimitError, MissingToolError, Note
from prolepsis.terms.terms import Term, Variable, format_value


def timeline(name: str = "egg1") -> Timeline:
    facts = [
        Fact(kind="fluent", type="broken", args=(name,), start=0.5, end=2.0, evidence={"force": 35.2}),
        Fact(kind="event", type="closingGripper", args=("g",), start=1, end=2, evidence={"level": "force7"}),
        Fact(kind="event", type="closingGripper", args=("g",), start=3, end=4, evidence={"level": "force9"}),
    ]
    domain = Domain(
        instances=((name, "Egg"),),
        parts=((name, "shell1"),),
        values=((name, "mass", 0.06),),
        relations=(("on", name, "table1"),),
    )
    return make_timeline(facts, dt=0.001, duration=4.0, domain=domain)


@pytest.fixture(scope="module")
def session() -> Iterator[Session]:
    session = Session()
    yield session
    session.close()


@pytest.mark.parametrize(
    ("goal", "message"),
    [
        ("holds(F, T", "syntax error at column"),
        ("", "syntax error"),
        (
            "Holds(F,T)",
            r"column 6, before \(F,T\): a predicate's name begins with a small letter, and Holds is a variable; "
            r"write holds\(F,T\)",
        ),
        ("holds(BROKEN(egg1), T)", r"BROKEN is a variable; write broken\(egg1\)"),
        ("occurs(PickingUp(X, egg1), T)", r"PickingUp is a variable; write picking_up\(X, egg1\)"),
        ("holds(FOO(f(x)), T)", r"FOO is a variable; write foo\(f\(x\)\)"),
        ("holds(Broken(X), T)", r"Broken is a variable; write broken\("),
        ("Holds (F,T)", r"Holds is a variable; write holds\("),
        ("holds (F, T", "syntax error at column"),
        ("T1 before T2", r"column 4, before before: before stands before what it is about, in brackets: before\("),
        ("holds(broken(X), 1 s)", "column 20, before s.: a number stands without its unit, in SI units .*; write 1"),
        ("evidence(E, T, force, F), F > 40N", "a number stands without its unit"),
        ("holds(broken egg1, T)", r"column 7, before broken: broken stands before what it is about"),
        ("holds(F, S-E), S => 1", r"unknown predicate \(=>\)/2; => is written >="),
        ("is_a(egg1, 'Egg')", r"unknown predicate is_a/2; ask instance_of\(Individual, Class\)"),
        ("holds(broken(X), T), Y is X + 1", "egg1 is computed with, and is no number"),
        ("holds(F,T),", "column 11, before ,: a term is missing after ,: "),
        ("holds(F,,T)", r"column 9, before ,T\): a term is missing between , and ,"),
        ("occurs(falling(X,), T)", r"column 18, before \),: a term is missing between , and \)"),
        ("holds(F,T) occurs(E,S)", r"column 12, before occurs\(E,S\): .*two terms stand side by side"),
        ("holds[F,T]", r"column 6, before \[F,T\]: .*two terms stand side by side"),
        ("holds(F, T), S = T - , true", "column 22, before ,: .*a bracket or a comma stands where a term should"),
        ("true,\nholds(F,T))", r"line 2, column 11, before \): nothing is opened that this \) closes"),
        ("holds(broken(egg1, T), true", r"column 6, before \(broken\(egg1,: this \( is not closed"),
        ("X = [a, b), true", r"column 10, before \),: ] should close what \[ opens, not \)"),
        ("X = 'a", "column 5, before 'a: a quoted name begins here and has no end"),
        ("true, /* a", r"column 7, before /\*: a comment begins here and has no end"),
        ("holds(F,T); ; true", "column 13, before ;: a term is missing between ; and ;"),
        ("holds(F,T) and occurs(E,S)", "column 12, before and: and is written ,: "),
        ("holds(F,T) || true", r"column 12, before \|\|: \|\| is no sign of Prolog; write ;: "),
        ("not holds(F,T)", r"column 1, before not: not is written \\\+: "),
        ("holds(broken(\u201cegg1\u201d), T)", "column 14, .*: \u201c is no sign of Prolog; write ': "),
        ("holds(F, T), T = S-E, E - S > .5", r"column 31, before \.5: a number begins with a digit; write 0\.5"),
        ("holds(F, 1.)", r"column 11, before \.\): a number ends with a digit; write 1 or 1\.0"),
        ("X == 1 = 2", "column 3, before ==: operator clash: these operators cannot be combined without brackets"),
        ("holds(F, T) | true", "either of two goals is asked with ;"),
        ("X = 'a\0b'", "syntax error at column 7: no character of a text"),
        ("X = '\ud800'", "syntax error at column 6: no character of a text"),
        ("true, " * 9000 + "true", "the goal has 54,004 characters; at most 20,000 are read"),
        ("broken(X)", r"unknown predicate broken/1; broken is a type of fluent; ask holds\(broken\(X\), T\)"),
        ("closinggripper(X)", "did you mean the event closingGripper, asked by occurs/2"),
        ("a :- b", "a query is one goal; rules are added as chronicles"),
        ("3", "not a goal: 3; a goal is a predicate with arguments"),
        ("X > 1", "a value is needed before it is known"),
        ("read(X)", r"not permitted: read\(_\): a query only reads"),
        ("lists:append(X, Y, [a])", "without the name of its module"),
        ("X = f(X), length(X, N)", "list"),
        ("put_attr(X, a, b)", "not permitted: put_attr"),
        ("freeze(X, true)", "not permitted: freeze"),
        ("X is 2**100000", "an answer that Python cannot hold"),
        ("X = point{x: 1}", "an answer that Python cannot hold"),
        ("holds(F,T). holds(G,T)", r"column 11, before \.: more than one goal"),
        ("hold(F,T)", "unknown predicate hold/2; did you mean holds/2"),
        ("findall(X, hols(X,T), L)", "unknown predicate hols/2; did you mean holds/2"),
        ("allen(R0, 0.1, 0.2)", "not an interval: 0.1"),
        ("R = befor, allen(R, 0.0-1.0, 2.0-3.0)", "unknown relation 'befor'; known: before"),
        ("X is foo + 1", "foo"),
        ("G = shell(x), call(G)", "only when the query runs"),
        ("call(shell, x)", "not permitted: shell"),
        ("maplist(shell, [x])", "not permitted: shell"),
        ("maplist([X]>>shell(X), [x])", "not permitted: shell"),
        ("findall(X, assertz(f(X)), L)", "not permitted: assertz"),
        ("setof(X, Y^consult(Y), L)", "not permitted: consult"),
        ("forall(holds(F,T), retract(a))", "not permitted: retract"),
        ("format(atom(A), '~@', [shell(x)])", "not permitted: format"),
        ("format(atom(A), '~10@', [shell(x)])", "not permitted: format"),
        ("format(atom(A), '~~~@', [shell(x)])", "not permitted: format"),
        ("format(atom(A), F, [shell(x)])", "not permitted: format"),
        ("format(atom(A), '~W', ['touch X', [portray(true), portray_goal(shell)]])", "not permitted: format"),
        ("format(atom(A), '~5*W', [a, []])", "not permitted: format"),
        ("maplist([F]>>format(atom(_), F, [halt]), ['~@'])", "not permitted: format"),
        ("format(atom(A), '~*c', [1000000000, 0'x])", "not permitted: format"),
        ("format(atom(A), '~1000000000f', [1.5])", "not permitted: format"),
        ("format(atom(A), 'x~1000|', [])", "not permitted: format"),
        ("X = {|html||<b>x</b>|}", "syntax error"),
        ("true. X = {|html||<b>x</b>|}", "syntax error"),
        ("format(user_output, hello, [])", "not permitted: format"),
        ("format(Sink, hello, [])", "not permitted: format"),
        ("maplist(format(atom(A)), ['~@'], [[shell(x)]])", "not permitted: format"),
        ("read_term(user_input, X, [])", "not permitted: read_term"),
        ("nb_setval(a, 1)", "not permitted: nb_setval"),
        ("b_setval(prolepsis_run, x)", "not permitted: b_setval"),
        ("set_prolog_flag(stack_limit, 1)", "not permitted: set_prolog_flag"),
        ("thread_create(true, I)", "not permitted: thread_create"),
        ("print_message(error, format('~@', [shell(x)]))", "not permitted: print_message"),
        ("system:shell(x)", "not permitted: system:shell"),
        ("use_module(library(process))", "not permitted: use_module"),
        ("halt", "not permitted: halt"),
        ("abort", "not permitted: abort"),
    ],
)
def test_a_goal_that_does_more_than_ask_is_refused(session: Session, goal: str, message: str) -> None:
    egg = timeline()
    with pytest.raises(GoalError, match=message):
        session.ask(egg, goal)
    assert session.ask(egg, "holds(broken(egg1), _)") == [{}]


@pytest.mark.parametrize(
    "goal",
    [
        "numlist(1, 100000, L), allen(before, L, 1-2)",
        "length(L, 40), foldl([_, A, B]>>(B = f(A, A)), L, x, R), allen(before, R, 1-2)",
        "length(L, 3000000), maplist(=(x), L), atomic_list_concat(L, R), allen(R, 1-2, 3-4)",
        f"{'x' * 5000}(1)",
        f"holds(X, T), {'X' * 5000}",
        f"X = '{'x' * 5000}', X > 1",
        "'a\\nb'(x)",
        f"'{'x' * 5000}",
    ],
)
def test_what_is_said_of_a_goal_is_one_short_line(session: Session, goal: str) -> None:
    session.load(timeline())
    process = session._process  # pyright: ignore[reportPrivateUsage]
    with pytest.raises(GoalError) as refused:
        session.ask(timeline(), goal)
    assert len(str(refused.value)) <= 500 and "\n" not in str(refused.value)
    assert session._process is process  # pyright: ignore[reportPrivateUsage]


def test_a_large_value_leaves_its_neighbours_whole(session: Session) -> None:
    with pytest.warns(Note, match="too large"):
        ((answer),) = session.ask(timeline(), "numlist(1, 200001, A), B = 1, C = f(x)")
    assert (answer["B"], answer["C"]) == (1, Term("f", ("x",)))


def test_a_run_has_its_name_to_itself() -> None:
    session, one, two = Session(), timeline("egg1"), timeline("egg2")
    everywhere = "in(R, holds(broken(X), _))"
    session.load(one, run="x")
    session.load(two, run="x")
    assert session.ask(one, "holds(broken(X), _)") == [{"X": "egg1"}]
    assert session.ask(two, everywhere) == [{"R": "x", "X": "egg2"}, {"R": "run1", "X": "egg1"}]
    session.load(two, run="run1")
    assert session.ask(one, "holds(broken(X), _)") == [{"X": "egg1"}]
    assert session.ask(one, everywhere) == [{"R": "run1", "X": "egg2"}, {"R": "run2", "X": "egg1"}]
    session.load(one, run="y")
    assert session.ask(one, everywhere) == [{"R": "run1", "X": "egg2"}, {"R": "y", "X": "egg1"}]
    del two
    assert session.ask(one, everywhere) == [{"R": "y", "X": "egg1"}]
    session.close()


def test_no_run_is_lost_when_the_process_is_killed() -> None:
    session, one, two = Session(), timeline("egg1"), timeline("egg2")
    session.load(one, run="a")
    session.load(two, run="b")
    process = session._process  # pyright: ignore[reportPrivateUsage]
    assert process is not None
    os.kill(process.process_id, signal.SIGKILL)
    assert session.ask(one, "in(b, holds(broken(X), _))") == [{"X": "egg2"}]
    with pytest.raises(GoalLimitError, match="time limit"):  # a loop in C, which only ends with the process
        session.ask(one, "X is powm(3, 2**1000000-1, 2**1000000-3)", time_limit=0.1)
    assert session.ask(one, "in(b, holds(broken(X), _))") == [{"X": "egg2"}]
    session.close()


def test_nobody_is_blamed_for_the_goals_of_others() -> None:
    session, egg = Session(), timeline()
    session.load(egg)
    stopped = threading.Event()

    def stop() -> None:
        with pytest.raises(GoalLimitError):
            session.ask(egg, "X is powm(3, 2**1000000-1, 2**1000000-3)", time_limit=0.1)
        stopped.set()

    thread = threading.Thread(target=stop)
    thread.start()
    while not stopped.is_set():
        answers = session.ask(egg, "between(1, 1000000, N), N >= 1000000, holds(broken(X), _)", time_limit=60.0)
        assert answers == [{"N": 1000000, "X": "egg1"}]
    thread.join()
    session.close()


def test_endless_and_boundless_goals_are_stopped(session: Session) -> None:
    with pytest.raises(GoalLimitError, match=r"time limit of 0\.3 s"):
        session.ask(timeline(), "repeat, fail", time_limit=0.3)
    with pytest.raises(GoalLimitError, match="memory limit"):
        session.ask(timeline(), "numlist(1, 1000000000, L)", time_limit=60.0)


def test_what_no_limit_interrupts_ends_with_its_process(session: Session) -> None:
    session.ask(timeline(), "true")
    started = time.monotonic()
    with pytest.raises(GoalLimitError, match=r"^time limit of 0\.3 s reached"):
        session.ask(timeline(), "X is powm(3, 2**1000000-1, 2**1000000-3)", time_limit=0.3)
    # It would take minutes.
    assert time.monotonic() - started < 4.0


def test_answers_are_values(session: Session) -> None:
    egg = timeline()
    assert session.ask(egg, "holds(broken(X), S-E)") == [{"X": "egg1", "S": 0.5, "E": 2.0}]
    assert session.ask(egg, "holds(F, 1.0), fluentT(F, broken)") == [{"F": Term("broken", ("egg1",))}]
    assert session.ask(egg, "X = f(Y, Y)") == [{"X": Term("f", (Variable("_1"), Variable("_1"))), "Y": Variable("_1")}]
    assert session.ask(egg, "X = f(X)")[0]["X"] is not None
    assert session.ask(egg, "member(X, [b, a, b])") == [{"X": "b"}, {"X": "a"}]
    assert session.ask(egg, "repeat, member(X, [a, b])", limit=2) == [{"X": "a"}, {"X": "b"}]
    assert session.ask(egg, "X is 1 rdiv 3, Y = '😀', Z = \"text\", W = 'ü b'") == [
        {"X": Term("rdiv", (1, 3)), "Y": "😀", "Z": "text", "W": "ü b"}
    ]
    assert session.ask(egg, "findall(N, between(1, 50000, N), L)")[0]["L"] == tuple(range(1, 50001))
    assert len(session.ask(egg, "between(1, inf, X)", limit=100_000)) == 100_000
    assert session.ask(egg, "X = 'a\\tb\\nc'") == [{"X": "a\tb\nc"}]


@pytest.mark.parametrize(
    ("goal", "variables"),
    [
        ("aggregate_all(count, holds(F, T), N)", {"N"}),
        ("holds(broken(X), T), aggregate_all(max(E), holds(F, S-E), Last)", {"X", "T", "Last"}),
        ("holds(broken(X), T), aggregate_all(count, holds(F, T), N)", {"X", "T", "N"}),
        ("findall(F, holds(F, T), Fs)", {"Fs"}),
        ("findall(F, holds(F, T), Fs, More)", {"Fs", "More"}),
        ("forall(holds(broken(X), T), true)", set[str]()),
        ("\\+ holds(broken(X), 0.0), (Y = a ; once(Z = b))", {"Y", "Z"}),
        ("setof(F, S^E^holds(F, S-E), Fs)", {"Fs"}),
        ("bagof(F, S^holds(F, S-E), Fs)", {"Fs", "E"}),
        ("A = 2, foldl([X, Y, Z]>>(Z is A * X + Y), [1, 3], 0, S)", {"A", "S"}),
    ],
)
def test_an_answer_gives_the_variables_that_the_goal_binds(session: Session, goal: str, variables: set[str]) -> None:
    answers = session.ask(timeline(), goal)
    assert answers and all(set(answer) == variables for answer in answers)


def test_the_level_is_that_of_the_instance(session: Session) -> None:
    egg = timeline()
    goal = "occurs(E, S-_), eventT(E, 'ClosingGripper'), argsOf(E, [g, Level])"
    assert [(a["S"], a["Level"]) for a in session.ask(egg, goal)] == [(1.0, "force7"), (3.0, "force9")]
    assert session.ask(egg, "occurs(E, _), argsOf(E, [g])") != []


def test_domain_knowledge_is_answered(session: Session) -> None:
    egg = timeline()
    assert session.ask(egg, "instance_of(X, 'Egg'), has_part(X, P), value(X, mass, M)") == [
        {"X": "egg1", "P": "shell1", "M": 0.06}
    ]
    assert session.ask(egg, "holds(on(egg1, T), 0.0)") == [{"T": "table1"}]
    assert session.ask(egg, "holds(on(egg1, T), S-E)") == [{"T": "table1", "S": 0.0, "E": 4.0}]


def test_a_session_whose_process_was_killed_answers_again(session: Session) -> None:
    egg = timeline()
    session.load(egg)
    process = session._process  # pyright: ignore[reportPrivateUsage]
    assert process is not None
    os.kill(process.process_id, signal.SIGKILL)
    assert session.ask(egg, "holds(broken(X), _)") == [{"X": "egg1"}]


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({"limit": 0}, "limit: a whole number of answers, at least 1, not 0"),
        ({"limit": -1}, "not -1"),
        ({"limit": 2.5}, "not 2.5"),
        ({"time_limit": 0}, "time_limit: a number of seconds above 0"),
        ({"time_limit": -1.0}, "not -1.0"),
        ({"time_limit": float("nan")}, "not nan"),
        ({"time_limit": float("inf")}, "not inf"),
    ],
)
def test_limits_must_make_sense(session: Session, limits: dict[str, Any], message: str) -> None:
    with pytest.raises(GoalError, match=message):
        session.ask(timeline(), "true", **limits)


def test_a_thread_is_answered_while_the_queries_of_others_are_stopped(session: Session) -> None:
    egg = timeline()
    told: list[str] = []

    def fail(goal: str, time_limit: float) -> None:
        try:
            session.ask(egg, goal, time_limit=time_limit)
        except GoalLimitError as error:
            told.append(str(error).partition(":")[0])

    endless = threading.Thread(target=fail, args=("repeat, fail", 0.5))
    boundless = threading.Thread(target=fail, args=("findall(X, between(1, 10000000, X), L)", 60.0))
    for thread in (endless, boundless):
        thread.start()
    while endless.is_alive() or boundless.is_alive():
        assert session.ask(egg, "holds(broken(X), _)") == [{"X": "egg1"}]
    assert sorted(told) == ["memory limit of 256 MB reached", "time limit of 0.5 s reached"]


def test_all_threads_are_answered_when_the_process_is_killed_between(session: Session) -> None:
    egg = timeline()
    assert session.ask(egg, "true")
    answers: list[object] = []

    def ask() -> None:
        answers.extend(session.ask(egg, "between(1, 200000, N), N >= 200000, holds(broken(X), _)") for _ in range(3))

    threads = [threading.Thread(target=ask) for _ in range(3)]
    for thread in threads:
        thread.start()
    process = session._process  # pyright: ignore[reportPrivateUsage]
    assert process is not None
    os.kill(process.process_id, signal.SIGKILL)
    for thread in threads:
        thread.join()
    assert answers == [[{"N": 200000, "X": "egg1"}]] * 9


def test_no_question_makes_prolog_load_a_library(session: Session) -> None:
    egg = timeline()
    session.load(egg)
    process = session._process  # pyright: ignore[reportPrivateUsage]
    assert process is not None

    def loaded() -> str:
        return process.call("findall(F, source_file(F), Files), atomic_list_concat(Files, '\\n', Reply)", 10.0)

    before = loaded()
    session.ask(egg, "limit(1, order_by([desc(T)], distinct(X, holds(broken(X), T)))), format(atom(A), '~2f', [1])")
    with pytest.raises(GoalError):
        session.ask(egg, "hols(broken(X), _)")
    assert loaded() == before


def test_two_threads_ask_two_runs_at_once(session: Session) -> None:
    wrong: list[object] = []

    def ask(name: str) -> None:
        run = timeline(name)
        answers = [session.ask(run, "holds(broken(X), _)") for _ in range(30)]
        wrong.extend(answer for answer in answers if answer != [{"X": name}])

    threads = [threading.Thread(target=ask, args=(name,)) for name in ("egg1", "egg2")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_without_swi_prolog_the_message_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nonexistent")
    with pytest.raises(MissingToolError, match="apt install swi-prolog-nox"):
        Session().ask(timeline(), "true")


@pytest.mark.parametrize(
    ("goal", "shown"),
    [
        ("length(_L, 22), foldl([_, A, B]>>(B = f(A, A)), _L, x, R)", "..."),
        ("length(_L, 5000), foldl([_, A, f(A)]>>true, _L, a, R)", "..."),
        ("numlist(1, 600000, R)", "..."),
        ("length(_L, 2000000), maplist(=(x), _L), atomic_list_concat(_L, R)", "..."),
        ("length(_L, 2000000), maplist(=(x), _L), atomic_list_concat(_L, _A), R = f(_A)", "..."),
        ("length(_L, 22), foldl([_, A, B]>>(B = f(A, A)), _L, _, R)", "..."),
        ("X is 2**10000000, R = f(X)", "..."),
        # Its digits alone would take minutes.
        ("R is 2**1000000000", "..."),
    ],
)
def test_an_answer_that_is_too_large_is_cut_with_a_note(session: Session, goal: str, shown: str) -> None:
    with pytest.warns(Note, match="too large or too deep"):
        (answer,) = session.ask(timeline(), goal)
    text = format_value(answer["R"])
    assert shown in text and len(text) < 4_000_000


def test_all_answers_together_have_bounds(session: Session) -> None:
    with pytest.raises(GoalLimitError, match="the answers have more than 50,000,000 characters; set a limit"):
        words = "length(_L, 900000), maplist(=(x), _L), atomic_list_concat(_L, A), between(1, 100, N)"
        session.ask(timeline(), words, time_limit=60.0)


def test_a_displacement_of_an_action_is_the_list_that_the_plan_has() -> None:
    carrying = Fact(kind="event", type="carrying", args=("hand1", "[0.1,-0.37,0]"), start=0.0, end=0.5)
    timeline = make_timeline([carrying], dt=0.001, duration=1.0)
    assert timeline.ask("occurs(carrying(hand1, [0.1, -0.37, 0]), T)")
    (answer,) = timeline.ask("occurs(carrying(H, D), _), is_list(D), nth0(1, D, Y)")
    assert answer["Y"] == -0.37 and answer["H"] == "hand1"
    assert format_value(carrying.term) == "carrying(hand1,[0.1,-0.37,0])"
    assert timeline.ask(f"occurs({format_value(carrying.term)}, T)")


def test_a_text_that_is_no_list_of_numbers_is_a_text() -> None:
    for text in ("[1.2.3]", "[1.]", "[-]", "[1,]", "[]"):
        fact = Fact(kind="event", type="carrying", args=("hand1", text), start=0.0, end=0.5)
        (answer,) = make_timeline([fact], dt=0.001, duration=1.0).ask("occurs(carrying(H, D), _)")
        assert answer["D"] == text
