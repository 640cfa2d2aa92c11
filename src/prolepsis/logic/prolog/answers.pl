/*  Answers: a goal in text is read, checked, put in order, run within its limits, and answered in text.

    A reply is lines: first "ok" ("cut" where a value was too large or deep to be told whole) and, after tabs, how the answer
    rests on what still went on when the log ended, and that; or what went wrong. Then what may not have been meant, in threes: as it
    stands, of what kind that is, and the name that was meant or the values that are told; then each "no" on which an answer
    rests, with the same of it; the variables; and one line for each distinct answer, with the values of the variables
    separated by tabs, as terms that can be read back.
*/

:- module(answers,
          [ ask/5,                      % +Run, +Text, +Limit, +Seconds, -Reply
            failure/2,                  % +Error, -Lines
            short_text/2,               % +Term, -Text
            small/1                     % +Term
          ]).
:- use_module(library(time)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(occurs)).
:- use_module(library(solution_sequences)).
:- use_module(another_time).
:- use_module(denials).
:- use_module(runs).
:- use_module(guard).
:- use_module(kinds).
:- use_module(known).
:- use_module(longer).
:- use_module(names).
:- use_module(numbers).
:- use_module(not_as_meant).
:- use_module(open_ends).
:- use_module(order).
:- use_module(outer).
:- use_module(query).
:- use_module(same_tick).

%!  ask(+Run, +Text, +Limit, +Seconds, -Reply:string) is det.
%
%   Reply to the goal Text in Run, with at most Limit answers (infinite: all) in at most Seconds.

ask(Run, Text, Limit, Seconds, Reply) :-
    catch(answers(Run, Text, Limit, Seconds, Lines), Error, failure(Error, Lines)),
    !,
    atomics_to_string(Lines, Reply).

