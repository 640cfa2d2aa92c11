/*  The same tick: of two things that begin at once neither is after the other, though one may have brought the other about. */

:- module(same_tick, [ same_tick/3 ]).  % +Run, +Goal, -Name
:- use_module(library(lists)).
:- use_module(library(time)).
:- use_module(order).
:- use_module(query).
:- use_module(runs).

%   In so many inferences and seconds: this is beside the answer.

most_inferences(2_000_000).
most_seconds(0.5).

%!  same_tick(+Run, +Goal, -Name) is semidet.
%
%   True if Goal, which is not so in Run, would be if Name, which is after or before, were true of what begins in the same
%   tick.

same_tick(Run, Goal, Name) :-
    most_inferences(Inferences),
    most_seconds(Seconds),
    findall(Found-Other, begun_together(Goal, Found, Other), All),
    catch(call_with_time_limit(Seconds, call_with_inference_limit(first_so(All, Run, Name), Inferences, Result)), _, fail),
    Result \== inference_limit_exceeded.

first_so(All, Run, Name) :-
    member(Name-Goal, All),
    order_goal(Goal, Ordered),
    with_run(Run, query:Ordered),
    !.

%   begun_together(+Goal, -Name, -Other): Other asks of two intervals of Goal that they begin at once, and is Goal else.

begun_together(Goal, _, _), var(Goal) => fail.
begun_together((A, B), Name, Other) =>
    (   Other = (C, B),
        begun_together(A, Name, C)
    ;   Other = (A, C),
        begun_together(B, Name, C)
    ).
begun_together(Goal, Name, Other), compound(Goal), Goal =.. [Name0, I, J], memberchk(Name0, [after, before]) =>
    Name = Name0,
    Other = allen(Relation, I, J),
    member(Relation, [starts, started_by, equals]).
begun_together(_, _, _) => fail.
