/*  Longer: whether an answer rests on where the log ended, by asking again as if what still went on then had gone on.

    A run has one that is like it, but for what goes on when the log ends: its fluents last far beyond that, and so do those
    of its events that are lengthened. What differs, once an event is lengthened, rests on the end of that event.
*/

:- module(longer, [ rests_on/5 ]).      % +Run, +Goal, :Asked, -Events, -How
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(time)).
:- use_module(positions).
:- use_module(runs).

:- meta_predicate rests_on(+, +, 2, -, -).

%   So many inferences and seconds: this is beside the answer. So many events are looked at one by one.

most_inferences(5_000_000).
most_seconds(0.5).
most_events(8).

%   What goes on is lengthened by so much [s].

beyond(1.0e6).

%!  rests_on(+Run, +Goal, :Asked, -Events:list, -How) is semidet.
%
%   Events are event(Id, Text, Start, End) of Run that went on when its log ended, on whose ends what call(Asked, Module,
%   Texts) finds in a run Module rests. How is shown, if all that differs is the end that is told, or other.

rests_on(Run, Goal, Asked, Events, How) :-
    reads_events(Goal),
    known_run(Run, Module),
    Module:lasts(Last),
    once(Module:proof(_, ends, 'with the log')),
    most_inferences(Inferences),
    most_seconds(Seconds),
    catch(call_with_time_limit(Seconds,
                               call_with_inference_limit(found(Module, Last, Asked, Ids, How), Inferences, Result)),
          _, fail),
    Result \== inference_limit_exceeded,
    findall(event(Id, Text, Start, Last),
            ( member(Id, Ids), Module:event(_, _, _, Term, Start, _, Id), format(string(Text), '~q', [Term]) ),
            Events).

reads_events(Goal) :-
    within(Goal, Inner),
    functor(Inner, Name, Arity),
    memberchk(Name/Arity, [ occurs/2, evidence/4, allen/3, after/2, before/2, meets/2, met_by/2, overlaps/2, overlapped_by/2,
                            starts/2, started_by/2, during/2, finishes/2, finished_by/2, equals/2 ]),
    !.

found(Module, Last, Asked, Ids, How) :-
    longer_run(Module, Longer),
    nb_setval(prolepsis_met, []),
    texts(Asked, Longer, none, Texts),
    nb_getval(prolepsis_met, Met0),
    Met0 \== [],
    texts(Asked, Longer, all, Others),
    Others \== Texts,
    nb_getval(prolepsis_met, Met1),
    sort(Met1, Met),
    most_events(Most),
    (   length(Met, Count),
        Count =< Most,
        include(matters(Asked, Longer, Texts), Met, Ids0),
        Ids0 \== []
    ->  Ids = Ids0
    ;   Ids = Met
    ),
    far(Last, Far),
    maplist(ending(Far, Last), Others, Shown0),
    sort(Shown0, Shown),
    sort(Texts, Sorted),
    ( Shown == Sorted -> How = shown ; How = other ).

matters(Asked, Longer, Texts, Id) :-
    texts(Asked, Longer, Id, Others),
    Others \== Texts.

texts(Asked, Longer, Which, Texts) :-
    nb_setval(prolepsis_longer, Which),
    call(Asked, Longer, Texts).

%   ending(+Far, +Last, +Text, -Told): Told is Text with Last where Far is told.

ending(Far, Last, Text, Told) :-
    format(string(Long), '~w', [Far]),
    format(string(Short), '~w', [Last]),
    atomic_list_concat(Parts, Long, Text),
    atomic_list_concat(Parts, Short, Told0),
    atom_string(Told0, Told).

far(Last, Far) :-
    beyond(Seconds),
    Far is Last+Seconds.

longer_run(Module, Longer) :-
    atom_concat('longer ', Module, Longer),
    (   current_predicate(Longer:event/7)
    ->  true
    ;   set_module(Longer:base(Module)),
        assertz((Longer:fluent(Type, A, B, Term, Start, End, Id) :-
                     longer:fluent(Module, Type, A, B, Term, Start, End, Id))),
        assertz((Longer:event(Type, A, B, Term, Start, End, Id) :-
                     longer:event(Module, Type, A, B, Term, Start, End, Id))),
        assertz((Longer:span(Start, End) :- longer:span(Module, Start, End)))
    ).

fluent(Module, Type, A, B, Term, Start, End, Id) :-
    Module:lasts(Last),
    Module:fluent(Type, A, B, Term, Start, End0, Id),
    ( End0 >= Last -> far(Last, End) ; End = End0 ).

event(Module, Type, A, B, Term, Start, End, Id) :-
    Module:lasts(Last),
    Module:event(Type, A, B, Term, Start, End0, Id),
    (   End0 >= Last
    ->  met(Id),
        nb_getval(prolepsis_longer, Which),
        ( ( Which == all ; Which == Id ) -> far(Last, End) ; End = End0 )
    ;   End = End0
    ).

span(Module, Start, End) :-
    Module:lasts(Last),
    Module:span(Start, End0),
    (   End = End0
    ;   End0 >= Last,
        far(Last, End)
    ).

met(Id) :-
    nb_getval(prolepsis_met, Met),
    (   memberchk(Id, Met)
    ->  true
    ;   nb_setval(prolepsis_met, [Id|Met])
    ).
