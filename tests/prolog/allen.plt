:- use_module('../../src/prolepsis/logic/prolog/runs').
:- use_module('../../src/prolepsis/logic/prolog/allen').

:- begin_tests(allen).

test(meets, Relation == meets) :- allen(Relation, 0.0-1.0, 1.0-2.0).
test(contains, Relation == contains) :- allen(Relation, 0.0-1.0, 0.25-0.75).
test(one_each, Count == 1) :- aggregate_all(count, allen(_, 0.0-2.0, 1.0-3.0), Count).
test(broad_after) :- after(1.0-3.0, 0.0-2.0).
test(broad_after_is_not_during, fail) :- after(1.0-2.0, 0.0-2.0).
test(before_is_inverse) :- before(0.0-2.0, 1.0-3.0).
test(empty, error(type_error(interval, _))) :- allen(_, 1.0-1.0, 0.0-2.0).
test(unknown, error(existence_error(relation, befor))) :- allen(befor, 0.0-1.0, 2.0-3.0).

:- end_tests(allen).
