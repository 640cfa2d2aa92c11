/*  The timeline: which fluents held and which events occurred, with the paper's predicates.

    Fluents and events are terms, contacts(hand1, egg1); an interval is Start-End, right-open, in
    seconds; a number for an interval means "at that instant". All read the current run.
*/

:- module(timeline,
          [ holds/2,                    % ?Fluent, ?Interval
            holds_at/2,                 % ?Fluent, +Instant
            occurs/2,                   % ?Event, ?Interval
            fluent/2,                   % ?Fluent, ?Type
            fluentT/2,                  % ?Fluent, ?Type
            event/2,                    % ?Event, ?Type
            eventT/2,                   % ?Event, ?Type
            argsOf/2,                   % ?FluentOrEvent, ?Arguments
            objOf/2,                    % ?FluentOrEvent, ?Object
            evidence/4,                 % ?FluentOrEvent, ?Interval, ?Name, ?Value
            fact/6,                     % ?Run, ?Id, ?Type, ?Arguments, ?Start, ?End
            in/2,                       % ?Run, :Goal
            matching/5,                 % +Kind, ?Term, ?Interval, ?Type, ?Object
            args_of/3,                  % ?Term, ?Interval, ?Arguments
            same_type/2,                % +Type, +Type
            interval/3                  % ?Interval, -Start, -End
          ]).
:- use_module(library(error)).
:- use_module(library(lists)).
:- use_module(runs).
:- use_module(ticks).

:- meta_predicate in(?, 0).

%!  holds(?Fluent, ?Interval) is nondet.
%
%   True if Fluent holds over Interval, or at the instant Interval if that is a number. What the
%   situation asserts is a fluent, too, which ends when the log shows otherwise.

holds(Fluent, Time) :-
    matching(fluent, Fluent, Time, _, _).

%!  holds_at(?Fluent, +Instant:number) is nondet.

holds_at(Fluent, Instant) :-
    must_be(number, Instant),
    must_be_instant(Instant),
    holds(Fluent, Instant).

%!  occurs(?Event, ?Interval) is nondet.
%
%   True if Event occurs over Interval. Chronicles are events, too.

occurs(Event, Time) :-
    matching(event, Event, Time, _, _).

%!  matching(+Kind, ?Term, ?Interval, ?Type, ?Object) is nondet.
%
%   True if Term of Kind holds or occurs over Interval; given a Type, only those of that type, and
%   given an Object, only those with that argument. This is what holds/2 and occurs/2 come down to.

matching(Kind, Term, Time, Type, Object) :-
    current_run(Run),
    found(Time, Kind, Term, Type, Object, Run).

found(Instant, Kind, Term, Type, Object, Run), number(Instant) =>
    must_be_time(Instant),
    snapped(Run, Instant, Time),
    narrowed(Term, Type, Object, Kind, Run, Start, End, _),
    Start =< Time,
    Time < End.
found(Time, Kind, Term, _, _, Run), var(Time), nonvar(Term) =>
    Time = Start-End,
    row(Kind, Term, Start, End, _, Run).
found(Time, Kind, Term, Type, Object, Run) =>
    must_be_time(Time),
    Time = Start-End,
    snapped(Run, Start, S),
    snapped(Run, End, E),
    narrowed(Term, Type, Object, Kind, Run, S, E, _).

narrowed(Term, Type, Object, Kind, Run, S, E, Id), var(Term), atom(Object) =>
    ids_with(Object, Kind, Run, Ids),
    member(Id, Ids),
    row(Kind, Term, S, E, Id, Run),
    (   var(Type)
    ->  true
    ;   type_of(Term, Type)
    ).
narrowed(Term, Type, _, Kind, Run, S, E, Id), var(Term), atom(Type) =>
    Run:type(Name, Kind),
    same_type(Type, Name),
    table_row(Kind, Run, Name, _, _, Term, S, E, Id).
narrowed(Term, _, _, Kind, Run, S, E, Id) =>
    row(Kind, Term, S, E, Id, Run).

%   In the order of the timeline.

