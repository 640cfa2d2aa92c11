/*  Runs: where the facts of each projection are kept, apart from those of every other.

    A run is a module of its own. Its facts are flat, one clause each, in the order of the timeline:

        fluent(Type, First, Second, Term, Start, End, Id)       event/7 alike
        proof(Id, Name, Value)      evidence behind a fact
        span(Start, End)            each distinct interval once, by start and end
        type(Type, Kind)            the types that occur
        near(Term, Start, End, Margin)   what nearly was so
        wide(Type)                  those with more than two arguments
        spelling(Float, Number)     how a whole number is written that is an argument: 10 or 10.0, as it first occurs
        symmetric(Type)             those whose two arguments are alike
        declared(Kind, Type, Arity) what else may occur, as far as Python has been told
        instance/2, part/2, value/3, unit/2       domain knowledge
        subclass/2, definition/3, subproperty/2, inverse/2, named/2      what is told of classes and properties
        touched/1, changing/1, belonging/4, becomes/2                    when individuals are of which classes

    First and Second repeat the first two arguments of Term ([] when there are fewer), so that the
    just-in-time index finds them. When a run is loaded, its facts become static.
*/

:- module(runs,
          [ load_run/2,                 % +Run, +File
            add_chronicles/3,           % +Run, +Source, :Finder
            finish_run/1,               % +Run
            drop_run/1,                 % +Run
            known_run/2,                % ?Run, -Module
            current_run/1,              % -Module
            with_run/2,                 % +Run, :Goal
            with_module/2,              % +Module, :Goal
            spelt/3,                    % +Module, +Number, -Kept
            spelt_term/3,               % +Module, +Term, -Kept
            equal_value/2,              % ?Value, +Kept
            row/6,                      % +Kind, ?Term, ?Start, ?End, ?Id, +Module
            table_row/9,                % +Kind, +Module, ?Type, ?First, ?Second, ?Term, ?Start, ?End, ?Id
            flat/4                      % +Term, -Type, -First, -Second
          ]).
:- use_module(library(error)).
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(chronicles).
:- use_module(classes, [work_out_classes/1]).
:- use_module(ticks).

:- meta_predicate with_run(+, 0), with_module(+, 0), add_chronicles(+, +, 4).
:- dynamic known_run/2.

% Tables of a run: those whose clauses come from the file, and those that follow from them.
table(fluent/7).
table(event/7).
table(proof/3).
table(span/2).
table(type/2).
table(wide/1).
table(tick/2).
table(lasts/1).
table(near/4).
table(spelling/2).
table(symmetric/1).
table(declared/3).
table(instance/2).
table(part/2).
table(value/3).
table(subclass/2).
table(definition/3).
table(subproperty/2).
table(inverse/2).
table(named/2).
table(touched/1).
table(changing/1).
table(belonging/4).
table(becomes/2).
table(unit/2).

%!  load_run(+Run:atom, +File) is det.
%
%   Read the facts of Run from File, replacing a run of that name, and work out our chronicles. Others may be added
%   until finish_run/1.

load_run(Run, File) :-
    must_be(atom, Run),
    drop_run(Run),
    atom_concat('run ', Run, Module),
    forall(table(Table), dynamic(Module:Table)),
    setup_call_cleanup(open(File, read, In, [encoding(utf8)]),
                       read_rows(In, Module, 0, _),
                       close(In)),
    index_spans(Module),
    work_out_classes(Module),
    assertz(known_run(Run, Module)),
    add_chronicles(Run, chronicles, all).

all(_, Goal, Template, Found) :-
    findall(Template, Goal, Found).

%!  finish_run(+Run) is det.
%
%   Make the facts of Run static: nothing changes them any more.

finish_run(Run) :-
    known_run(Run, Module),
    forall(( table(Table), make_head(Table, Head), \+ \+ clause(Module:Head, true) ),
           compile_predicates([Module:Table])).

make_head(Name/Arity, Head) :-
    functor(Head, Name, Arity).

read_rows(In, Module, Id0, Last) :-
    read_term(In, Row, []),
    (   Row == end_of_file
    ->  Last = Id0
    ;   add_row(Row, Module, Id0, Id),
        read_rows(In, Module, Id, Last)
    ).

add_row(fluent(Term0, Start, End), Module, Id0, Id) =>
    Id is Id0+1,
    kept_term(Module, Term0, Term),
    flat(Term, Type, First, Second),
    assertz(Module:fluent(Type, First, Second, Term, Start, End, Id)).
