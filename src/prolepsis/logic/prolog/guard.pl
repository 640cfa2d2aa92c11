/*  The guard: a goal only reads the timeline and computes; anything else is refused, saying why.

    A goal is read as data and walked before it runs. Each predicate in it, also those that it hands to
    findall/3, maplist/3 and the like, must be on the list below, and library(sandbox) must agree.
*/

:- module(guard,
          [ read_goal/3,                % +Text, -Goal, -Bindings
            check_goal/1,               % +Goal
            allowed/1                   % ?Name/Arity
          ]).
:- use_module(library(sandbox)).
:- use_module(library(lists)).
:- use_module(library(apply)).
:- use_module(library(aggregate)).
:- use_module(library(pairs)).
:- use_module(library(ordsets)).
:- use_module(library(solution_sequences)).
:- use_module(library(yall)).
:- use_module(timeline).
:- use_module(allen).
:- use_module(knowledge).
:- use_module(query).

:- multifile
    sandbox:safe_primitive/1,
    sandbox:safe_meta_predicate/1.

%   Each predicate of the modules of ours that queries see is a primitive for the sandbox.

term_expansion(trust(Module), Clauses) :-
    module_property(Module, exports(Exports)),
    findall((sandbox:safe_primitive(Module:Head)),
            ( member(Name/Arity, Exports),
              Name/Arity \== in/2,
              functor(Head, Name, Arity) ),
            Clauses).

trust(timeline).
trust(allen).
trust(knowledge).

sandbox:safe_meta_predicate(timeline:in/2).

%!  read_goal(+Text, -Goal, -Bindings) is det.
%
%   Read the one goal in Text. Bindings are Name=Variable, without the variables that begin with _.
%
%   @error syntax(Character, Message) counted from 0

read_goal(Text, Goal, Bindings) :-
    without_stop(Text, Bare),
    (   Bare == ""
    ->  throw(refused(syntax(0, 'the goal is empty')))
    ;   true
    ),
    % The line break ends a comment that the goal may end with.
    string_concat(Bare, "\n.", Whole),
    setup_call_cleanup(open_string(Whole, In),
                       read_only(In, Goal, All),
                       close(In)),
    exclude(anonymous, All, Bindings).

without_stop(Text, Bare) :-
    split_string(Text, "", " \t\n", [Stripped]),
    (   string_concat(Bare, ".", Stripped)
    ->  true
    ;   Bare = Stripped
    ).

anonymous(Name=_) :-
    sub_atom(Name, 0, _, _, '_').

read_only(In, Goal, Bindings) :-
    catch(( read_term(In, Goal, [variable_names(Bindings), module(query), syntax_errors(error)]),
            read_rest(In, Rest) ),
          error(syntax_error(What), Where),
          syntax_refusal(What, Where)),
    (   Rest == end_of_file
    ->  true
    ;   throw(refused(syntax(0, 'more than one goal; join them with a comma')))
    ).

% After a goal with its own full stop and a comment, only the full stop is left that read_goal/3 added.
read_rest(In, Rest) :-
    catch(read_term(In, Rest, [module(query), syntax_errors(error)]),
          error(syntax_error(end_of_clause), _),
          Rest = end_of_file).

syntax_refusal(What, Where) :-
    (   Where = stream(_, _, _, Character)
    ->  true
    ;   Where = string(_, Character)
    ->  true
    ;   Character = 0
    ),
    (   catch(message_to_string_of(What, Message), _, fail)
    ->  true
    ;   format(atom(Message), '~w', [What])
    ),
    throw(refused(syntax(Character, Message))).

message_to_string_of(What, Message) :-
    format(atom(Plain), '~w', [What]),
    atomic_list_concat(Words, '_', Plain),
    atomic_list_concat(Words, ' ', Message).

%!  check_goal(+Goal) is det.
%
%   @error refused(unknown_predicate(Name/Arity)), refused(unknown_relation(Name)),
%          refused(not_permitted(Goal)), refused(unbound_goal)

check_goal(Goal) :-
    (   acyclic_term(Goal)
    ->  true
    ;   throw(refused(not_permitted('an infinite goal')))
    ),
    walk(Goal),
    catch(sandbox:safe_goal(query:Goal), error(Error, _), sandbox_refusal(Error, Goal)).

sandbox_refusal(permission_error(_, _, What), _) :-
    !,
    strip_module(What, _, Plain),
    throw(refused(not_permitted(Plain))).
sandbox_refusal(_, Goal) :-
    throw(refused(not_permitted(Goal))).

walk(Goal), var(Goal) =>
    throw(refused(unbound_goal)).
walk(Goal), \+ callable(Goal) =>
    throw(refused(not_permitted(Goal))).
walk(Module:Goal) =>
    throw(refused(not_permitted(Module:Goal))).
walk(Goal) =>
    functor(Goal, Name, Arity),
    (   allowed(Name/Arity)
    ->  check_relation(Goal),
        (   predicate_property(query:Goal, meta_predicate(Spec))
        ->  walk_arguments(Arity, Spec, Goal)
        ;   true
        )
    ;   functor(Head, Name, Arity),
        exists(Head)
    ->  throw(refused(not_permitted(Goal)))
    ;   throw(refused(unknown_predicate(Name/Arity)))
    ).

exists(Head) :-
    catch(predicate_property(query:Head, visible), error(_, _), true).