ids_with(Object, Kind, Run, Ids) :-
    findall(at(S, E, Id),
            (   table_row(Kind, Run, _, Object, _, _, S, E, Id)
            ;   table_row(Kind, Run, _, _, Object, _, S, E, Id)
            ;   Run:type(Type, Kind),
                Run:wide(Type),
                table_row(Kind, Run, Type, _, _, Term, S, E, Id),
                compound(Term),
                Term =.. [_, _, _|More],
                memberchk(Object, More)
            ), All),
    sort(All, Sorted),
    findall(Id, member(at(_, _, Id), Sorted), Ids).

%!  fluentT(?Fluent, ?Type) is nondet.
%!  fluent(?Fluent, ?Type) is nondet.
%!  eventT(?Event, ?Type) is nondet.
%!  event(?Event, ?Type) is nondet.
%
%   True if Type is the type of Fluent or Event. Type may be given in either spelling, ClosingGripper
%   or closingGripper; when unbound it is the name of the term.

fluentT(Fluent, Type) :-
    typed(fluent, Fluent, Type).
fluent(Fluent, Type) :-
    typed(fluent, Fluent, Type).
eventT(Event, Type) :-
    typed(event, Event, Type).
event(Event, Type) :-
    typed(event, Event, Type).

typed(Kind, Term, Type), var(Term) =>
    current_run(Run),
    distinct_terms(Kind, Run, Type, Terms),
    member(Term, Terms),
    type_of(Term, Type).
typed(Kind, Term, Type), callable(Term) =>
    current_run(Run),
    functor(Term, Name, _),
    once(Run:type(Name, Kind)),
    type_of(Term, Type).
typed(_, _, _) =>
    fail.

distinct_terms(Kind, Run, Type, Terms) :-
    findall(Term, narrowed(Term, Type, _, Kind, Run, _, _, _), All),
    list_to_set(All, Terms).

type_of(Term, Type) :-
    functor(Term, Name, _),
    (   var(Type)
    ->  Type = Name
    ;   atom(Type),
        same_type(Type, Name)
    ).

%!  same_type(+Type, +Other) is semidet.
%
%   True of two spellings of one type.

same_type(Name, Name) :- !.
same_type(Type, Name) :-
    spelling(Type, Common),
    spelling(Name, Common).

% ClosingGripper, closingGripper and closing_gripper are one type.
spelling(Name, Common) :-
    atomic_list_concat(Words, '_', Name),
    Words = [First|Rest],
    lower_first(First, Lower),
    maplist(upper_first, Rest, Upper),
    atomic_list_concat([Lower|Upper], Common).

lower_first(Word, Lower) :-
    sub_atom(Word, 0, 1, _, Initial),
    !,
    sub_atom(Word, 1, _, 0, Rest),
    downcase_atom(Initial, Small),
    atom_concat(Small, Rest, Lower).
lower_first(Word, Word).

upper_first(Word, Upper) :-
    sub_atom(Word, 0, 1, _, Initial),
    !,
    sub_atom(Word, 1, _, 0, Rest),
    upcase_atom(Initial, Capital),
    atom_concat(Capital, Rest, Upper).
upper_first(Word, Word).

%!  argsOf(?Term, ?Arguments:list) is nondet.
%
%   True if Arguments are the arguments of a fluent or event. When an instance has a commanded level,
%   it is the last argument: [rightGripper, force7]; a list of fixed length without it matches too.

argsOf(Term, Arguments) :-
    args_of(Term, _, Arguments).

%!  args_of(?Term, ?Interval, ?Arguments:list) is nondet.
%
%   As argsOf/2, of the instance of Term over Interval.

args_of(Term, Time, Arguments), var(Term) =>
    current_run(Run),
    member(Kind, [fluent, event]),
    distinct_terms(Kind, Run, _, Terms),
    member(Term, Terms),
    args_of(Term, Time, Arguments).
args_of(Term, _, _), \+ callable(Term) =>
    fail.
