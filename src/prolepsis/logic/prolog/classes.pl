/*  Classes in time: what makes an individual one of a class may come and go.

    A class may be defined by named classes, by what is true of an individual, and by a relation to some of a class. What
    is true and what is related are fluents, so it is known when each part of a definition is met. Any other class is as
    the situation tells, from the start to the end; and so is one of these where no fluent tells of it at the start.
*/

:- module(classes,
          [ belongs/5,                  % +Run, ?Individual, ?Class, ?Start, ?End
            comes_to_be/3,              % +Run, ?Individual, ?Class
            told_above/3,               % +Run, ?Class, ?Above
            all_above/3                 % +Run, +Class, -Above
          ]).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(runs).
:- use_module(vocabulary).

%!  belongs(+Run, ?Individual, ?Class, ?Start, ?End) is nondet.
%
%   True if Individual is one of Class from Start to End, and not right before and after.

belongs(Run, Individual, Class, Start, End) :-
    candidate(Run, Individual, Class),
    spans(Run, Individual, Class, Spans),
    member(Start-End, Spans).

%!  comes_to_be(+Run, ?Individual, ?Class) is nondet.
%
%   True if Individual is one of Class at some time, though the situation does not tell of it.

comes_to_be(Run, Individual, Class) :-
    varied(Run, Individual, Class),
    \+ is_one(Run, Individual, Class),
    spans(Run, Individual, Class, [_|_]).

candidate(Run, Individual, Class) :-
    Run:instance(Individual, Class).
candidate(Run, Individual, Class) :-
    varied(Run, Individual, Class),
    \+ is_one(Run, Individual, Class).

%   varied(+Run, ?Individual, ?Class): a fluent of Individual is what Class, or one below it, asks for; each pair once.

varied(Run, Individual, Class) :-
    findall(Each-Its,
            ( varies(Run, Defined),
              depends(Run, Defined, Property),
              met(Run, Property, Each, _, _, _),
              Each = Individual,
              at_or_above(Run, Defined, Its),
              Its = Class ),
            Pairs0),
    sort(Pairs0, Pairs),
    member(Individual-Class, Pairs).

at_or_above(_, Class, Class).
at_or_above(Run, Class, Above) :-
    all_above(Run, Class, All),
    member(Above, All).

%   varies(+Run, ?Class): Class is defined by what fluents tell.

varies(Run, Class) :-
    findall(Each, definition(Run, Each, _, _), All),
    sort(All, Classes),
    member(Class, Classes),
    once(depends(Run, Class, _)).

%   depends(+Run, +Class, -Property): the definition of Class asks for Property, itself or by a class that it names.

depends(Run, Class, Property) :-
    depends(Run, [], Class, Property).

depends(Run, Seen, Class, Property) :-
    definition(Run, Class, Asked, Filler),
    (   Asked == is
    ->  \+ memberchk(Filler, Seen),
        depends(Run, [Class|Seen], Filler, Property)
    ;   Property = Asked
    ).

%   spans(+Run, +Individual, +Class, -Spans): when Individual is one of Class, in order and apart.

spans(Run, Individual, Class, Spans) :-
    Run:lasts(Last),
    (   constant(Run, Individual, Class)
    ->  Spans = [0.0-Last]
    ;   findall(Span,
                ( varies(Run, Defined),
                  once(at_or_above(Run, Defined, Class)),
                  defined_spans(Run, [], Individual, Defined, Some),
                  member(Span, Some) ),
                Found),
        joined(Found, Spans)
    ).

%   constant(+Run, +Individual, +Class): no fluent takes Individual out of Class.

constant(Run, Individual, Class) :-
    Run:instance(Individual, Class),
    (   firm(Run, Individual, Class)
    ;   Run:instance(Individual, Below),
        Below \== Class,
        firm(Run, Individual, Below),
        all_above(Run, Below, All),
        memberchk(Class, All)
    ),
    !.

firm(Run, Individual, Class) :-
    \+ ( varies(Run, Defined),
         Run:instance(Individual, Defined),
         once(at_or_above(Run, Defined, Class)),
         told_of_at_the_start(Run, Individual, Defined) ).

told_of_at_the_start(Run, Individual, Defined) :-
    depends(Run, Defined, Property),
    met(Run, Property, Individual, _, 0.0, _),
    !.

%   defined_spans(+Run, +Seen, +Individual, +Class, -Spans): when all that the definition of Class asks for is so.

