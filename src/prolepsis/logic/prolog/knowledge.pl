/*  Domain knowledge: what is known of the individuals of the current run.

    Classes are given with everything inferred, so nothing is reasoned here.
*/

:- module(knowledge,
          [ instance_of/2,              % ?Individual, ?Class
            has_part/2,                 % ?Whole, ?Part
            value/3                     % ?Individual, ?Property, ?Value
          ]).
:- use_module(runs).

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
