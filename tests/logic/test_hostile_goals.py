"""No goal does harm: whatever is tried, no program runs, no file is read or written, and nothing is changed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.hostile_goals import EFFECTS, by_hand, crossed
from tests.logic.test_session import timeline

from prolepsis.logic.confinement import Walls
from prolepsis.logic.process import ProcessLost, PrologProcess
from prolepsis.logic.session import Session
from prolepsis.terms.errors import GoalError, InputError, Note
from prolepsis.terms.terms import format_atom, format_value

SECRET = "what nobody may read"
TRIPPED = "flag(tripped, Count, Count), format(string(Reply), '~w', [Count])"


@pytest.fixture
def files(tmp_path: Path) -> dict[str, str]:
    secret = tmp_path / "secret.pl"
    secret.write_text(f"{format_atom(SECRET)}.")
    return {"{mark}": str(tmp_path / "mark"), "{secret}": str(secret), "{folder}": str(tmp_path)}


@pytest.fixture(scope="module")
def session() -> Iterator[Session]:
    session = Session()
    yield session
    session.close()


def running(session: Session) -> PrologProcess:
    """Return the session's process, in which running ``trip`` is counted, as a goal that gets through would."""
    session.load(timeline())
    process = session._process  # pyright: ignore[reportPrivateUsage]
    assert process is not None
    for head in ("trip", "trip(_)", "trip(_, _)", "trip(_, _, _)", "trip(_, _, _, _)"):
        clause = f"user:({head} :- flag(tripped, N, N+1))"
        process.call(f"( clause(user:{head}, _) -> true ; assertz({clause}) ), Reply = ok", 10.0)
    return process


def filled(goal: str, files: dict[str, str]) -> str:
    for name, path in files.items():
        goal = goal.replace(name, path)
    return goal


def test_goals_that_mean_harm_are_refused(session: Session, files: dict[str, str]) -> None:
    process = running(session)
    goals = list(by_hand())
    assert len(goals) >= 300
    for goal in goals:
        with pytest.raises(GoalError) as refused:
            session.ask(timeline(), filled(goal, files), time_limit=2.0)
        assert SECRET not in str(refused.value), goal
    assert sorted(path.name for path in Path(files["{folder}"]).iterdir()) == ["secret.pl"]
    assert running(session) is process and process.call(TRIPPED, 10.0) == "0"


def test_no_allowed_predicate_runs_a_goal_unseen(session: Session) -> None:
    process = running(session)
    table = process.call(
        "findall(L, (guard:may(F), functor(F, N, A), format(string(L), '~q\\t~w', [N, A])), Ls),"
        "atomic_list_concat(Ls, '\\n', Reply)",
        10.0,
    )
    rows = [line.split("\t") for line in table.split("\n")]
    forms = [(name if name[0].isalpha() or name[0] == "'" else f"({name})", int(arity)) for name, arity in rows]
    forms = [(f"'{name[1:-1]}'" if name.startswith("(") else name, arity) for name, arity in forms]
    asked = 0
    for goal, _ in crossed(forms):
        asked += 1
        try:
            for answer in session.ask(timeline(), goal, limit=3, time_limit=0.5):
                assert SECRET not in "".join(map(format_value, answer.values()))
        except GoalError:
            pass
    assert asked >= 2500
    assert running(session) is process and process.call(TRIPPED, 10.0) == "0"


def test_without_walls_and_guard_it_would_be_noticed(files: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("prolepsis.logic.process.offered", Walls)
    with pytest.warns(Note, match="not confined"):
        process = PrologProcess()
    process.call(f"ignore({filled(EFFECTS[0], files)}), Reply = ok", 10.0)
    assert Path(files["{mark}"]).exists()
    process.call("assertz((user:trip(_) :- flag(tripped, N, N+1))), trip(1), Reply = ok", 10.0)
    assert process.call(TRIPPED, 10.0) == "1"
    process.close()


def test_without_the_guard_the_second_wall_holds(files: dict[str, str]) -> None:
    process = PrologProcess()
    try:
        for effect in EFFECTS:
            if effect.startswith(
                ("halt", "abort", "prolog", "break", "trace", "thread_", "mqi", "read(", "get_char", "sleep")
            ):
                continue
            goal = filled(effect, files)
            shown = "with_output_to(string(Reply), print(X))"
            try:
                reply = process.call(f"catch(ignore(({goal})), _, true), {shown}", 5.0)
            except (InputError, ProcessLost):
                process.close()
                process = PrologProcess()
                continue
            assert SECRET not in reply, effect
        assert sorted(path.name for path in Path(files["{folder}"]).iterdir()) == ["secret.pl"]
        assert Path(files["{secret}"]).read_text() == f"{format_atom(SECRET)}."
    finally:
        process.close()
