/*  Positions: what stands where in a goal, as what it names or as what it is compared with. */

:- module(positions,
          [ takes/1,                    % ?Form
            links/1,                    % ?Form
            named/3,                    % +Goal, -Kind, -Argument
            argument/3,                 % +Goal, -Kind, -Argument
            within/2,                   % +Goal, -Inner
            called/3                    % +Calls, +Closure, -Goal
          ]).
:- use_module(library(lists)).
:- use_module(guard).

%!  takes(?Form) is nondet.
%
%   What the arguments of the predicates on timelines and individuals must be: ? for any term, else the kind of what is
%   named; fact is a fluent or an event, type(Kind) the name of its type in either spelling, individuals a list of them,
%   arguments a list of what need not be known, value(N) a value of what the Nth argument names, time an interval or an instant, interval and instant one of them, and
%   number what is computed with.

takes(holds(fluent, time)).
takes(holds_at(fluent, instant)).
takes(occurs(event, time)).
takes(fluent(fluent, type(fluent))).
takes(fluentT(fluent, type(fluent))).
takes(event(event, type(event))).
takes(eventT(event, type(event))).
takes(argsOf(fact, arguments)).
takes(objOf(fact, individual)).
takes(evidence(fact, time, evidence, value(3))).
takes(fact(run, ?, type(fact), individuals, instant, instant)).
takes(in(run, ?)).
takes(ongoing(fact)).
takes(near_miss(fact, time, ?)).
takes(instance_of(individual, class)).
takes(instance_of(individual, class, time)).
takes(has_part(individual, individual)).
takes(value(individual, property, value(2))).
takes(subclass_of(class, class)).
takes(unit(quantity, unit)).
takes(matching(?, ?, time, type(fact), individual)).
takes(Relation) :-
    interval_relation(Name),
    functor(Relation, Name, 2),
    Relation =.. [_, interval, interval].
takes(allen(relation, interval, interval)).

interval_relation(after).
interval_relation(before).
interval_relation(meets).
interval_relation(met_by).
interval_relation(overlaps).
interval_relation(overlapped_by).
interval_relation(starts).
interval_relation(started_by).
interval_relation(during).
interval_relation(finishes).
interval_relation(finished_by).
interval_relation(equals).

%!  links(?Form) is nondet.
%
%   What the arguments of Prolog's own predicates have in common: the same variable stands for things of one kind, list(K)
%   for a list of them, called(Ks) for a goal that is called with them; number is what is computed with, computed what is
%   found so, found(K) a number that is compared and stays as it is, and ? any term. Where there are several of a name, the
%   first argument tells which.

links(K = K).
links(K \= K).
links(K == K).
links(K \== K).
links(K =@= K).
links(K \=@= K).
links(unify_with_occurs_check(K, K)).
links(subsumes_term(K, K)).
links(copy_term(K, K)).
links(number < number).
links(number > number).
links(number =< number).
links(number >= number).
links(number =:= number).
links(number =\= number).
links(computed is number).
links(succ(computed, computed)).
links(plus(computed, computed, computed)).
links(between(computed, computed, computed)).
links(call(called([]))).
links(call(called([A]), A)).
links(call(called([A, B]), A, B)).
links(call(called([A, B, C]), A, B, C)).
links(findall(K, ?, list(K))).
links(findall(K, ?, list(K), list(K))).
links(bagof(K, ?, list(K))).
links(setof(K, ?, list(K))).
links(aggregate_all(max(found(K)), ?, K)).
links(aggregate_all(min(found(K)), ?, K)).
links(aggregate_all(sum(number), ?, computed)).
links(aggregate_all(max(found(N), K), ?, max(N, K))).
links(aggregate_all(min(found(N), K), ?, min(N, K))).
links(aggregate_all(bag(K), ?, list(K))).
links(aggregate_all(set(K), ?, list(K))).
links(call_nth(?, computed)).
links(member(K, list(K))).
links(memberchk(K, list(K))).
links(append(list(K), list(K), list(K))).
links(append(list(list(K)), list(K))).
links(delete(list(K), K, list(K))).
links(intersection(list(K), list(K), list(K))).
links(union(list(K), list(K), list(K))).
links(subtract(list(K), list(K), list(K))).
links(subset(list(K), list(K))).
links(prefix(list(K), list(K))).
links(last(list(K), K)).
links(length(?, computed)).
links(list_to_set(list(K), list(K))).
links(max_list(list(found(K)), K)).
links(min_list(list(found(K)), K)).
links(sum_list(list(number), computed)).
links(max_member(K, list(K))).
links(min_member(K, list(K))).
links(msort(list(K), list(K))).
links(sort(list(K), list(K))).
links(sort(?, ?, list(K), list(K))).
links(predsort(?, list(K), list(K))).
links(nextto(K, K, list(K))).
links(nth0(computed, list(K), K)).
links(nth1(computed, list(K), K)).
links(nth0(computed, list(K), K, list(K))).
links(nth1(computed, list(K), K, list(K))).
links(numlist(computed, computed, list(computed))).
links(permutation(list(K), list(K))).
links(reverse(list(K), list(K))).
links(select(K, list(K), list(K))).
links(selectchk(K, list(K), list(K))).
links(select(K, list(K), K, list(K))).
links(selectchk(K, list(K), K, list(K))).
links(include(called([K]), list(K), list(K))).
links(exclude(called([K]), list(K), list(K))).
links(partition(called([K]), list(K), list(K), list(K))).
links(convlist(called([A, B]), list(A), list(B))).
links(maplist(called([A]), list(A))).
links(maplist(called([A, B]), list(A), list(B))).
links(maplist(called([A, B, C]), list(A), list(B), list(C))).
links(maplist(called([A, B, C, D]), list(A), list(B), list(C), list(D))).
links(foldl(called([A, S, S]), list(A), S, S)).
links(pairs_keys_values(list(K-V), list(K), list(V))).
links(pairs_keys(list(K-_), list(K))).
links(pairs_values(list(_-V), list(V))).
links(keysort(list(K), list(K))).
links(list_to_ord_set(list(K), list(K))).
links(ord_memberchk(K, list(K))).
links(ord_union(list(K), list(K), list(K))).
links(ord_subtract(list(K), list(K), list(K))).
links(ord_intersection(list(K), list(K), list(K))).
links(ord_subset(list(K), list(K))).

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
        arg(N, Calls, Called),
        arg(N, Goal, Argument),
        called(Called, Argument, Inner0),
        within(Inner0, Inner)
    ).
within(_, _) => fail.

%!  argument(+Goal, -Kind, -Argument) is nondet.
%
%   True if Argument of Goal itself is what a Kind of thing is named by.

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

%!  called(+Calls, +Closure, -Goal) is semidet.
%
%   Goal is Closure where a predicate Calls it, as the guard's table says.

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
