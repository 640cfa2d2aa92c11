/*  Not as meant: what can be seen of a goal that is right, and asks something else than was meant, perhaps. */

:- module(not_as_meant,
          [ read_as_variable/5,         % +Goal, +Bindings, -Variable, -Kind, -Name
            individual_as_variable/5,   % +Readings, +Variables, +Bindings, -Variable, -Name
            spelt_otherwise/3,          % +Readings, -Text, -Name
            told_by_none/4,             % +Readings, -Kind, -Value, -Told
            never_both/5,               % +Readings, +Variables, +Bindings, -Variable, -What
            given_by_none/4,            % +Goal, +Bindings, -Variable, -How
            outside/4                   % +Goal, +Readings, +Run, -Instant
          ]).
:- use_module(library(lists)).
:- use_module(library(occurs)).
:- use_module(kinds).
:- use_module(known).
:- use_module(positions).
:- use_module(runs).
:- use_module(timeline, [same_type/2]).
:- use_module(vocabulary).

%!  read_as_variable(+Goal, +Bindings, -Variable, -Kind, -Name) is nondet.
%
%   True if Variable stands only once in Goal, where a Kind is named, and is spelt as the Name of one but for capitals.
%   One letter is how variables are written.

read_as_variable(Goal, Bindings, Variable, Kind, Name) :-
    member(Variable=Value, Bindings),
    var(Value),
    \+ atom_length(Variable, 1),
    occurrences_of_var(Value, Goal, 1),
    once(( named(Goal, Kind, Argument), Argument == Value )),
    what(Kind),
    folded(Variable, Folded),
    once(( candidate(Kind, Known), named_as(Known, Kind, Name), functor(Name, Plain, _), folded(Plain, Folded) )).

%!  individual_as_variable(+Readings, +Variables, +Bindings, -Variable, -Name) is nondet.
%
%   True if Variable, one of the Variables of the goal of Readings, stands for any individual, is compared with none, and is
%   spelt as the individual Name but for capitals.

individual_as_variable(Readings, Variables, Bindings, Variable, Name) :-
    member(Reading, Readings),
    variable(Reading, N, Kinds, []),
    memberchk(individual, Kinds),
    nth0(N, Variables, Value),
    member(Variable=Same, Bindings),
    Same == Value,
    \+ atom_length(Variable, 1),
    ( small(Variable, Name) ; downcase_atom(Variable, Name) ),
    known(individual, Name).

small(Name, Small) :-
    sub_atom(Name, 0, 1, Rest, First),
    sub_atom(Name, 1, Rest, 0, More),
    downcase_atom(First, Lower),
    atom_concat(Lower, More, Small).

%!  spelt_otherwise(+Readings, -Text, -Name) is nondet.
%
%   True if a variable of the goal of Readings stands for a type, which is told as Name, and is compared with Text, its other
%   spelling.

spelt_otherwise(Readings, Text, Name) :-
    member(Reading, Readings),
    variable(Reading, _, Kinds, Constants),
    memberchk(type(Kind), Kinds),
    member(Text, Constants),
    atom(Text),
    \+ known(name(Kind), Text),
    once(( candidate(type(Kind), Name), same_type(Text, Name) )).

%!  told_by_none(+Readings, -Kind, -Value, -Told:list) is nondet.
%
%   True if the goal of Readings asks whether Value is a value of a Kind that may be any text, and no run has it, but those
%   Told; Kind is value(Of), or value, if of anything, where Value is what values are called.

told_by_none(Readings, Kind, Value, Told) :-
    member(Reading, Readings),
    class(Reading, Kinds, Constants, _),
    member(Kind, Kinds),
    free(Kind),
    member(Value, Constants),
    ( atom(Value) ; string(Value) ),
    \+ has(Kind, Value),
    findall(Each, ( Kind = value(_), has(Kind, Each), atom(Each) ), All),
    sort(All, Told),
    ( Kind == value -> known(quantity, Value) ; Told \== [] ).

free(value).
free(value(Of)) :-
    \+ allowed_value(Of, _),
    \+ quantity(Of, _).

has(value, Value) :- ( allowed_value(_, Value) ; stored_value_of(_, Value) ), !.
has(value(Of), Value) :- stored_value_of(Of, Value).

%!  never_both(+Readings, +Variables, +Bindings, -Variable, -What) is nondet.
%
%   True if Variable, one of the Variables of the goal of Readings, stands for a fact, and for What, which no fact is, or no
%   fluent.

never_both(Readings, Variables, Bindings, Variable, What) :-
    member(Reading, Readings),
    variable(Reading, N, Kinds, _),
    (   subset([fluent, event], Kinds)
    ->  What = event
    ;   once(( member(Kind, Kinds), fact_kind(Kind) )),
        once(( member(Other, Kinds), no_fact(Other, What) ))
    ),
    nth0(N, Variables, Value),
    member(Variable=Same, Bindings),
    Same == Value.

no_fact(end, time).
no_fact(instant, time).
no_fact(time, time).
no_fact(interval, time).
no_fact(individual, individual).
no_fact(class, class).
no_fact(property, property).

%!  given_by_none(+Goal, +Bindings, -Variable, -How) is nondet.
%
%   True if nothing in Goal gives Variable the value that is compared with a number, or that is collected.

given_by_none(Goal, Bindings, Variable, How) :-
    member(Variable=Value, Bindings),
    var(Value),
    occurrences_of_var(Value, Goal, 1),
    within(Goal, Inner),
    (   ( Inner = (A == B) ; Inner = (A \== B) ),
        ( A == Value, number(B) ; B == Value, number(A) )
    ->  How = compared
    ;   Inner =.. [Collects, Template|_],
        memberchk(Collects, [findall, bagof, setof, aggregate_all]),
        occurrences_of_var(Value, Template, 1)
    ->  How = collected
    ).

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

%!  outside(+Goal, +Readings, +Run, -Instant) is nondet.
%
%   True if Goal asks of an Instant, or an interval from or to that, at which the log of Run does not tell anything.

outside(Goal, Readings, Run, Instant) :-
    \+ ( within(Goal, Inner), functor(Inner, in, 2) ),
    known_run(Run, Module),
    Module:lasts(Last),
    asked_at(Goal, Readings, Instant),
    number(Instant),
    ( Instant < 0 ; Instant > Last ).

asked_at(Goal, _, Instant) :-
    named(Goal, time, Interval),
    nonvar(Interval),
    Interval = Start-End,
    ( Instant = Start ; Instant = End ).
asked_at(_, Readings, Instant) :-
    member(Reading, Readings),
    class(Reading, Kinds, Constants, _),
    ( memberchk(time, Kinds) ; memberchk(instant, Kinds) ),
    member(Instant, Constants).
