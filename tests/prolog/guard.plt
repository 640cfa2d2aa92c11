:- use_module('../../src/prolepsis/logic/prolog/guard').

%   What becomes of a goal in text: permitted, or the reason why not.

verdict(Text, Verdict) :-
    catch(( read_goal(Text, Goal, _),
            check_goal(Goal),
            Verdict = permitted ),
          refused(Reason),
          Verdict = Reason).

:- begin_tests(guard).

permitted("holds(F, T), after(T, 0.0-1.0), \\+ occurs(falling(_), T)").
permitted("findall(X, (member(X, [1, 2]), X > 1), L), sum_list(L, S)").
permitted("setof(X-T, A^holds(contacts(X, A), T), L)").
permitted("maplist([X, Y]>>(Y is X * 2), [1, 2], L)").
permitted("Y = 1, maplist({Y}/[X]>>(X = Y), [A])").
permitted("foldl([X, A0, A]>>(A is A0 + X), [1, 2], 0, Sum)").
permitted("call(member, X, [a, b])").
permitted("format(atom(A), '~w drops ~2f m ~~ ~`-t~30|', [egg1, 0.5])").
permitted("in(run1, holds(F, T))").
permitted("true. % and a comment").

refused("halt").
refused("user:assertz(a)").
refused("lists:append(X, Y, [a])").
refused("[X]>>halt").
refused("call([X]>>halt, a)").
refused("call({a}/[X]>>halt, a)").
refused("maplist(Y>>halt, [a])").
refused("findall(X, Y^halt, L)").
refused("setof(X, Y^(true, halt), L)").
refused("aggregate_all(count, halt, N)").
refused("in(run1, halt)").
refused("\\+ \\+ halt").
refused("(true -> true ; halt)").
refused("forall(true, halt)").
refused("foldl(assertz, [a], b, C)").
refused("include(shell, [a], L)").
refused("catch(true, _, halt)").
refused("throw(time_limit_exceeded)").
refused("print(a)").
refused("freeze(X, halt)").
refused("b_setval(prolepsis_run, x)").
refused("read(X)").
refused("G = halt, call(G)").
refused("member(G, [halt]), G").
refused("call(call, halt)").
refused("maplist(call, [halt])").
refused("maplist(G, [halt])").
refused("X = f(X), X").
refused("allen(befor, I, J)").
refused("timeline:matching(fluent, F, T, _, _)").
refused("matching(fluent, F, T, _, _)").

test(permitted, [forall(permitted(Text)), Verdict == permitted]) :- verdict(Text, Verdict).
test(refused, [forall(refused(Text))]) :- verdict(Text, Verdict), Verdict \== permitted.
test(unknown, Verdict == unknown_predicate(hold/2)) :- verdict("hold(F, T)", Verdict).
test(relation, Verdict == unknown_relation(befor)) :- verdict("allen(befor, I, J)", Verdict).
test(unbound, Verdict == unbound_goal) :- verdict("call(G)", Verdict).
test(two_goals, Verdict = syntax(_, _)) :- verdict("true. true", Verdict).
test(empty, Verdict = syntax(0, _)) :- verdict(" ", Verdict).
test(names, Names == ['X', 'T']) :- read_goal("holds(f(X, _Y, _), T)", _, Bindings), findall(N, member(N=_, Bindings), Names).

:- end_tests(guard).

%   The table says of each argument what the system says: a goal that is called is walked.

called(?, false).
called(Form, false) :- memberchk(Form, [sink, directives, relation]).
called(Form, Form) :- integer(Form).
called(^, ^).

system_says(Form, Spec) :-
    functor(Form, Name, Arity),
    functor(Head, Name, Arity),
    (   predicate_property(query:Head, meta_predicate(Spec))
    ->  true
    ;   Spec = Head
    ).

as_called(Said, Called) :-
    (   ( integer(Said) ; Said == (^) )
    ->  Called = Said
    ;   Called = false
    ).

:- begin_tests(table).

test(defined, Missing == []) :-
    % Those that only newer versions have.
    Newer = [max_member/3, min_member/3, scanl/4, scanl/5, scanl/6, scanl/7],
    findall(Name/Arity,
            ( may(Form), functor(Form, Name, Arity), \+ memberchk(Name/Arity, Newer),
              functor(Head, Name, Arity), \+ exists(Head) ),
            Missing).
test(goals_are_walked, Different == []) :-
    findall(Form-N,
            ( may(Form), compound(Form), system_says(Form, Spec), arg(N, Form, Argument), called(Argument, Ours),
              arg(N, Spec, Said), as_called(Said, Theirs), Ours \== Theirs ),
            Different).
test(every_argument_has_a_form, Strange == []) :-
    findall(Form, ( may(Form), compound(Form), arg(_, Form, Argument), \+ called(Argument, _) ), Strange).
test(once_each, Twice == []) :-
    findall(Name/Arity, ( may(Form), functor(Form, Name, Arity) ), All),
    findall(PI, ( select(PI, All, Others), memberchk(PI, Others) ), Twice).

:- end_tests(table).
