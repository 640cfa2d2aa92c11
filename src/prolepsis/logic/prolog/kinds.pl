/*  Kinds: what each variable of a goal stands for, by where it stands, and what it is compared with.

    A goal is read as equations: of a variable and what it is unified or compared with, of a list and what is in it, of a
    fact and what it is made of. Variables that the equations join are one class, which has the kinds of all positions in
    which they stand, and the constants and terms that they meet. Nothing is run. Of a disjunction one branch is read at a
    time, so that what stands in one bears on nothing in the other.
*/

:- module(kinds,
          [ readings/3,                 % +Goal, +Numbers, -Reading
            class/4,                    % +Reading, -Kinds, -Constants, -Terms
            variable/4,                 % +Reading, ?N, -Kinds, -Constants
            number_kinds/2,             % +Reading, -Numbers
            interval_computed/2,        % +Reading, -Reader
            made_of/4                   % +Reading, -Kind, -Name, -Arity
          ]).
:- use_module(library(apply)).
:- use_module(library(assoc)).
:- use_module(library(lists)).
:- use_module(library(ordsets)).
:- use_module(library(solution_sequences)).
:- use_module(guard).
:- use_module(known, [fact_kind/1]).
:- use_module(positions).

%   No more readings of a goal are made: each disjunction doubles them.

most_readings(100).

%!  readings(+Goal, +Numbers, -Reading) is nondet.
%
%   Reading is what Goal tells of its variables in one choice of the branches of its disjunctions. Numbers are the
%   Variable-Number of variables that stand for numbers.

readings(Goal, Numbers, Reading) :-
    most_readings(Most),
    limit(Most, reading(Goal, Numbers, Reading)).

reading(Goal, Numbers, reading(Classes, Equations, Variables, Pairs)) :-
    copy_term(Goal-Numbers, Copy-Pairs),
    term_variables(Copy, Variables),
    phrase(equations(Copy), Equations0),
    maplist(is_number, Pairs, Known),
    append(Known, Equations0, Equations),
    numbervars(Variables-Equations, 0, Next, [functor_name('$class')]),
    empty_assoc(Empty),
    foldl(joined, Equations, state(Next, Empty), State),
    spread(Equations, State, Classes).

is_number(Variable-Number, same(Variable, Number)).

%   equations(+Goal)//: what Goal tells, each as same(A, B), in(List, Element), kind(Term, Kind), named(Fact, Name, Arity),
%   argument(Fact, Argument) or gives(Interval, Reader).

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
stands(value(N), Argument, Goal) --> !,
    { arg(N, Goal, Of) },
    ( { atom(Of) } -> [kind(Argument, value(Of))] ; [] ).
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

%   joined(+Equation, +State0, -State): a state has the next number, and by its number each class, which is
%   class(Kinds, Constants, Terms, Element), or to(Number) of the one that it was joined with. A term is
%   term(Name, Arity, Numbers), the classes of its arguments.

joined(same(A, B), State0, State) => join(A, B, State0, State).
joined(in(List, Element), State0, State) =>
    number_of(List, Number, State0, State1),
    element(Number, In, State1, State2),
    join('$class'(In), Element, State2, State).
joined(kind(Term, Kind), State0, State) =>
    number_of(Term, Number, State0, State1),
    add_kind(Number, Kind, State1, State).
joined(_, State0, State) => State = State0.

join(A, B, State0, State), A == B => State = State0.
join('$class'(I), '$class'(J), State0, State) => join_classes(I, J, State0, State).
join('$class'(I), Term, State0, State) => add_term(I, Term, State0, State).
join(Term, '$class'(I), State0, State) => add_term(I, Term, State0, State).
join(A, B, State0, State), compound(A), compound(B), compound_name_arity(A, Name, N), compound_name_arity(B, Name, N) =>
    compound_name_arguments(A, _, As),
    compound_name_arguments(B, _, Bs),
    foldl(join, As, Bs, State0, State).
