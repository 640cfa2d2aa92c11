/*  Which variables of a goal an answer gives: those that the goal can bind, not those of a collection inside it. */

:- module(outer, [ outer_bindings/3 ]). % +Goal, +Bindings, -Outer
:- use_module(library(apply)).

%!  outer_bindings(+Goal, +Bindings, -Outer) is det.
%
%   Outer are the Name=Variable of Bindings whose Variable occurs where Goal can bind it: not only inside the goal of
%   findall/3, aggregate_all/3 or forall/2, in a lambda, or bound by ^ in setof/3.

outer_bindings(Goal, Bindings, Outer) :-
    outer(Goal, Terms, []),
    term_variables(Terms, Variables),
    include(among(Variables), Bindings, Outer).

among(Variables, _=Variable) :-
    (   var(Variable)
    ->  member_of(Variables, Variable)
    ;   true
    ).

member_of([First|Rest], Variable) :-
    (   First == Variable
    ->  true
    ;   member_of(Rest, Variable)
    ).

%   outer(+Goal)//: the terms in a goal that it can bind.

outer(Goal) -->
    { var(Goal) },
    !,
    [Goal].
outer(Goal) -->
    { parts(Goal, Goals, Terms) },
    !,
    [Terms],
    outers(Goals).
outer(Goal) -->
    { compound(Goal) },
    !,
    { Goal =.. [_|Arguments], maplist(bound_by_call, Arguments, Bound) },
    [Bound].
outer(Goal) -->
    [Goal].

%   A lambda is copied before it is called: of what stands only in it, nothing is bound.

bound_by_call(Lambda, Bound), nonvar(Lambda), Lambda = Free/Inner, nonvar(Inner), Inner = (_>>_) => Bound = Free.
bound_by_call(Lambda, Bound), nonvar(Lambda), Lambda = (_>>_) => Bound = [].
bound_by_call(Argument, Bound) => Bound = Argument.

outers([]) --> [].
outers([Goal|Goals]) -->
    outer(Goal),
    outers(Goals).

%   parts(+Goal, -Goals, -Terms): the goals inside that bind for good, and the terms beside them.

parts((A, B), [A, B], []).
parts((A ; B), [A, B], []).
parts((A -> B), [A, B], []).
parts((A *-> B), [A, B], []).
parts(once(A), [A], []).
parts(ignore(A), [A], []).
parts(in(Run, A), [A], [Run]).
parts(\+ _, [], []).
parts(forall(_, _), [], []).
parts(findall(_, _, List), [], [List]).
parts(findall(_, _, List, Tail), [], [List, Tail]).
parts(aggregate_all(_, _, Result), [], [Result]).
parts(aggregate_all(_, _, _, Result), [], [Result]).
parts(setof(Template, Goal, List), [], [Free, List]) :-
    free(Template, Goal, Free).
parts(bagof(Template, Goal, List), [], [Free, List]) :-
    free(Template, Goal, Free).

%   By the variables that are neither in the template nor before a ^, setof/3 tells its answers apart.

free(Template, Goal0, Free) :-
    without_carets(Goal0, Goal, Template, Local),
    term_variables(Local, Locals),
    outer(Goal, Terms, []),
    term_variables(Terms, Variables),
    exclude(member_of(Locals), Variables, Free).

without_carets(Goal, Goal, Local, Local) :-
    var(Goal),
    !.
without_carets(Variables^Goal0, Goal, Local0, Local) :-
    !,
    without_carets(Goal0, Goal, Variables-Local0, Local).
without_carets(Goal, Goal, Local, Local).
