/*  Rules of a user's own: a file of chronicles is read as data, checked as goals are, and run within limits.

    A file holds clauses chronicle(Event, Start-End) :- Goal, and those of helpers that only it sees. Nothing in it is
    executed when it is read. Each file is a module of its own, so that no helper meets one of another file, or ours.
*/

:- module(rules,
          [ add_rules/5,                % +Number, +File, +Taken, +Seconds, -Reply
            add_rules_to_run/4          % +Number, +Run, +Seconds, -Reply
          ]).
:- use_module(library(apply)).
:- use_module(library(assoc)).
:- use_module(library(lists)).
:- use_module(library(time)).
:- use_module(library(solution_sequences)).
:- use_module(answers).
:- use_module(chronicles).
:- use_module(decimals).
:- use_module(guard).
:- use_module(known).
:- use_module(names).
:- use_module(query).
:- use_module(runs).

:- dynamic rules_module/2,              % ?Number, ?Module
           rule/3.                      % ?Module, ?Head, ?Body, as it stands in the file

%   No file has more clauses, and no chronicle more answers.

most_clauses(10_000).
most_answers(100_000).

%!  add_rules(+Number, +File, +Taken, +Seconds, -Reply:string) is det.
%
%   Read the rules in File as those of Number, in at most Seconds. No event may be called as those in Taken. Reply is "ok",
%   or what is wrong: its kind, the line of the rule (of a syntax error, the character), and what it is about.

add_rules(Number, File, Taken, Seconds, Reply) :-
    catch(( call_with_time_limit(Seconds, ( read_rules(File, Rules), check_rules(Rules, Taken) )),
            keep_rules(Number, Rules),
            Lines = ["ok"] ),
          Error,
          failure_at(Error, Lines)),
    atomics_to_string(Lines, Reply).

read_rules(File, Rules) :-
    setup_call_cleanup(open(File, read, In, [encoding(utf8)]),
                       read_rules(In, 0, Rules),
                       close(In)).

read_rules(In, Count, Rules) :-
    read_data(In, Term, [term_position(Position)]),
    stream_position_data(line_count, Position, Line),
    (   Term == end_of_file
    ->  (   at_end_of_stream(In)
        ->  Rules = []
        ;   throw(refused_at(Line, no_rule(Term)))
        )
    ;   most_clauses(Most),
        (   Count < Most
        ->  true
        ;   throw(refused_at(Line, too_many))
        ),
        Rules = [Line-Term|More],
        Next is Count+1,
        read_rules(In, Next, More)
    ).

check_rules(Rules, Taken) :-
    maplist(check_head(Taken), Rules, Names),
    (   memberchk(chronicle/2, Names)
    ->  true
    ;   throw(refused_at(1, no_chronicle))
    ),
    sort(Names, Distinct),
    findall(Name-true, ( member(Name, Distinct), Name \== chronicle/2 ), Pairs),
    list_to_assoc(Pairs, Helpers),
    forall(member(Line-Term, Rules),
           ( parts(Term, _, Body),
             catch(check_body(Body, Helpers), refused(Reason), throw(refused_at(Line, Reason))) )).

parts((Head :- Body), Head, Body) :- !.
parts(Head, Head, true).

check_head(Taken, Line-Term, Name/Arity) :-
    parts_checked(Term, Line, Head),
    functor(Head, Name, Arity),
    (   Head = chronicle(Event, Interval)
    ->  (   ( var(Interval) ; Interval = _-_ )
        ->  check_event(Event, Line, Taken)
        ;   throw(refused_at(Line, event(Interval)))
        )
    ;   functor(General, Name, Arity),
        ( allowed(Name/Arity) ; exists(General) )
    ->  throw(refused_at(Line, taken(Name/Arity)))
    ;   true
    ).

check_event(Event, Line, Taken) :-
    (   callable(Event),
        functor(Event, Name, Arity),
        Event \= _:_,
        atom(Name),
        Name \== '[|]',
        ( Arity > 0 ; atom(Event) )
    ->  true
    ;   throw(refused_at(Line, event(Event)))
    ),
    (   ( memberchk(Name, Taken) ; chronicle_name(Name, _) )
    ->  throw(refused_at(Line, known_event(Name)))
    ;   true
    ).

parts_checked(Term, Line, Head) :-
    (   callable(Term),
        acyclic_term(Term),
        \+ ( compound(Term), functor(Term, Name, _), memberchk(Name, [(:-), (?-), (-->), (=>)]), Term \= (_ :- _) ),
        parts(Term, Head, _),
        callable(Head),
        Head \= _:_
    ->  true
    ;   throw(refused_at(Line, no_rule(Term)))
    ).