args_of(Term0, Time, Arguments0) =>
    current_run(Run),
    spelt_term(Run, Term0, Term),
    spelt_term(Run, Arguments0, Arguments),
    plain_args(Term, Plain),
    levels(Term, Time, Run, Levels),
    (   member(Level, Levels),
        append(Plain, [Level], Arguments)
    ;   (   Levels == []
        ;   is_list(Arguments)
        ),
        Arguments = Plain
    ).

plain_args(Term, Arguments) :-
    (   compound(Term)
    ->  compound_name_arguments(Term, _, Arguments)
    ;   Arguments = []
    ).

levels(Term, Time, Run, Levels) :-
    findall(Level,
            ( instance(Term, Time, Run, Id), Run:proof(Id, level, Level0), spelt_term(Run, Level0, Level) ),
            All),
    list_to_set(All, Levels).

instance(Term, Time, Run, Id) :-
    member(Kind, [fluent, event]),
    row_at(Time, Kind, Term, Id, Run).

%   row_at(?Time, +Kind, ?Term, ?Id, +Run): Term is a fact over the interval Time, or one that lasts at that instant.

row_at(Instant, Kind, Term, Id, Run), number(Instant) =>
    must_be_time(Instant),
    snapped(Run, Instant, Time),
    row(Kind, Term, Start, End, Id, Run),
    Start =< Time,
    Time < End.
row_at(Time, Kind, Term, Id, Run) =>
    must_be_time(Time),
    Time = Start-End,
    snapped(Run, Start, S),
    snapped(Run, End, E),
    row(Kind, Term, S, E, Id, Run).

%!  objOf(?Term, ?Object:atom) is nondet.
%
%   True if Object is one of the arguments of a fluent or event.

objOf(Term, Object), var(Term) =>
    current_run(Run),
    member(Kind, [fluent, event]),
    findall(T, narrowed(T, _, Object, Kind, Run, _, _, _), All),
    list_to_set(All, Terms),
    member(Term, Terms),
    objOf(Term, Object).
objOf(Term, Object), compound(Term) =>
    compound_name_arguments(Term, _, Arguments),
    list_to_set(Arguments, Objects),
    member(Object, Objects),
    atom(Object).
objOf(_, _) =>
    fail.

%!  evidence(?Term, ?Interval, ?Name:atom, ?Value) is nondet.
%
%   True if Value was measured under Name for the instance of Term over Interval.

evidence(Term, Time, Name, Value) :-
    current_run(Run),
    (   var(Term)
    ->  Run:proof(Id, Name, Known),
        equal_value(Value, Known),
        member(Kind, [fluent, event]),
        row_at(Time, Kind, Term, Id, Run)
    ;   instance(Term, Time, Run, Id),
        Run:proof(Id, Name, Known),
        equal_value(Value, Known)
    ).


%!  fact(?Run, ?Id, ?Type, ?Arguments, ?Start, ?End) is nondet.
%
%   The facts as they are stored, of any run.

fact(Name, Id, Type, Arguments0, Start, End) :-
    known_run(Name, Run),
    spelt_term(Run, Arguments0, Arguments),
    snapped(Run, Start, S),
    snapped(Run, End, E),
    member(Kind, [fluent, event]),
    table_row(Kind, Run, Type, _, _, Term, S, E, Id),
    plain_args(Term, Arguments).

%!  in(?Run, :Goal) is nondet.
%
%   True if Goal is true in Run.

in(Run, Goal) :-
    with_run(Run, Goal).

%!  interval(?Interval, -Start, -End) is nondet.
%
%   True if Interval is a ground, non-empty interval, or one of the timeline's, each once; from the tick at Start to
%   that at End.

interval(Interval, Start, End), ground(Interval) =>
    (   Interval = S-E, number(S), number(E), S < E
    ->  snapped_ends(S, E, Start, End)
    ;   throw(error(type_error(interval, Interval), _))
    ).
interval(Interval, Start, End) =>
    (   Interval = S-E
    ->  current_run(Run),
        snapped(Run, S, Start),
        snapped(Run, E, End),
        Run:span(Start, End)
    ;   throw(error(type_error(interval, Interval), _))
    ).
