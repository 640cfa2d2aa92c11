/*  A run made of rows, for the tests: the rows are what a run file holds, without the list of types. */

:- module(rows,
          [ answers/4                   % +Rows, ?Template, :Goal, -Answers
          ]).
:- use_module('../../src/prolepsis/logic/prolog/runs').
:- use_module(library(lists)).

:- meta_predicate answers(+, ?, 0, -).

%!  answers(+Rows, ?Template, :Goal, -Answers) is det.
%
%   Answers are the instances of Template for which Goal is true in a run of Rows.

answers(Rows, Template, Goal, Answers) :-
    findall(type(Type, Kind, Arity),
            ( member(Row, Rows), Row =.. [Kind, Term, _, _], memberchk(Kind, [fluent, event]),
              functor(Term, Type, Arity) ),
            Types0),
    sort(Types0, Types),
    setup_call_cleanup(
        tmp_file_stream(utf8, File, Out),
        ( forall(( member(Row, [tick(1, 1000), lasts(1000.0), symmetric(contacts)|Types]) ; member(Row, Rows) ), format(Out, '~q.~n', [Row])),
          close(Out),
          load_run(test, File),
          finish_run(test),
          findall(Template, with_run(test, Goal), Answers) ),
        delete_file(File)).
