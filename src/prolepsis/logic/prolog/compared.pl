/*  Intervals are no numbers: T > 1 of an interval T would compute start minus end, and answer something else. */

:- module(compared,
          [ check_compared/1            % +Goal
          ]).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(occurs)).

%!  check_compared(+Goal) is det.
%
%   Check that Goal, a conjunction, compares no interval that a reader of the timeline gives and nothing else binds.
%
%   @error refused(compared_interval(Reader))

check_compared(Goal) :-
    conjuncts(Goal, Goals),
    (   member(Reader, Goals),
        gives(Reader, Interval),
        var(Interval),
        member(Comparison, Goals),
        compares(Comparison, Interval),
        \+ ( member(Other, Goals),
             \+ gives(Other, _),
             \+ compares(Other, Interval),
             \+ relates(Other),
             term_variables(Other, Variables),
             member(Variable, Variables),
             Variable == Interval )
    ->  throw(refused(compared_interval(Reader)))
    ;   true
    ).

conjuncts(Goal, [Goal]) :- var(Goal), !.
conjuncts((A, B), Goals) :- !,
    conjuncts(A, As),
    conjuncts(B, Bs),
    append(As, Bs, Goals).
conjuncts(Goal, [Goal]).

gives(Goal, Interval) :-
    nonvar(Goal),
    (   Goal = holds(_, Interval)
    ;   Goal = occurs(_, Interval)
    ;   Goal = instance_of(_, _, Interval)
    ).

compares(Goal, Interval) :-
    compound(Goal),
    Goal =.. [Operator, A, B],
    memberchk(Operator, [<, >, =<, >=, =:=, =\=]),
    ( member(Side, [A, B]), sub_term(Part, Side), Part == Interval ),
    !.

relates(Goal) :-
    compound(Goal),
    functor(Goal, Name, Arity),
    Arity =< 3,
    memberchk(Name, [ allen, after, before, meets, met_by, overlaps, overlapped_by, starts, started_by, during, contains,
                      finishes, finished_by, equals, evidence ]).
