/*  Chronicles: complex events, each a rule over grounded fluents and events.

    chronicle(Event, Start-End) is one rule. It may use whatever a query may use, and the chronicles
    before it. Its answers are ordinary events of the run. An empty interval is made one tick long. Users' own
    are in rules.pl.
*/

:- module(chronicles,
          [ chronicle/2,                % ?Event, -Interval
            chronicle_name/2            % -Name, -Arity
          ]).
:- use_module(library(lists)).
:- use_module(timeline).
:- use_module(allen).
:- use_module(knowledge).

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
%   Recognition notices nothing shorter than this, so what happens at one moment may be recorded this
%   far apart [s]. It is the longest of its debounce times for contact, support, hold and fall; a test
%   compares them.

slack(0.05).

%!  chronicle(picking_up(?Hand, ?Object), -Interval) is nondet.
%
%   Object loses its support, be it a liquid, while Hand holds it, nothing else takes the support over, and
%   it moves. From the beginning of the hold until Object comes to rest or is let go. What Hand held already when
%   the support began, and did not let go since, only brushed it.

chronicle(picking_up(Hand, Object), Start-End) :-
    hold(Hand, Object, HoldStart, HoldEnd, _),
    slack(Slack),
    once(( borne(Support, Object, SupportStart-Lost),
           HoldStart =< Lost+Slack,
           HoldEnd > Lost+Slack,
           Support \== Hand,
           \+ is_hand(Support),
           \+ kept(Hand, Object, SupportStart, Lost),
           \+ supported_by_another(Hand, Object, Lost+Slack),
           \+ ( occurs(falling(Object), FallStart-FallEnd), FallStart < HoldStart, FallEnd > Lost ),
           occurs(moving(Object), MoveStart-MoveEnd),
           MoveStart < HoldEnd,
           MoveEnd > Lost+Slack )),
    Start is min(HoldStart, Lost),
    End is min(MoveEnd, HoldEnd).

%!  chronicle(putting_down(?Hand, ?Object), -Interval) is nondet.
%
%   Object gains a support, be it a liquid, while Hand holds it, and still has it when Hand lets go. Another hand is no
%   such support, nor is one that Object had to fall to. From the gain of the support until Hand no
%   longer touches Object.

chronicle(putting_down(Hand, Object), Start-End) :-
    hold(Hand, Object, HoldStart, HoldEnd, LetGo),
    slack(Slack),
    once(( borne(Support, Object, Gained-SupportEnd),
           Gained > HoldStart+Slack,
           Gained =< HoldEnd+Slack,
           SupportEnd > LetGo+Slack,
           Support \== Hand,
           \+ is_hand(Support),
           \+ ( occurs(falling(Object), FallStart-_), FallStart >= HoldEnd-Slack, FallStart =< Gained ) )),
    Start is min(Gained, HoldEnd),
    End is max(Gained, LetGo).

%!  chronicle(dropping(?Hand, ?Object), -Interval) is nondet.
%
%   A hold ends in falling: at once, or after slipping through Hand's grip. From the end of the hold to
%   the end of the fall. While another hand holds Object, or something bears it, it is not dropped; nor
%   is what only lay on a hand that gave way.

chronicle(dropping(Hand, Object), HoldEnd-FallEnd) :-
    hold(Hand, Object, HoldStart, HoldEnd, LetGo),
    slack(Slack),
    once(( occurs(falling(Object), FallStart-FallEnd),
           FallStart > HoldStart,
           FallStart >= HoldEnd-Slack,
           FallStart =< LetGo+Slack,
           FallEnd > HoldEnd )),
    \+ ( member(Carried, [attached(_, Object), supports(_, Object)]),
         holds(Carried, OtherStart-OtherEnd),
         OtherStart < FallStart,
         OtherEnd > HoldEnd+Slack ).

%!  chronicle(pouringTo(?From, ?Liquid, ?To), -Interval) is nondet.
%
%   Liquid flows over the rim of From, which is tilted, and some of it comes from there to To. From the
%   beginning of the outflow until the stream ends: the outflow, or what arrives at To.

