/*  Domain knowledge: what is known of the individuals of the current run.

    Classes are given with everything inferred, so nothing is reasoned here.
*/

:- module(knowledge,
          [ instance_of/2,              % ?Individual, ?Class
            has_part/2,                 % ?Whole, ?Part
            value/3,                    % ?Individual, ?Property, ?Value
            subclass_of/2,              % ?Class, ?Above
            unit/2                      % ?Name, ?Unit
          ]).
:- use_module(library(lists)).
:- use_module(runs).
:- use_module(vocabulary).

%!  instance_of(?Individual, ?Class) is nondet.
%
%   True if Individual belongs to Class, inferred classes included.

instance_of(Individual, Class) :-
    current_run(Run),
    Run:instance(Individual, Class).

%!  has_part(?Whole, ?Part) is nondet.
%
%   True if Part is a direct part of Whole.

has_part(Whole, Part) :-
    current_run(Run),
    Run:part(Whole, Part).

%!  value(?Individual, ?Property, ?Value) is nondet.
%
%   True if Individual has Value for Property; quantities are in SI units.

value(Individual, Property, Value) :-
    current_run(Run),
    Run:value(Individual, Property, Value).

%!  subclass_of(?Class, ?Above) is nondet.
%
%   True if Above is a class above Class, as told, at any height: each once, the nearest first.

subclass_of(Class, Above), var(Class), nonvar(Above) =>
    setof(Each, Near^told_above(Each, Near), Classes),
    member(Class, Classes),
    above([Class], [], All),
    memberchk(Above, All).
subclass_of(Class, Above), var(Class) =>
    setof(Each, Near^told_above(Each, Near), Classes),
    member(Class, Classes),
    subclass_of(Class, Above).
subclass_of(Class, Above) =>
    above([Class], [], All),
    member(Above, All).

%   above(+Queue, +Seen, -All): those above the classes in Queue that are not in Seen, by height.

above([], _, []).
above([Class|Queue], Seen, All) :-
    findall(Above, told_above(Class, Above), Aboves0),
    sort(Aboves0, Aboves),
    subtract(Aboves, [Class|Seen], New),
    append(New, Seen, Seen1),
    append(Queue, New, Queue1),
    append(New, More, All),
    above(Queue1, Seen1, More).

told_above(Class, Above) :-
    current_run(Run),
    Run:subclass(Class, Above).
told_above(Class, Above) :-
    parent(Class, Above).

%!  unit(?Name, ?Unit) is nondet.
%
%   True if the values of the property Name, or of evidence of that name, are in the SI unit Unit; each pair once.

unit(Name, Unit) :-
    findall(Name-Unit, unit_of(Name, Unit), Pairs0),
    sort(Pairs0, Pairs),
    member(Name-Unit, Pairs).

unit_of(Name, Unit) :-
    current_run(Run),
    Run:unit(Name, Unit).
unit_of(Name, Unit) :-
    ( property(Name, Unit) ; evidence_unit(Name, Unit) ),
    Unit \== ''.
