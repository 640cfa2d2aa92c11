/*  The guard: a goal only reads the timeline and computes; anything else is refused, saying why.

    A goal is read as data and walked before it runs. Each predicate in it must be in the table below, which also
    says which of its arguments are called, as findall/3 and maplist/3 do; those are walked, too, and must be known by
    then: a goal that is built only when the query runs is refused. Of format/3 it says what may be printed and where.
    library(sandbox) must agree. The rules of a chronicle's file are walked in the same way.
*/

:- module(guard,
          [ read_goal/3,                % +Text, -Goal, -Bindings
            read_data/3,                % +In, -Term, +Options
            check_goal/1,               % +Goal
            check_body/2,               % +Goal, +Helpers
            allowed/1,                  % ?Name/Arity
            exists/1,                   % +Head
            may/1                       % ?Form
          ]).
:- use_module(library(sandbox)).
:- use_module(library(lists)).
:- use_module(library(apply)).
:- use_module(library(aggregate)).
:- use_module(library(assoc)).
:- use_module(library(pairs)).
:- use_module(library(ordsets)).
:- use_module(library(solution_sequences)).
:- use_module(library(yall)).
:- use_module(asking, []).
:- use_module(timeline, [in/2]).
:- use_module(allen).
:- use_module(near, []).
:- use_module(open_ends, []).
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

trust(asking).
trust(timeline).
trust(allen).
trust(near).
trust(open_ends).

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
    read_data(In, Goal, [variable_names(Bindings)]),
    read_rest(In, Rest),
    (   Rest == end_of_file
    ->  true
    ;   throw(refused(syntax(0, 'more than one goal; join them with a comma')))
    ).

%!  read_data(+In, -Term, +Options) is det.
%
%   Read a term, and run nothing that stands in it.
%
%   @error refused(syntax(Character, Message))

read_data(In, Term, Options) :-
    catch(read_term(In, Term, [module(query), syntax_errors(error), quasi_quotations(Quoted)|Options]),
          error(syntax_error(What), Where),
          syntax_refusal(What, Where)),
    (   Quoted == []
    ->  true
    ;   throw(refused(syntax(0, 'a quasi-quotation')))
    ).

% After a goal with its own full stop and a comment, only the full stop is left that read_goal/3 added.
read_rest(In, Rest) :-
    catch(read_data(In, Rest, []),
          refused(syntax(_, 'end of clause')),
          Rest = end_of_file).

