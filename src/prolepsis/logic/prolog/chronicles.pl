/*  Chronicles: complex events, each a rule over grounded fluents and events.

    chronicle(Event, Start-End) is one rule. It may use whatever a query may use, and the chronicles
    before it. Its answers are ordinary events of the run. An empty interval is made one tick long.
*/

:- module(chronicles,
          [ chronicle/2,                % ?Event, -Interval
            chronicle_name/2            % -Name, -Arity
          ]).
:- use_module(timeline).
:- use_module(allen).
:- use_module(knowledge).

:- multifile chronicle/2.
:- dynamic chronicle/2.

%!  chronicle_name(-Name, -Arity) is nondet.
%
%   The chronicles there are, each once, in their order.

chronicle_name(Name, Arity) :-
    findall(N/A, ( clause(chronicle(Event, _), _), functor(Event, N, A) ), All),
    list_to_set(All, Names),
    member(Name/Arity, Names).

%!  slack(-Seconds) is det.
%
%   Facts are debounced, so what happens at one moment may be recorded this far apart [s].

slack(0.05).

%!  chronicle(picking_up(?Hand, ?Object), -Interval) is nondet.
%
%   Object loses its support while Hand holds it, nothing else takes the support over, and it moves.
%   From the beginning of the hold until Object comes to rest or is let go.

chronicle(picking_up(Hand, Object), Start-End) :-
    holds(attached(Hand, Object), HoldStart-HoldEnd),
    holds(supports(Support, Object), _-Lost),
    Support \== Hand,
    slack(Slack),
    HoldStart =< Lost+Slack,
    HoldEnd > Lost+Slack,
    \+ supported_by_another(Hand, Object, Lost+Slack),
    \+ ( occurs(falling(Object), FallStart-FallEnd), FallStart < HoldStart, FallEnd > Lost ),
    once(( occurs(moving(Object), MoveStart-MoveEnd), MoveStart < HoldEnd, MoveEnd > Lost+Slack )),
    Start is min(HoldStart, Lost),
    End is min(MoveEnd, HoldEnd).

%!  chronicle(putting_down(?Hand, ?Object), -Interval) is nondet.
%
%   Object gains a support while Hand holds it, and still has it when Hand lets go.
%   From the gain of the support until Hand no longer touches Object.

chronicle(putting_down(Hand, Object), Start-End) :-
    holds(attached(Hand, Object), HoldStart-HoldEnd),
    holds(supports(Support, Object), Gained-SupportEnd),
    Support \== Hand,
    slack(Slack),
    Gained > HoldStart+Slack,
    Gained =< HoldEnd+Slack,
    SupportEnd > HoldEnd+Slack,
    \+ ( occurs(falling(Object), FallStart-_), FallStart >= HoldEnd-Slack, FallStart =< Gained ),
    Start is min(Gained, HoldEnd),
    (   holds(contacts(Hand, Object), TouchStart-TouchEnd),
        TouchStart =< Start,
        TouchEnd > Start
    ->  End = TouchEnd
    ;   End is max(Gained, HoldEnd)
    ).

%!  chronicle(dropping(?Hand, ?Object), -Interval) is nondet.
%
%   A hold ends in falling. From the end of the hold to the end of the fall.

chronicle(dropping(Hand, Object), HoldEnd-FallEnd) :-
    holds(attached(Hand, Object), HoldStart-HoldEnd),
    occurs(falling(Object), FallStart-FallEnd),
    slack(Slack),
    abs(FallStart-HoldEnd) =< Slack,
    FallStart > HoldStart,
    FallEnd > HoldEnd,
    \+ ( holds(attached(Other, Object), OtherStart-OtherEnd),
         Other \== Hand,
         OtherStart =< HoldEnd,
         OtherEnd > HoldEnd ).

supported_by_another(Hand, Object, Time) :-
    Instant is Time,
    holds(supports(Other, Object), Instant),
    Other \== Hand.
