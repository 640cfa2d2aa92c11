/*  Classes in time: what makes an individual one of a class may come and go.

    A class may be defined by named classes, by what is true of an individual, and by a relation to some of a class. What
    is true and what is related are fluents, so it is known when each part of a definition is met. Any other class is as
    the situation tells, from the start to the end; and so is one of these where no fluent tells of it at the start.

    All this is worked out when a run is loaded, once for each class and individual, and kept with the run.
*/

:- module(classes,
          [ work_out_classes/1,         % +Run
            belongs/5,                  % +Run, ?Individual, ?Class, ?Start, ?End
            comes_to_be/3,              % +Run, ?Individual, ?Class
            told_above/3,               % +Run, ?Class, ?Above
            all_above/3                 % +Run, +Class, -Above
          ]).
:- use_module(library(apply)).
:- use_module(library(assoc)).
:- use_module(library(lists)).
:- use_module(library(ordsets)).
:- use_module(library(pairs)).
:- use_module(runs).
:- use_module(vocabulary).

%!  belongs(+Run, ?Individual, ?Class, ?Start, ?End) is nondet.
%
%   True if Individual is one of Class from Start to End, and not right before and after.

belongs(Run, Individual, Class, Start, End) :-
    Run:instance(Individual, Class),
    (   Run:touched(Individual),
        Run:changing(Class)
    ->  Run:belonging(Individual, Class, Start, End)
    ;   Start = 0.0,
        Run:lasts(End)
    ).
belongs(Run, Individual, Class, Start, End) :-
    Run:becomes(Individual, Class),
    Run:belonging(Individual, Class, Start, End).

%!  comes_to_be(+Run, ?Individual, ?Class) is nondet.
%
%   True if Individual is one of Class at some time, though the situation does not tell of it.

comes_to_be(Run, Individual, Class) :-
    Run:becomes(Individual, Class).

%!  work_out_classes(+Run) is det.
%
%   Keep in Run when each individual of which a fluent tells is one of each class that fluents decide. From what does not
%   change on, classes grow by those of the classes below and those that meet the definition, until none does any more.

work_out_classes(Run) :-
    findall(Property, ( definition(Run, _, Property, _), Property \== 'is a' ), Asked0),
    sort(Asked0, Asked),
    findall(Property-Rows, ( member(Property, Asked), met(Run, Property, Rows), Rows \== [] ), Met),
    findall(Individual, ( member(_-Rows, Met), member(Individual-_, Rows) ), Touched0),
    sort(Touched0, Touched),
    changing(Run, Met, Classes),
    constant(Run, Met, Touched, Classes, Constant),
    list_to_assoc(Met, Rows),
    graph(told_above(Run, Class, Above), Above-Class, Down),
    maplist(way(Run, Down, Touched, Classes), Classes, Ways),
    grown(Ways, Rows, Constant, Members),
    forall(member(Class, Classes), assertz(Run:changing(Class))),
    forall(member(Individual, Touched), assertz(Run:touched(Individual))),
    forall(( gen_assoc(Class, Members, Its), told_members(Run, Down, Class, Told), member(Individual-Spans, Its) ),
           keep(Run, Told, Individual, Class, Spans)).

keep(Run, Told, Individual, Class, Spans) :-
    forall(member(Start-End, Spans), assertz(Run:belonging(Individual, Class, Start, End))),
    (   ord_memberchk(Individual, Told)
    ->  true
    ;   assertz(Run:becomes(Individual, Class))
    ).

%   changing(+Run, +Met, -Classes): those on which fluents bear; a class stands after those that it follows from, but for
%   those that follow from it, too.

changing(Run, Met, Classes) :-
    findall(Class, ( member(Property-_, Met), definition(Run, Class, Property, _) ), Near0),
    sort(Near0, Near),
    graph(( told_above(Run, Class, Above) ; definition(Run, Above, _, Class) ), Class-Above, Graph),
    reached(Graph, Near, Classes).

graph(Goal, Pair, Graph) :-
    findall(Pair, Goal, Pairs0),
    sort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    list_to_assoc(Groups, Graph).

reached(Graph, Starts, Nodes) :-
    empty_assoc(Seen),
    foldl(visit(Graph), Starts, Seen-[], _-Nodes).

visit(_, Node, Seen-Nodes, Same) :-
    get_assoc(Node, Seen, _),
    !,
    Same = Seen-Nodes.
visit(Graph, Node, Seen0-Nodes0, Seen-[Node|Nodes]) :-
    put_assoc(Node, Seen0, true, Seen1),
    found(Node, Graph, Next),
    foldl(visit(Graph), Next, Seen1-Nodes0, Seen-Nodes).

found(Key, Assoc, List) :-
    (   get_assoc(Key, Assoc, List0)
    ->  List = List0
    ;   List = []
    ).

%   constant(+Run, +Met, +Touched, +Classes, -Constant): of Classes, the members that no fluent takes out, as an assoc of
%   lists Individual-Spans: those told, unless a fluent tells at the start of what they are, or what they are follows from
%   such a class. What a definition asks for does not follow from it.

