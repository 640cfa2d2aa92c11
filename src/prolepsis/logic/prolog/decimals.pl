/*  Decimals: what a goal computes of 0.1 and 0.2 is what it is of a tenth and a fifth.

    A float in a goal, or that it finds, is the simplest fraction of which it is the nearest float: 0.1 is a tenth. Sums,
    differences, products, quotients and whole powers are exact, and what they come to is the float nearest to that. So what is
    computed meets what is stored, in whatever order it is computed. What is large or small beyond 1.0e30 is computed as ever.
*/

:- module(decimals,
          [ in_decimals/2,              % +Goal, -Decimal
            computed/2,                 % ?Number, +Expression
            compared/3,                 % +Relation, +Expression, +Expression
            same/2,                     % ?Value, ?Value
            other/2,                    % ?Value, ?Value
            added/3,                    % ?Number, ?Number, ?Sum
            summed/2                    % +Numbers, ?Sum
          ]).
:- use_module(library(lists)).
:- use_module(positions).
:- use_module(guard, [may/1]).

%!  in_decimals(+Goal, -Decimal) is det.
%
%   Decimal is Goal, which the guard has let pass, with what computes in it done by this module.

in_decimals(Goal, Decimal), var(Goal) => Decimal = Goal.
in_decimals(Free/Lambda, Decimal) => Decimal = Free/Inner, in_decimals(Lambda, Inner).
in_decimals(Parameters>>Body, Decimal), is_list(Parameters) => Decimal = (Parameters>>Inner), in_decimals(Body, Inner).
in_decimals(Variables^Goal, Decimal) => Decimal = Variables^Inner, in_decimals(Goal, Inner).
in_decimals(aggregate_all(What, Goal, Result), Decimal), gathers(What, Expression, Number, Gathered) =>
    in_decimals(Goal, Inner),
    Computed = ( Inner, decimals:computed(Number, Expression) ),
    (   What = sum(_)
    ->  Decimal = ( findall(Number, Computed, Numbers), decimals:summed(Numbers, Result) )
    ;   Decimal = ( aggregate_all(Gathered, Computed, Found), decimals:same(Found, Result) )
    ).
in_decimals(Goal, Decimal), computes(Goal, Computed) => Decimal = Computed.
in_decimals(Goal, Decimal), callable(Goal), functor(Goal, Name, Arity), Arity > 0, functor(Calls, Name, Arity), may(Calls) =>
    Goal =.. [Name|Arguments],
    Calls =.. [Name|Called],
    all_in_decimals(Called, Arguments, Decimals),
    Decimal =.. [Name|Decimals].
in_decimals(Goal, Decimal) => Decimal = Goal.

all_in_decimals([], [], []).
all_in_decimals([Calls|More], [Argument|Arguments], [Decimal|Decimals]) :-
    (   nonvar(Argument),
        called(Calls, Argument, Goal)
    ->  in_decimals(Goal, Whole),
        without_last(Calls, Argument, Goal, Whole, Decimal)
    ;   Decimal = Argument
    ),
    all_in_decimals(More, Arguments, Decimals).

%   What a closure is called with stands at its end, in what computes as in what did.

without_last(_, Argument, Goal, Whole, Decimal), Goal == Argument => Decimal = Whole.
without_last(_, Argument, Goal, Whole, Decimal), Goal == Whole => Decimal = Argument.
without_last(Extra, _, _, Module:Whole, Decimal), Whole \= (_ , _) =>
    Whole =.. [Name|All],
    length(Last, Extra),
    append(Arguments, Last, All),
    Plain =.. [Name|Arguments],
    Decimal = Module:Plain.
without_last(_, Argument, _, _, Decimal) => Decimal = Argument.

gathers(What, Expression, Number, Gathered), compound(What) =>
    (   What = sum(Expression), Gathered = What
    ;   What = max(Expression), Gathered = max(Number)
    ;   What = min(Expression), Gathered = min(Number)
    ;   What = max(Expression, Witness), Gathered = max(Number, Witness)
    ;   What = min(Expression, Witness), Gathered = min(Number, Witness)
    ),
    !.
gathers(_, _, _, _) => fail.

