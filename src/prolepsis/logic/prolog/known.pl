/*  Known: what a goal may name is the vocabulary, what is declared in Python or by a rule of a user's, and whatever occurs
    in a run of this session or in what is known of its individuals.
*/

:- module(known,
          [ known_fact/3,               % +Kind, +Name, +Arity
            occurs_with/3,              % +Kind, +Name, ?Arity
            known/2,                    % +Kind, +Name
            related/1,                  % +Name
            quantity/2,                 % +Name, -Unit
            stored_value/2,             % +Name, ?Value
            stored_value_of/2,          % +Name, ?Value
            known_names/2,              % +Kind, -Names
            candidate/2,                % +Kind, -Name
            fact_kind/1,                % ?Kind
            made_by_rule/2,             % ?Name, ?Arity
            declare_event/1             % +Event
          ]).
:- use_module(library(lists)).
:- use_module(chronicles).
:- use_module(runs).
:- use_module(timeline, [same_type/2]).
:- use_module(vocabulary).

:- dynamic declared_event/2, declared_name/1.

%!  fact_kind(?Kind) is nondet.

fact_kind(fluent).
fact_kind(event).
fact_kind(fact).

%!  known_fact(+Kind, +Name, +Arity) is semidet.

known_fact(Kind, Name, Arity) :-
    of_kind(Kind, Known),
    (   fact_type(Name, Arity, Known)
    ;   declared(Known, Name, Arity)
    ;   known_run(_, Run),
        occurring(Run, Known, Name, Arity)
    ),
    !.

%!  occurs_with(+Kind, +Name, ?Arity) is nondet.

occurs_with(Kind, Name, Arity) :-
    of_kind(Kind, Known),
    known_run(_, Run),
    occurring(Run, Known, Name, Arity).

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

%!  known(+Kind, +Name) is semidet.
%
%   True if Name is that of a Kind; of name(Kind) it is the name of a fact's term, of type(Kind) that in either spelling.

known(type(Kind), Name) :-
    of_kind(Kind, Known),
    (   type_name(Known, Name)
    ;   known_type_spelled(Known, Name)
    ),
    !.
known(name(Kind), Name) :-
    of_kind(Kind, Known),
    type_name(Known, Name),
    !.
known(unit, Name) :-
    ( property(_, Name) ; evidence_unit(_, Name) ; known_run(_, Run), Run:unit(_, Name) ),
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

%!  related(+Of) is semidet.
%
%   True if Of is what a fact tells, and no value.

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

%!  quantity(+Of, -Unit) is semidet.

quantity(Of, Unit) :-
    property(Of, Unit),
    Unit \== '',
    !.
quantity(Of, Unit) :-
    known_run(_, Run),
    Run:unit(Of, Unit),
    !.

%!  stored_value(+Of, ?Value) is semidet.

stored_value(Of, Value) :-
    stored_value_of(Of, Value),
    !.

%!  stored_value_of(+Name, ?Value) is nondet.

stored_value_of(Of, Value) :-
    known_run(_, Run),
    ( Run:value(_, Of, Value) ; Run:proof(_, Of, Value) ).

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

%!  made_by_rule(?Name, ?Arity) is nondet.
%
%   True if an event of that Name is what a rule of a user's finds: its arguments may be any terms.

made_by_rule(Name, Arity) :-
    declared_event(Name, Arity).

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
candidate(name(Kind), Name) =>
    candidate(type(Kind), Name).
candidate(unit, Name) =>
    ( property(_, Name) ; evidence_unit(_, Name) ; known_run(_, Run), Run:unit(_, Name) ),
    Name \== ''.
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