constant(Run, Met, Touched, Classes, Constant) :-
    Run:lasts(Last),
    graph(told_above(Run, Class, Above), Class-Above, Up),
    graph(( told_above(Run, Class, Above), \+ definition(Run, Class, 'is a', Above) ), Class-Above, Following),
    graph(definition(Run, Class, 'is a', Part), Part-Class, Users),
    graph(( member(Property-Rows, Met),
            member(Individual-Its, Rows),
            once(member(_-(0.0-_), Its)),
            definition(Run, Class, Property, _) ),
          Individual-Class, AtStart),
    list_to_ord_set(Classes, Changing),
    findall(Class-(Individual-[0.0-Last]),
            ( member(Individual, Touched),
              findall(Each, Run:instance(Individual, Each), Told0),
              sort(Told0, Told),
              found(Individual, AtStart, Near),
              reached(Users, Near, Asking),
              sort(Asking, Asked),
              ord_intersection(Asked, Told, Shown),
              reached(Following, Shown, Loose0),
              sort(Loose0, Loose),
              ord_subtract(Told, Loose, Firm),
              reached(Up, Firm, All0),
              sort(All0, All),
              ord_intersection(All, Changing, Its),
              member(Class, Its) ),
            Pairs0),
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    list_to_assoc(Groups, Constant).

%   way(+Run, +Down, +Touched, +Classes, +Class, -Way): Way is way(Class, Below, Parts), how it comes to members: the classes
%   right below, and what its definition asks for. Of a class that does not change, those told are its members.

way(Run, Down, Touched, Classes, Class, way(Class, Below, Parts)) :-
    found(Class, Down, Below),
    findall(Part,
            ( definition(Run, Class, Asked, Filler), part(Asked, Filler, Run, Down, Touched, Classes, Part) ),
            Parts).

part('is a', Class, _, _, _, Classes, Part), memberchk(Class, Classes) =>
    Part = members(Class).
part('is a', Class, Run, Down, Touched, _, Part) =>
    Run:lasts(Last),
    told_members(Run, Down, Class, Told),
    ord_intersection(Touched, Told, Its),
    findall(Each-[0.0-Last], member(Each, Its), Members),
    Part = told(Members).
part(Property, 'is true', _, _, _, _, Part) =>
    Part = some(Property, true, '', []).
part(Property, '', _, _, _, _, Part) =>
    Part = some(Property, to(_), '', []).
part(Property, Class, Run, Down, Touched, Classes, Part) =>
    told_members(Run, Down, Class, Told0),
    ( memberchk(Class, Classes) -> ord_subtract(Told0, Touched, Told) ; Told = Told0 ),
    Part = some(Property, to(_), Class, Told).

told_members(Run, Down, Class, Members) :-
    reached(Down, [Class], Classes),
    findall(Each, ( member(Its, Classes), Run:instance(Each, Its) ), Members0),
    sort(Members0, Members).

%   grown(+Ways, +Rows, +Members0, -Members)

grown(Ways, Rows, Members0, Members) :-
    foldl(grow(Rows), Ways, Members0-same, Members1-Changed),
    (   Changed == same
    ->  Members = Members1
    ;   grown(Ways, Rows, Members1, Members)
    ).

grow(Rows, way(Class, Below, Parts), Members0-Changed0, Members-Changed) :-
    found(Class, Members0, Old),
    findall(One, ( member(Each, Below), found(Each, Members0, Its), member(One, Its) ), Lower),
    (   Parts = [Part|More]
    ->  part_members(Rows, Members0, Part, First),
        foldl(narrowed(Rows, Members0), More, First, Defined)
    ;   Defined = []
    ),
    append([Old, Defined, Lower], All),
    united(All, New),
    (   New == Old
    ->  Members = Members0,
        Changed = Changed0
    ;   put_assoc(Class, Members0, New, Members),
        Changed = changed
    ).

narrowed(_, _, _, [], Narrow) =>
    Narrow = [].
narrowed(Rows, Members, Part, Wide, Narrow) =>
    part_members(Rows, Members, Part, Its),
    both(Wide, Its, Narrow).

part_members(_, Members, members(Class), Its) =>
    found(Class, Members, Its).
part_members(_, _, told(Told), Its) =>
    Its = Told.
part_members(Rows, Members, some(Property, Other, Class, Told), Its) =>
    found(Class, Members, Of0),
    list_to_assoc(Of0, Of),
    found(Property, Rows, All),
    findall(Individual-Spans,
            ( member(Individual-Met, All),
              findall(Part, ( member(Other-Span, Met), while(Other, Class, Of, Told, Span, Part) ), Parts),
              Parts \== [],
              joined(Parts, Spans) ),
            Its).

%   while(+Other, +Class, +Of, +Told, +Span, -Part): in Part of Span Other is of Class, of which Of tells when it changes.

while(_, '', _, _, Span, Span) :- !.
while(to(Other), _, Of, _, Span, Part) :-
    get_assoc(Other, Of, Spans),
    !,
    member(During, Spans),
    common(Span, During, Part).
