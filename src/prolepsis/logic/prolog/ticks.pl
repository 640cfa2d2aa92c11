/*  Ticks: a time that a goal says is the instant of the tick nearest to it, of which there is one float.

    So a time reads back as it was printed, 2 is 2.0, and what is computed of times meets what is stored.
*/

:- module(ticks,
          [ snapped/2,                  % ?Time, ?Exact
            snapped/3,                  % +Run, ?Time, ?Exact
            snapped_ends/4,             % +Start, +End, -ExactStart, -ExactEnd
            must_be_time/1,             % ?Time
            must_be_interval/1,         % ?Time
            must_be_instant/1,          % ?Time
            ticks_apart/4               % +Later, +Earlier, +OtherLater, +OtherEarlier
          ]).

%!  snapped(?Time, ?Exact) is semidet.
%!  snapped(+Run, ?Time, ?Exact) is semidet.
%
%   Exact is Time as the facts of Run have it, of the current run if none is given; whatever is no number is itself.

snapped(Time, Exact), number(Time) =>
    (   current(Run)
    ->  nearest(Run, Time, Exact)
    ;   in_float(Time, Exact)
    ).
snapped(Time, Exact) =>
    Exact = Time.

snapped(Run, Time, Exact), number(Time) =>
    nearest(Run, Time, Exact).
snapped(_, Time, Exact) =>
    Exact = Time.

current(Run) :-
    nb_current(prolepsis_run, Run),
    Run \== none.

nearest(Run, Time, Exact) :-
    Run:tick(Numerator, Denominator),
    (   abs(Time) < 1.0e15,
        Ticks is Time*Denominator/Numerator,
        counted(Ticks)
    ->  Exact is float(round(Ticks)*Numerator)/Denominator
    ;   in_float(Time, Exact)
    ).

in_float(Time, Exact), float(Time) => Exact = Time.
in_float(Time, Exact) => Exact is float(Time).

%!  must_be_time(?Time) is det.
%!  must_be_interval(?Time) is det.
%!  must_be_instant(?Time) is det.
%
%   Check that Time is not known yet, or is a number or an interval Start-End, each of them a number or not known yet.

must_be_time(Time), number(Time) => must_be_instant(Time).
must_be_time(Time) => must_be_interval(Time).

must_be_interval(Time), var(Time) => true.
must_be_interval(Time) =>
    (   Time = Start-End,
        ( var(Start) ; number(Start) ),
        ( var(End) ; number(End) ),
        \+ ( number(Start), number(End), Start >= End )
    ->  must_be_instant(Start),
        must_be_instant(End)
    ;   throw(error(type_error(interval, Time), _))
    ).

must_be_instant(Time) :-
    (   ( var(Time) ; number(Time), Time > -inf, Time < inf )
    ->  true
    ;   throw(refused(no_time(Time)))
    ).

%   Ticks that floats tell apart.

counted(Ticks) :-
    abs(Ticks) < 9007199254740992.

%!  snapped_ends(+Start, +End, -ExactStart, -ExactEnd) is det.
%
%   The ends of a stretch of time that is not empty, at least a tick apart.

snapped_ends(Start0, End0, Start, End) :-
    snapped(Start0, Start),
    snapped(End0, End1),
    (   Start < End1
    ->  End = End1
    ;   current(Run),
        Run:tick(Numerator, Denominator),
        Ticks is Start*Denominator/Numerator,
        counted(Ticks)
    ->  End is float((round(Ticks)+1)*Numerator)/Denominator
    ;   End is nexttoward(Start, inf)
    ).

%!  ticks_apart(+Later, +Earlier, +OtherLater, +OtherEarlier) is semidet.
%
%   Of neither pair of times the later is less than a tick after the earlier.

ticks_apart(T2, T1, U2, U1) :-
    current(Run),
    Run:tick(Numerator, Denominator),
    (T2-T1)*Denominator >= Numerator,
    (U2-U1)*Denominator >= Numerator.
