/*  Names: what a goal names must be known, or the answer "no" would be to a question that nobody meant.

    Known is the vocabulary, what is declared in Python or by a rule of a user's, and whatever occurs in a run of this
    session or in what is known of its individuals. A goal is looked through before it runs, and what it binds only then
    is looked up when a predicate finds nothing: what it finds is known.
*/

:- module(names,
          [ takes/1,                    % ?Form
            check_names/1,              % +Goal
            check_found_nothing/1,      % +Goal
            known_names/2,              % +Kind, -Names
            named/3,                    % +Goal, -Kind, -Argument
            within/2,                   % +Goal, -Inner
            what/1,                     % +Kind
            fact_kind/1,                % ?Kind
            candidate/2,                % +Kind, -Name
            declare_event/1             % +Event
          ]).
:- use_module(library(lists)).
:- use_module(library(apply)).
:- use_module(chronicles).
:- use_module(guard).
:- use_module(runs).
:- use_module(timeline, [same_type/2]).
:- use_module(vocabulary).

:- dynamic declared_event/2, declared_name/1.

%!  takes(?Form) is nondet.
%
%   What the arguments of the predicates on timelines and individuals must be: ? for any term, else the kind of what is
%   named; fact is a fluent or an event, type(Kind) the name of its type in either spelling, individuals a list of them,
%   value(N) a value of what the Nth argument names, and time an interval or an instant, which names nothing.

takes(holds(fluent, time)).
takes(holds_at(fluent, time)).
takes(occurs(event, time)).
takes(fluent(fluent, type(fluent))).
takes(fluentT(fluent, type(fluent))).
takes(event(event, type(event))).
takes(eventT(event, type(event))).
takes(argsOf(fact, ?)).
takes(objOf(fact, individual)).
takes(evidence(fact, time, evidence, value(3))).
takes(fact(run, ?, type(fact), individuals, ?, ?)).
takes(in(run, ?)).
takes(ongoing(fact)).
takes(near_miss(fact, time, ?)).
takes(instance_of(individual, class)).
takes(instance_of(individual, class, time)).
takes(has_part(individual, individual)).
takes(value(individual, property, value(2))).
takes(subclass_of(class, class)).
takes(unit(quantity, ?)).
takes(matching(?, ?, ?, type(fact), individual)).

%!  check_names(+Goal) is det.
%
%   Check what Goal, which the guard has let pass, and the goals in it name.
%
%   @error refused(unknown_name(Kind, Name)), refused(no_number(Property, Unit, Value)), refused(no_value(Relation))

check_names(Goal) :-
    forall(( named(Goal, Kind, Argument), nonvar(Argument) ),
           check_name(Kind, Argument)),
    forall(( compared(Goal, Variable, Term), once(( named(Goal, Kind, Named), Named == Variable )), what(Kind) ),
           check_name(Kind, Term)).

%   compared(+Goal, -Variable, -Term): in Goal it is asked whether Variable is Term, beside where it is named.

compared(Goal, Variable, Term) :-
    within(Goal, Inner),
    (   comparison(Inner, Variable, Term)
    ;   comparison(Inner, Term, Variable)
    ),
    var(Variable),
    nonvar(Term).

comparison(A = B, A, B).
comparison(A == B, A, B).
comparison(A \= B, A, B).
comparison(A \== B, A, B).

%!  what(+Kind) is semidet.
%
%   True of a Kind that is not an individual, which may be there in one run and not in another.

what(Kind) :-
    ( fact_kind(Kind) ; memberchk(Kind, [type(_), class, property, evidence, quantity]) ),
    !.

%!  named(+Goal, -Kind, -Argument) is nondet.
%
%   True if Argument in Goal, or in a goal in it, is what a Kind of thing is named by.

named(Goal, Kind, Argument) :-
    within(Goal, Inner),
    argument(Inner, Kind, Argument).

%!  within(+Goal, -Inner) is nondet.
%
%   True if Inner is Goal, or a goal in it.

within(Goal, _), var(Goal) => fail.
within(_/Lambda, Inner) => within(Lambda, Inner).
within(Parameters>>Body, Inner), is_list(Parameters) => within(Body, Inner).
within(_^Goal, Inner) => within(Goal, Inner).
within(Goal, Inner), callable(Goal) =>
    (   Inner = Goal
    ;   functor(Goal, Name, Arity),
        Arity > 0,
        functor(Calls, Name, Arity),
        may(Calls),
        arg(N, Calls, Way),
        arg(N, Goal, Argument),
        called(Way, Argument, Called),
        within(Called, Inner)
    ).
