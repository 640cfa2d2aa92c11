/*  Denials: the "no" on which an answer rests, as that of a negation, or of a collection that is empty. */

:- module(denials, [ denials/5 ]).      % +Run, +Goal, +Ordered, +Spent, -Denied
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(solution_sequences)).
:- use_module(library(time)).
:- use_module(order).
:- use_module(positions).
:- use_module(query).
:- use_module(runs).

%   So many answers are looked at, and so many denials told, in so many seconds, and in so many inferences or a part of those
%   that the answers took: this is beside the answer.

most_answers(1000).
most_denials(100).
least_inferences(300_000).
most_inferences(5_000_000).
part_of_inferences(5).
most_seconds(0.5).

%!  denials(+Run, +Goal, +Ordered, +Spent, -Denied:list) is det.
%
%   Denied are goals about Run that are in Goal, as an answer to Goal binds them, which are not so, where Goal is; Ordered
%   is Goal in an order that is quick, whose answers took Spent inferences.

denials(Run, Goal, Ordered, Spent, Denied) :-
    nb_setval(prolepsis_denied, []),
    (   has_asks(Goal)
    ->  least_inferences(Least),
        most_inferences(Most),
        part_of_inferences(Part),
        Inferences is min(Most, max(Least, Spent//Part)),
        most_seconds(Seconds),
        catch(call_with_time_limit(Seconds, call_with_inference_limit(all_denials(Run, Goal, Ordered), Inferences, _)),
              _, true)
    ;   true
    ),
    nb_getval(prolepsis_denied, Found),
    reverse(Found, Denied).

all_denials(Run, Goal, Ordered) :-
    most_answers(Answers),
    most_denials(Most),
    % What stands alone binds nothing in itself.
    ( asks(Goal, _, _) -> Called = true ; Called = Ordered ),
    forall(limit(Most, distinct(Each, with_run(Run, ( limit(Answers, query:Called), denied(Goal, Each) )))),
           ( nb_getval(prolepsis_denied, Found), nb_setval(prolepsis_denied, [Each|Found]) )).

%   asks(+Goal, -Inner, -Then): Goal may be so where Inner is not; else Then is called after Inner.

asks((Inner -> Then ; _), Inner, Then).
asks((Inner *-> Then ; _), Inner, Then).
asks(\+ Inner, Inner, fail).
asks(ignore(Inner), Inner, true).
asks(forall(Inner, Then), Inner, Then).
asks(findall(_, Inner, _), Inner, true).
asks(findall(_, Inner, _, _), Inner, true).
asks(aggregate_all(_, Inner, _), Inner, true).
asks(aggregate_all(_, _, Inner, _), Inner, true).

has_asks(Goal) :-
    within(Goal, Part),
    asks(Part, _, _),
    !.

%   denied(+Goal, -Denied): Goal has been called.

denied(Goal, _), var(Goal) => fail.
denied((If -> Then ; Else), Denied) => branch(If, Then, Else, Denied).
denied((If *-> Then ; Else), Denied) => branch(If, Then, Else, Denied).
denied((A ; B), Denied) => ( taken(A, Denied) ; taken(B, Denied) ).
denied((A, B), Denied) => ( denied(A, Denied) ; denied(B, Denied) ).
denied((A -> B), Denied) => ( denied(A, Denied) ; denied(B, Denied) ).
denied((A *-> B), Denied) => ( denied(A, Denied) ; denied(B, Denied) ).
denied(once(Goal), Denied) => denied(Goal, Denied).
denied(call(Goal), Denied) => denied(Goal, Denied).
denied(setof(_, Goal, _), Denied) => collected(Goal, Denied).
denied(bagof(_, Goal, _), Denied) => collected(Goal, Denied).
denied(Goal, Denied), asks(Goal, Inner, Then) => branch(Inner, Then, true, Denied).
denied(_, _) => fail.

branch(If, Then, Else, Denied) :-
    plain(If, Plain),
    (   \+ so(Plain)
    ->  (   tells(Plain),
            Denied = Plain
        ;   denied(Else, Denied)
        )
    ;   has_asks((If, Then)),
        so(If),
        ( denied(If, Denied) ; taken(Then, Denied) )
    ).

taken(Goal, Denied) :-
    has_asks(Goal),
    so(Goal),
    denied(Goal, Denied).

so(Goal) :-
    order_goal(Goal, Ordered),
    query:Ordered.

collected(_^Goal, Denied) => collected(Goal, Denied).
collected(Goal, Denied) => taken(Goal, Denied).

%   plain(+Goal, -Plain): Plain is Goal but for the negations in it: where these alone make it false, nothing is denied.

plain(Goal, Plain), var(Goal) => Plain = Goal.
plain((A, B), Plain) => Plain = (P, Q), plain(A, P), plain(B, Q).
plain((A ; B), Plain), A \= (_ -> _), A \= (_ *-> _) => Plain = (P ; Q), plain(A, P), plain(B, Q).
plain(\+ _, Plain) => Plain = true.
plain(forall(_, _), Plain) => Plain = true.
plain(Goal, Plain) => Plain = Goal.

%   tells(+Goal): Goal asks the log, or what is known, and not only how things compare.

tells(Goal) :-
    \+ ( within(Goal, In), functor(In, in, 2) ),
    within(Goal, Inner),
    argument(Inner, Kind, _),
    \+ memberchk(Kind, [interval, relation]),
    !.
