:- use_module(library(yall)).
:- use_module(library(lists)).
:- use_module(library(apply)).
:- use_module(rows).
:- use_module('../../src/prolepsis/logic/prolog/timeline').
:- use_module('../../src/prolepsis/logic/prolog/chronicles').

%   What a hand did, in the cases that differ by one fact.

done(Rows, Done) :-
    answers(Rows, Event-T, ( occurs(Event, T), functor(Event, Name, 2), chronicle_name(Name, 2) ), Done).

%   Recorded from a simulated hand: an egg is lifted off the table, and lowered again.

lifted([ fluent(supports(table1, egg1), 0.0, 2.007),
         fluent(contacts(egg1, table1), 0.0, 2.007),
         fluent(contacts(hand1, egg1), 1.531, 4.318),
         fluent(attached(hand1, egg1), 2.007, 3.952),
         proof(by, grip),
         event(moving(egg1), 2.033, 2.712),
         event(moving(egg1), 3.293, 3.960) ]).

lowered([ fluent(contacts(egg1, table1), 3.952, 5.575),
          fluent(supports(table1, egg1), 3.952, 5.575),
          event(openingGripper(hand1), 4.316, 4.572) ]).

%   The same egg, let go at a height.

let_go([ fluent(supports(table1, egg1), 0.0, 2.007),
         fluent(contacts(hand1, egg1), 1.531, 3.256),
         fluent(attached(hand1, egg1), 2.007, 3.256),
         event(moving(egg1), 2.033, 2.712),
         event(falling(egg1), 3.256, 3.398),
         event(moving(egg1), 3.256, 3.398),
         event(breaking(egg1), 3.398, 3.399),
         fluent(supports(table1, egg1), 3.4, 4.5) ]).

picked(picking_up(hand1, egg1)-(2.007-2.712)).

:- begin_tests(picking_up).

test(lifted_off_the_table, Done == [Picked]) :-
    lifted(Rows), picked(Picked), done(Rows, Done).
test(the_hold_may_be_recorded_before_the_support_is_lost, Done == [picking_up(h, e)-(0.9-2.5)]) :-
    done([ fluent(supports(t, e), 0.0, 1.0), fluent(attached(h, e), 0.9, 3.0), event(moving(e), 1.0, 2.5) ], Done).
test(of_two_supports_lost_at_once_one_is_told, Done == [picking_up(h, e)-(1.0-2.0)]) :-
    done([ fluent(supports(t1, e), 0.0, 0.99), fluent(supports(t2, e), 0.0, 1.01),
           fluent(attached(h, e), 1.0, 3.0), event(moving(e), 1.0, 2.0) ], Done0),
    maplist([E-(S-F), E-(R-F)]>>( R is round(S*10)/10.0 ), Done0, Done).
test(slid_to_another_support, Done == []) :-
    done([ fluent(supports(t1, e), 0.0, 1.0), fluent(supports(t2, e), 0.98, 3.0),
           fluent(attached(h, e), 0.9, 3.0), event(moving(e), 0.9, 2.5) ], Done).
test(lifted_by_two_hands_from_below, Done == [picking_up(h1, e)-(0.9-2.5), picking_up(h2, e)-(0.9-2.5)]) :-
    done([ instance(h1, 'Gripper'), instance(h2, 'Gripper'), fluent(supports(t, e), 0.0, 1.0),
           fluent(attached(h1, e), 0.9, 3.0), fluent(supports(h1, e), 0.8, 3.0),
           fluent(attached(h2, e), 0.9, 3.0), fluent(supports(h2, e), 0.8, 3.0), event(moving(e), 1.0, 2.5) ], Done).
test(falling_off_the_table, Done == []) :-
    done([ fluent(supports(t, e), 0.0, 1.0), event(falling(e), 1.0, 1.4), event(moving(e), 0.8, 1.4),
           fluent(supports(floor, e), 1.5, 3.0) ], Done).
test(held_without_moving, Done == []) :-
    done([ fluent(supports(t, e), 0.0, 1.0), fluent(attached(h, e), 0.9, 3.0) ], Done).
test(taken_from_an_open_hand, Done == []) :-
    done([ instance(palm, 'Gripper'), fluent(supports(palm, e), 0.0, 1.0), fluent(attached(h, e), 0.98, 3.0),
           event(moving(e), 1.0, 2.0) ], Done).