computes(X is Expression, decimals:computed(X, Expression)).
computes(A =:= B, decimals:compared(=:=, A, B)).
computes(A =\= B, decimals:compared(=\=, A, B)).
computes(A < B, decimals:compared(<, A, B)).
computes(A =< B, decimals:compared(=<, A, B)).
computes(A > B, decimals:compared(>, A, B)).
computes(A >= B, decimals:compared(>=, A, B)).
computes(A = B, decimals:same(A, B)) :- may_be_number(A), may_be_number(B).
computes(A \= B, decimals:other(A, B)) :- may_be_number(A), may_be_number(B).
computes(plus(A, B, C), decimals:added(A, B, C)).
computes(sum_list(List, Sum), decimals:summed(List, Sum)).

may_be_number(A) :- ( var(A) ; number(A) ), !.

%!  computed(?Number, +Expression) is semidet.
%
%   Number is what Expression comes to: as is/2, but that 10 is 10.0.

computed(Number, Expression) :-
    come_to(Expression, Value),
    same(Number, Value).

%!  compared(+Relation, +A, +B) is semidet.

compared(Relation, A, B) :-
    come_to(A, X),
    come_to(B, Y),
    call(Relation, X, Y).

%!  same(?A, ?B) is semidet.
%!  other(?A, ?B) is semidet.
%
%   A and B are one, or are not: of numbers, however they are written.

same(A, B), number(A), number(B) => A =:= B.
same(A, B) => A = B.

other(A, B), number(A), number(B) => A =\= B.
other(A, B) => A \= B.

%!  added(?A, ?B, ?Sum) is semidet.

added(A, B, Sum), var(A) => computed(A, Sum-B).
added(A, B, Sum), var(B) => computed(B, Sum-A).
added(A, B, Sum) => computed(Sum, A+B).

%!  summed(+Numbers, ?Sum) is semidet.

summed(Numbers, Sum) :-
    added_up(Numbers, 0, Value),
    same(Value, Sum).

added_up([], Sum, Sum).
added_up([Number|Numbers], Sum0, Sum) :-
    come_to(Sum0+Number, Sum1),
    added_up(Numbers, Sum1, Sum).

come_to(Expression, Value), number(Expression) => Value = Expression.
come_to(Expression, Value), compound(Expression), acyclic_term(Expression) =>
    exact(Expression, Kind, Exact),
    in_number(Kind, Exact, Value).
come_to(Expression, Value) => Value is Expression.

in_number(fraction, Fraction, Number) => Number is float(Fraction).
in_number(_, Number0, Number) => Number = Number0.

%   exact(+Expression, -Kind, -Value): Value is a whole number, the fraction for which a float stands, or plain: a float that
%   is none.

exact(Expression, Kind, Value), integer(Expression) => Kind = whole, Value = Expression.
exact(Expression, Kind, Value), float(Expression) => of_float(Expression, Kind, Value).
exact(A+B, Kind, Value) => operands(A, B, KindA, X, KindB, Y), added(KindA, X, KindB, Y, Kind, Value).
exact(A-B, Kind, Value) => operands(A, B, KindA, X, KindB, Y), subtracted(KindA, X, KindB, Y, Kind, Value).
exact(A*B, Kind, Value) => operands(A, B, KindA, X, KindB, Y), multiplied(KindA, X, KindB, Y, Kind, Value).
exact(A/B, Kind, Value) => operands(A, B, KindA, X, KindB, Y), divided(KindA, X, KindB, Y, Kind, Value).
exact(A**B, Kind, Value) => operands(A, B, KindA, X, KindB, Y), raised(**, KindA, X, KindB, Y, Kind, Value).
exact(A^B, Kind, Value) => operands(A, B, KindA, X, KindB, Y), raised(^, KindA, X, KindB, Y, Kind, Value).
exact(-A, Kind, Value) => exact(A, Kind, X), Value is -X.
exact(+A, Kind, Value) => exact(A, Kind, Value).
exact(abs(A), Kind, Value) => exact(A, Kind, X), Value is abs(X).
exact(Expression, Kind, Value), compound(Expression), rounds(Expression, A) =>
    exact(A, KindA, X),
    ( KindA == fraction -> Plain = X ; in_number(KindA, X, Plain) ),
    functor(Expression, Name, 1),
    Rounding =.. [Name, Plain],
    Number is Rounding,
    of_number(Number, Kind, Value).
