/*  Order: a goal is answered in an order that is quick and gives the same answers.

    Two things are done, and only among neighbouring goals that read the timeline, which neither fail to
    terminate nor raise errors on unbound arguments, so that their order does not change what is true:

      * a relation between intervals waits until a later holds/2 or occurs/2 has given it its interval,
        instead of trying each interval of the timeline;
      * holds(F, T) with F unbound looks only among the facts of the type and the object that the goals
        after it demand of F.

    Also argsOf(E, Args) after occurs(E, T) is asked of that instance, whose level may differ from that of
    another occurrence of the same event. What a goal computes is computed in decimals.
*/

:- module(order, [ order_goal/2 ]).     % +Goal, -Ordered
:- use_module(library(lists)).
:- use_module(library(apply)).
:- use_module(decimals).

%!  order_goal(+Goal, -Ordered) is det.

order_goal(Goal, Ordered) :-
    order_goal(Goal, [], Ordered0),
    in_decimals(Ordered0, Ordered).

%   Before is what was called earlier in the conjunctions around Goal.

order_goal(Goal, _, Ordered), var(Goal) => Ordered = Goal.
order_goal((A, B), Before, Ordered) =>
    conjuncts((A, B), Goals0),
    inner(Goals0, Before, Goals1),
    postpone(Goals1, Before, Goals2),
    refine(Goals2, Before, Goals),
    conjunction(Goals, Ordered).
order_goal(Goal, Before, Ordered), controls(Goal) =>
    Goal =.. [Name|Parts],
    ordered_parts(Parts, Before, Ordereds),
    Ordered =.. [Name|Ordereds].
order_goal(findall(T, Goal, L), Before, Ordered) =>
    order_goal(Goal, Before, Inner),
    Ordered = findall(T, Inner, L).
order_goal(aggregate_all(T, Goal, R), Before, Ordered) =>
    order_goal(Goal, Before, Inner),
    Ordered = aggregate_all(T, Inner, R).
order_goal(in(Run, Goal), _, Ordered) =>
    order_goal(Goal, [], Inner),
    Ordered = in(Run, Inner).
order_goal(Goal, Before, Ordered) =>
    refine([Goal], Before, [Ordered]).

controls((_;_)).
controls((_->_)).
controls((_*->_)).
controls(\+ _).
controls(forall(_, _)).
controls(once(_)).

ordered_parts([], _, []).
ordered_parts([Part|Parts], Before, [Ordered|Ordereds]) :-
    order_goal(Part, Before, Ordered),
    ordered_parts(Parts, [Part|Before], Ordereds).

conjuncts(Goal, Goals) :-
    (   nonvar(Goal),
        Goal = (A, B)
    ->  conjuncts(A, As),
        conjuncts(B, Bs),
        append(As, Bs, Goals)
    ;   Goals = [Goal]
    ).

conjunction([Goal], Goal) :- !.
conjunction([Goal|Goals], (Goal, Rest)) :-
    conjunction(Goals, Rest).

inner([], _, []).
inner([Goal|Goals], Before, [Ordered|Ordereds]) :-
    (   reads_timeline(Goal)
    ->  Ordered = Goal
    ;   order_goal(Goal, Before, Ordered)
    ),
    inner(Goals, [Goal|Before], Ordereds).

%   postpone(+Goals, +Before, -Ordered): let relations wait for their intervals.

postpone([], _, []).
postpone([Goal|Goals], Before, Ordered) :-
    (   relation(Goal, Intervals),
        include(unbound_in(Before), Intervals, Waiting),
        Waiting \== [],
        passed(Waiting, Goals, Passed, Rest),
        \+ Passed == []
    ->  append(Passed, [Goal|Rest], Moved),
        postpone_rest(Moved, Before, Ordered)
    ;   Ordered = [Goal|More],
        postpone(Goals, [Goal|Before], More)
    ).

postpone_rest([Goal|Goals], Before, [Goal|More]) :-
    postpone(Goals, [Goal|Before], More).