test(lifted_by_a_joint, Done == []) :-
    done([ fluent(supports(t, lid), 0.0, 1.0), fluent(attached(pot, lid), 0.0, 3.0), proof(by, joint),
           event(moving(lid), 1.0, 2.0) ], Done).
test(the_table_ends_with_the_log, Done == []) :-
    done([ fluent(supports(t, e), 0.0, 3.0), fluent(attached(h, e), 0.9, 3.0), event(moving(e), 0.9, 3.0) ], Done).

test(out_of_the_water, Done == [picking_up(h, e)-(0.5-2.0)]) :-
    done([ fluent(floats(e, l), 0.0, 1.0), fluent(attached(h, e), 0.5, 3.0), event(moving(e), 0.9, 2.0) ], Done).
test(the_hold_begins_a_moment_late, Done == [picking_up(h, e)-(1.0-2.0)]) :-
    done([ fluent(supports(t, e), 0.0, 1.0), fluent(attached(h, e), 1.04, 3.0), event(moving(e), 1.0, 2.0) ], Done).
test(caught_in_the_air, Done == []) :-
    done([ fluent(supports(t, e), 0.0, 1.0), fluent(attached(h, e), 1.2, 3.0), event(moving(e), 1.0, 2.0) ], Done).

:- end_tests(picking_up).

:- begin_tests(putting_down).

test(lowered_and_let_go, Done == [Picked, putting_down(hand1, egg1)-(3.952-4.318)]) :-
    lifted(Lifted), lowered(Lowered), append(Lifted, Lowered, Rows), picked(Picked), done(Rows, Done).
test(the_hold_may_be_recorded_beyond_the_support, Done == [putting_down(h, e)-(2.0-2.5)]) :-
    done([ fluent(attached(h, e), 0.0, 2.5), fluent(supports(t, e), 2.0, 4.0) ], Done).
test(put_into_water_where_it_floats, Done == [putting_down(h, e)-(2.0-2.5)]) :-
    done([ fluent(attached(h, e), 0.0, 2.5), fluent(floats(e, l), 2.0, 4.0) ], Done).
test(put_into_water_where_it_sinks, Done == [putting_down(h, e)-(2.0-2.5)]) :-
    done([ fluent(attached(h, e), 0.0, 2.5), fluent(immersed(e, l), 2.0, 4.0), fluent(supports(cup, e), 2.9, 4.0) ],
         Done).
test(dipped_into_it_is_not, Done == []) :-
    done([ fluent(attached(h, e), 0.0, 5.0), fluent(floats(e, l), 2.0, 2.5), event(moving(e), 1.0, 4.0) ], Done).
test(two_supports_are_one_putting_down, Done == [putting_down(h, e)-(2.0-2.02)]) :-
    done([ fluent(attached(h, e), 0.0, 2.0), fluent(supports(b1, e), 2.0, 4.0), fluent(supports(b2, e), 2.02, 4.0),
           fluent(contacts(h, e), 0.0, 2.02) ], Done).
test(dropping_is_not, Done == [Picked, dropping(hand1, egg1)-(3.256-3.398)]) :-
    let_go(Rows), picked(Picked), done(Rows, Done).
test(nor_is_a_short_drop, Done == [dropping(h, e)-(2.0-2.04)]) :-
    done([ fluent(attached(h, e), 0.0, 2.0), event(falling(e), 2.0, 2.04), fluent(supports(t, e), 2.045, 4.0) ], Done).
test(nor_handing_over_to_a_grip, Done == []) :-
    done([ fluent(attached(h1, e), 0.0, 2.1), fluent(attached(h2, e), 2.0, 4.0), event(moving(e), 0.0, 4.0) ], Done).
test(nor_handing_over_to_an_open_hand, Done == []) :-
    done([ instance(palm, 'Gripper'), fluent(attached(h1, e), 0.0, 2.0), fluent(supports(palm, e), 2.0, 4.0) ], Done).
test(only_the_hand_that_put_it_down, Done == [putting_down(h2, e)-(4.0-4.2)]) :-
    done([ fluent(attached(h1, e), 0.0, 2.1), fluent(attached(h2, e), 2.0, 4.2), fluent(supports(t, e), 4.0, 6.0) ],
         Done).
test(nor_brushing_while_held, Done == []) :-
    done([ fluent(attached(h, e), 0.0, 5.0), fluent(supports(t, e), 2.0, 2.4), event(moving(e), 1.0, 4.0) ], Done).
