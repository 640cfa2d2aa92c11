/*  Open ends: what still went on when the log ended, and so might have changed an answer had the log been longer. */

:- module(open_ends,
          [ ongoing/1,                  % ?FluentOrEvent
            open_ends/4,                % +Run, +Goal, +Events, -Fields
            open_fields/2               % +Events, -Fields
          ]).
:- use_module(library(lists)).
:- use_module(library(occurs)).
:- use_module(runs).
:- use_module(timeline).

%!  ongoing(?Term) is nondet.
%
%   True if the fluent or event Term still held or occurred when the log ended.

ongoing(Term) :-
    current_run(Run),
    Run:lasts(Last),
    member(Kind, [fluent, event]),
    row(Kind, Term, _, End, _, Run),
    End >= Last.

%!  open_ends(+Run, +Goal, +Events, -Fields:list) is det.
%
%   Fields are text, start and end of each of Events, event(Id, Text, Start, End), and of each event on which Goal bears and
%   that went on when the log of Run ended: one that it names, or one of all the things that it names.

open_ends(Run, Goal, Events, Fields) :-
    with_run(Run, findall(event(Id, Text, Start, End), open_end(Goal, Id, Text, Start, End), Bearing)),
    union(Events, Bearing, All0),
    sort(All0, All),
    open_fields(All, Fields).

%!  open_fields(+Events, -Fields:list) is det.

open_fields(Events, Fields) :-
    findall([Text, Start, End], member(event(_, Text, Start, End), Events), Rows),
    append(Rows, Fields).

open_end(Goal, Id, Text, Start, End) :-
    current_run(Run),
    Run:lasts(_),
    once(Run:proof(_, ends, 'with the log')),
    names(Goal, Names),
    findall(Name, ( member(Name, Names), thing(Name, Run) ), Things),
    Run:proof(Id, ends, 'with the log'),
    row(event, Event, Start, End, Id, Run),
    bears_on(Goal, Names, Things, Event),
    format(string(Text), '~q', [Event]).

names(Goal, Names) :-
    findall(Name,
            ( sub_term(Part, Goal),
              nonvar(Part),
              ( compound(Part) -> compound_name_arity(Part, Name, _) ; Name = Part ),
              atom(Name) ),
            All),
    sort(All, Names).

thing(Name, Run) :-
    (   Run:instance(Name, _)
    ;   table_row(_, Run, _, Name, _, _, _, _, _)
    ;   table_row(_, Run, _, _, Name, _, _, _, _)
    ),
    !.

bears_on(Goal, Names, Things, Event) :-
    Event =.. [Type|Arguments],
    (   subset(Things, Arguments),
        ( Things \== [] ; named(Names, Type) )
    ;   sub_term(Pattern, Goal),
        nonvar(Pattern),
        Pattern \== Type,
        \+ Pattern \= Event
    ),
    !.

named(Names, Type) :-
    member(Name, Names),
    same_type(Name, Type),
    !.