unbound_in(Before, Interval) :-
    var(Interval),
    term_variables(Before, Bound),
    \+ ( member(Variable, Bound), Variable == Interval ).

%   The goals up to the last that gives an interval waited for; [] if none can be reached.

passed(Waiting, Goals, Passed, Rest) :-
    findall(N, gives_at(Waiting, Goals, N), Places),
    (   max_list(Places, Last)
    ->  length(Passed, Last),
        append(Passed, Rest, Goals)
    ;   Passed = [],
        Rest = Goals
    ).

gives_at(Waiting, Goals, N) :-
    append(Earlier, [Goal|_], Goals),
    reads_all(Earlier),
    reads_timeline(Goal),
    generates(Goal, Interval),
    member(Variable, Waiting),
    Variable == Interval,
    \+ ( member(Before, Earlier), generates(Before, Other), Other == Variable ),
    length(Earlier, Before0),
    N is Before0+1.

reads_all([]).
reads_all([Goal|Goals]) :-
    reads_timeline(Goal),
    reads_all(Goals).

generates(holds(_, Interval), Interval).
generates(occurs(_, Interval), Interval).
generates(instance_of(_, _, Interval), Interval).

relation(Goal, [I, J]) :-
    (   Goal = allen(Relation, I, J)
    ->  atom(Relation)
    ;   compound(Goal),
        Goal =.. [Name, I, J],
        memberchk(Name, [ after, before, meets, met_by, overlaps, overlapped_by, starts, started_by,
                          during, finishes, finished_by, equals ])
    ).

%   reads_timeline(+Goal): Goal terminates and raises no error, whatever is bound.

reads_timeline(Goal) :-
    compound(Goal),
    (   relation(Goal, _)
    ->  true
    ;   functor(Goal, Name, Arity),
        memberchk(Name/Arity, [ holds/2, occurs/2, fluent/2, fluentT/2, event/2, eventT/2, argsOf/2,
                                objOf/2, ongoing/1, near_miss/3, evidence/4, instance_of/2, instance_of/3, has_part/2,
                                value/3, subclass_of/2, unit/2 ])
    ).

%   refine(+Goals, +Before, -Refined): tell each goal what its neighbours know.

refine([], _, []).
refine([Goal|Goals], Before, [Refined|More]) :-
    refined(Goal, Goals, Before, Refined),
    refine(Goals, [Goal|Before], More).

refined(Goal, Goals, Before, Refined) :-
    nonvar(Goal),
    reader(Goal, Kind, Term, Interval),
    unbound_in(Before, Term),
    neighbours(Goals, Near),
    type_demanded(Near, Term, Type),
    object_demanded(Near, Term, [Goal|Before], Object),
    !,
    Refined = asking:matching(Kind, Term, Interval, Type, Object).
refined(argsOf(Term, Arguments), _, Before, timeline:args_of(Term, Interval, Arguments)) :-
    var(Term),
    member(Earlier, Before),
    nonvar(Earlier),
    reader(Earlier, _, Same, Interval),
    Same == Term,
    !.
refined(Goal, _, _, Goal).

reader(holds(Term, Interval), fluent, Term, Interval).
reader(occurs(Term, Interval), event, Term, Interval).

neighbours([Goal|Goals], [Goal|Near]) :-
    nonvar(Goal),
    reads_timeline(Goal),
    !,
    neighbours(Goals, Near).
neighbours(_, []).

type_demanded(Near, Term, Type) :-
    (   member(Goal, Near),
        compound(Goal),
        Goal =.. [Name, Same, Type0],
        memberchk(Name, [fluent, fluentT, event, eventT]),
        Same == Term,
        atom(Type0)
    ->  Type = Type0
    ;   true
    ).

object_demanded(Near, Term, Before, Object) :-
    (   member(objOf(Same, Object0), Near),
        Same == Term,
        (   atom(Object0)
        ->  true
        ;   var(Object0),
            \+ unbound_in(Before, Object0)
        )
    ->  Object = Object0
    ;   true
    ).
