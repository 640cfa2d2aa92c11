/*  Allen's thirteen relations between intervals, and the paper's broader after and before.

    allen(Relation, I, J) is exact. Ten relations also exist under their bare names. The bare after/2 and
    its inverse before/2 are the paper's broader ones; for Allen's own, and for the interval relation
    contains (a fluent has that name), use allen/3. An unbound interval ranges over the intervals of the
    timeline, each once.
*/

:- module(allen,
          [ allen/3,                    % ?Relation, ?I, ?J
            relation_names/1,           % -Names
            after/2,                    % ?I, ?J
            before/2,                   % ?I, ?J
            meets/2, met_by/2, overlaps/2, overlapped_by/2, starts/2, started_by/2,
            during/2, finishes/2, finished_by/2, equals/2           % ?I, ?J
          ]).
:- use_module(ticks).
:- use_module(timeline).

%!  allen(?Relation, ?I, ?J) is nondet.
%
%   True if Relation is the one in which interval I stands to interval J.

allen(Relation, I, J) :-
    relation_names(Names),
    (   var(Relation)
    ->  true
    ;   memberchk(Relation, Names)
    ->  true
    ;   throw(error(existence_error(relation, Relation), _))
    ),
    interval(I, S1, E1),
    interval(J, S2, E2),
    compare_ends(S1, E1, S2, E2, Relation).

%!  relation_names(-Names) is det.

relation_names([ before, after, meets, met_by, overlaps, overlapped_by, starts, started_by,
                 during, contains, finishes, finished_by, equals ]).

compare_ends(_, E1, S2, _, Relation), E1 < S2 => Relation = before.
compare_ends(_, E1, S2, _, Relation), E1 =:= S2 => Relation = meets.
compare_ends(S1, _, _, E2, Relation), S1 > E2 => Relation = after.
compare_ends(S1, _, _, E2, Relation), S1 =:= E2 => Relation = met_by.
compare_ends(S1, E1, S2, E2, Relation), S1 =:= S2 =>
    (   E1 =:= E2 -> Relation = equals
    ;   E1 < E2   -> Relation = starts
    ;   Relation = started_by
    ).
compare_ends(S1, E1, S2, E2, Relation), E1 =:= E2 =>
    (   S1 > S2 -> Relation = finishes
    ;   Relation = finished_by
    ).
compare_ends(S1, E1, S2, E2, Relation), S1 < S2 =>
    (   E1 < E2 -> Relation = overlaps
    ;   Relation = contains
    ).
compare_ends(_, E1, _, E2, Relation) =>
    (   E1 > E2 -> Relation = overlapped_by
    ;   Relation = during
    ).

%!  after(?I, ?J) is nondet.
%
%   True if I begins later and ends later than J: Allen's after, met_by or overlapped_by.

% Most pairs of a join are told apart without their ticks.
after(S1-E1, S2-E2), float(S1), float(E1), float(S2), float(E2), S1 < E1, S2 < E2 =>
    S1 > S2,
    E1 > E2,
    (   ticks_apart(S1, S2, E1, E2)
    ->  true
    ;   after_at_ticks(S1-E1, S2-E2)
    ).
after(I, J) =>
    after_at_ticks(I, J).

after_at_ticks(I, J) :-
    interval(J, S2, E2),
    interval(I, S1, E1),
    S1 > S2,
    E1 > E2.

%!  before(?I, ?J) is nondet.
%
%   The inverse of after/2.

before(I, J) :-
    after(J, I).

meets(I, J) :- allen(meets, I, J).
met_by(I, J) :- allen(met_by, I, J).
overlaps(I, J) :- allen(overlaps, I, J).
overlapped_by(I, J) :- allen(overlapped_by, I, J).
starts(I, J) :- allen(starts, I, J).
started_by(I, J) :- allen(started_by, I, J).
during(I, J) :- allen(during, I, J).
finishes(I, J) :- allen(finishes, I, J).
finished_by(I, J) :- allen(finished_by, I, J).
equals(I, J) :- allen(equals, I, J).