join(A, B, State0, State) =>
    % Both are known, and differ: what either is, is told where it stands.
    number_of(A, Number, State0, State1),
    add_term(Number, B, State1, State).

number_of('$class'(I), Number, State0, State) => Number = I, State = State0.
number_of(Term, Number, State0, State) =>
    fresh(Number, State0, State1),
    add_term(Number, Term, State1, State).

root(I, state(Next, Classes), Root, Class) :-
    (   get_assoc(I, Classes, Found)
    ->  (   Found = to(J)
        ->  root(J, state(Next, Classes), Root, Class)
        ;   Root = I,
            Class = Found
        )
    ;   Root = I,
        Class = class([], [], [], none)
    ).

put(I, Class, state(Next, Classes0), state(Next, Classes)) :-
    put_assoc(I, Classes0, Class, Classes).

fresh(Number, state(Number, Classes), state(Next, Classes)) :-
    Next is Number+1.

join_classes(I, J, State0, State) :-
    root(I, State0, A, class(KindsA, ConstantsA, TermsA, ElementA)),
    root(J, State0, B, class(KindsB, ConstantsB, TermsB, ElementB)),
    (   A == B
    ->  State = State0
    ;   ord_union(KindsA, KindsB, Kinds),
        ord_union(ConstantsA, ConstantsB, Constants),
        put(A, to(B), State0, State1),
        put(B, class(Kinds, Constants, TermsB, ElementB), State1, State2),
        foldl(add_parts(B), TermsA, State2, State3),
        (   ElementA == none
        ->  State = State3
        ;   element(B, Element, State3, State4),
            join_classes(ElementA, Element, State4, State)
        )
    ).

add_kind(I, Kind, State0, State) :-
    root(I, State0, A, class(Kinds0, Constants, Terms, Element)),
    ord_add_element(Kinds0, Kind, Kinds),
    put(A, class(Kinds, Constants, Terms, Element), State0, State).

add_term(_, [], State0, State) => State = State0.
add_term(I, [First|Rest], State0, State) =>
    element(I, Element, State0, State1),
    join('$class'(Element), First, State1, State2),
    join('$class'(I), Rest, State2, State).
add_term(I, Term, State0, State), compound(Term) =>
    compound_name_arguments(Term, Name, Arguments),
    length(Arguments, Arity),
    foldl(number_of, Arguments, Numbers, State0, State1),
    add_parts(I, term(Name, Arity, Numbers), State1, State).
add_term(I, Constant, State0, State) =>
    root(I, State0, A, class(Kinds, Constants0, Terms, Element)),
    ord_add_element(Constants0, Constant, Constants),
    put(A, class(Kinds, Constants, Terms, Element), State0, State).

add_parts(I, term(Name, Arity, Numbers), State0, State) :-
    root(I, State0, A, class(Kinds, Constants, Terms, Element)),
    (   memberchk(term(Name, Arity, Known), Terms)
    ->  foldl(join_classes, Numbers, Known, State0, State)
    ;   put(A, class(Kinds, Constants, [term(Name, Arity, Numbers)|Terms], Element), State0, State)
    ).

element(I, Number, State0, State) :-
    root(I, State0, A, class(Kinds, Constants, Terms, Element)),
    (   Element == none
    ->  fresh(Number, State0, State1),
        put(A, class(Kinds, Constants, Terms, Number), State1, State)
    ;   Number = Element,
        State = State0
    ).

%   spread(+Equations, +State0, -State): what a thing is made of has kinds, too.

spread(Equations, State0, State) :-
    findall(I-Kind, ( spreads(Equations, State0, I, Kind), \+ has_kind(State0, I, Kind) ), Found0),
    sort(Found0, Found),
    (   Found == []
    ->  State = State0
    ;   foldl(add_found, Found, State0, State1),
        spread(Equations, State1, State)
    ).

add_found(I-Kind, State0, State) :-
    add_kind(I, Kind, State0, State).

has_kind(State, I, Kind) :-
    root(I, State, _, class(Kinds, _, _, _)),
    memberchk(Kind, Kinds).