syntax_refusal(What, Where) :-
    (   ( Where = stream(_, _, _, Character) ; Where = file(_, _, _, Character) )
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
    check_body(Goal, t),
    catch(sandbox:safe_goal(query:Goal), error(Error, _), sandbox_refusal(Error, Goal)).

%!  check_body(+Goal, +Helpers) is det.
%
%   As check_goal/1, where predicates with a Name/Arity in the assoc Helpers may be used, too, which are checked elsewhere.

check_body(Goal, Helpers) :-
    (   acyclic_term(Goal)
    ->  true
    ;   throw(refused(not_permitted('an infinite goal')))
    ),
    walk(Goal, Helpers).

sandbox_refusal(permission_error(_, _, What), _) :-
    !,
    strip_module(What, _, Plain),
    throw(refused(not_permitted(Plain))).
sandbox_refusal(_, Goal) :-
    throw(refused(not_permitted(Goal))).

walk(Goal, _), var(Goal) =>
    throw(refused(unbound_goal)).
walk(Goal, _), \+ callable(Goal) =>
    throw(refused(not_permitted(Goal))).
walk(Module:Goal, _) =>
    throw(refused(not_permitted(Module:Goal))).
walk(Goal, Helpers) =>
    functor(Goal, Name, Arity),
    functor(Form, Name, Arity),
    (   get_assoc(Name/Arity, Helpers, _)
    ->  true
    ;   may(Form)
    ->  walk_arguments(Arity, Form, Goal, Helpers)
    ;   functor(Head, Name, Arity),
        exists(Head)
    ->  throw(refused(not_permitted(Goal)))
    ;   throw(refused(unknown_predicate(Name/Arity)))
    ).

%!  exists(+Head) is semidet.

exists(Head) :-
    catch(predicate_property(query:Head, visible), error(_, _), true).

walk_arguments(0, _, _, _) :- !.
walk_arguments(N, Form, Goal, Helpers) :-
    arg(N, Form, Kind),
    arg(N, Goal, Argument),
    walk_argument(Kind, Argument, Goal, Helpers),
    Rest is N-1,
    walk_arguments(Rest, Form, Goal, Helpers).

walk_argument(?, _, _, _) => true.
walk_argument(^, Argument, _, Helpers) => walk_quantified(Argument, Helpers).
walk_argument(Extra, Argument, _, Helpers), integer(Extra) => walk_closure(Argument, Extra, Helpers).
walk_argument(sink, Argument, Goal, _) => check(sink(Argument), Goal).
walk_argument(directives, Argument, Goal, _) => check(prints(Argument), Goal).
walk_argument(relation, Argument, _, _) => check_relation(Argument).

walk_quantified(Goal, Helpers), var(Goal) => walk(Goal, Helpers).
walk_quantified(_^Goal, Helpers) => walk_quantified(Goal, Helpers).
walk_quantified(Goal, Helpers) => walk(Goal, Helpers).

%   A closure is called with Extra more arguments.

walk_closure(Closure, _, Helpers), var(Closure) => walk(Closure, Helpers).
walk_closure(Closure, 0, Helpers) => walk(Closure, Helpers).
walk_closure(_/Lambda, Extra, Helpers) => walk_closure(Lambda, Extra, Helpers).
walk_closure(_/Parameters>>Body, Extra, Helpers) => walk_closure(Parameters>>Body, Extra, Helpers).
walk_closure(Parameters>>Body, Extra, Helpers), is_list(Parameters) =>
    length(Parameters, Count),
    More is max(0, Extra-Count),
    walk_closure(Body, More, Helpers).
walk_closure(Closure, Extra, Helpers), callable(Closure), Closure \= _:_ =>
    length(Arguments, Extra),
    Closure =.. Plain,
    append(Plain, Arguments, Extended),
    Goal =.. Extended,
    walk(Goal, Helpers).
walk_closure(Closure, _, Helpers) => walk(Closure, Helpers).

check(Condition, Goal) :-
    (   call(Condition)
    ->  true
    ;   throw(refused(not_permitted(Goal)))
    ).

check_relation(Relation), nonvar(Relation) =>
    relation_names(Names),
    (   memberchk(Relation, Names)
    ->  true
    ;   throw(refused(unknown_relation(Relation)))
    ).
check_relation(_) => true.

%   What format/3 prints to, and a text whose directives only print; both known before the goal runs.

sink(Sink) :-
    compound(Sink),
    compound_name_arity(Sink, Kind, 1),
    memberchk(Kind, [atom, string, codes, chars]).

prints(Format) :-
    ( atom(Format) ; string(Format) ),
    !,
    atom_codes(Format, Codes),
    only_prints(Codes).

only_prints([]).
only_prints([0'~|Codes]) :-
    !,
    directive(Codes, Directive, Rest),
    printing(Directives),
    memberchk(Directive, Directives),
    only_prints(Rest).
only_prints([_|Codes]) :-
    only_prints(Codes).

%   Not ~@ and ~p, which call goals, nor ~W, whose options may.

printing(`acdDefgGhiInqrRstw~|+`).

%   A column or a count has at most three digits; ~* would take it from the arguments, which are not known yet.

directive([0'`, _, Directive|Rest], Directive, Rest) :- !.
directive(Codes, Directive, Rest) :-
    digits(3, Codes, [Directive|Rest]).

digits(N, [Digit|Codes], Rest) :-
    between(0'0, 0'9, Digit),
    !,
    N > 0,
    Fewer is N-1,
    digits(Fewer, Codes, Rest).
digits(_, Codes, Codes).

%!  allowed(?Name/Arity) is nondet.
%
%   What a goal may use.

allowed(Name/Arity) :-
    (   nonvar(Name),
        nonvar(Arity)
    ->  functor(Form, Name, Arity),
        may(Form),
        !
    ;   may(Form),
        functor(Form, Name, Arity)
    ).

%!  may(?Form) is nondet.
%
%   The table of what a goal may use. An argument is ? for any term, 0 for a goal, a number for a goal that is called
%   with so many more arguments, ^ for a goal behind Variable^, or one of the forms that walk_argument/4 checks.

% The timeline, intervals and what is known of individuals.
may(holds(?, ?)).
may(holds_at(?, ?)).
may(occurs(?, ?)).
may(fluent(?, ?)).
may(fluentT(?, ?)).
may(event(?, ?)).
may(eventT(?, ?)).
may(ongoing(?)).
may(near_miss(?, ?, ?)).
may(argsOf(?, ?)).
may(objOf(?, ?)).
may(evidence(?, ?, ?, ?)).
may(fact(?, ?, ?, ?, ?, ?)).
may(in(?, 0)).
may(allen(relation, ?, ?)).
may(after(?, ?)).
may(before(?, ?)).
may(meets(?, ?)).
may(met_by(?, ?)).
may(overlaps(?, ?)).
may(overlapped_by(?, ?)).
may(starts(?, ?)).
may(started_by(?, ?)).
may(during(?, ?)).
may(finishes(?, ?)).
may(finished_by(?, ?)).
may(equals(?, ?)).
may(instance_of(?, ?)).
may(instance_of(?, ?, ?)).
may(has_part(?, ?)).
may(value(?, ?, ?)).
may(subclass_of(?, ?)).
may(unit(?, ?)).
% Control.
may((0, 0)).
may((0 ; 0)).
may((0 -> 0)).
may((0 *-> 0)).
may(\+ 0).
may(!).
may(true).
may(fail).
may(false).
may(repeat).
may(once(0)).
may(ignore(0)).
may(not(0)).
may(call(0)).
may(call(1, ?)).
may(call(2, ?, ?)).
may(call(3, ?, ?, ?)).
may(call(4, ?, ?, ?, ?)).
may(call(5, ?, ?, ?, ?, ?)).
may(call(6, ?, ?, ?, ?, ?, ?)).
may(call(7, ?, ?, ?, ?, ?, ?, ?)).
% All solutions.
may(forall(0, 0)).
may(findall(?, 0, ?)).
may(findall(?, 0, ?, ?)).
may(bagof(?, ^, ?)).
may(setof(?, ^, ?)).
may(aggregate(?, ^, ?)).
may(aggregate(?, ?, ^, ?)).
may(aggregate_all(?, 0, ?)).
may(aggregate_all(?, ?, 0, ?)).
may(foreach(0, 0)).
may(distinct(0)).
may(distinct(?, 0)).
may(reduced(0)).
may(reduced(?, 0, ?)).
may(limit(?, 0)).
may(offset(?, 0)).
may(call_nth(0, ?)).
may(order_by(?, 0)).
may(group_by(?, ?, 0, ?)).
% Comparison, arithmetic and types.
may(? = ?).
may(? \= ?).
may(? == ?).
may(? \== ?).
may(? @< ?).
may(? @=< ?).
may(? @> ?).
may(? @>= ?).
may(? =@= ?).
may(? \=@= ?).
may(compare(?, ?, ?)).
may(unify_with_occurs_check(?, ?)).
may(subsumes_term(?, ?)).
may(? is ?).
may(? =:= ?).
may(? =\= ?).
may(? < ?).
may(? =< ?).
may(? > ?).
may(? >= ?).
may(succ(?, ?)).
may(plus(?, ?, ?)).
may(between(?, ?, ?)).
may(var(?)).
may(nonvar(?)).
may(atom(?)).
may(atomic(?)).
may(number(?)).
may(integer(?)).
may(float(?)).
may(compound(?)).
may(callable(?)).
may(ground(?)).
may(is_list(?)).
may(string(?)).
% Terms, atoms and texts.
may(functor(?, ?, ?)).
may(arg(?, ?, ?)).
may(? =.. ?).
may(copy_term(?, ?)).
may(term_variables(?, ?)).
may(atom_codes(?, ?)).
may(atom_chars(?, ?)).
may(char_code(?, ?)).
may(atom_length(?, ?)).
may(atom_concat(?, ?, ?)).
may(sub_atom(?, ?, ?, ?, ?)).
may(atom_number(?, ?)).
may(number_codes(?, ?)).
may(atom_string(?, ?)).
may(atomic_list_concat(?, ?)).
may(atomic_list_concat(?, ?, ?)).
may(upcase_atom(?, ?)).
may(downcase_atom(?, ?)).
may(string_concat(?, ?, ?)).
may(string_length(?, ?)).
may(sub_string(?, ?, ?, ?, ?)).
may(string_lower(?, ?)).
may(string_upper(?, ?)).
may(split_string(?, ?, ?, ?)).
may(format(sink, directives, ?)).
% Lists.
may(append(?, ?)).
may(append(?, ?, ?)).
may(clumped(?, ?)).
may(delete(?, ?, ?)).
may(flatten(?, ?)).
may(intersection(?, ?, ?)).
may(is_set(?)).
may(keysort(?, ?)).
may(last(?, ?)).
may(length(?, ?)).
may(list_to_set(?, ?)).
may(max_list(?, ?)).
may(max_member(?, ?)).
may(max_member(2, ?, ?)).
may(member(?, ?)).
may(memberchk(?, ?)).
may(min_list(?, ?)).
may(min_member(?, ?)).
may(min_member(2, ?, ?)).
may(msort(?, ?)).
may(nextto(?, ?, ?)).
may(nth0(?, ?, ?)).
may(nth0(?, ?, ?, ?)).
may(nth1(?, ?, ?)).
may(nth1(?, ?, ?, ?)).
may(numlist(?, ?, ?)).
may(permutation(?, ?)).
may(predsort(3, ?, ?)).
may(prefix(?, ?)).
may(proper_length(?, ?)).
may(reverse(?, ?)).
may(same_length(?, ?)).
may(select(?, ?, ?)).
may(select(?, ?, ?, ?)).
may(selectchk(?, ?, ?)).
may(selectchk(?, ?, ?, ?)).
may(sort(?, ?)).
may(sort(?, ?, ?, ?)).
may(subset(?, ?)).
may(subtract(?, ?, ?)).
may(sum_list(?, ?)).
may(union(?, ?, ?)).
may(convlist(2, ?, ?)).
may(exclude(1, ?, ?)).
may(include(1, ?, ?)).
may(partition(1, ?, ?, ?)).
may(partition(2, ?, ?, ?, ?)).
may(maplist(1, ?)).
may(maplist(2, ?, ?)).
may(maplist(3, ?, ?, ?)).
may(maplist(4, ?, ?, ?, ?)).
may(foldl(3, ?, ?, ?)).
may(foldl(4, ?, ?, ?, ?)).
may(foldl(5, ?, ?, ?, ?, ?)).
may(foldl(6, ?, ?, ?, ?, ?, ?)).
may(scanl(3, ?, ?, ?)).
may(scanl(4, ?, ?, ?, ?)).
may(scanl(5, ?, ?, ?, ?, ?)).
may(scanl(6, ?, ?, ?, ?, ?, ?)).
% Pairs and ordered sets.
may(group_pairs_by_key(?, ?)).
may(map_list_to_pairs(2, ?, ?)).
may(pairs_keys(?, ?)).
may(pairs_keys_values(?, ?, ?)).
may(pairs_values(?, ?)).
may(transpose_pairs(?, ?)).
may(is_ordset(?)).
may(list_to_ord_set(?, ?)).
may(ord_add_element(?, ?, ?)).
may(ord_del_element(?, ?, ?)).
may(ord_disjoint(?, ?)).
may(ord_empty(?)).
may(ord_intersect(?, ?)).
may(ord_intersection(?, ?)).
may(ord_intersection(?, ?, ?)).
may(ord_memberchk(?, ?)).
may(ord_selectchk(?, ?, ?)).
may(ord_seteq(?, ?)).
may(ord_subset(?, ?)).
may(ord_subtract(?, ?, ?)).
may(ord_symdiff(?, ?, ?)).
may(ord_union(?, ?)).
may(ord_union(?, ?, ?)).
may(ord_union(?, ?, ?, ?)).