keep_rules(Number, Rules) :-
    atom_concat('rules ', Number, Module),
    set_module(Module:base(query)),
    forall(member(_-Term, Rules),
           ( parts(Term, Head, Body),
             functor(Head, Name, Arity),
             dynamic(Module:Name/Arity),
             in_decimals(Body, Decimal),
             assertz(Module:(Head :- Decimal)),
             assertz(rule(Module, Head, Body)),
             ( Head = chronicle(Event, _) -> declare_event(Event) ; true ) )),
    assertz(rules_module(Number, Module)).

%!  add_rules_to_run(+Number, +Run, +Seconds, -Reply:string) is det.
%
%   Work out the chronicles of Number in Run, each in at most Seconds, and keep them as events.

add_rules_to_run(Number, Run, Seconds, Reply) :-
    rules_module(Number, Module),
    catch(( check_rule_names(Module),
            add_chronicles(Run, Module, occurrences(Seconds)),
            Lines = ["ok"] ),
          Error,
          failure_at(Error, Lines)),
    atomics_to_string(Lines, Reply).

%   What is named is known of a run only, so it is looked through here, and not when the rules are read.

check_rule_names(Module) :-
    forall(rule(Module, Head, Body),
           catch(check_names(Body), refused(Reason), throw(failed_rule(Head, Reason)))).

%   occurrences(+Seconds, +Event, :Goal, +Template, -Found): what add_chronicles/3 calls.

occurrences(Seconds, Event, Goal, Template, Found) :-
    functor(Event, Name, Arity),
    most_answers(Most),
    catch(call_with_time_limit(Seconds,
                               % What shares its parts would be copied part by part.
                               findall(Template, limit(Most, ( Goal, checked(Template) )), Found0)),
          Error,
          throw(failed(Name/Arity, Error))),
    (   length(Found0, Most)
    ->  throw(failed(Name/Arity, too_many_answers))
    ;   maplist(in_floats, Found0, Found)
    ).

checked(occurrence(S, E, Event)) :-
    (   number(S),
        number(E),
        S > -inf,
        E < inf,
        small(Event),
        ground(Event)
    ->  (   S =< E
        ->  true
        ;   throw(backwards(S, E))
        )
    ;   throw(open_answer)
    ).

in_floats(occurrence(S0, E0, Event), occurrence(S, E, Event)) :-
    S is float(S0),
    E is float(E0).

%!  failure_at(+Error, -Lines) is det.

failure_at(refused_at(Line, too_many), ["many\n", Line]) :- !.
failure_at(refused_at(Line, no_chronicle), ["none\n", Line]) :- !.
failure_at(refused_at(Line, no_rule(Term)), ["rule\n", Line, "\n", Text]) :- !, short_text(Term, Text).
failure_at(refused_at(Line, event(Term)), ["head\n", Line, "\n", Text]) :- !, short_text(Term, Text).
failure_at(refused_at(Line, taken(PI)), ["taken\n", Line, "\n", Text]) :- !, short_text(PI, Text).
failure_at(refused_at(Line, known_event(Name)), ["known\n", Line, "\n", Text]) :- !, short_text(Name, Text).
failure_at(refused_at(Line, Reason), ["goal\n", Line, "\n"|Lines]) :- !, failure(refused(Reason), Lines).
failure_at(refused(syntax(Character, Message)), ["syntax\n", Character, "\n", Message]) :- !.
failure_at(failed(PI, too_many_answers), ["answers\n", Text, "\n", Most]) :-
    !,
    short_text(PI, Text),
    most_answers(Most).
failure_at(failed(PI, backwards(S, E)), ["backwards\n", Text, "\n", Interval]) :-
    !,
    short_text(PI, Text),
    short_text(S-E, Interval).
failure_at(failed(PI, open_answer), ["open\n", Text]) :- !, short_text(PI, Text).
failure_at(failed(PI, error(instantiation_error, _)), ["open\n", Text]) :- !, short_text(PI, Text).
failure_at(failed_rule(chronicle(Event, _), Reason), Lines) :-
    !,
    functor(Event, Name, Arity),
    failure_at(failed(Name/Arity, refused(Reason)), Lines).
failure_at(failed_rule(Head, Reason), Lines) :-
    !,
    functor(Head, Name, Arity),
    failure_at(failed(Name/Arity, refused(Reason)), Lines).
failure_at(failed(PI, Error), ["failed\n", Text, "\n"|Lines]) :- !, short_text(PI, Text), failure(Error, Lines).
failure_at(time_limit_exceeded, ["late\n"]) :- !.
failure_at(Error, ["file\n"|Lines]) :- failure(Error, Lines).