answers(Run, Text, Limit, Seconds, Lines) :-
    read_goal(Text, Goal, Bindings),
    outer_bindings(Goal, Bindings, Outer),
    pairs(Outer, Names, Values),
    nb_setval(prolepsis_cut, "ok"),
    nb_setval(prolepsis_told, 0),
    statistics(inferences, Before),
    call_with_time_limit(Seconds, answers(Run, Goal, Bindings, Values, Limit, Answers, Read, Kept, Ordered)),
    statistics(inferences, After),
    Spent is After-Before,
    nb_getval(prolepsis_cut, Status),
    how_ended(Run, Goal, asked_of(Ordered, Values, Limit), Answers, Ends),
    atomic_list_concat([Status|Ends], '\t', First),
    (   Answers == []
    ->  ( same_tick(Run, Kept, Name) -> Together = [Name, together, ''] ; Together = [] ),
        another_time(Run, Kept, 2_000_000, Otherwise),
        Denied = []
    ;   Together = [],
        Otherwise = [],
        denials(Run, Kept, Ordered, Spent, Denied)
    ),
    append([Read, Together, Otherwise], ReadAll),
    atomic_list_concat(ReadAll, '\t', Second),
    maplist(told_of_denied(Run), Denied, Told),
    atomic_list_concat(Told, '\x1D\', Third),
    atomic_list_concat(Names, '\t', Header),
    atomic_list_concat([Header|Answers], '\n', Body),
    Lines = [First, "\n", Second, "\n", Third, "\n", Body].

%   A "no" rests on what it would be another answer without, and on what might have come to what is asked.

how_ended(Run, Goal, Asked, Answers, Ends) :-
    (   rests_on(Run, Goal, answers:Asked, Events, How0)
    ->  true
    ;   Events = [],
        How0 = none
    ),
    (   Answers == []
    ->  How = until,
        open_ends(Run, Goal, Events, Fields)
    ;   How = How0,
        open_fields(Events, Fields)
    ),
    ( Fields == [] -> Ends = [] ; Ends = [How|Fields] ).

%   asked_of(+Goal, +Values, +Limit, +Module, -Texts): what is answered in a run Module; nothing of it is told.

asked_of(Goal, Values, Limit, Module, Texts) :-
    nb_getval(prolepsis_cut, Cut),
    nb_getval(prolepsis_told, Told),
    call_cleanup(snapshot(findall(Text, limit(Limit, distinct(Text, answer_in(Module, Goal, Values, Text))), Texts)),
                 ( nb_setval(prolepsis_cut, Cut), nb_setval(prolepsis_told, Told) )).

answer_in(Module, Goal, Values, Text) :-
    with_module(Module, query:Goal),
    value_texts(Values, Text).

told_of_denied(Run, Goal, Told) :-
    short_text(Goal, Text),
    open_ends(Run, Goal, [], Ends),
    readings(Goal, [], Readings),
    not_as_meant(Run, Goal, [], Readings, [], Read),
    another_time(Run, Goal, 50_000, Otherwise),
    append(Read, Otherwise, ReadAll),
    atomic_list_concat([Text|Ends], '\t', First),
    atomic_list_concat(ReadAll, '\t', Second),
    atomic_list_concat([First, Second], '\x1E\', Told).

not_as_meant(Run, Goal, Bindings, Readings, Variables, Read) :-
    findall([Shown, Of, Text],
            (   read_as_variable(Goal, Bindings, Shown, Kind, Name),
                named_kind(Kind, Of),
                short_text(Name, Text)
            ;   individual_as_variable(Readings, Variables, Bindings, Shown, Name),
                Of = individual,
                short_text(Name, Text)
            ;   never_both(Readings, Variables, Bindings, Shown, Text),
                Of = both
            ;   given_by_none(Goal, Bindings, Shown, Of),
                Text = ''
            ;   spelt_otherwise(Readings, Given, Name),
                Of = spelling,
                short_text(Given, Shown),
                short_text(Name, Text)
            ;   told_by_none(Readings, What, Value, Told),
                named_kind(What, Of),
                short_text(Value, Shown),
                findall(Each, ( member(One, Told), format(atom(Each), '~q', [One]) ), All),
                atomic_list_concat(All, '\x1F\', Text)
            ;   outside(Goal, Readings, Run, Shown),
                Of = time,
                Text = ''
            ),
            Found),
    append(Found, Read).

named_kind(type(Kind), Of) => Of = Kind.
named_kind(name(Kind), Of) => Of = Kind.
named_kind(value(Name), Of) => atom_concat('value of ', Name, Of).
named_kind(Kind, Of) => Of = Kind.

answers(Run, Goal, Bindings, Values, Limit, Answers, Read, Kept, Ordered) :-
    check_goal(Goal),
    apart(Goal, Kept, Numbers),
    term_variables(Kept, Variables),
    readings(Kept, Numbers, Readings),
    check_names(Goal, Readings),
    known_run(Run, Module),
    as_kept(Module, Readings, KeptNumbers),
    maplist(becomes, Numbers, KeptNumbers),
    order_goal(Kept, Ordered),
    found(Run, Ordered, Values, Limit, Answers),
    not_as_meant(Run, Goal, Bindings, Readings, Variables, Read).

found(Run, Goal, Values, Limit, Answers) :-
    % Nothing that is permitted changes a fact; should it ever, snapshot/1 undoes it.
    snapshot(findall(Answer, limit(Limit, distinct(Answer, answer(Run, Goal, Values, Answer))), Answers)).

becomes(Number-_, Number).

answer(Run, Goal, Values, Answer) :-
    with_run(Run, query:Goal),
    value_texts(Values, Answer).

pairs([], [], []).
pairs([Name=Value|More], [Name|Names], [Value|Values]) :-
    pairs(More, Names, Values).

%   Unbound variables of one answer are named _1, _2 ... so that equal answers have equal texts.

value_texts(Values0, Text) :-
    (   acyclic_term(Values0)
    ->  Values1 = Values0
    ;   maplist(finite, Values0, Values1)
    ),
    most_characters(Most),
    (   size_abstract_term(100, Values1, Abstract),
        Abstract =@= Values1,
        \+ ( sub_term(Part, Values1), too_long(Part) ),
        written(Values1, Text),
        string_length(Text, Length),
        Length =< Most
    ->  true
    ;   cut(Values1, Values),
        written(Values, Text)
    ),
    count(Text).

written(Values0, Text) :-
    copy_term(Values0, Values, _),
    term_variables(Values, Variables),
    numbered(Variables, 1, Names),
    with_output_to(string(Text), write_values(Values, Names)).

finite(Value, Finite) :-
    (   acyclic_term(Value)
    ->  Finite = Value
    ;   '$factorize_term'(Value, Skeleton, Substitutions),
        Finite = @(Skeleton, Substitutions)
    ).

%   How much of a value is told: names and numbers, how deep they stand, and the characters of one name; and of all
%   answers, characters. A term that shares its parts may be far larger when it is written than in memory.

most_parts(200_000).
most_deep(100).
most_characters(1_000_000).
most_told(50_000_000).

%!  cut(+Values, -Cut) is det.
%
%   Cut is Values where what is too large or too deep has become the atom ... .

cut(Values, Cut) :-
    maplist(cut_value, Values, Cut).

cut_value(Value, Cut) :-
    most_parts(Most),
    cut_term(Value, Most, _, 0, Cut).

cut_term(Term, Left0, Left, Depth, Cut) :-
    most_deep(Deepest),
    (   ( Left0 =< 0 ; Depth > Deepest )
    ->  Left = Left0,
        cut_here(Cut)
    ;   compound(Term),
        Term = [_|_]
    ->  Next is Depth+1,
        cut_list(Term, Left0, Left, Next, Cut)
    ;   compound(Term)
    ->  compound_name_arity(Term, Name, Arity),
        Left1 is Left0-1-Arity,
        (   Left1 < 0
        ->  Left = Left1,
            cut_here(Cut)
        ;   compound_name_arity(Cut, Name, Arity),
            Next is Depth+1,
            cut_arguments(1, Arity, Term, Left1, Left, Next, Cut)
        )
    ;   too_long(Term)
    ->  Left is Left0-1,
        cut_here(Cut)
    ;   Left is Left0-1,
        Cut = Term
    ).

cut_arguments(N, Arity, _, Left0, Left, _, _), N > Arity => Left = Left0.
cut_arguments(N, Arity, Term, Left0, Left, Depth, Cut) =>
    arg(N, Term, Argument),
    arg(N, Cut, CutArgument),
    cut_term(Argument, Left0, Left1, Depth, CutArgument),
    Next is N+1,
    cut_arguments(Next, Arity, Term, Left1, Left, Depth, Cut).

cut_list([Item|Items], Left0, Left, Depth, Cut), Left0 > 0 =>
    Cut = [CutItem|More],
    Left1 is Left0-1,
    cut_term(Item, Left1, Left2, Depth, CutItem),
    cut_list(Items, Left2, Left, Depth, More).
cut_list(Rest, Left0, Left, _, Cut), Rest == [] => Cut = [], Left = Left0.
cut_list([_|_], Left0, Left, _, Cut) => Cut = [Rest], Left = Left0, cut_here(Rest).
cut_list(Rest, Left0, Left, Depth, Cut) => cut_term(Rest, Left0, Left, Depth, Cut).

cut_here('...') :-
    nb_setval(prolepsis_cut, "cut").

%   A number's digits are not written to be counted: that takes longer the more there are.

too_long(Term) :-
    most_characters(Most),
    (   atom(Term)
    ->  atom_length(Term, Length)
    ;   string(Term)
    ->  string_length(Term, Length)
    ;   integer(Term)
    ->  Length is ceiling(msb(abs(Term)+1)/3)
    ),
    Length > Most.

count(Text) :-
    nb_getval(prolepsis_told, Told0),
    string_length(Text, Length),
    Told is Told0+Length,
    nb_setval(prolepsis_told, Told),
    most_told(Most),
    (   Told =< Most
    ->  true
    ;   throw(refused(too_much(Most)))
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
    short_text(Value, Text).
failure(error(existence_error(procedure, PI), _), Lines) :-
    !,
    strip_module(PI, _, Plain),
    refusal(unknown_predicate(Plain), Lines).
failure(Error, ["error\n", Text]) :-
    (   small(Error),
        catch(message_text(Error, Text0), _, fail)
    ->  split_string(Text0, "\n", " ", Parts),
        atomic_list_concat(Parts, ' ', Text1),
        shortened(Text1, Text)
    ;   short_text(Error, Text)
    ).

message_text(error(Formal, _), Text) :-
    '$messages':translate_message(error(Formal, _), Lines, []),
    with_output_to(string(Text), print_message_lines(current_output, '', Lines)).

%!  short_text(+Term, -Text:string) is det.
%
%   Text shows Term in at most 200 characters and one line, however large Term is.

short_text(Term0, Text) :-
    (   acyclic_term(Term0)
    ->  Term1 = Term0
    ;   finite(Term0, Term1)
    ),
    size_abstract_term(60, Term1, Term2),
    copy_term(Term2, Term, _),
    term_variables(Term, Variables),
    maplist(=('$VAR'('_')), Variables),
    format(string(Long), '~W', [Term, [quoted(true), numbervars(true), max_depth(20)]]),
    shortened(Long, Text).

shortened(Long, Text) :-
    string_length(Long, Length),
    (   Length =< 200
    ->  Text = Long
    ;   sub_string(Long, 0, 197, _, Start),
        string_concat(Start, "...", Text)
    ).

%   small(+Term): Term has few enough parts to be written.

small(Term) :-
    size_abstract_term(1000, Term, Abstract),
    Abstract =@= Term.

refusal(syntax(Character, Message), ["syntax\n", Character, "\n", Text, "\n", Known]) :-
    shortened(Message, Text),
    findall(Name, ( allowed(Name/_) ; candidate(type(fact), Name) ), Names),
    sort(Names, Sorted),
    atomic_list_concat(Sorted, '\t', Known).
refusal(unknown_predicate(PI), ["predicate\n", Text, "\n", Known]) :-
    short_text(PI, Text),
    findall(Name, ( allowed(N/A), format(atom(Name), '~w/~w', [N, A]) ), Names),
    sort(Names, Sorted),
    atomic_list_concat(Sorted, '\t', Known).
refusal(unknown_name(Kind, Named), ["name\n", Of, "\n", Text, "\n", Known]) :-
    named_kind(Kind, Of),
    short_text(Named, Text),
    known_names(Kind, Names),
    findall(Each, ( member(Known0, Names), format(atom(Each), '~q', [Known0]) ), All),
    atomic_list_concat(All, '\t', Known).
refusal(no_value(Name), ["related\n", Name]).
refusal(no_number(Name, Unit, Value), ["number\n", Name, "\n", Unit, "\n", Text]) :-
    short_text(Value, Text).
refusal(no_list(Value), ["list\n", Text]) :-
    short_text(Value, Text).
refusal(other_kind(Kind, Name, Other), ["other\n", Name, "\n", Kind, "\n", Other]).
refusal(computed_interval(Reader), ["computed\n", Text]) :-
    short_text(Reader, Text).
refusal(no_time(Value), ["instant\n", Text]) :-
    short_text(Value, Text).
refusal(unknown_relation(Name), ["relation\n", Text]) :-
    short_text(Name, Text).
refusal(not_permitted(Goal), [Kind, Text]) :-
    (   callable(Goal), Goal \== []
    ->  ( Goal = _:_ -> Kind = "module\n" ; Kind = "permission\n" )
    ;   Kind = "goal\n"
    ),
    short_text(Goal, Text).
refusal(unbound_goal, ["unbound"]).
refusal(too_much(Most), ["much\n", Most]).
