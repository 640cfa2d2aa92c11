/*  Kinds: what each variable of a goal stands for, by where it stands, and what it is compared with.

    Variables that the equations of a goal join are one class, which has the kinds of all positions in which they stand, and
    the names, numbers and terms that they meet.
*/

:- module(kinds,
          [ readings/3,                 % +Goal, +Numbers, -Readings
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
:- use_module(equations).
:- use_module(known, [fact_kind/1]).

%   No more readings of a goal are made: each disjunction doubles them.

most_readings(100).

%!  readings(+Goal, +Numbers, -Readings:list) is det.
%
%   Readings are what Goal tells of its variables, in each choice of the branches of its disjunctions. Numbers are the
%   Variable-Number of variables that stand for numbers.

readings(Goal, Numbers, Readings) :-
    most_readings(Most),
    findall(Reading, limit(Most, reading(Goal, Numbers, Reading)), Readings).

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
add_term(I, List, State0, State), List = [_|_] =>
    items(List, Items, Rest),
    (   Rest == []
    ->  Name = '[|]',
        Arguments = Items
    ;   Name = '[|',
        Arguments = [Rest|Items]
    ),
    add_compound(I, Name, Arguments, State0, State).
add_term(I, Term, State0, State), compound(Term) =>
    compound_name_arguments(Term, Name, Arguments),
    add_compound(I, Name, Arguments, State0, State).
add_term(I, Constant, State0, State) =>
    root(I, State0, A, class(Kinds, Constants0, Terms, Element)),
    ord_add_element(Constants0, Constant, Constants),
    put(A, class(Kinds, Constants, Terms, Element), State0, State).

add_compound(I, Name, Arguments, State0, State) :-
    length(Arguments, Arity),
    foldl(number_of, Arguments, Numbers, State0, State1),
    add_parts(I, term(Name, Arity, Numbers), State1, State).

items([First|More], [First|Items], Rest) :-
    !,
    items(More, Items, Rest).
items(Rest, [], Rest).

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

%   spread(+Equations, +State0, -State): what a thing is made of has kinds, too. What stands in a list that is written out
%   has the kinds of what is in the list, and is met by that; but nothing makes one of it what another is.

spread(Equations, State0, State) :-
    findall(Found, new(Equations, State0, Found), All0),
    sort(All0, All),
    (   All == []
    ->  State = State0
    ;   foldl(add_found, All, State0, State1),
        spread(Equations, State1, State)
    ).

new(Equations, State, kind(I, Kind)) :-
    spreads(Equations, State, I, Kind),
    root(I, State, _, class(Kinds, _, _, _)),
    \+ memberchk(Kind, Kinds).
new(_, State, Found) :-
    listed(State, Element0, Term),
    root(Element0, State, Element, class(Kinds, Constants, Terms, _)),
    item(Term, First),
    root(First, State, _, class(OwnKinds, OwnConstants, OwnTerms, _)),
    (   Found = kind(First, Kind),
        member(Kind, Kinds),
        \+ memberchk(Kind, OwnKinds)
    ;   Found = constant(Element, Constant),
        member(Constant, OwnConstants),
        \+ memberchk(Constant, Constants)
    ;   Found = parts(Element, term(Name, Arity, Numbers)),
        member(term(Name, Arity, Numbers), OwnTerms),
        \+ ( memberchk(term(Name, Arity, Known), Terms), maplist(same_class(State), Numbers, Known) )
    ).
new(_, State, element(Rest, Element)) :-
    listed(State, Element0, Term),
    rest(Term, Rest),
    root(Element0, State, Element, _),
    root(Rest, State, _, class(_, _, _, In)),
    \+ ( In \== none, root(In, State, Element, _) ).

same_class(State, I, J) :-
    root(I, State, A, _),
    root(J, State, A, _).

%   listed(+State, -Element, -Term): Term is a list that is written out, of a class that has an Element.

listed(state(_, Classes), Element, Term) :-
    gen_assoc(_, Classes, class(_, _, Terms, Element)),
    Element \== none,
    member(Term, Terms),
    is_written(Term).

is_written(term(Name, _, _)) :- memberchk(Name, ['[|]', '[|']).

%   What is in a list that is written out, and what it may end in.

item(term('[|]', _, Items), Item) :- member(Item, Items).
item(term('[|', _, [_|Items]), Item) :- member(Item, Items).

rest(term('[|', _, [Rest|_]), Rest).

add_found(kind(I, Kind), State0, State) => add_kind(I, Kind, State0, State).
add_found(constant(I, Constant), State0, State) => add_term(I, Constant, State0, State).
add_found(parts(I, Term), State0, State) => add_parts(I, Term, State0, State).
add_found(element(I, Element), State0, State) =>
    element(I, In, State0, State1),
    join_classes(In, Element, State1, State).

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
    ;   list_of(Of, Each),
        (   Element \== none,
            I = Element,
            Kind = Each
        ;   member(Term, Terms),
            ( item(Term, I), Kind = Each ; rest(Term, I), Kind = Of )
        )
    ).
spreads(Equations, State, I, Kind) :-
    member(Equation, Equations),
    (   Equation = named(Fact, '$class'(I), _),
        Kind = name(Of)
    ;   Equation = argument(Fact, '$class'(I)),
        Kind = individual
    ;   Equation = apart(Fact, '$class'(L)),
        root(L, State, _, class(_, _, Terms, _)),
        member(term('[|]', _, [Name|Arguments]), Terms),
        ( I = Name, Kind = name(Of) ; member(I, Arguments), Kind = individual )
    ),
    kind_in(State, Fact, Of).

list_of(individuals, individual).
list_of(arguments, argument).
% An argument may be a displacement.
list_of(individual, argument).

kind_in(State, '$class'(F), Of) :-
    root(F, State, _, class(Kinds, _, _, _)),
    member(Of, Kinds),
    fact_kind(Of).

%!  class(+Reading, -Kinds, -Constants, -Terms) is nondet.
%
%   The classes of a reading: the kinds of each, the names and numbers that it meets, and its terms, with variables for what
%   is in them.

class(reading(State, _, _, _), Kinds, Constants, Terms) :-
    State = state(_, Classes),
    gen_assoc(_, Classes, class(Kinds, Constants, Terms0, _)),
    findall(Term, ( member(Term0, Terms0), general_term(Term0, Term) ), Terms).

general_term(Term0, Term), is_written(Term0) => Term = [_].
general_term(term(Name, Arity, _), Term) => functor(Term, Name, Arity).

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
    \+ memberchk(value, Kinds),
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