exact(Expression, Kind, Value), compound(Expression), Expression \= [_|_] =>
    compound_name_arguments(Expression, Name, Arguments0),
    all_come_to(Arguments0, Arguments),
    compound_name_arguments(Plain, Name, Arguments),
    Number is Plain,
    of_number(Number, Kind, Value).
exact(Expression, Kind, Value) =>
    Number is Expression,
    of_number(Number, Kind, Value).

rounds(floor(A), A).
rounds(ceiling(A), A).
rounds(round(A), A).
rounds(integer(A), A).
rounds(truncate(A), A).

all_come_to([], []).
all_come_to([Expression|Expressions], [Number|Numbers]) :-
    exact(Expression, Kind, Value),
    in_number(Kind, Value, Number),
    all_come_to(Expressions, Numbers).

operands(A, B, KindA, X, KindB, Y) :-
    exact(A, KindA, X),
    exact(B, KindB, Y).

of_number(Number, Kind, Value), float(Number) => of_float(Number, Kind, Value).
of_number(Number, Kind, Value) => Kind = whole, Value = Number.

of_float(Float, Kind, Value) :-
    Size is abs(Float),
    (   ( Size < 1.0e30, Size > 1.0e-30 ; Size =:= 0.0 )
    ->  Kind = fraction,
        Value is rationalize(Float)
    ;   Kind = plain,
        Value = Float
    ).

added(whole, X, whole, Y, Kind, Value) => Value is X+Y, Kind = whole.
added(KindA, X, KindB, Y, Kind, Value), KindA \== plain, KindB \== plain => Value is X+Y, Kind = fraction.
added(KindA, X, KindB, Y, Kind, Value) => plain(KindA, X, KindB, Y, +, Kind, Value).

subtracted(whole, X, whole, Y, Kind, Value) => Value is X-Y, Kind = whole.
subtracted(KindA, X, KindB, Y, Kind, Value), KindA \== plain, KindB \== plain => Value is X-Y, Kind = fraction.
subtracted(KindA, X, KindB, Y, Kind, Value) => plain(KindA, X, KindB, Y, -, Kind, Value).

multiplied(whole, X, whole, Y, Kind, Value) => Value is X*Y, Kind = whole.
multiplied(KindA, X, KindB, Y, Kind, Value), KindA \== plain, KindB \== plain => Value is X*Y, Kind = fraction.
multiplied(KindA, X, KindB, Y, Kind, Value) => plain(KindA, X, KindB, Y, *, Kind, Value).

divided(whole, X, whole, Y, Kind, Value) => Number is X/Y, of_number(Number, Kind, Value).
divided(KindA, X, KindB, Y, Kind, Value), KindA \== plain, KindB \== plain, Y =\= 0 => Value is X rdiv Y, Kind = fraction.
divided(KindA, X, KindB, Y, Kind, Value) => plain(KindA, X, KindB, Y, /, Kind, Value).

%   Greatest whole power that is exact, and the binary digits of its base.

most_power(64).
most_digits(128).

raised(_, fraction, X, whole, Y, Kind, Value), most_power(Most), abs(Y) =< Most, is_short(X), ( X =\= 0 ; Y > 0 ) =>
    Value is X**Y,
    Kind = fraction.
raised(Operator, KindA, X, KindB, Y, Kind, Value) => plain(KindA, X, KindB, Y, Operator, Kind, Value).

is_short(Fraction) :-
    most_digits(Most),
    Numerator is abs(numerator(Fraction)),
    Denominator is denominator(Fraction),
    Numerator < 1<<Most,
    Denominator < 1<<Most.

plain(KindA, X, KindB, Y, Operator, Kind, Value) :-
    in_number(KindA, X, A),
    in_number(KindB, Y, B),
    Expression =.. [Operator, A, B],
    Number is Expression,
    of_number(Number, Kind, Value).