test(nor_brushing_that_interrupts_the_hold, Done == []) :-
    done([ fluent(contacts(h, e), 0.0, 5.0), fluent(attached(h, e), 0.0, 2.0), fluent(supports(t, e), 2.0, 2.4),
           fluent(attached(h, e), 2.4, 5.0), event(moving(e), 1.0, 4.0) ], Done).
test(nor_setting_it_on_the_table_without_letting_go, Done == []) :-
    done([ fluent(contacts(h, e), 0.0, 5.0), fluent(attached(h, e), 0.0, 2.0), fluent(supports(t, e), 2.0, 5.0) ],
         Done).
test(the_table_that_carried_it_all_along_is_not_gained, Done == []) :-
    done([ fluent(attached(h, e), 1.0, 2.0), fluent(supports(t, e), 0.0, 5.0) ], Done).

test(the_support_begins_a_moment_late, Done == [putting_down(h, e)-(2.0-2.04)]) :-
    done([ fluent(attached(h, e), 0.0, 2.0), fluent(supports(t, e), 2.04, 4.0) ], Done).
test(nor_throwing_upon_it, Done == []) :-
    done([ fluent(attached(h, e), 0.0, 2.0), fluent(supports(t, e), 2.2, 4.0) ], Done).

:- end_tests(putting_down).

:- begin_tests(dropping).

test(slipping_through_the_grip, Done == [dropping(h, e)-(2.0-2.9)]) :-
    done([ fluent(contacts(e, h), 0.0, 2.5), fluent(attached(h, e), 0.0, 2.0), event(falling(e), 2.5, 2.9) ], Done).
test(from_an_opening_palm_it_falls_undropped, Done == []) :-
    done([ fluent(supports(palm, e), 0.0, 1.0), event(openingGripper(palm), 0.98, 1.2), event(falling(e), 1.0, 1.3) ],
         Done).
test(a_table_drops_nothing, Done == []) :-
    done([ fluent(supports(t, e), 0.0, 1.0), event(falling(e), 1.0, 1.3) ], Done).
test(another_hand_still_holds_it, Done == []) :-
    done([ fluent(attached(h1, e), 0.0, 2.0), fluent(attached(h2, e), 1.0, 4.0), event(falling(e), 2.0, 2.3) ], Done).
test(put_down_and_pushed_over_the_edge, Done == [putting_down(h, e)-(2.0-2.1)]) :-
    done([ fluent(attached(h, e), 0.0, 2.0), fluent(contacts(h, e), 0.0, 2.1), fluent(supports(t, e), 2.0, 4.0),
           event(falling(e), 4.0, 4.4) ], Done).
test(put_down_then_pushed_over_the_edge_by_the_closed_hand, Done == []) :-
    done([ fluent(attached(h, e), 0.0, 2.0), fluent(contacts(h, e), 0.0, 4.0), fluent(supports(t, e), 2.0, 4.0),
           event(falling(e), 4.0, 4.4) ], Done).
test(gripped_anew_and_dropped_once, Done == [dropping(h, e)-(3.0-3.3)]) :-
    done([ fluent(contacts(h, e), 0.0, 3.0), fluent(attached(h, e), 0.0, 2.0), fluent(attached(h, e), 2.2, 3.0),
           event(falling(e), 3.0, 3.3) ], Done).

test(the_fall_begins_a_moment_late, Done == [dropping(h, e)-(2.0-2.4)]) :-
    done([ fluent(attached(h, e), 0.0, 2.0), event(falling(e), 2.03, 2.4) ], Done).
test(thrown_up_and_falling_later, Done == []) :-
    done([ fluent(attached(h, e), 0.0, 2.0), event(falling(e), 2.3, 2.7) ], Done).

:- end_tests(dropping).

:- begin_tests(chronicles).

test(stand_among_the_other_events_by_time, Types == [picking_up, moving, moving, putting_down, openingGripper]) :-
    lifted(Lifted), lowered(Lowered), append(Lifted, Lowered, Rows),
    answers(Rows, Type, ( occurs(E, _), eventT(E, Type) ), Types).
test(also_of_one_object, Types == [picking_up, moving, moving, putting_down]) :-
    lifted(Lifted), lowered(Lowered), append(Lifted, Lowered, Rows),
    answers(Rows, Type, ( matching(event, E, _, _, egg1), functor(E, Type, _) ), Types).
test(are_typed, Type == picking_up) :-
    lifted(Rows), answers(Rows, Type, eventT(picking_up(hand1, egg1), Type), [Type]).