within(_, _) => fail.

argument(Goal, Kind, Argument) :-
    functor(Goal, Name, Arity),
    functor(Form, Name, Arity),
    takes(Form),
    arg(N, Form, Kind0),
    Kind0 \== (?),
    arg(N, Goal, Argument),
    (   Kind0 = value(M)
    ->  arg(M, Goal, Of),
        atom(Of),
        Kind = value(Of)
    ;   Kind = Kind0
    ).

called(^, Goal, Called) =>
    Called = Goal.
called(Extra, Closure, Called), integer(Extra) =>
    (   extended(Closure, Extra, Called)
    ->  true
    ;   Called = Closure
    ).
called(_, _, _) =>
    fail.

%   A closure is called with Extra more arguments.

extended(Closure, Extra, Called) :-
    callable(Closure),
    Extra > 0,
    Closure \= _/_,
    Closure \= _>>_,
    length(More, Extra),
    Closure =.. Plain,
    append(Plain, More, All),
    Called =.. All.

%!  check_found_nothing(+Goal) is failure.
%
%   Fail, once what Goal names is sure to be known.

check_found_nothing(Goal) :-
    forall(( argument(Goal, Kind, Argument), nonvar(Argument) ), check_name(Kind, Argument)),
    forall(argument(Goal, Kind, Argument), check_arity(Kind, Argument)),
    fail.

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

occurs_with(Kind, Name, Arity) :-
    of_kind(Kind, Known),
    known_run(_, Run),
    occurring(Run, Known, Name, Arity).

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
check_name(time, _) =>
    true.
check_name(individuals, List) =>
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

%   related(+Of): Of is what a fact tells, and no value.

related(Of) :-
    atom(Of),
    \+ allowed_value(Of, _),
    \+ stored_value(Of, _),
    (   property(Of, ''),
        fact_type(Of, 2, fluent)
    ;   known_run(_, Run),
        Run:named(relation, Of)
    ),
    !.

quantity(Of, Unit) :-
    property(Of, Unit),
    Unit \== '',
    !.
quantity(Of, Unit) :-
    known_run(_, Run),
    Run:unit(Of, Unit),
    !.

stored_value(Of, Value) :-
    known_run(_, Run),
    ( Run:value(_, Of, Value) ; Run:proof(_, Of, Value) ),
    !.

%!  fact_kind(?Kind) is nondet.

fact_kind(fluent).
fact_kind(event).
fact_kind(fact).

unknown(Kind, Term) :-
    throw(refused(unknown_name(Kind, Term))).

%   The arguments of a fact are individuals, numbers, or what a rule makes of them.

check_individuals(0, _) :- !.
check_individuals(N, Term) :-
    arg(N, Term, Argument),
    (   ( atom(Argument) ; string(Argument) )
    ->  check_name(individual, Argument)
    ;   true
    ),
    Rest is N-1,
    check_individuals(Rest, Term).

%   known_fact(+Kind, +Name, +Arity)

known_fact(Kind, Name, Arity) :-
    of_kind(Kind, Known),
    (   fact_type(Name, Arity, Known)
    ;   declared(Known, Name, Arity)
    ;   known_run(_, Run),
        occurring(Run, Known, Name, Arity)
    ),
    !.

of_kind(fact, Kind) => ( Kind = fluent ; Kind = event ).
of_kind(Kind, Known) => Known = Kind.

declared(event, Name, Arity) :-
    (   declared_event(Name, Arity)
    ;   chronicle_name(Name, Arity)
    ).
declared(Kind, Name, Arity) :-
    known_run(_, Run),
    Run:declared(Kind, Name, Arity).

occurring(Run, Kind, Name, Arity) :-
    Run:type(Name, Kind),
    table_row(Kind, Run, Name, _, _, Term, _, _, _),
    functor(Term, Name, Arity).

%   known(+Kind, +Name)

known(type(Kind), Name) :-
    of_kind(Kind, Known),
    (   type_name(Known, Name)
    ;   known_type_spelled(Known, Name)
    ),
    !.
known(individual, Name) :-
    known_run(_, Run),
    individual(Run, Name),
    !.
known(individual, Name) :-
    declared_name(Name),
    !.
known(value(Of), Value) :-
    ( allowed_value(Of, Value) ; stored_value(Of, Value) ),
    !.
known(class, Name) :-
    (   class(Name)
    ;   known_run(_, Run),
        class_of(Run, Name)
    ),
    !.
known(property, Name) :-
    (   property(Name, _)
    ;   known_run(_, Run),
        property_of(Run, Name)
    ),
    !.
