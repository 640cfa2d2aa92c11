/*  Not as meant: what can be seen of a goal that is right, and asks something else than was meant, perhaps. */

:- module(not_as_meant,
          [ read_as_variable/5,         % +Goal, +Bindings, -Variable, -Kind, -Name
            outside/3                   % +Goal, +Run, -Instant
          ]).
:- use_module(library(lists)).
:- use_module(library(occurs)).
:- use_module(known).
:- use_module(positions).
:- use_module(runs).

%!  read_as_variable(+Goal, +Bindings, -Variable, -Kind, -Name) is nondet.
%
%   True if Variable stands only once in Goal, where a Kind is named, and is spelt as the Name of one but for capitals.

read_as_variable(Goal, Bindings, Variable, Kind, Name) :-
    member(Variable=Value, Bindings),
    var(Value),
    occurrences_of_var(Value, Goal, 1),
    once(( named(Goal, Kind, Argument), Argument == Value )),
    what(Kind),
    folded(Variable, Folded),
    once(( candidate(Kind, Known), named_as(Known, Kind, Name), functor(Name, Plain, _), folded(Plain, Folded) )).

%   what(+Kind): of a Kind that is not an individual, which may be there in one run and not in another.

what(Kind) :-
    ( fact_kind(Kind) ; memberchk(Kind, [type(_), class, property, evidence, quantity]) ),
    !.

%   A fact is named by a term.

named_as(Name/Arity-Is, Kind, Term), fact_kind(Kind) =>
    ( Kind == fact ; Kind == Is ),
    functor(Term, Name, Arity).
named_as(Name, _, Known) =>
    Known = Name.

folded(Name, Folded) :-
    atom(Name),
    atomic_list_concat(Words, '_', Name),
    atomic_list_concat(Words, Joined),
    downcase_atom(Joined, Folded).

%!  outside(+Goal, +Run, -Instant) is nondet.
%
%   True if Goal asks of an Instant at which the log of Run does not tell anything.

outside(Goal, Run, Instant) :-
    \+ ( within(Goal, Inner), functor(Inner, in, 2) ),
    known_run(Run, Module),
    Module:lasts(Last),
    named(Goal, time, Instant),
    number(Instant),
    ( Instant < 0 ; Instant > Last ).
