/*  Another time: a "no" to what is so, but over another interval than the goal asks for. */

:- module(another_time, [ another_time/4 ]).    % +Run, +Goal, +Inferences, -Fields
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(time)).
:- use_module(order).
:- use_module(query).
:- use_module(runs).

most_seconds(0.5).
most_facts(4).

%!  another_time(+Run, +Goal, +Inferences, -Fields:list) is det.
%
%   Fields tell in threes what is so, and how, where Goal is not so in Run: `shared` if two facts are asked to have the very
%   same interval, `whole` if one is asked for a part of its interval or for more than that, `last` if for the end of the
%   log, which no interval contains. They are empty where Goal would not be so either, or that takes more Inferences.

another_time(Run, Goal, Inferences, Fields) :-
    known_run(Run, Module),
    Module:lasts(Last),
    loosened(Goal, Last, [], Times, Loose),
    include(changed, Times, [_|_]),
    order_goal(Loose, Ordered),
    most_seconds(Seconds),
    catch(call_with_time_limit(Seconds, call_with_inference_limit(so(Run, Ordered), Inferences, Result)), _, fail),
    Result \== inference_limit_exceeded,
    !,
    findall([Text, How, ''], told(Times, How, Text), Told),
    append(Told, Fields).
another_time(_, _, _, []).

so(Run, Goal) :-
    with_run(Run, query:Goal),
    !.

%   loosened(+Goal, +Last, +Times0, -Times, -Loose): Loose is Goal where what it asks the time of may be so at another one.
%   Times are time(Fact, Asked, Interval, How), in reverse, of each; how is `asked` of what stays as it is.

loosened(Goal, _, Times0, Times, Loose), var(Goal) => Times = Times0, Loose = Goal.
loosened((A, B), Last, Times0, Times, Loose) =>
    Loose = (C, D),
    loosened(A, Last, Times0, Times1, C),
    loosened(B, Last, Times1, Times, D).
loosened(Goal, Last, Times0, Times, Loose), timed(Goal, Fact, Asked, Interval, Timed) =>
    (   member(time(Same, Other, Interval0, _), Times0),
        Same-Other == Fact-Asked
    ->  Times = Times0,
        Interval = Interval0,
        Loose = Timed
    ;   another(Asked, Last, Times0, Interval, Condition, How)
    ->  Times = [time(Fact, Asked, Interval, How)|Times0],
        Loose = (Timed, Condition)
    ;   Times = [time(Fact, Asked, Asked, asked)|Times0],
        Interval = Asked,
        Loose = Goal
    ).
loosened(Goal, _, Times0, Times, Loose) => Times = Times0, Loose = Goal.

%   timed(+Goal, -Fact, -Asked, -Interval, -Timed): Goal asks for Fact at the time Asked, and Timed over Interval.

timed(holds(Fact, Asked), Fact, Asked, Interval, holds(Fact, Interval)).
timed(holds_at(Fact, Asked), Fact, Asked, Interval, holds(Fact, Interval)).
timed(occurs(Fact, Asked), Fact, Asked, Interval, occurs(Fact, Interval)).
timed(evidence(Fact, Asked, Name, Value), Fact, Asked, Interval, evidence(Fact, Interval, Name, Value)).
timed(instance_of(Thing, Class, Asked), instance_of(Thing, Class), Asked, Interval, instance_of(Thing, Class, Interval)).

another(Asked, Last, _, Interval, Condition, How), number(Asked) =>
    Asked =:= Last,
    Interval = _-End,
    Condition = (End =:= Asked),
    How = last.
another(Asked, _, Times, _, Condition, How), shared(Asked, Times) =>
    Condition = true,
    How = shared.
another(From-To, Last, _, Interval, Condition, How), ( number(From) ; number(To) ) =>
    \+ ( number(From), From < 0 ),
    \+ ( number(To), To > Last ),
    Interval = Start-End,
    Condition = ( Before, After ),
    ( number(To) -> Before = (Start < To) ; To = End, Before = (Start =< From) ),
    ( number(From) -> After = (From < End) ; From = Start, After = (To =< End) ),
    How = whole.
another(_, _, _, _, _, _) => fail.

%   An interval of which nothing is known but that another fact has it.

shared(Asked, Times) :-
    ( var(Asked) ; nonvar(Asked), Asked = Start-End, var(Start), var(End) ),
    member(time(_, Other, _, _), Times),
    Other == Asked,
    !.

changed(time(_, _, _, How)) :- How \== asked.

told(Times0, How, Text) :-
    reverse(Times0, Times),
    member(How, [shared, whole, last]),
    memberchk(time(_, _, _, How), Times),
    findall(Each, ( member(time(Fact, Asked, Interval, Its), Times),
                    ( Its == How ; How == shared, Its == asked, is_shared(Asked, Times) ),
                    over(Fact, Interval, Each) ),
            All),
    most_facts(Most),
    ( length(Few, Most), append(Few, [_|_], All) -> true ; Few = All ),
    atomic_list_concat(Few, ', ', Text).

is_shared(Asked, Times) :-
    member(time(_, Other, _, shared), Times),
    Other == Asked,
    !.

over(Fact, Interval, Text) :-
    copy_term(Fact-Interval, Copy, _),
    numbervars(Copy, 0, _),
    Copy = Shown-Over,
    format(string(Text), '~W over ~W', [Shown, [quoted(true), numbervars(true), max_depth(10)], Over, [numbervars(true)]]).