known(quantity, Name) :-
    ( known(property, Name) ; known(evidence, Name) ),
    !.
known(evidence, Name) :-
    (   evidence_unit(Name, _)
    ;   known_run(_, Run),
        Run:proof(_, Name, _)
    ),
    !.
known(run, Name) :-
    known_run(Name, _),
    !.

type_name(Kind, Name) :- fact_type(Name, _, Kind).
type_name(Kind, Name) :- known_run(_, Run), Run:type(Name, Kind).
type_name(Kind, Name) :- declared(Kind, Name, _).

known_type_spelled(Kind, Name) :-
    type_name(Kind, Known),
    same_type(Name, Known).

class_of(Run, Name) :- Run:instance(_, Name).
class_of(Run, Name) :- Run:subclass(Name, _).
class_of(Run, Name) :- Run:subclass(_, Name).
class_of(Run, Name) :- Run:definition(Name, _, _).
class_of(Run, Name) :- Run:named(class, Name).

property_of(Run, Name) :- Run:value(_, Name, _).
property_of(Run, Name) :- Run:unit(Name, _).
property_of(Run, Name) :- Run:named(property, Name).
property_of(Run, Name) :- Run:named(relation, Name).

%   individual(+Run, ?Name)

individual(Run, Name) :- Run:instance(Name, _).
individual(Run, Name) :- Run:part(_, Name).
individual(Run, Name) :- Run:part(Name, _).
individual(Run, Name) :- Run:value(Name, _, _).
individual(Run, Name) :- table_row(_, Run, _, Name, _, _, _, _, _).
individual(Run, Name) :- table_row(_, Run, _, _, Name, _, _, _, _).
individual(Run, Name) :-
    Run:wide(Type),
    table_row(_, Run, Type, _, _, Term, _, _, _),
    compound(Term),
    arg(_, Term, Name).
individual(Run, Name) :- Run:proof(_, _, Name).

%!  declare_event(+Event) is det.
%
%   Event is what a rule may find; the names in it are known from then on.

declare_event(Event) :-
    functor(Event, Name, Arity),
    assertz(declared_event(Name, Arity)),
    forall(( compound(Event), arg(_, Event, Argument), atom(Argument) ),
           assertz(declared_name(Argument))).

%!  known_names(+Kind, -Names) is det.
%
%   The names of a kind, each once, or for facts Name/Arity, to tell the nearest of them; not more than are soon compared.

known_names(Kind, Names) :-
    findall(Name, candidate(Kind, Name), All),
    sort(All, Sorted),
    most_names(Most),
    length(Sorted, Count),
    (   Count =< Most
    ->  Names = Sorted
    ;   length(Names, Most),
        append(Names, _, Sorted)
    ).

most_names(20_000).

%!  candidate(+Kind, -Name) is nondet.
%
%   True if Name is known of Kind, for facts Name/Arity-Kind; some come more than once.

candidate(Kind, Candidate), fact_kind(Kind) =>
    Candidate = Name/Arity-Known,
    member(Known, [fluent, event]),
    (   fact_type(Name, Arity, Known)
    ;   declared(Known, Name, Arity)
    ;   known_run(_, Run),
        Run:type(Name, Known),
        once(( table_row(Known, Run, Name, _, _, Term, _, _, _), functor(Term, _, Arity) ))
    ).
candidate(occurring, Candidate) =>
    Candidate = Name/Arity-Kind,
    known_run(_, Run),
    Run:type(Name, Kind),
    table_row(Kind, Run, Name, _, _, Term, _, _, _),
    functor(Term, _, Arity).
candidate(type(Kind), Name) =>
    of_kind(Kind, Known),
    (   fact_type(Name, _, Known)
    ;   declared(Known, Name, _)
    ;   known_run(_, Run),
        Run:type(Name, Known)
    ).
candidate(individual, Name) =>
    (   declared_name(Name)
    ;   known_run(_, Run),
        individual(Run, Name),
        atom(Name)
    ).
candidate(value(Of), Value) =>
    allowed_value(Of, Value).
candidate(class, Name) =>
    ( class(Name) ; known_run(_, Run), class_of(Run, Name) ).
candidate(property, Name) =>
    ( property(Name, _) ; known_run(_, Run), property_of(Run, Name) ).
candidate(quantity, Name) =>
    ( candidate(property, Name) ; candidate(evidence, Name) ).
candidate(evidence, Name) =>
    ( evidence_unit(Name, _) ; known_run(_, Run), Run:proof(_, Name, _) ).
candidate(run, Name) =>
    known_run(Name, _).
