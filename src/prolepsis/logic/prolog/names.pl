/*  Names: what a goal names must be known, or the answer "no" would be to a question that nobody meant.

    A goal is looked through before it runs: what stands where something is named, and what a variable is compared with that
    stands there. What the goal binds only when it runs is looked up when a predicate finds nothing: what it finds is known.
*/

:- module(names,
          [ check_names/1,              % +Goal
            check_names/2,              % +Goal, +Readings
            check_found_nothing/1       % +Goal
          ]).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(allen, [relation_names/1]).
:- use_module(kinds).
:- use_module(known).
:- use_module(positions).
:- use_module(ticks).
:- use_module(vocabulary).

%!  check_names(+Goal) is det.
%!  check_names(+Goal, +Readings) is det.
%
%   Check what Goal, which the guard has let pass, and the goals in it name, as it stands and in its Readings.
%
%   @error refused(unknown_name(Kind, Name)), refused(no_number(Property, Unit, Value)), refused(no_value(Relation)),
%          refused(no_time(Value)), refused(computed_interval(Reader)), type_error(interval, Value)

check_names(Goal) :-
    readings(Goal, [], Readings),
    check_names(Goal, Readings).

check_names(Goal, Readings) :-
    forall(( named(Goal, Kind, Argument), nonvar(Argument) ),
           check_name(Kind, Argument)),
    forall(member(Reading, Readings), check_reading(Reading)).

check_reading(Reading) :-
    forall(class(Reading, Kinds, Constants, Terms), check_class(Kinds, Constants, Terms)),
    forall(made_of(Reading, Kind, Name, Arity), check_made(Kind, Name, Arity)),
    forall(interval_computed(Reading, Reader), throw(refused(computed_interval(Reader)))).

%   What is known as one of several kinds is known.

check_class(Kinds0, Constants, Terms) :-
    exclude(anything, Kinds0, Kinds),
    (   Kinds = [Kind|_]
    ->  forall(( member(Constant, Constants), \+ ( member(Each, Kinds), accepts(Each, Constant) ) ),
               check_name(Kind, Constant)),
        forall(( member(Term, Terms), \+ ( member(Each, Kinds), accepts(Each, Term) ) ),
               check_name(Kind, Term))
    ;   true
    ).

anything(any).
anything(number).
anything(computed).
anything(argument).
anything(value).

accepts(individual, Term), ( compound(Term) ; number(Term) ) => true.
accepts(Kind, Term) => catch(check_name(Kind, Term), Error, refuses(Error)).

refuses(refused(_)) => fail.
refuses(error(type_error(interval, _), _)) => fail.

check_made(Kind, Name, Arity) :-
    (   ( Arity == any -> known(name(Kind), Name) ; known_fact(Kind, Name, Arity) )
    ->  true
    ;   Arity == any
    ->  unknown(name(Kind), Name)
    ;   unknown(Kind, Name/Arity)
    ).

%!  check_found_nothing(+Goal) is failure.
%
%   Fail, once what Goal names is sure to be known. What is known as something else, the query has found, or it was told
%   of before the query ran.

check_found_nothing(Goal) :-
    forall(( argument(Goal, Kind, Argument), nonvar(Argument), \+ accepts(Kind, Argument), \+ found(Argument) ),
           check_name(Kind, Argument)),
    forall(argument(Goal, Kind, Argument), check_arity(Kind, Argument)),
    fail.

%   found(+Term): a query may find Term, as a fact, or as a name or value of some kind.

found(Term) :-
    compound(Term),
    functor(Term, Name, Arity),
    known_fact(fact, Name, Arity),
    check_individuals(Arity, Term),
    !.
found(Name) :-
    ( atom(Name) ; string(Name) ),
    (   known_fact(fact, Name, 0)
    ;   member(Kind, [individual, class, property, evidence, type(fact), unit, run]),
        known(Kind, Name)
    ;   stored_value_of(_, Name)
    ),
    !.

%   A fact that occurs with other arguments only has not been asked for: an action has those that its plan gives it.

check_arity(Kind, Term) :-
    (   fact_kind(Kind),
        callable(Term),
        functor(Term, Name, Arity),
        occurs_with(Kind, Name, _),
        \+ occurs_with(Kind, Name, Arity)
    ->  unknown(occurring, Name/Arity)
    ;   true
    ).

check_name(Kind, Term), fact_kind(Kind) =>
    (   callable(Term),
        functor(Term, Name, Arity),
        known_fact(Kind, Name, Arity)
    ->  check_individuals(Arity, Term)
    ;   callable(Term)
    ->  functor(Term, Name, Arity),
        unknown(Kind, Name/Arity)
    ;   unknown(Kind, Term)
    ).
check_name(time, Time) =>
    must_be_time(Time).
check_name(interval, Interval) =>
    must_be_interval(Interval).
check_name(Instant, Time), memberchk(Instant, [instant, end]) =>
    must_be_instant(Time).
check_name(arguments, List) =>
    check_list(List).
check_name(relation, Relation) =>
    relation_names(Names),
    ( memberchk(Relation, Names) -> true ; throw(refused(unknown_relation(Relation))) ).
check_name(type(Kind), Name), atom(Name), \+ known(type(Kind), Name), other_kind(Kind, Other), known(type(Other), Name) =>
    throw(refused(other_kind(Kind, Name, Other))).
check_name(individuals, List) =>
    check_list(List),
    forall(( listed(List, Each), ( atom(Each) ; string(Each) ) ), check_name(individual, Each)).
check_name(property, Name), related(Name) =>
    throw(refused(no_value(Name))).
check_name(value(Of), Value) =>
    check_value(Of, Value).
check_name(Kind, Name) =>
    (   atom(Name),
        known(Kind, Name)
    ->  true
    ;   unknown(Kind, Name)
    ).

other_kind(fluent, event).
other_kind(event, fluent).

check_list(List) :-
    (   ( var(List) ; List == [] ; List = [_|_] )
    ->  true
    ;   throw(refused(no_list(List)))
    ).

%   listed(+List, -Each): of a list that may end in a variable; [] is none.

listed(List, Each) :-
    nonvar(List),
    List = [First|Rest],
    ( Each = First ; listed(Rest, Each) ).

%   Where there are few, a value is one of them; and a quantity is a number.

check_value(Of, Value) :-
    (   allowed_value(Of, _)
    ->  ( known(value(Of), Value) -> true ; unknown(value(Of), Value) )
    ;   ( atom(Value) ; string(Value) ),
        quantity(Of, Unit),
        \+ stored_value(Of, Value)
    ->  throw(refused(no_number(Of, Unit, Value)))
    ;   true
    ).

unknown(Kind, Term) :-
    throw(refused(unknown_name(Kind, Term))).

%   The arguments of a fact are individuals, numbers and lists of them, or what a rule makes of them.

check_individuals(0, _) :- !.
check_individuals(N, Term) :-
    arg(N, Term, Argument),
    (   ( atom(Argument) ; string(Argument) )
    ->  check_name(individual, Argument)
    ;   compound(Argument),
        Argument \= [_|_],
        functor(Term, Name, Arity),
        \+ made_by_rule(Name, Arity)
    ->  unknown(individual, Argument)
    ;   true
    ),
    Rest is N-1,
    check_individuals(Rest, Term).
