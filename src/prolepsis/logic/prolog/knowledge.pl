/*  Domain knowledge: what is known of the individuals of the current run.

    Classes are given with everything inferred, so nothing is reasoned here.
*/

:- module(knowledge,
          [ instance_of/3,              % ?Individual, ?Class, ?Interval
            instance_of/2,              % ?Individual, ?Class
            has_part/2,                 % ?Whole, ?Part
            value/3,                    % ?Individual, ?Property, ?Value
            subclass_of/2,              % ?Class, ?Above
            unit/2                      % ?Name, ?Unit
          ]).
:- use_module(library(lists)).
:- use_module(classes).
:- use_module(runs).
:- use_module(ticks).
:- use_module(vocabulary).

%!  instance_of(?Individual, ?Class) is nondet.
%
%   True if Individual belongs to Class, inferred classes included: as the situation tells, or at any time of the run.

instance_of(Individual, Class) :-
    current_run(Run),
    (   Run:instance(Individual, Class)
    ;   comes_to_be(Run, Individual, Class)
    ).

%!  instance_of(?Individual, ?Class, ?Interval) is nondet.
%
%   True if Individual belongs to Class over Interval, or at the instant Interval if that is a number. What a class asks
%   for may come and go: an egg is a BrokenThing once it is broken, a cup a LiquidContainer while a liquid is in it.

instance_of(Individual, Class, Instant), number(Instant) =>
    must_be_time(Instant),
    current_run(Run),
    snapped(Run, Instant, Time),
    belongs(Run, Individual, Class, Start, End),
    Start =< Time,
    Time < End.
instance_of(Individual, Class, Time) =>
    must_be_time(Time),
    current_run(Run),
    Time = Start-End,
    snapped(Run, Start, S),
    snapped(Run, End, E),
    belongs(Run, Individual, Class, S, E).

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
    Run:value(Individual, Property, Known),
    equal_value(Value, Known).

%!  subclass_of(?Class, ?Above) is nondet.
%
%   True if Above is a class above Class, as told, at any height: each once, the nearest first.

subclass_of(Class, Above), var(Class) =>
    current_run(Run),
    setof(Each, Near^told_above(Run, Each, Near), Classes),
    member(Class, Classes),
    all_above(Run, Class, All),
    (   nonvar(Above)
    ->  memberchk(Above, All)
    ;   member(Above, All)
    ).
subclass_of(Class, Above) =>
    current_run(Run),
    all_above(Run, Class, All),
    member(Above, All).

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