add_row(event(Term0, Start, End), Module, Id0, Id) =>
    Id is Id0+1,
    kept_term(Module, Term0, Term),
    flat(Term, Type, First, Second),
    assertz(Module:event(Type, First, Second, Term, Start, End, Id)).
add_row(proof(Name, Value), Module, Id0, Id) =>
    Id = Id0,
    % A level is told among the arguments.
    ( Name == level -> kept_term(Module, level(Value), _) ; true ),
    assertz(Module:proof(Id, Name, Value)).
add_row(near(Term0, Start, End, Margin), Module, Id0, Id) =>
    Id = Id0,
    kept_term(Module, Term0, Term),
    assertz(Module:near(Term, Start, End, Margin)).
add_row(type(Type, Kind, Arity), Module, Id0, Id) =>
    Id = Id0,
    add_type(Module, Type, Kind, Arity).
add_row(Row, Module, Id0, Id), callable(Row), functor(Row, Name, Arity), table(Name/Arity) =>
    Id = Id0,
    assertz(Module:Row).

%   kept_term(+Module, +Term0, -Term): Term0 as the run keeps it, with the spelling of the numbers that occur first.

kept_term(Module, Term0, Term) :-
    forall(( number_in(Term0, Number), whole(Number, Float), \+ Module:spelling(Float, _) ),
           assertz(Module:spelling(Float, Number))),
    spelt_term(Module, Term0, Term).

number_in(Term, Number) :-
    compound(Term),
    arg(_, Term, Argument),
    (   number(Argument)
    ->  Number = Argument
    ;   number_in(Argument, Number)
    ).

%   whole(+Number, -Float): a float tells Number, which is whole, from any other.

whole(Number, Float) :-
    abs(Number) < 9007199254740992,
    Number =:= truncate(Number),
    Float is float(Number).

%!  spelt(+Module, +Number, -Kept) is det.
%
%   Kept is the Number as the run of Module has it in its facts: 10 or 10.0.

spelt(Module, Number, Kept) :-
    (   whole(Number, Float),
        Module:spelling(Float, Kept0)
    ->  Kept = Kept0
    ;   Kept = Number
    ).

%!  spelt_term(+Module, +Term, -Kept) is det.
%
%   The same of a Term that is a number, or of all in it.

spelt_term(Module, Term, Kept), number(Term) => spelt(Module, Term, Kept).
spelt_term(Module, Term, Kept), compound(Term), once(number_in(Term, _)) =>
    compound_name_arguments(Term, Name, Arguments),
    maplist(spelt_term(Module), Arguments, Parts),
    compound_name_arguments(Kept, Name, Parts).
spelt_term(_, Term, Kept) =>
    Kept = Term.

%!  equal_value(?Value, +Kept) is semidet.
%
%   Value is Kept: of numbers, however they are written.

equal_value(Value, Kept), number(Value), number(Kept) => Value =:= Kept.
equal_value(Value, Kept) => Value = Kept.

%!  flat(+Term, -Type, -First, -Second) is det.

flat(Term, Type, First, Second) :-
    (   compound(Term)
    ->  Term =.. [Type, First|More],
        (   More = [Second|_]
        ->  true
        ;   Second = []
        )
    ;   Type = Term,
        First = [],
        Second = []
    ).

%   A type may have terms of several arities; it is listed once.

add_type(Module, Type, Kind, Arity) :-
    (   Module:type(Type, Kind)
    ->  true
    ;   assertz(Module:type(Type, Kind))
    ),
    (   ( Arity =< 2 ; Module:wide(Type) )
    ->  true
    ;   assertz(Module:wide(Type))
    ).

index_spans(Module) :-
    findall(S-E, ( Module:fluent(_,_,_,_,S,E,_) ; Module:event(_,_,_,_,S,E,_) ), Spans),
    sort(Spans, Distinct),
    retractall(Module:span(_,_)),
    forall(member(S-E, Distinct), assertz(Module:span(S,E))).

%!  add_chronicles(+Run, +Source, :Finder) is det.
%
%   Work out the chronicles of the module Source, each once, and keep them as events, so that every predicate finds
%   them. They see the grounded facts and the chronicles before them. Finder is called with an event, a goal, a template
%   and what it finds of that.

add_chronicles(Run, Source, Finder) :-
    known_run(Run, Module),
    findall(Name/Arity,
            ( clause(Source:chronicle(Event, _), _), functor(Event, Name, Arity) ),
            Names0),
    list_to_set(Names0, Names),
    aggregate_all(count, ( Module:fluent(_,_,_,_,_,_,_) ; Module:event(_,_,_,_,_,_,_) ), Last),
    with_run(Run, foldl_chronicles(Names, Source, Finder, Module, Last, End)),
    (   End > Last
    ->  index_spans(Module),
        sort_events(Module)
    ;   true
    ).