while(to(Other), _, _, Told, Span, Span) :-
    ord_memberchk(Other, Told).

%   united(+Pairs, -United): Individual-Spans, each individual once, in order.

united(Pairs0, United) :-
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    maplist(united_spans, Groups, United).

united_spans(Individual-Lists, Individual-Spans) :-
    append(Lists, All),
    joined(All, Spans).

%   both(+Ones, +Others, -Common): who is among both, and while.

both([One-Spans|Ones], [Other-During|Others], Common), One == Other =>
    findall(Part, ( member(S, Spans), member(D, During), common(S, D, Part) ), Parts),
    (   Parts == []
    ->  Common = More
    ;   Common = [One-Parts|More]
    ),
    both(Ones, Others, More).
both([One-_|Ones], [Other-During|Others], Common), One @< Other =>
    both(Ones, [Other-During|Others], Common).
both([One-Spans|Ones], [_|Others], Common) =>
    both([One-Spans|Ones], Others, Common).
both(_, _, Common) =>
    Common = [].

common(S1-E1, S2-E2, Start-End) :-
    Start is max(S1, S2),
    End is min(E1, E2),
    Start < End.

%   met(+Run, +Property, -Rows): who has Property when, Individual-[Other-Span, ...] by individual: true for Other if it is
%   plainly so, to(Other) if it is a relation.

met(Run, Property, Rows) :-
    or_below([Property-ahead], [], Run, Names),
    findall(Individual-(Other-(Start-End)),
            ( member(Name-Way, Names),
              table_row(fluent, Run, Name, _, _, Term, Start, End, _),
              told_of(Way, Run, Term, Individual, Other) ),
            Pairs0),
    sort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Rows).

told_of(Way, Run, Term, Individual, Other) :-
    compound(Term),
    compound_name_arguments(Term, Type, Arguments),
    (   Arguments = [Individual],
        Way == ahead,
        Other = true
    ;   Arguments = [A, B],
        (   Way == ahead, Individual-Other = A-to(B)
        ;   ( Way == back ; Run:symmetric(Type) ), Individual-Other = B-to(A)
        )
    ).

%   or_below(+Queue, +Seen, +Run, -All): the properties in Queue and below them, each with the way in which it is read.

or_below([], Seen, _, Seen).
or_below([Each|Queue], Seen, Run, All) :-
    (   memberchk(Each, Seen)
    ->  or_below(Queue, Seen, Run, All)
    ;   findall(Near, right_below(Each, Run, Near), Nears),
        append(Nears, Queue, Queue1),
        or_below(Queue1, [Each|Seen], Run, All)
    ).

right_below(Property-Way, Run, Near-Way) :-
    subproperty(Run, Near, Property).
right_below(Property-Way, Run, Near-Back) :-
    ( inverse(Run, Near, Property) ; inverse(Run, Property, Near) ),
    ( Way == ahead -> Back = back ; Back = ahead ).

%   As the situation says, and what only the built-in ontology does.

definition(Run, Class, Asked, Filler) :-
    Run:definition(Class, Asked, Filler).
definition(Run, Class, Asked, Filler) :-
    defined_by(Class, Asked, Filler),
    \+ Run:definition(Class, _, _).

subproperty(Run, Property, Above) :-
    Run:subproperty(Property, Above).
subproperty(_, Property, Above) :-
    property_parent(Property, Above).

inverse(Run, Property, Other) :-
    Run:inverse(Property, Other).
inverse(_, Property, Other) :-
    property_inverse(Property, Other).

%   joined(+Spans, -Joined): what any of Spans covers, in order and apart.

joined(Spans0, Joined) :-
    sort(Spans0, Spans),
    join(Spans, Joined).

join([S-E, S1-E1|Spans], Joined), S1 =< E =>
    Later is max(E, E1),
    join([S-Later|Spans], Joined).
join([Span|Spans], Joined) =>
    Joined = [Span|More],
    join(Spans, More).
join([], Joined) =>
    Joined = [].

%!  told_above(+Run, ?Class, ?Above) is nondet.
%
%   True if Above is told to be right above Class, by the situation or by the built-in ontology.

told_above(Run, Class, Above) :-
    Run:subclass(Class, Above).
told_above(_, Class, Above) :-
    parent(Class, Above).

%!  all_above(+Run, +Class, -Above:list) is det.
%
%   The classes above Class, as told, each once, the nearest first.

all_above(Run, Class, Above) :-
    above([Class], [Class], Run, Above).

%   above(+Classes, +Seen, +Run, -All): those above Classes that are not in the ordered Seen, by height.

above([], _, _, []) :- !.
above(Classes, Seen, Run, All) :-
    findall(Above, ( member(Class, Classes), told_above(Run, Class, Above) ), Aboves0),
    sort(Aboves0, Aboves),
    ord_subtract(Aboves, Seen, New),
    ord_union(Seen, New, Seen1),
    append(New, More, All),
    above(New, Seen1, Run, More).
