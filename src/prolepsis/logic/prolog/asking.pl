/*  Asking: the predicates of a goal, each as its own module has it, but that "no" is said of known names only. */

:- module(asking,
          [ holds/2, holds_at/2, occurs/2, fluent/2, fluentT/2, event/2, eventT/2, argsOf/2, objOf/2, evidence/4, fact/6,
            matching/5,                 % as of timeline
            instance_of/3, instance_of/2, has_part/2, value/3, subclass_of/2, unit/2, % as of knowledge
            near_miss/3,                % as of near
            ongoing/1                   % as of open_ends
          ]).
:- use_module(library(lists)).
:- use_module(knowledge, []).
:- use_module(names).
:- use_module(near, []).
:- use_module(open_ends, []).
:- use_module(timeline, []).

term_expansion(asked(Module, Predicates), Clauses) :-
    findall((Head :- ( Module:Head *-> true ; check_found_nothing(Head) )),
            ( member(Name/Arity, Predicates), functor(Head, Name, Arity) ),
            Clauses).

asked(timeline, [ holds/2, holds_at/2, occurs/2, fluent/2, fluentT/2, event/2, eventT/2, argsOf/2, objOf/2, evidence/4,
                  fact/6, matching/5 ]).
asked(knowledge, [ instance_of/3, instance_of/2, has_part/2, value/3, subclass_of/2, unit/2 ]).
asked(open_ends, [ ongoing/1 ]).
asked(near, [ near_miss/3 ]).
