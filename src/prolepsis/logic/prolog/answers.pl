/*  Answers: a goal in text is read, checked, put in order, run within its limits, and answered in text.

    A reply is lines: first "ok", or what went wrong; then one line for each distinct answer, with the
    values of the variables separated by tabs, as terms that can be read back.
*/

:- module(answers,
          [ ask/5                       % +Run, +Text, +Limit, +Seconds, -Reply
          ]).
:- use_module(library(time)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(solution_sequences)).
:- use_module(runs).
:- use_module(guard).
:- use_module(order).
:- use_module(query).

%!  ask(+Run, +Text, +Limit, +Seconds, -Reply:string) is det.
%
%   Reply to the goal Text in Run, with at most Limit answers (infinite: all) in at most Seconds.

ask(Run, Text, Limit, Seconds, Reply) :-
    catch(answers(Run, Text, Limit, Seconds, Lines), Error, failure(Error, Lines)),
    !,
    atomics_to_string(Lines, Reply).

answers(Run, Text, Limit, Seconds, Lines) :-
    read_goal(Text, Goal, Bindings),
    pairs(Bindings, Names, Values),
    call_with_time_limit(Seconds, found(Run, Goal, Values, Limit, Answers)),
    atomic_list_concat(Names, '\t', Header),
    atomic_list_concat([Header|Answers], '\n', Body),
    Lines = ["ok\n", Body].

found(Run, Goal0, Values, Limit, Answers) :-
    check_goal(Goal0),
    order_goal(Goal0, Goal),
    % Nothing that is permitted changes a fact; should it ever, snapshot/1 undoes it.
    snapshot(findall(Answer, limit(Limit, distinct(Answer, answer(Run, Goal, Values, Answer))), Answers)).

answer(Run, Goal, Values, Answer) :-
    with_run(Run, query:Goal),
    value_texts(Values, Answer).

pairs([], [], []).
pairs([Name=Value|More], [Name|Names], [Value|Values]) :-
    pairs(More, Names, Values).

%   Unbound variables of one answer are named _1, _2 ... so that equal answers have equal texts.

value_texts(Values0, Text) :-
    copy_term(Values0, Values, _),
    (   acyclic_term(Values)
    ->  Finite = Values
    ;   maplist(finite, Values, Finite)
    ),
    term_variables(Finite, Variables),
    numbered(Variables, 1, Names),
    with_output_to(string(Text), write_values(Finite, Names)).

finite(Value, Finite) :-
    (   acyclic_term(Value)
    ->  Finite = Value
    ;   '$factorize_term'(Value, Skeleton, Substitutions),
        Finite = @(Skeleton, Substitutions)
    ).

numbered([], _, []).
numbered([Variable|More], N, [Name=Variable|Names]) :-
    atom_concat('_', N, Name),
    Next is N+1,
    numbered(More, Next, Names).

write_values([], _).
write_values([Value|More], Names) :-
    write_term(Value, [quoted(true), ignore_ops(true), variable_names(Names)]),
    (   More == []
    ->  true
    ;   put_char('\t'),
        write_values(More, Names)
    ).

%!  failure(+Error, -Lines) is det.
%
%   The reply to a goal that is refused or comes to nothing: its kind, then what it is about.

failure(refused(Reason), Lines) :-
    !,
    refusal(Reason, Lines).
failure(time_limit_exceeded, ["time"]) :- !.
failure(time_limit_exceeded(_), ["time"]) :- !.
failure(error(resource_error(_), _), ["memory"]) :- !.
failure(error(existence_error(relation, Name), _), Lines) :-
    !,
    refusal(unknown_relation(Name), Lines).
failure(error(type_error(interval, Value), _), ["interval\n", Text]) :-
    !,
    format(string(Text), '~q', [Value]).
failure(error(existence_error(procedure, PI), _), Lines) :-
    !,
    strip_module(PI, _, Plain),
    refusal(unknown_predicate(Plain), Lines).
failure(Error, ["error\n", Text]) :-
    message_to_string(Error, Text0),
    split_string(Text0, "\n", " ", Parts),
    atomic_list_concat(Parts, ' ', Text).

message_to_string(Error, Text) :-
    message_to_codes_(Error, Text),
    !.
message_to_string(Error, Text) :-
    format(string(Text), '~q', [Error]).

message_to_codes_(error(Formal, _), Text) :-
    '$messages':translate_message(error(Formal, _), Lines, []),
    with_output_to(string(Text), print_message_lines(current_output, '', Lines)).

refusal(syntax(Character, Message), ["syntax\n", Character, "\n", Message]).
refusal(unknown_predicate(PI), ["predicate\n", Text, "\n", Known]) :-
    format(string(Text), '~w', [PI]),
    findall(Name, ( allowed(N/A), format(atom(Name), '~w/~w', [N, A]) ), Names),
    sort(Names, Sorted),
    atomic_list_concat(Sorted, '\t', Known).
refusal(unknown_relation(Name), ["relation\n", Text]) :-
    format(string(Text), '~w', [Name]).
refusal(not_permitted(Goal), [Kind, Text]) :-
    (   callable(Goal), Goal \== []
    ->  ( Goal = _:_ -> Kind = "module\n" ; Kind = "permission\n" )
    ;   Kind = "goal\n"
    ),
    term_variables(Goal, Variables),
    maplist(=('$VAR'('_')), Variables),
    format(string(Text), '~W', [Goal, [quoted(true), numbervars(true), max_depth(20)]]).
refusal(unbound_goal, ["unbound"]).