chronicle(pouringTo(From, Liquid, To), Start-End) :-
    over_rim(From, Liquid, Start-OutEnd),
    tilt(From, Liquid, Start-OutEnd, Tilt),
    upright(Limit),
    Tilt > Limit,
    longest_fall(Fall),
    findall(To-Last,
            ( occurs(flowingOnto(Liquid, To), First-Last),
              evidence(flowingOnto(Liquid, To), First-Last, source, From),
              Last > Start,
              First =< OutEnd+Fall ),
            Arrivals),
    setof(Last, member(To-Last, Arrivals), Ends),
    last(Ends, ArrivalEnd),
    End is max(OutEnd, ArrivalEnd).

%!  chronicle(overflowing(?Container, ?Liquid), -Interval) is nondet.
%
%   Liquid flows over the rim of Container, which is full, upright, and not just being moved.

chronicle(overflowing(Container, Liquid), Start-End) :-
    over_rim(Container, Liquid, Start-End),
    tilt(Container, Liquid, Start-End, Tilt),
    upright(Limit),
    Tilt =< Limit,
    evidence(flowingOut(Container, Liquid), Start-End, fill, Fill),
    full(Least),
    Fill >= Least,
    \+ ( occurs(moving(Container), MoveStart-MoveEnd), MoveStart =< Start, MoveEnd > Start ).

%!  chronicle(leaking(?Container, ?Liquid), -Interval) is nondet.
%
%   A noticeable part of Liquid flows out of Container through a hole.

chronicle(leaking(Container, Liquid), Interval) :-
    occurs(flowingOut(Container, Liquid), Interval),
    evidence(flowingOut(Container, Liquid), Interval, through_holes, Share),
    evidence(flowingOut(Container, Liquid), Interval, fraction, Fraction),
    noticeable(Least),
    Share*Fraction >= Least.

%   over_rim(?Container, ?Liquid, ?Interval): most of what flows out takes the way over the rim.

over_rim(Container, Liquid, Interval) :-
    occurs(flowingOut(Container, Liquid), Interval),
    evidence(flowingOut(Container, Liquid), Interval, over_rim, Share),
    Share >= 0.5.

tilt(Container, Liquid, Interval, Tilt) :-
    evidence(flowingOut(Container, Liquid), Interval, tilt, Tilt).

%   Greatest tilt of what stands upright [rad]: 10 degrees.

upright(0.1745).

%   Least fill of what is full [1]: particles pack less tightly at walls, and slosh.

full(0.9).

%   Longest fall of a stream [s]: from 1.2 m.

longest_fall(0.5).

%   Fraction of a stuff that is noticed [1]; a test compares it with that of recognition.

noticeable(0.02).

%   hold(?Hand, ?Object, -Start, -End, -LetGo): Hand holds Object, not by a joint, and touches it until LetGo.

hold(Hand, Object, Start, End, LetGo) :-
    holds(attached(Hand, Object), Start-End),
    \+ evidence(attached(Hand, Object), Start-End, by, joint),
    (   holds(contacts(Hand, Object), TouchStart-TouchEnd),
        TouchStart =< End,
        TouchEnd > End
    ->  LetGo = TouchEnd
    ;   LetGo = End
    ).

%   borne(?Support, ?Object, ?Interval): Support bears Object, or is a liquid in which it is immersed or
%   floats, and which takes over from the hand that lets go of it there.

borne(Support, Object, Interval) :-
    holds(supports(Support, Object), Interval).
borne(Liquid, Object, Interval) :-
    holds(immersed(Object, Liquid), Interval).
borne(Liquid, Object, Interval) :-
    holds(floats(Object, Liquid), Interval).

%   kept(+Hand, +Object, +Start, +End): Hand held Object before Start, and did not let go until End.

kept(Hand, Object, Start, End) :-
    hold(Hand, Object, HoldStart, HoldEnd, LetGo),
    slack(Slack),
    HoldStart < Start,
    HoldEnd >= Start-Slack,
    LetGo >= End-Slack.

%   is_hand(+Thing): Thing is a gripper, as far as is known of it.

is_hand(Thing) :-
    (   instance_of(Thing, 'Gripper')
    ;   occurs(openingGripper(Thing), _)
    ;   occurs(closingGripper(Thing), _)
    ),
    !.

supported_by_another(Hand, Object, Time) :-
    Instant is Time,
    holds(supports(Other, Object), Instant),
    Other \== Hand,
    \+ is_hand(Other).
