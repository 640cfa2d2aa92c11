:- use_module(rows).
:- use_module('../../src/prolepsis/logic/prolog/timeline').
:- use_module('../../src/prolepsis/logic/prolog/allen').
:- use_module('../../src/prolepsis/logic/prolog/runs').

rows([ event(closingGripper(g), 0.5, 1.0), proof(level, force7), proof(force, 12.5),
       fluent(attached(g, egg1), 1.0, 3.0),
       event(raining, 1.5, 2.5),
       event(closingGripper(g), 2.0, 2.5), proof(level, force9),
       fluent(between(egg1, g, table1), 2.0, 3.0),
       fluent(filled(cup1, 2), 2.5, 3.0) ]).

found(Template, Goal, Answers) :-
    rows(Rows),
    answers(Rows, Template, Goal, Answers).

:- begin_tests(holds).

test(over_its_interval, A == [1.0-3.0]) :- found(T, holds(attached(g, egg1), T), A).
test(at_its_first_instant) :- found(x, holds(attached(g, egg1), 1.0), [x]).
test(not_at_its_last, A == []) :- found(x, holds(attached(g, egg1), 3.0), A).
test(whole_numbers_are_times_too, A == [x]) :- found(x, holds(attached(_, _), 1-3), A).
test(events_do_not_hold, A == []) :- found(x, holds(raining, _), A).
test(by_half_an_interval, A == [attached(g, egg1)]) :- found(F, holds(F, 1.0-_), A).
test(in_the_order_of_the_timeline, A == [attached, between, filled]) :-
    found(N, ( holds(F, _), functor(F, N, _) ), A).
test(at_an_instant_only, error(type_error(number, 0.0-1.0))) :- found(x, holds_at(_, 0.0-1.0), _).

:- end_tests(holds).

:- begin_tests(occurs).

test(each_occurrence, A == [0.5-1.0, 2.0-2.5]) :- found(T, occurs(closingGripper(g), T), A).
test(without_arguments, A == [1.5-2.5]) :- found(T, occurs(raining, T), A).

:- end_tests(occurs).

:- begin_tests(types).

test(is_the_name, A == [attached]) :- found(T, fluentT(attached(g, egg1), T), A).
test(in_the_paper_s_spelling, A == [closingGripper(g)]) :- found(E, eventT(E, 'ClosingGripper'), A).
test(with_underscores, A == [x]) :- found(x, eventT(closingGripper(g), closing_gripper), A).
test(of_fluents_only, A == []) :- found(x, fluent(raining, _), A).
test(of_a_number, A == []) :- found(T, eventT(3, T), A).

:- end_tests(types).

:- begin_tests(arguments).

test(the_level_comes_last, A == [[g, force7], [g, force9]]) :-
    found(Args, ( argsOf(closingGripper(g), Args), Args = [_, _] ), A).
test(a_list_without_the_level_matches, A == [x]) :- found(x, argsOf(closingGripper(g), [g]), A).
test(of_one_instance, A == [[g, force9]]) :- found(Args, args_of(closingGripper(g), 2.0-2.5, Args), A).
test(none, A == [[]]) :- found(Args, argsOf(raining, Args), A).
test(each_object, A == [egg1, g, table1]) :- found(O, objOf(between(egg1, g, table1), O), A).
test(numbers_are_no_objects, A == [cup1]) :- found(O, objOf(filled(cup1, 2), O), A).
test(a_third_argument_is_found, A == [between(egg1, g, table1)]) :- found(F, objOf(F, table1), A).

:- end_tests(arguments).

:- begin_tests(evidence).

test(by_name, A == [12.5]) :- found(V, evidence(closingGripper(g), 0.5-1.0, force, V), A).
test(at_an_instant, A == [force9]) :- found(V, evidence(closingGripper(g), 2.25, level, V), A).
test(by_value, A == [closingGripper(g)-(0.5-1.0)]) :- found(E-T, evidence(E, T, level, force7), A).

:- end_tests(evidence).

:- begin_tests(symmetric).

contacts([ fluent(contacts(egg1, table1), 0.0, 1.0), fluent(contacts(g, egg1), 0.5, 2.0), proof(force, 3.0),
           fluent(contacts(egg1, bowl1), 0.75, 1.0), fluent(supports(table1, egg1), 0.0, 1.0) ]).

touching(Template, Goal, Answers) :-
    contacts(Rows),
    answers(Rows, Template, Goal, Answers).

test(either_order_in_time, A == [table1-(0.0-1.0), g-(0.5-2.0), bowl1-(0.75-1.0)]) :-
    touching(X-T, holds(contacts(egg1, X), T), A).
test(either_order_from_behind, A == [table1, g, bowl1]) :- touching(X, holds(contacts(X, egg1), _), A).
test(both_given, A == [0.5-2.0]) :- touching(T, holds(contacts(egg1, g), T), A).
test(at_an_instant, A == [g]) :- touching(X, holds(contacts(egg1, X), 1.5), A).
test(over_an_interval, A == [g]) :- touching(X, holds(contacts(egg1, X), 0.5-2), A).
test(evidence, A == [3.0]) :- touching(V, evidence(contacts(egg1, g), _, force, V), A).
test(each_once_as_stored, A == [contacts(egg1, table1), contacts(g, egg1), contacts(egg1, bowl1)]) :-
    touching(contacts(X, Y), holds(contacts(X, Y), _), A).
test(each_once_as_stored_by_its_object, A == [contacts(egg1, table1), contacts(g, egg1), contacts(egg1, bowl1)]) :-
    touching(F, ( holds(F, _), fluentT(F, contacts), objOf(F, egg1) ), A).
test(not_of_other_types, A == []) :- touching(T, holds(supports(egg1, table1), T), A).

:- end_tests(symmetric).

:- begin_tests(runs).

test(facts_as_stored, A == [2-[g, egg1]]) :- found(Id-Args, fact(test, Id, attached, Args, 1.0, 3.0), A).
test(in_a_run, A == [x]) :- found(x, in(test, holds(attached(g, egg1), _)), A).
test(in_no_run, A == []) :- found(x, in(nowhere, true), A).
test(a_run_of_the_same_name_replaces, A == [b]) :-
    answers([fluent(a, 0.0, 1.0)], x, true, _),
    answers([fluent(b, 0.0, 1.0)], F, holds(F, _), A).
test(a_dropped_run_is_gone, fail) :-
    answers([fluent(a, 0.0, 1.0)], x, true, _),
    drop_run(test),
    with_run(test, true).
test(facts_cannot_be_changed, error(permission_error(_, _, _))) :-
    answers([fluent(a, 0.0, 1.0)], x, ( current_run(Run), assertz(Run:fluent(b, [], [], b, 0.0, 1.0, 9)) ), _).
test(each_interval_once, A == [0.5-1.0, 1.0-3.0, 1.5-2.5, 2.0-2.5, 2.0-3.0, 2.5-3.0]) :- found(T, interval(T, _, _), A).
test(relations_range_over_them, A == [0.5-1.0]) :- found(T, before(T, 1.0-1.2), A).

:- end_tests(runs).