%   Events that were added stand where their time puts them.

sort_events(Module) :-
    findall(Row, table_clause(Module, event/7, Row), Rows0),
    sort(6, @=<, Rows0, Rows1),
    sort(5, @=<, Rows1, Rows),
    retractall(Module:event(_,_,_,_,_,_,_)),
    forall(member(Row, Rows), assertz(Module:Row)).

table_clause(Module, Table, Head) :-
    make_head(Table, Head),
    Module:Head.

foldl_chronicles([], _, _, _, Id, Id).
foldl_chronicles([Name/Arity|Names], Source, Finder, Module, Id0, Id) :-
    functor(Event, Name, Arity),
    call(Finder, Event, ( Source:chronicle(Event, S-E0), E is E0 ), occurrence(S, E, Event), Found0),
    maplist(at_ticks, Found0, Found),
    sort(Found, Distinct),
    (   Distinct == []
    ->  Id1 = Id0
    ;   add_type(Module, Name, event, Arity),
        assert_occurrences(Distinct, Module, Id0, Id1)
    ),
    foldl_chronicles(Names, Source, Finder, Module, Id1, Id).

at_ticks(occurrence(S0, E0, Event), occurrence(S, E, Event)) :-
    snapped_ends(S0, E0, S, E).

assert_occurrences([], _, Id, Id).
assert_occurrences([occurrence(S, E, Event)|More], Module, Id0, Id) :-
    Id1 is Id0+1,
    kept_term(Module, Event, Kept),
    flat(Kept, Type, First, Second),
    assertz(Module:event(Type, First, Second, Kept, S, E, Id1)),
    (   Module:lasts(Last),
        E >= Last
    ->  assertz(Module:proof(Id1, ends, 'with the log'))
    ;   true
    ),
    assert_occurrences(More, Module, Id1, Id).

%!  drop_run(+Run) is det.
%
%   Forget Run and free its memory; a run that is not known is none to forget.

drop_run(Run) :-
    (   retract(known_run(Run, Module))
    ->  forall(table(Table), catch(abolish(Module:Table), error(_, _), true))
    ;   true
    ).

%!  current_run(-Module) is det.

current_run(Module) :-
    b_getval(prolepsis_run, Module).

%!  with_run(?Run, :Goal) is nondet.
%
%   True if Goal is true in Run. The assignment is undone on backtracking, and outside Goal.

with_run(Run, Goal) :-
    known_run(Run, Module),
    with_module(Module, Goal).

%!  with_module(+Module, :Goal) is nondet.

with_module(Module, Goal) :-
    (   nb_current(prolepsis_run, Before)
    ->  true
    ;   Before = none
    ),
    b_setval(prolepsis_run, Module),
    call(Goal),
    b_setval(prolepsis_run, Before).

%!  row(+Kind, ?Term, ?Start, ?End, ?Id, +Module) is nondet.
%
%   True if Term is a fact of Kind over Start-End, in the order of the timeline. Of a symmetric type the two arguments
%   may stand in either order, once one of them is known; else each fact comes once, as it is stored.

row(Kind, Term, Start, End, Id, Module), var(Term) =>
    table_row(Kind, Module, _, _, _, Term, Start, End, Id).
row(Kind, Term, Start, End, Id, Module), swapped(Term, Module, Swapped) =>
    findall(at(Start, End, Id, Term),
            (   stored(Kind, Term, Start, End, Id, Module)
            ;   stored(Kind, Swapped, Start, End, Id, Module)
            ),
            Found0),
    sort(Found0, Found),
    member(at(Start, End, Id, Term), Found).
row(Kind, Term, Start, End, Id, Module) =>
    spelt_term(Module, Term, Kept),
    stored(Kind, Kept, Start, End, Id, Module).

stored(Kind, Term, Start, End, Id, Module) :-
    flat(Term, Type, First, Second),
    table_row(Kind, Module, Type, First, Second, Term, Start, End, Id).

swapped(Term, Module, Swapped) :-
    compound(Term),
    compound_name_arguments(Term, Type, [A, B]),
    ( nonvar(A) ; nonvar(B) ),
    !,
    Module:symmetric(Type),
    compound_name_arguments(Swapped, Type, [B, A]).

table_row(fluent, Module, Type, First, Second, Term, Start, End, Id) :-
    Module:fluent(Type, First, Second, Term, Start, End, Id).
table_row(event, Module, Type, First, Second, Term, Start, End, Id) :-
    Module:event(Type, First, Second, Term, Start, End, Id).
