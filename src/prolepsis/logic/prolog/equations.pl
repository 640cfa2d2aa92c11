/*  Equations: what a goal tells of its variables, without being run.

    It tells with what a variable is unified or compared, what is in a list, what a fact is made of, and where each stands. Of
    a disjunction one branch is read at a time, so that what stands in one bears on nothing in the other.
*/

:- module(equations,
          [ equations//1                % +Goal
          ]).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(guard).
:- use_module(positions).

%!  equations(+Goal)// is nondet.
%
%   What Goal tells, each as same(A, B), in(List, Element), kind(Term, Kind), named(Fact, Name, Arity),
%   argument(Fact, Argument), apart(Fact, List) or gives(Interval, Reader).

equations(Goal) --> { var(Goal) }, !.
equations((A ; B)) -->
    !,
    (   { nonvar(A), ( A = (If -> Then) ; A = (If *-> Then) ) }
    ->  ( equations(If), equations(Then) ; equations(B) )
    ;   ( equations(A) ; equations(B) )
    ).
equations(_/Lambda) --> !, equations(Lambda).
equations(Parameters>>Body) --> { is_list(Parameters) }, !, equations(Body).
equations(_^Goal) --> !, equations(Goal).
equations(Goal) --> { callable(Goal) }, !, own(Goal), inner(Goal).
equations(_) --> [].

own(F =.. List) --> !, univ(List, F).
own(functor(F, Name, Arity)) --> !, [named(F, Name, Arity)].
own(arg(_, F, Argument)) --> !, [argument(F, Class), same(Class, Argument)].
own(Goal) -->
    { form(Goal, Form) },
    !,
    { Goal =.. [_|Arguments], Form =.. [_|Shapes] },
    shaped(Shapes, Arguments, Goal),
    gives(Goal).
own(Goal) -->
    { functor(Goal, Name, Arity), functor(Calls, Name, Arity), ( may(Calls) -> true ; Calls = Goal ),
      findall(N, ( Arity > 0, arg(N, Calls, Way), \+ goes_into(Way) ), Plain), maplist(argument_of(Goal), Plain, Arguments),
      term_variables(Arguments, Variables) },
    of_kind(Variables, any).

goes_into(Way) :- ( integer(Way) ; Way == (^) ).

argument_of(Goal, N, Argument) :- arg(N, Goal, Argument).

form(Goal, Form) :-
    functor(Goal, Name, Arity),
    functor(Form, Name, Arity),
    (   takes(Form)
    ->  true
    ;   Name == aggregate_all
    ->  arg(1, Goal, Asked),
        arg(1, Form, What),
        nonvar(Asked),
        functor(Asked, Of, Parts),
        functor(What, Of, Parts),
        links(Form)
    ;   links(Form)
    ),
    !.

univ(List, F) --> { var(List) }, !, [apart(F, List)].
univ([Name|Arguments], F) -->
    !,
    [named(F, Name, _)],
    univ_arguments(Arguments, F).
univ(_, _) --> [].

univ_arguments(Arguments, F) --> { nonvar(Arguments), Arguments = [First|Rest] }, !,
    [argument(F, Class), same(Class, First)],
    univ_arguments(Rest, F).
univ_arguments(_, _) --> [].

shaped([], [], _) --> [].
shaped([Shape|Shapes], [Argument|Arguments], Goal) -->
    stands(Shape, Argument, Goal),
    shaped(Shapes, Arguments, Goal).

%   stands(?Shape, ?Argument, +Goal)//: Argument of Goal stands where one of Shape is taken.

stands(Shape, Argument, _) --> { var(Shape) }, !, [same(Shape, Argument)].
stands(?, Argument, _) --> !, ( { var(Argument) } -> [kind(Argument, any)] ; [] ).
stands(number, Expression, _) --> !,
    { term_variables(Expression, Variables) },
    of_kind(Variables, number).
stands(found(Shape), Argument, Goal) --> !,
    stands(number, Argument, Goal),
    ( { var(Argument) } -> stands(Shape, Argument, Goal) ; stands(Shape, Class, Goal), [kind(Class, computed)] ).
stands(value(N), Argument, Goal) --> !,
    { arg(N, Goal, Of) },
    ( { atom(Of) } -> [kind(Argument, value(Of))] ; [kind(Argument, value)] ).
stands(type(Kind), Argument, _) --> !, [kind(Argument, type(Kind))].
stands(list(Shape), List, Goal) --> !,
    [in(List, Element)],
    stands(Shape, Element, Goal).
stands(called(More), Closure, Goal) --> !, closure(Closure, More, Goal).
stands(Kind, Argument, _) --> { atom(Kind) }, !, [kind(Argument, Kind)].
stands(Shape, Argument, Goal) -->
    { Shape =.. [Name|Shapes], length(Shapes, Count), length(Arguments, Count), Term =.. [Name|Arguments] },
    [same(Term, Argument)],
    shaped(Shapes, Arguments, Goal).

of_kind([], _) --> [].
of_kind([Variable|Variables], Kind) --> [kind(Variable, Kind)], of_kind(Variables, Kind).

closure(Closure, _, _) --> { var(Closure) }, !.
closure(_/Lambda, More, Goal) --> !, closure(Lambda, More, Goal).
closure(Parameters>>Body, More, Goal) --> { is_list(Parameters) }, !,
    { length(Parameters, Count), length(More, Given), First is min(Count, Given),
      length(Bound, First), append(Bound, Rest, More), append(Heads, _, Parameters), length(Heads, First) },
    all_same(Heads, Bound),
    closure(Body, Rest, Goal).
closure(Closure, More, _) --> { callable(Closure), Closure \= _:_ }, !,
    { Closure =.. Plain, append(Plain, More, All), Called =.. All },
    equations(Called).
closure(_, _, _) --> [].

all_same([], []) --> [].
all_same([A|As], [B|Bs]) --> [same(A, B)], all_same(As, Bs).

gives(Goal) -->
    (   { gives(Goal, Interval), var(Interval) }
    ->  [gives(Interval, Goal)]
    ;   []
    ).

gives(holds(_, Interval), Interval).
gives(occurs(_, Interval), Interval).
gives(instance_of(_, _, Interval), Interval).
gives(evidence(_, Interval, _, _), Interval).

%   inner(+Goal)//: the goals in Goal that no link has told of already.

inner(Goal) -->
    { functor(Goal, Name, Arity), functor(Calls, Name, Arity), may(Calls), Arity > 0 },
    !,
    { ( form(Goal, Form) -> true ; functor(Form, Name, Arity) ), Goal =.. [_|Arguments], Calls =.. [_|Ways],
      Form =.. [_|Shapes] },
    inners(Ways, Shapes, Arguments).
inner(_) --> [].

inners([], [], []) --> [].
inners([Way|Ways], [Shape|Shapes], [Argument|Arguments]) -->
    (   { nonvar(Shape), Shape = called(_) }
    ->  []
    ;   { called(Way, Argument, Called) }
    ->  equations(Called)
    ;   []
    ),
    inners(Ways, Shapes, Arguments).

