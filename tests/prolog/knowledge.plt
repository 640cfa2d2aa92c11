:- use_module(rows).
:- use_module('../../src/prolepsis/logic/prolog/knowledge').

found(Template, Goal, Answers) :-
    answers([ instance(egg1, 'Egg'), instance(egg1, 'Breakable'), instance(cup1, 'Container'),
              part(egg1, eggshell1), part(egg1, yolk1),
              value(egg1, mass, 0.058), value(egg1, colour, brown) ], Template, Goal, Answers).

:- begin_tests(knowledge).

test(each_class, A == ['Egg', 'Breakable']) :- found(C, instance_of(egg1, C), A).
test(each_instance, A == [cup1]) :- found(I, instance_of(I, 'Container'), A).
test(not_an_instance, A == []) :- found(x, instance_of(cup1, 'Egg'), A).
test(parts, A == [eggshell1, yolk1]) :- found(P, has_part(egg1, P), A).
test(whole, A == [egg1]) :- found(W, has_part(W, yolk1), A).
test(value, A == [0.058]) :- found(V, value(egg1, mass, V), A).
test(names_are_values, A == [colour]) :- found(P, value(egg1, P, brown), A).
test(what_is_not_known, A == []) :- found(V, value(cup1, mass, V), A).
test(no_knowledge_at_all, A == []) :- answers([fluent(a, 0.0, 1.0)], I, instance_of(I, _), A).

:- end_tests(knowledge).