walk_arguments(0, _, _) :- !.
walk_arguments(N, Spec, Goal) :-
    arg(N, Spec, Meta),
    arg(N, Goal, Argument),
    walk_argument(Meta, Argument),
    Rest is N-1,
    walk_arguments(Rest, Spec, Goal).

walk_argument(0, Goal) => walk(Goal).
walk_argument(^, Goal) => walk_quantified(Goal).
walk_argument(Extra, Closure), integer(Extra) => walk_closure(Closure, Extra).
walk_argument(_, _) => true.

walk_quantified(Goal), var(Goal) => walk(Goal).
walk_quantified(_^Goal) => walk_quantified(Goal).
walk_quantified(Goal) => walk(Goal).

%   A closure is called with Extra more arguments.

walk_closure(Closure, _), var(Closure) => walk(Closure).
walk_closure(_/Lambda, Extra) => walk_closure(Lambda, Extra).
walk_closure(_/Parameters>>Body, Extra) => walk_closure(Parameters>>Body, Extra).
walk_closure(Parameters>>Body, Extra), is_list(Parameters) =>
    length(Parameters, Count),
    More is max(0, Extra-Count),
    walk_closure(Body, More).
walk_closure(Closure, 0) => walk(Closure).
walk_closure(Closure, Extra), callable(Closure), Closure \= _:_ =>
    length(Arguments, Extra),
    Closure =.. Plain,
    append(Plain, Arguments, Extended),
    Goal =.. Extended,
    walk(Goal).
walk_closure(Closure, _) => walk(Closure).

check_relation(allen(Relation, _, _)), nonvar(Relation) =>
    relation_names(Names),
    (   memberchk(Relation, Names)
    ->  true
    ;   throw(refused(unknown_relation(Relation)))
    ).
check_relation(format(Sink, Format, _)) =>
    (   compound(Sink),
        functor(Sink, Kind, 1),
        memberchk(Kind, [atom, string, codes, chars]),
        ( atom(Format) ; string(Format) ),
        atom_codes(Format, Codes),
        only_prints(Codes)
    ->  true
    ;   throw(refused(not_permitted(format(Sink, Format, _))))
    ).
check_relation(_) => true.

%   only_prints(+Codes): no directive of a format calls a goal, as ~@ does, and as ~p may.

only_prints([]).
only_prints([0'~|Codes]) :-
    !,
    directive(Codes, Directive, Rest),
    \+ memberchk(Directive, [0'@, 0'p]),
    only_prints(Rest).
only_prints([_|Codes]) :-
    only_prints(Codes).

directive([0'`, _, Directive|Rest], Directive, Rest) :- !.
directive([0'*, Directive|Rest], Directive, Rest) :- !.
directive([Digit|Codes], Directive, Rest) :-
    between(0'0, 0'9, Digit),
    !,
    directive(Codes, Directive, Rest).
directive([Directive|Rest], Directive, Rest).

%!  allowed(?Name/Arity) is nondet.
%
%   What a goal may use.

allowed(PI) :-
    ground(PI),
    !,
    (   allowed_(PI)
    ->  true
    ).
allowed(PI) :-
    allowed_(PI).

allowed_(PI) :- ours(PI).
allowed_(PI) :- builtin(PI).
allowed_(PI) :-
    library(Module),
    module_property(Module, exports(Exports)),
    member(PI, Exports).
allowed_(call/Arity) :-
    between(1, 8, Arity).

ours(PI) :-
    query_module(Module),
    module_property(Module, exports(Exports)),
    member(PI, Exports),
    \+ internal(PI).

internal(matching/5).
internal(args_of/3).
internal(interval/1).
internal(relation_names/1).

query_module(timeline).
query_module(allen).
query_module(knowledge).

library(lists).
library(apply).
library(aggregate).
library(pairs).
library(ordsets).
library(solution_sequences).

builtin(PI) :-
    member(PI,
           [ (',')/2, (;)/2, (->)/2, (*->)/2, (\+)/1, (!)/0, true/0, fail/0, false/0, repeat/0,
             once/1, ignore/1, not/1, forall/2, findall/3, findall/4, bagof/3, setof/3, aggregate_all/3,
             aggregate_all/4, between/3, length/2, numlist/3, memberchk/2, msort/2, sort/2, sort/4,
             predsort/3, keysort/2, succ/2, plus/3,
             (=)/2, (\=)/2, (==)/2, (\==)/2, (@<)/2, (@=<)/2, (@>)/2, (@>=)/2, compare/3, (=@=)/2,
             (\=@=)/2, unify_with_occurs_check/2, subsumes_term/2,
             (is)/2, (=:=)/2, (=\=)/2, (<)/2, (=<)/2, (>)/2, (>=)/2,
             var/1, nonvar/1, atom/1, atomic/1, number/1, integer/1, float/1, compound/1, callable/1,
             ground/1, is_list/1, string/1,
             functor/3, arg/3, (=..)/2, copy_term/2, term_variables/2,
             atom_codes/2, atom_chars/2, char_code/2, atom_length/2, atom_concat/3, sub_atom/5,
             atom_number/2, number_codes/2, atom_string/2, atomic_list_concat/2, atomic_list_concat/3,
             upcase_atom/2, downcase_atom/2, string_concat/3, string_length/2, sub_string/5,
             string_lower/2, string_upper/2, split_string/4, format/3 ]).
