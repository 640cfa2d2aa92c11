/*  Near: what did not come about, but nearly. */

:- module(near, [ near_miss/3 ]).       % ?FluentOrEvent, ?Interval, ?Margin
:- use_module(runs).
:- use_module(ticks).

%!  near_miss(?Term, ?Interval, ?Margin) is nondet.
%
%   True if the fluent or event Term was nearly so over Interval, or at the instant Interval if that is a number, and
%   what decides it came up to Margin of its threshold, from 0.8 up to 1.

near_miss(Term0, Time, Margin) :-
    current_run(Run),
    spelt_term(Run, Term0, Term),
    (   number(Time)
    ->  must_be_time(Time),
        snapped(Run, Time, Instant),
        Run:near(Term, Start, End, Margin),
        Start =< Instant,
        Instant < End
    ;   must_be_time(Time),
        Time = Start-End,
        snapped(Run, Start, S),
        snapped(Run, End, E),
        Run:near(Term, S, E, Margin)
    ).