defined_spans(Run, Seen, Individual, Class, Spans) :-
    Run:lasts(Last),
    findall(Asked-Filler, definition(Run, Class, Asked, Filler), Parts),
    foldl(narrowed(Run, [Class|Seen], Individual), Parts, [0.0-Last], Spans).

narrowed(Run, Seen, Individual, Asked-Filler, Spans0, Spans) :-
    asked_spans(Asked, Filler, Run, Seen, Individual, Some),
    findall(Start-End,
            ( member(S1-E1, Spans0),
              member(S2-E2, Some),
              Start is max(S1, S2),
              End is min(E1, E2),
              Start < End ),
            Spans).

asked_spans(is, Class, Run, Seen, Individual, Spans), \+ memberchk(Class, Seen), once(depends(Run, Class, _)) =>
    defined_spans(Run, Seen, Individual, Class, Spans).
asked_spans(is, Class, Run, _, Individual, Spans) =>
    (   is_one(Run, Individual, Class)
    ->  Run:lasts(Last),
        Spans = [0.0-Last]
    ;   Spans = []
    ).
asked_spans(Property, Filler, Run, _, Individual, Spans) =>
    findall(Start-End,
            ( met(Run, Property, Individual, Other, Start, End),
              ( Filler == true -> Other == true ; Other \== true, is_one(Run, Other, Filler) ) ),
            Found),
    joined(Found, Spans).

is_one(_, _, '') :- !.               % anything
is_one(Run, Individual, Class) :-
    Run:instance(Individual, Told),
    at_or_above(Run, Told, Class),
    !.

%   met(+Run, +Property, ?Individual, ?Other, ?Start, ?End): a fluent says so of Individual, or of it and Other.

met(Run, Property, Individual, Other, Start, End) :-
    at_or_below(Run, Property, Name),
    table_row(fluent, Run, Name, _, _, Term, Start, End, _),
    (   Term =.. [_, Individual]
    ->  Other = true
    ;   Term =.. [_, Individual, Other]
    ).

at_or_below(Run, Property, Below) :-
    below([Property], [Property], Run, All),
    member(Below, All).

%   below(+Queue, +Seen, +Run, -All): the properties below those in Queue, and all that were Seen, each once.

below([], Seen, _, Seen).
below([Property|Queue], Seen, Run, All) :-
    findall(Near, subproperty(Run, Near, Property), Nears0),
    sort(Nears0, Nears),
    subtract(Nears, Seen, New),
    append(Seen, New, Seen1),
    append(Queue, New, Queue1),
    below(Queue1, Seen1, Run, All).

%   As the situation says, and what only the built-in ontology does.

definition(Run, Class, Asked, Filler) :-
    Run:definition(Class, Asked, Filler).
definition(Run, Class, Asked, Filler) :-
    defined_by(Class, Asked, Filler),
    \+ Run:definition(Class, _, _).

subproperty(Run, Property, Above) :-
    Run:subproperty(Property, Above).
subproperty(_, Property, Above) :-
    property_parent(Property, Above).

%   joined(+Spans, -Joined): what any of Spans covers, in order and apart.

joined(Spans0, Joined) :-
    sort(Spans0, Spans),
    join(Spans, Joined).

join([S-E, S1-E1|Spans], Joined), S1 =< E =>
    Later is max(E, E1),
    join([S-Later|Spans], Joined).
join([Span|Spans], Joined) =>
    Joined = [Span|More],
    join(Spans, More).
join([], Joined) =>
    Joined = [].

%!  told_above(+Run, ?Class, ?Above) is nondet.
%
%   True if Above is told to be right above Class, by the situation or by the built-in ontology.

told_above(Run, Class, Above) :-
    Run:subclass(Class, Above).
told_above(_, Class, Above) :-
    parent(Class, Above).

%!  all_above(+Run, +Class, -Above:list) is det.
%
%   The classes above Class, as told, each once, the nearest first.

all_above(Run, Class, Above) :-
    above([Class], [], Run, Above).

%   above(+Queue, +Seen, +Run, -All): those above the classes in Queue that are not in Seen, by height.

above([], _, _, []).
above([Class|Queue], Seen, Run, All) :-
    findall(Above, told_above(Run, Class, Above), Aboves0),
    sort(Aboves0, Aboves),
    subtract(Aboves, [Class|Seen], New),
    append(New, Seen, Seen1),
    append(Queue, New, Queue1),
    append(New, More, All),
    above(Queue1, Seen1, Run, More).