spreads(_, state(_, Classes), I, Kind) :-
    gen_assoc(_, Classes, class(Kinds, _, Terms, Element)),
    member(Of, Kinds),
    (   fact_kind(Of),
        member(term(_, _, Numbers), Terms),
        member(I, Numbers),
        Kind = individual
    ;   memberchk(Of, [time, interval]),
        member(term(-, 2, Numbers), Terms),
        member(I, Numbers),
        Kind = end
    ;   list_of(Of, Kind),
        Element \== none,
        I = Element
    ).
spreads(Equations, State, I, Kind) :-
    member(Equation, Equations),
    (   Equation = named(Fact, '$class'(I), _),
        Kind = name(Of)
    ;   Equation = argument(Fact, '$class'(I)),
        Kind = individual
    ),
    kind_in(State, Fact, Of).

list_of(individuals, individual).
list_of(arguments, argument).

kind_in(State, '$class'(F), Of) :-
    root(F, State, _, class(Kinds, _, _, _)),
    member(Of, Kinds),
    fact_kind(Of).

%!  class(+Reading, -Kinds, -Constants, -Terms) is nondet.
%
%   The classes of a reading: the kinds of each, the names and numbers that it meets, and its terms as Name/Arity.

class(reading(State, _, _, _), Kinds, Constants, Terms) :-
    State = state(_, Classes),
    gen_assoc(_, Classes, class(Kinds, Constants, Terms0, _)),
    findall(Name/Arity, member(term(Name, Arity, _), Terms0), Terms).

%!  variable(+Reading, ?N, -Kinds, -Constants) is nondet.
%
%   The kinds of the Nth variable of the goal, counted from 0, and the names and numbers that it meets.

variable(reading(State, _, Variables, _), N, Kinds, Constants) :-
    nth0(N, Variables, '$class'(I)),
    root(I, State, _, class(Kinds, Constants, _, _)).

%!  number_kinds(+Reading, -Numbers) is det.
%
%   Numbers are Number-Kinds for each of those of the goal, in their order.

number_kinds(reading(State, _, _, Pairs), Numbers) :-
    maplist(kinds_of_number(State), Pairs, Numbers).

kinds_of_number(State, '$class'(I)-Number, Number-Kinds) :-
    root(I, State, _, class(Kinds, _, _, _)).

%!  made_of(+Reading, -Kind, -Name, -Arity) is nondet.
%
%   True if a fact of Kind is taken apart as one of that Name, or, if Arity is a number, of that, too.

made_of(reading(State, Equations, _, _), Kind, Name, Arity) :-
    member(named(Fact, Name0, Arity0), Equations),
    kind_in(State, Fact, Kind),
    one(State, Name0, Name),
    atom(Name),
    ( one(State, Arity0, Arity), integer(Arity) -> true ; Arity = any ).

one(State, '$class'(I), Constant) =>
    root(I, State, _, class(_, [Constant], _, _)).
one(_, Term, Constant) =>
    Constant = Term.

%!  interval_computed(+Reading, -Reader) is nondet.
%
%   True if Reader gives an interval, which nothing else gives, and it is computed with as if it were a number.

interval_computed(reading(State, Equations, _, _), Reader) :-
    member(gives('$class'(I), Reader0), Equations),
    root(I, State, _, class(Kinds, Constants, Terms, _)),
    memberchk(number, Kinds),
    \+ ( member(Other, [any, computed, end, instant]), memberchk(Other, Kinds) ),
    \+ memberchk(value(_), Kinds),
    \+ ( member(Constant, Constants), number(Constant) ),
    ( Terms == [] ; memberchk(term(-, 2, _), Terms) ),
    general(Reader0, Reader).

%   Classes are shown as the variables that they were.

general('$class'(_), Term) => Term = _.
general(Term0, Term), compound(Term0) =>
    compound_name_arguments(Term0, Name, Arguments0),
    maplist(general, Arguments0, Arguments),
    compound_name_arguments(Term, Name, Arguments).
general(Term0, Term) => Term = Term0.
