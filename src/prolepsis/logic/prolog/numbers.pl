/*  Numbers: 10 and 10.0 are one argument of a fact, one value and one instant, however they are written.

    A run keeps an argument as it first occurs in it. So a number in a goal that is one becomes the number that the run has,
    wherever in the goal it stands: in a fact, or in what a variable is compared with that is in one.
*/

:- module(numbers,
          [ apart/3,                    % +Goal, -Skeleton, -Numbers
            as_kept/3                   % +Run, +Readings, -Kept
          ]).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(kinds).
:- use_module(runs).
:- use_module(ticks).

%!  apart(+Goal, -Skeleton, -Numbers:list) is det.
%
%   Skeleton is Goal with a variable for each number in it; Numbers are the Variable-Number.

apart(Goal, Skeleton, Numbers) :-
    phrase(apart(Goal, Skeleton), Numbers).

apart(Term, Variable) --> { number(Term) }, !, [Variable-Term].
apart(Term, Skeleton) --> { compound(Term) }, !,
    { compound_name_arguments(Term, Name, Arguments), same_length(Arguments, Parts),
      compound_name_arguments(Skeleton, Name, Parts) },
    all_apart(Arguments, Parts).
apart(Term, Term) --> [].

all_apart([], []) --> [].
all_apart([Term|Terms], [Skeleton|Skeletons]) --> apart(Term, Skeleton), all_apart(Terms, Skeletons).

%!  as_kept(+Run, +Readings, -Kept:list) is det.
%
%   Kept are the numbers of the goal of Readings as the module Run has them.

as_kept(Run, Readings, Kept) :-
    maplist(number_kinds, Readings, [First|More]),
    foldl(both, More, First, All),
    maplist(kept(Run), All, Kept).

both(Some, More, All) :-
    maplist(both_kinds, Some, More, All).

both_kinds(Number-KindsA, Number-KindsB, Number-Kinds) :-
    append(KindsA, KindsB, Kinds).

%   An instant is a whole number, or one that was computed, as 0.1+0.2 is, within so much of that of its tick [s]; any other
%   is looked up at its tick when the goal runs.

rounding(1.0e-9).

kept(Run, Number-Kinds, Kept) :-
    (   ( memberchk(individual, Kinds) ; memberchk(argument, Kinds) )
    ->  spelt(Run, Number, Kept)
    ;   memberchk(end, Kinds),
        snapped(Run, Number, Instant),
        rounding(Most),
        abs(Instant-Number) < Most
    ->  Kept = Instant
    ;   memberchk(value(Of), Kinds),
        ( Run:proof(_, Of, Stored) ; Run:value(_, Of, Stored) ),
        number(Stored),
        Stored =:= Number
    ->  Kept = Stored
    ;   Kept = Number
    ).