test(are_found_in_the_other_spelling, Count == 1) :-
    lifted(Rows), answers(Rows, E, eventT(E, 'PickingUp'), Events), length(Events, Count).

:- end_tests(chronicles).

:- begin_tests(liquids).

%   What flows out of a cup that is being tilted, and where it arrives.

poured(To, Source, Rows) :-
    Rows = [ event(flowingOut(cup1, liq1), 2.0, 4.0),
             proof(fraction, 0.9), proof(over_rim, 1.0), proof(through_holes, 0.0), proof(tilt, 1.5), proof(fill, 0.6),
             event(flowingOnto(liq1, To), 2.2, 4.3),
             proof(fraction, 0.9), proof(source, Source) ].

happened(Rows, Events) :-
    answers(Rows, Event-T, ( occurs(Event, T), functor(Event, Name, Arity), chronicle_name(Name, Arity) ), Events).

test(poured_from_cup_to_cup, Events == [pouringTo(cup1, liq1, cup2)-(2.0-4.3)]) :-
    poured(cup2, cup1, Rows), happened(Rows, Events).
test(what_comes_from_elsewhere_was_not_poured, Events == []) :-
    poured(cup2, tap1, Rows), happened(Rows, Events).
test(what_runs_over_the_second_cup_was_not_poured_to_the_table, Events == [pouringTo(cup1, liq1, cup2)-(2.0-4.3)]) :-
    poured(cup2, cup1, Rows),
    append(Rows, [ event(flowingOnto(liq1, table1), 3.0, 5.0), proof(source, cup2) ], More),
    happened(More, Events).
test(the_stream_ends_with_the_outflow_or_the_arrival, Events == [pouringTo(cup1, liq1, cup2)-(2.0-4.0)]) :-
    happened([ event(flowingOut(cup1, liq1), 2.0, 4.0), proof(over_rim, 1.0), proof(tilt, 0.5),
               event(flowingOnto(liq1, cup2), 2.2, 3.3), proof(source, cup1) ], Events).
test(an_arrival_long_after_is_another_matter, Events == []) :-
    happened([ event(flowingOut(cup1, liq1), 2.0, 4.0), proof(over_rim, 1.0), proof(tilt, 0.5),
               event(flowingOnto(liq1, cup2), 6.0, 7.0), proof(source, cup1) ], Events).
test(an_upright_cup_that_leaks_does_not_pour, Events == [leaking(cup1, liq1)-(2.0-4.0)]) :-
    happened([ event(flowingOut(cup1, liq1), 2.0, 4.0), proof(fraction, 0.5), proof(over_rim, 0.1),
               proof(through_holes, 0.9), proof(tilt, 0.0), proof(fill, 0.5),
               event(flowingOnto(liq1, table1), 2.2, 4.3), proof(source, cup1) ], Events).
test(a_few_drops_through_a_hole_are_no_leak, Events == []) :-
    happened([ event(flowingOut(cup1, liq1), 2.0, 4.0), proof(fraction, 0.1), proof(over_rim, 0.9),
               proof(through_holes, 0.1), proof(tilt, 0.0), proof(fill, 0.5) ], Events).

overflown(Fill, Tilt, [ event(flowingOut(cup2, liq2), 2.0, 4.0), proof(fraction, 0.5), proof(over_rim, 1.0),
                        proof(through_holes, 0.0), proof(tilt, Tilt), proof(fill, Fill) ]).

test(a_full_cup_overflows, Events == [overflowing(cup2, liq2)-(2.0-4.0)]) :-
    overflown(0.97, 0.01, Rows), happened(Rows, Events).
test(what_slops_out_of_a_half_full_cup_does_not_overflow, Events == []) :-
    overflown(0.6, 0.01, Rows), happened(Rows, Events).
test(a_tilted_cup_does_not_overflow, Events == []) :-
    overflown(0.97, 0.5, Rows), happened(Rows, Events).
test(a_full_cup_that_is_jerked_does_not_overflow, Events == []) :-
    overflown(0.97, 0.01, Rows), happened([event(moving(cup2), 1.9, 2.5)|Rows], Events).
test(a_cup_that_is_taken_away_later_had_overflown, Events == [overflowing(cup2, liq2)-(2.0-4.0)]) :-
    overflown(0.97, 0.01, Rows), append(Rows, [event(moving(cup2), 5.0, 6.0)], More), happened(More, Events).

:- end_tests(liquids).
